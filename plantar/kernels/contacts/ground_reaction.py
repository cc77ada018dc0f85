"""Ground's reaction on all feet: wrench, ZMP, support, margin."""

import numpy as np

from ..geometry import few_points

__all__ = ["GroundReaction"]

_NONE = float("nan")


class GroundReaction:
    """Sums the contacts of all feet.

    `height`: height in m of ZMP's plane; NaN: force-weighted mean of contacts; `least`: vertical force in N below which
    there is no ZMP; `reach`: largest gap in m of contact that could carry; `ground`: whether geoms are ground (geoms,);
    None for all. Attributes `loads`: vertical force in N on each foot; `found`: whether there is a ZMP, at x, y in m;
    `margin`: signed distance in m of ZMP to support's edge, positive inside; NaN without.
    """

    def __init__(self, height, least, reach, ground=None):
        self.height = height
        self.least = least
        self.reach = reach
        self.ground = ground
        self.loads = np.zeros(2)
        self.sums = np.zeros(7)
        self.support = few_points.FewPoints()
        self.sole = few_points.FewPoints()
        self.feet = 0
        self.ends = np.zeros(3, dtype=np.intp)
        self.found = False
        self.x = _NONE
        self.y = _NONE
        self.margin = _NONE

    def update(self, feet):
        """Sum the current contacts of each foot's `FootContacts`."""
        for i in range(7):
            self.sums[i] = 0.0
        self.support.clear()
        self.feet = len(feet)
        if self.feet > self.loads.shape[0]:
            self.loads = np.zeros(self.feet)
            self.ends = np.zeros(self.feet + 1, dtype=np.intp)
        for number, foot in enumerate(feet):
            before = self.sums[2]
            foot.add_to_ground(self.reach, self.ground, self.sums, self.support)
            self.loads[number] = self.sums[2] - before
            self.ends[number + 1] = self.support.count
        self.support.hull(0, self.support.count)
        self._find_zmp()

    def _find_zmp(self):
        force = self.sums[2]
        self.found = force >= self.least
        if not self.found:
            self.x = _NONE
            self.y = _NONE
            self.margin = _NONE
            return
        height = self.height
        if height != height:
            height = self.sums[6] / force
        self.x = (height * self.sums[0] - self.sums[4]) / force
        self.y = (height * self.sums[1] + self.sums[3]) / force
        self.margin = self.support.margin(self.x, self.y)

    def area(self, foot):
        """Area in m^2 of the hull of a foot's points of support; 0 below three."""
        first = self.ends[foot]
        end = self.ends[foot + 1]
        if end - first < 3:
            return 0.0
        if end - first == self.support.count:
            return self.support.area()
        self.sole.clear()
        self.sole.add_some(self.support, first, end)
        self.sole.hull(0, end - first)
        return self.sole.area()

    def found_now(self):
        """Current result, to keep.

        Returns wrench (6,) about the world's origin; ZMP (x, y) in m or None; support hull, counter-clockwise; margin
        in m or None; each foot's points of support.
        """
        wrench = np.array(self.sums[:6])
        points = []
        for foot in range(self.feet):
            points.append(self.support.points_of(self.ends[foot], self.ends[foot + 1]))
        ring = self.support.corners_of()
        if not self.found:
            return wrench, None, ring, None, tuple(points)
        return wrench, np.array((self.x, self.y)), ring, self.margin, tuple(points)
