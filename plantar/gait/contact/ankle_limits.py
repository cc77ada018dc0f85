"""The part of a foothold on which a foot can carry the body alone, within the torque limits of its ankle.

With weight W and ZMP p a joint with axis a through c has the torque a . ((p - c) x W e_z). `ankle_reach` is a choice of
the robot's file; this limits the balance law of any robot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.polygon import area, centroid, closest_point, inner_offset, part_inside

__all__ = ["AnkleLimits"]

_SHARE = 0.95
"""Share of the torque limit that the weight may take; the rest is for the foot's own motion and the feedback."""


class AnkleLimits:
    """Where one foot can carry the body.

    Args:
        strips: Strips (m, 4) in the sole frame in which the ankle is within its limits, one for each joint: unit normal
            (x, y), middle and half width along it in m.
        margin: Distance in m of the desired ZMP from the edge of a support polygon.
    """

    def __init__(self, strips: NDArray[np.float64], margin: float) -> None:
        normal, middle, reach = strips[:, :2], strips[:, 2:3], _SHARE * strips[:, 3:]
        # |n . x - middle| <= reach as two half-planes n . x <= h.
        lines = np.vstack([np.hstack([normal, middle + reach]), np.hstack([-normal, reach - middle])])
        self._lines: list[list[float]] = lines.tolist()
        self._margin = margin

    def within(self, polygon: NDArray[np.float64]) -> NDArray[np.float64]:
        """The part (j, 2) of a support polygon (k, 2) that, moved inwards by the margin, ends at the ankle's reach;
        else all.

        Polygons are in the sole frame in m, counter-clockwise.
        """
        left = self._cut(polygon, self._margin)
        return left if area(left) > 0.0 else polygon

    def center(self, polygon: NDArray[np.float64], center: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the best place (2,) in m to load a foot that carries alone.

        It is `center` where the ankle reaches all of the polygon, else the centroid of the ZMP's region, or the nearest
        place to the ankle's reach that keeps the margin: over an edge the robot falls, with a joint at its limit it
        only sinks.

        Args:
            polygon: Support polygon (k, 2) in the sole frame in m, counter-clockwise.
            center: Best place (2,) in m for a strong ankle: the centroid.
        """
        reached = self._cut(polygon)
        if area(reached) >= area(polygon) * (1.0 - 1e-9):
            return center
        kept = inner_offset(polygon, self._margin)
        left = self._cut(kept)
        found = centroid(left) if area(left) > 0.0 else None
        if found is None:
            near = centroid(reached) if area(reached) > 0.0 else None
            near = center if near is None else near
            found = closest_point(kept, near) if area(kept) > 0.0 else near
        return center if found is None else found

    def _cut(self, polygon: NDArray[np.float64], margin: float = 0.0) -> NDArray[np.float64]:
        """The part of a polygon (k, 2) within the limits, or up to a margin in m outside of them."""
        for x, y, h in self._lines:
            polygon = part_inside(polygon, x, y, h + margin)
        return polygon
