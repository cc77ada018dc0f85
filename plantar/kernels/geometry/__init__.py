"""Hulls, polygons, outlines and inscribed shapes."""
