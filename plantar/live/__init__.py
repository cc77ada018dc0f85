"""Readings of soles as they are sampled."""
