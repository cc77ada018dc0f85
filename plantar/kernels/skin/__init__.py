"""Loads of a sole's taxels: sums, areas and extents of one reading or many, and the measured ground."""
