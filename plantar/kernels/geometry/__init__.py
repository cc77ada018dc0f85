"""Hulls, polygons, outlines and what fits into them."""
