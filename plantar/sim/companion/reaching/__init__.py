"""Reaching a goal among obstacles that may be touched."""
