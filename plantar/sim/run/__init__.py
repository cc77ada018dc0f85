"""Scenarios from scene to summary."""
