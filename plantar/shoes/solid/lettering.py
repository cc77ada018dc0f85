"""Stroke font letters as outlines, equal on every machine. In mm."""

from importlib.resources import files
from typing import Any

import shapely

# Strokes on a grid 4 wide and 6 high, one letter a line: polylines of points, x then y.
_STROKES = dict(
    line.split(" ", 1)
    for line in files("plantar.shoes.solid").joinpath("strokes.txt").read_text(encoding="utf-8").splitlines()
)
_ADVANCE = 6.0
_WIDTH = 0.9  # of a stroke, on the grid
_DETAIL = 0.08  # mm that are dropped
_LAND = 1.3  # mm: what is narrower between two strokes is filled


def lettering(text: str, height: float) -> Any:
    """Gives line of text as shapely outlines of a height in mm, lower left corner at the origin.

    Example:
        >>> outline = lettering("L", 6.0)
        >>> [round(v, 2) for v in outline.bounds]
        [-0.45, -0.45, 4.45, 6.45]
    """
    scale = height / 6.0
    lines = []
    for place, letter in enumerate(text.upper()):
        for stroke in filter(None, _STROKES.get(letter, "").split("|")):
            lines.append(shapely.LineString([(int(p[0]) + _ADVANCE * place, int(p[1])) for p in stroke.split()]))
    if not lines:
        return shapely.MultiPolygon()
    shape = shapely.union_all(lines).buffer(0.5 * _WIDTH, cap_style="square", join_style="mitre", mitre_limit=1.5)
    shape = shapely.affinity.scale(shape, scale, scale, origin=(0, 0))
    shape = shape.buffer(0.5 * _LAND, join_style="mitre").buffer(-0.5 * _LAND, join_style="mitre", mitre_limit=1.5)
    parts = [p for p in getattr(shape, "geoms", [shape]) if p.geom_type == "Polygon"]
    return shapely.set_precision(shapely.MultiPolygon([p.simplify(_DETAIL) for p in parts]), 1e-3)
