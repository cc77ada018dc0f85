"""Acceleration of free fall."""

GRAVITY = 9.81
"""Acceleration of free fall in m/s^2, as every part of the distribution takes it."""
