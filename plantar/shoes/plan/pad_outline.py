"""Where the pad is thick: next to the taxels, below the printed part. Lengths in mm."""

from __future__ import annotations

from typing import Any

import shapely

from plantar.shoes.geometry.outline import GRID
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.shoe_plan import ShoePlan

__all__ = ["pad_rim"]

_PLAY = 0.3  # mm between the taxels' heads and the rim
_LEAST = 2.0  # mm: a narrower rim is left out


def pad_rim(plan: ShoePlan, parameters: ShoeParameters) -> Any:
    """Gives the pad's rim by plan and parameters: the contact face next to the taxels where it is wide enough, a
    shapely geometry, possibly empty.
    """
    if parameters.pad_rim_height <= 0.0:
        return shapely.Polygon()
    beside = plan.contact.difference(shapely.union_all(plan.cells).buffer(_PLAY, join_style="mitre"))
    wide = beside.buffer(-0.5 * _LEAST).buffer(0.5 * _LEAST, quad_segs=2).intersection(beside)
    parts = [p for p in getattr(wide, "geoms", [wide]) if p.geom_type == "Polygon" and p.area > _LEAST**2]
    return shapely.set_precision(shapely.MultiPolygon(parts), GRID) if parts else shapely.Polygon()
