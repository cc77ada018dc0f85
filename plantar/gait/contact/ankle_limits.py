"""Part of a foothold that can carry alone within its ankle's torques.

With weight W and ZMP p a joint with axis a through c has the torque a . ((p - c) x W e_z). On a slope c leans over
another part of the sole.
"""

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import own
from plantar.geometry.polygon import area, centroid, closest_point, inner_offset, part_inside

# Share of the torque limit that the weight may take; the rest is for the foot's own motion and the feedback
_SHARE = 0.95
UPRIGHT = own(np.zeros(2))
"""A sole's lean on the level."""
_ANYWHERE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])  # m around an ankle: farther than soles go


class AnkleLimits:
    """Where one foot alone carries the body.

    `strips` (m, 5), sole frame, one a joint, within its torque: unit normal (x, y), middle and half width in m, and the
    ankle's height in m; `margin`: desired ZMP from a support polygon's edge in m.
    """

    def __init__(self, strips: NDArray[np.float64], margin: float) -> None:
        normal = strips[:, :2]
        middle = strips[:, 2:3]
        reach = _SHARE * strips[:, 3:4]
        high = strips[:, 4:]
        # |n . x - middle| <= reach as two half-planes n . x <= h.
        lines = np.vstack([np.hstack([normal, middle + reach, high]), np.hstack([-normal, reach - middle, high])])
        self._lines: list[list[float]] = lines.tolist()
        self._margin = margin

    def within(self, polygon: NDArray[np.float64], lean: NDArray[np.float64] = UPRIGHT) -> NDArray[np.float64]:
        """Returns the part (j, 2) of a support `polygon` (k, 2), moved in by the margin, in reach; else all.

        Sole frame, m, counter-clockwise; `lean` (2,): where a point 1 m over its origin is.
        """
        left = self._cut(polygon, lean, self._margin)
        return left if area(left) > 0.0 else polygon

    def center(
        self, polygon: NDArray[np.float64], center: NDArray[np.float64], lean: NDArray[np.float64] = UPRIGHT
    ) -> NDArray[np.float64]:
        """Returns the best place (2,) to load a foot alone on a `polygon` with a `lean` as in `within`.

        `center` (2,), best for a strong ankle, if the ankle reaches all of the polygon, else the centroid of the ZMP's
        region, or the nearest place with the margin: over an edge the robot falls, at a joint's limit it only sinks.
        """
        reached = self._cut(polygon, lean)
        if area(reached) >= area(polygon) * (1.0 - 1e-9):
            return center
        kept = inner_offset(polygon, self._margin)
        left = self._cut(kept, lean)
        found = centroid(left) if area(left) > 0.0 else None
        if found is None:
            near = centroid(reached) if area(reached) > 0.0 else closest_point(self._cut(_ANYWHERE, lean), center)
            near = center if near is None else near
            found = closest_point(kept, near) if area(kept) > 0.0 else near
        return center if found is None else found

    def _leaning(self, lean: NDArray[np.float64]) -> list[tuple[float, float, float]]:
        dx, dy = lean.tolist()
        return [(x, y, h + high * (x * dx + y * dy)) for x, y, h, high in self._lines]

    def _cut(self, polygon: NDArray[np.float64], lean: NDArray[np.float64], margin: float = 0.0) -> NDArray[np.float64]:
        """Part of a polygon (k, 2) within the limits plus a margin in m."""
        for x, y, h in self._leaning(lean):
            polygon = part_inside(polygon, x, y, h + margin)
        return polygon
