"""Whether the taxels observe the center of pressure in both directions. Lengths in mm.

A load is reported within the hull of the taxels' centres; one beyond it is off by its distance (the blind rim). Taxels
in a line observe nothing across it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.units import to_mm

__all__ = ["ACROSS", "ALONG", "ERROR", "Observability", "observability"]

ALONG, ACROSS, ERROR = 0.55, 0.45, 0.40
"""Least share of the face's length and width that the centres reach over; most error over the face's width."""


@dataclass(frozen=True)
class Observability:
    """How well the taxels observe the center of pressure.

    Attributes:
        along: Longer side of the smallest rectangle around the centres, over the face's length.
        across: Its shorter side, over the face's width; 0 for taxels in a line.
        error: Largest error in mm for a load anywhere on the face.
        width: Width of the face in mm.
    """

    along: float
    across: float
    error: float
    width: float

    @property
    def holds(self) -> bool:
        """Whether both directions are observed well enough."""
        return self.along >= ALONG and self.across >= ACROSS and self.error <= ERROR * self.width


def observability(plan: ShoePlan) -> Observability:
    """How well the taxels of a sole observe the center of pressure."""
    low_x, low_y, high_x, high_y = plan.contact.bounds
    box = shapely.MultiPoint(to_mm(plan.layout.positions[:, :2])).minimum_rotated_rectangle
    corners = shapely.get_coordinates(box)
    sides = np.hypot(*np.diff(corners, axis=0)[:2].T) if box.geom_type == "Polygon" else np.array([box.length, 0.0])
    return Observability(
        round(float(sides.max() / (high_x - low_x)), 3),
        round(float(sides.min() / (high_y - low_y)), 3),
        round(plan.blind_rim, 2),
        high_y - low_y,
    )
