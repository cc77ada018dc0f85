"""Acceleration of free fall."""

GRAVITY = 9.81
"""Acceleration of free fall in m/s^2, as every part of the distribution takes it. Nature: the acceleration of free fall
at middle latitudes, to the third digit (9.78 to 9.83 on Earth)."""
