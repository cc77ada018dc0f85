# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that turns the largest rectangle of a convex ring to its best angle.

Plain Python that also compiles ahead of time (`any_angle.pxd` gives the C types). `plantar.inscribed` is the public
face.
"""

from __future__ import annotations

import math

from ..base import work_arrays
from . import bracket, rectangle

__all__ = ["AnyAngle"]

_QUARTER = 0.5 * math.pi
_LEAST = 1e-10  # rad of the least step: summits that are narrower are looked for at edges alone
_SLIM = 1e2  # times its area over its diameter squared a ring is slim below 1, and all angles are as much finer
_STEPS = 1000  # steps along a ring's angles; some 20 are the rule, needles may want more
_SEEDS = 6  # directions of edges that are looked at first
_CLOSE = 8e-7  # share of the area that is not looked for
_SECTIONS = 48
_STEP = 1e-6  # rad to either side by which a summit is told
_STRIDE = 5e-3  # rad of the first step uphill
_INF = math.inf
_PROVEN = 1e-6  # share of the area that is not looked for, with what least steps and rounding leave
_LONGEST = 0.5  # rad of a step along the angles of a convex ring


class AnyAngle:
    """Largest rectangles at any angle in convex rings.

    In a convex ring the edges that hold the largest rectangle at one angle bound the
    rectangle at every angle t: with their multipliers l the area is at most (sum l h)^2 / (U V), U = sum l |cos| and
    V = sum l |sin| of the angles between t and the edges' normals. The second derivative of that bound's logarithm is
    2 + (U'/U)^2 + (V'/V)^2, where |U'| <= V and |V'| <= U, and at the rectangle U / V is the ratio of its sides. So it
    is at most (2 / sin 2 a)^2, with `a` the angle between diagonal and longer side, which may shrink by as much as t
    grows. A step along the angles is as long as the bound stays below the best area.

    Attributes:
        best: Largest area so far; best_angle where it stands.
        gap: By what share of its area nothing is larger than the rectangle of the last ring.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.gap = 0.0
        self.whole = 0.0
        self.n = 0
        self.best = 0.0
        self.best_angle = 0.0
        self.fine = 1.0
        self.bracket = bracket.Bracket()
        self.direction = work_arrays.numbers(_SEEDS + 2, self.lists)

    def in_ring(self, ring, n, work, out):
        """Largest rectangle in a convex ring.

        Args:
            ring: Clean convex ring, counter-clockwise, near the origin; flat.
            n: Number of vertices, 3 or more.
            work: Room for 8 n + 16 numbers.
            out: Receives the 4 corners, flat, counter-clockwise.

        Returns:
            Its area.
        """
        self.ring = ring
        self.n = n
        self.work = work
        self.best = 0.0
        self.best_angle = 0.0
        self.gap = 0.0
        self._measure(ring, n)
        self.seed(ring, n, out)
        if self.best > 0.0:
            self.climb(self.best_angle, self.best, out)
            self.march(out)
        return self.largest(self.best_angle, 0.0, out)

    def _measure(self, points, n):
        """Measure how slim a ring is: the summits of one that is become as narrow."""
        twice = 0.0
        reach2 = 0.0
        for i in range(1, n):
            dx = points[2 * i] - points[0]
            dy = points[2 * i + 1] - points[1]
            reach2 = max(reach2, dx * dx + dy * dy)
            if i + 1 < n:
                twice += dx * (points[2 * i + 3] - points[1]) - (points[2 * i + 2] - points[0]) * dy
        self.whole = 0.5 * twice
        self.fine = min(1.0, _SLIM * 0.5 * twice / reach2)

    def largest(self, angle, floor, out):
        """Largest rectangle at one angle; the floor where it is not above it."""
        return rectangle.largest_rectangle(self.ring, self.n, angle, floor, self.work, out)

    def find_directions(self, points, n):
        """Find the directions of some edges, within a quarter turn; their number."""
        direction = self.direction
        same = 1e-6 * self.fine
        count = 0
        for i in range(n - 1):
            dx = points[2 * i + 2] - points[2 * i]
            dy = points[2 * i + 3] - points[2 * i + 1]
            angle = (math.atan2(dy, dx) + 4.0 * _QUARTER) % _QUARTER
            known = False
            for k in range(count):
                if abs(direction[k] - angle) < same or abs(direction[k] - angle) > _QUARTER - same:
                    known = True
            if not known:
                direction[count] = angle
                count += 1
                if count == _SEEDS:
                    break
        return count

    def seed(self, points, n, out):
        """Try the directions of some edges."""
        for k in range(self.find_directions(points, n)):
            area = self.largest(self.direction[k], self.best, out)
            if area > self.best:
                self.best = area
                self.best_angle = self.direction[k]

    def march(self, out):
        """Step along all angles of a quarter turn in a convex ring, and climb where there is more than the best.

        Towards a summit that rises to the best in a corner the steps get ever shorter, and the slope that they know
        leads beyond the best behind it. So the bound of an angle a little ahead is followed backwards once, and where
        the steps have come to what that clears they go on behind it.
        """
        angle = 0.0
        last = 0.0
        before = 0.0
        clear_from = 0.0
        clear_to = 0.0
        self.gap = self.whole / self.best - 1.0
        for _ in range(_STEPS):
            if angle >= _QUARTER:
                self.gap = _PROVEN
                return
            area = self.largest(angle, 0.0, out)
            if area <= 0.0:
                return
            if area > self.best:
                self.climb(angle, area, out)
                area = self.largest(angle, 0.0, out)
            lean = rectangle.lean(out)
            curve = 2.0 / math.sin(2.0 * lean)
            curve *= curve
            gap = math.log(self.best * (1.0 + _CLOSE) / area)
            # The slope is at most what it rose by from the step before, if near enough, and a bit for the bend between.
            back = angle - last
            if not 0.0 < back < 0.3 * lean:
                back = min(0.25 * lean, max(1e-4, min(0.02, 0.1 * math.sqrt(2.0 * gap / curve))))
                before = self.largest(angle - back, 0.0, out)
            slope = _slope(area, before, back, lean)
            last = angle
            before = area
            step = _step(slope, curve, gap, lean, _LEAST * self.fine)
            skip = math.sqrt(0.7 * _CLOSE / curve)
            if step < skip and clear_to <= angle:
                clear_to = angle + skip
                clear_from = clear_to - self._behind(clear_to, skip, out)
            angle += step
            if clear_from <= angle < clear_to:
                angle = clear_to

    def _behind(self, angle, most, out):
        """How far before an angle, up to some distance, nothing above the best stands, by its bound backwards."""
        after = self.largest(angle + most, 0.0, out)
        area = self.largest(angle, 0.0, out)
        if not 0.0 < area <= self.best * (1.0 + _CLOSE):
            return 0.0
        lean = rectangle.lean(out) - most
        if lean <= 0.0:
            return 0.0
        curve = 2.0 / math.sin(2.0 * lean)
        curve *= curve
        gap = math.log(self.best * (1.0 + _CLOSE) / area)
        return min(most, _reach(math.log(area / max(1e-300, after)) / most + 0.5 * curve * most, curve, gap))

    def climb(self, middle, area, out):
        """Climb to the summit beside an angle; the best so far where it is higher."""
        mine = area
        at = middle
        side = middle + _STEP * self.fine
        beside = self.largest(side, area, out)
        if beside <= area:
            side = middle - _STEP * self.fine
            beside = self.largest(side, area, out)
        if beside > area:  # else the summit itself, as edges and corners that touch make them
            bracket = self.bracket
            bracket.begin(middle, area, side, beside)
            reach = _STRIDE * self.fine if side > middle else -_STRIDE * self.fine
            angle = side + reach
            trial = self.largest(angle, 0.0, out)
            while trial > bracket.mine and abs(reach) < _QUARTER:
                bracket.stride(angle, trial)
                reach *= 2.0
                angle = bracket.at + reach
                trial = self.largest(angle, 0.0, out)
            bracket.close(angle, trial)
            for _ in range(_SECTIONS):
                if bracket.is_closed(3e-8 * self.fine):
                    break
                bracket.propose()
                trial = self.largest(bracket.angle, 0.0, out)
                if bracket.take(trial):
                    break
            at = bracket.at
            mine = bracket.mine
        if mine > self.best:
            self.best = mine
            self.best_angle = at


def _slope(area, before, back, lean):
    """What the slope of a ring's bound at an angle is at most, from an area a little before and a bit for the bend."""
    curve = 2.0 / math.sin(2.0 * lean)
    bend = back * 2.0 / math.sin(2.0 * (lean - back))
    return min((math.log(area / max(1e-300, before)) + 0.5 * bend * bend) / back, curve)


def _reach(slope, curve, gap):
    """Where what rises with a slope that rises itself gains a gap."""
    root = math.sqrt(slope * slope + 2.0 * curve * gap)
    return 2.0 * gap / (slope + root) if slope > 0.0 else (root - slope) / curve


def _step(slope, curve, gap, lean, least):
    """How far a ring's bound stays below the best from an angle on, in rad."""
    step = min(_LONGEST, min(_reach(slope, curve, gap), 0.9 * lean))
    # Less, since the bound's curve rises; integrated twice it is this logarithm. What rises is convex, so it stays
    # below the chord from here: where it ends little above the gap, as much less of a step is enough.
    cotangent = 2.0 * math.cos(2.0 * lean) / math.sin(2.0 * lean)
    while True:
        rise = slope * step - math.log(math.sin(2.0 * (lean - step)) / math.sin(2.0 * lean)) - cotangent * step
        if not rise > gap:
            return max(step, least)
        step *= max(0.9, min(gap / rise, 1.0 - 1e-9))
