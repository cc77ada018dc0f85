"""Outlines, surfaces and sections."""
