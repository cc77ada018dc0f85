"""Polygons in a plane: hulls, outlines, and the shapes inscribed in them and around them."""
