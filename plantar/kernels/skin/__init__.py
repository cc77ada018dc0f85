"""Loads of a sole's taxels: sums, areas and extents of one reading or of many, and the ground they see."""
