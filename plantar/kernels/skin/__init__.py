"""Loads of a sole's taxels: sums, areas and extents, and the measured ground."""
