"""Tolerance of times."""

SAME_TIME = 1e-9
"""Times in s that are nearer to each other than this are one: sums of periods differ in their last bits. Nature:
floating point: 1e6 roundings of an hour's time (4e-13 s)."""
