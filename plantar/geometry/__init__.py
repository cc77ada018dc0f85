"""Polygons in a plane: hulls, outlines, inscribed and enclosing shapes."""
