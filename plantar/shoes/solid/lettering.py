"""Stroke font letters as outlines, equal on every machine. In mm."""

from __future__ import annotations

from typing import Any

import shapely

__all__ = ["lettering"]

# Strokes on a grid 4 wide and 6 high, one letter a line: polylines of points, x then y.
_STROKES = {
    "A": "00 26 40|12 32",
    "B": "00 06 36 45 44 33 03|33 42 41 30 00",
    "C": "45 36 16 05 01 10 30 41",
    "D": "00 06 26 44 42 20 00",
    "E": "46 06 00 40|03 33",
    "F": "46 06 00|03 33",
    "G": "45 36 16 05 01 10 30 41 43 23",
    "H": "00 06|40 46|03 43",
    "I": "20 26",
    "J": "46 41 30 10 01",
    "K": "00 06|46 03 40",
    "L": "06 00 40",
    "M": "00 06 23 46 40",
    "N": "00 06 40 46",
    "O": "10 01 05 16 36 45 41 30 10",
    "P": "00 06 36 45 44 33 03",
    "Q": "10 01 05 16 36 45 41 30 10|22 40",
    "R": "00 06 36 45 44 33 03|23 40",
    "S": "45 36 16 05 04 13 33 42 41 30 10 01",
    "T": "06 46|26 20",
    "U": "06 01 10 30 41 46",
    "V": "06 20 46",
    "W": "06 10 24 30 46",
    "X": "00 46|06 40",
    "Y": "06 23 46|23 20",
    "Z": "06 46 00 40",
    "0": "10 01 05 16 36 45 41 30 10|11 35",
    "1": "15 26 20|10 30",
    "2": "05 16 36 45 44 00 40",
    "3": "06 46 23 33 42 41 30 10 01",
    "4": "30 36 02 42",
    "5": "46 06 03 33 42 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02",
    "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33",
    "9": "01 10 30 41 45 36 16 05 04 13 33 44",
    "-": "13 33",
    "_": "00 40",
    ".": "20 21",
    "/": "00 46",
}
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
            points = [(int(p[0]) + _ADVANCE * place, int(p[1])) for p in stroke.split()]
            lines.append(shapely.LineString(points))
    if not lines:
        return shapely.MultiPolygon()
    shape = shapely.union_all(lines).buffer(0.5 * _WIDTH, cap_style="square", join_style="mitre", mitre_limit=1.5)
    shape = shapely.affinity.scale(shape, scale, scale, origin=(0, 0))
    shape = shape.buffer(0.5 * _LAND, join_style="mitre").buffer(-0.5 * _LAND, quad_segs=2)
    parts = [p for p in getattr(shape, "geoms", [shape]) if p.geom_type == "Polygon"]
    return shapely.set_precision(shapely.MultiPolygon([p.simplify(_DETAIL) for p in parts]), 1e-3)
