"""Part of a foothold that can carry alone within its ankle's torques.

With weight W and ZMP p a joint with axis a through c has the torque a . ((p - c) x W e_z). On a slope c leans over
another part of the sole. Over a part of its sole a robot stands as much higher as its knee needs there.
"""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import own
from plantar.gait.contact.standing_leg import StandingLeg
from plantar.geometry.polygon import area, centroid, closest_point, inner_offset, part_inside

# chosen: Share of the torque limit that the weight may take; the rest is for the foot's own motion and the feedback
_SHARE = 0.95
UPRIGHT = own(np.zeros(2))
"""A sole's lean on the level."""
# derived: m around an ankle: farther than soles go
_ANYWHERE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


class AnkleLimits:
    """Where one foot alone carries the body.

    `strips` (m, 5), sole frame, one a joint, within its torque: unit normal (x, y), middle and half width in m, and the
    ankle's height in m; `margin`: desired ZMP from a support polygon's edge in m; `leg`: of the knee, None without its
    limit.
    """

    def __init__(self, strips: NDArray[np.float64], margin: float, leg: StandingLeg | None = None) -> None:
        self._leg = leg
        self._margin = margin
        self._low = self._lines(strips, 0.0)
        self._high = self._lines(strips, 0.0 if leg is None else leg.rise)

    def _lines(self, strips: NDArray[np.float64], rise: float) -> list[list[float]]:
        """Half-planes n . x <= h, and the height of what leans, standing higher by `rise` in m."""
        if self._leg is not None:
            strips = np.vstack([strips, [1.0, 0.0, *self._leg.strip(rise), self._leg.high]])
        normal = strips[:, :2]
        middle = strips[:, 2:3]
        reach = _SHARE * strips[:, 3:4]
        high = strips[:, 4:]
        # |n . x - middle| <= reach
        lines = np.vstack([np.hstack([normal, middle + reach, high]), np.hstack([-normal, reach - middle, high])])
        return list(lines.tolist())

    def rise(self, place: NDArray[np.float64], mass_ratio: float = 1.0) -> float:
        """Returns how much higher in m the robot has to stand with its weight at a `place` (2,) of the sole in m.

        `mass_ratio`: its mass over the model's.
        """
        return 0.0 if self._leg is None else self._leg.rise_for(place.item(0), _SHARE / mass_ratio)

    def spare_reach(self, place: NDArray[np.float64], step: NDArray[np.float64], rise: float = 0.0) -> float:
        """Returns how much farther ahead in m than a `step` (2,) ahead and to the left in m the other foot can land.

        The body rests over a `place` (2,) of this sole in m, higher by `rise` in m. Negative beyond its reach.
        """
        if self._leg is None:
            return math.inf
        ahead, left = (step - place).tolist()
        return self._leg.spread(abs(left), rise) - self._leg.ankle - float(ahead)

    def within(
        self, polygon: NDArray[np.float64], lean: NDArray[np.float64] = UPRIGHT, risen: bool = False
    ) -> NDArray[np.float64]:
        """Returns the part (j, 2) of a support `polygon` (k, 2), moved in by the margin, in reach; else all.

        Sole frame, m, counter-clockwise; `lean` (2,): where a point 1 m over its origin is; `risen`: whether the robot
        stands as high as it needs.
        """
        left = self._cut(polygon, lean, risen, self._margin)
        return left if area(left) > 0.0 else polygon

    def center(
        self,
        polygon: NDArray[np.float64],
        center: NDArray[np.float64],
        lean: NDArray[np.float64] = UPRIGHT,
        risen: bool = False,
    ) -> NDArray[np.float64]:
        """Returns the best place (2,) to load a foot alone on a `polygon`, `lean` and `risen` as in `within`.

        `center` (2,), best for a strong ankle, if the ankle reaches all of the polygon, else the centroid of the ZMP's
        region, or the nearest place with the margin: over an edge the robot falls, at a joint's limit it only sinks.
        """
        reached = self._cut(polygon, lean, risen)
        if area(reached) >= area(polygon) * (1.0 - 1e-9):  # nature: floating point, far above an area's roundings
            return center
        kept = inner_offset(polygon, self._margin)
        left = self._cut(kept, lean, risen)
        found = centroid(left) if area(left) > 0.0 else None
        if found is None:
            near = (
                centroid(reached) if area(reached) > 0.0 else closest_point(self._cut(_ANYWHERE, lean, risen), center)
            )
            near = center if near is None else near
            found = closest_point(kept, near) if area(kept) > 0.0 else near
        return center if found is None else found

    def _cut(
        self, polygon: NDArray[np.float64], lean: NDArray[np.float64], risen: bool, margin: float = 0.0
    ) -> NDArray[np.float64]:
        """Part of a polygon (k, 2) within the limits plus a margin in m."""
        dx, dy = lean.tolist()
        for x, y, h, high in self._high if risen else self._low:
            polygon = part_inside(polygon, x, y, h + high * (x * dx + y * dy) + margin)
        return polygon
