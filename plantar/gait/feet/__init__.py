"""Commanded feet, their swing and landing."""
