"""Outlines, transforms and sections."""
