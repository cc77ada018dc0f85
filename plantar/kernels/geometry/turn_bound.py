# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that bounds, over a narrow interval of angles, the rectangles of an outline that enclose a box.

Plain Python that also compiles ahead of time (`turn_bound.pxd` gives the C types). `any_angle` searches with it.
"""

from __future__ import annotations

import math

from ..base import work_arrays
from . import rectangle

__all__ = ["TurnBound", "cut_ring"]

_LINES = 32  # slanted edges that are taken account of; others are left out, which only weakens the bound
_CHAIN = 6  # edges of a chain that are walked along
_INF = math.inf  # typed: an attribute of the module is looked up at each use
_WIDER = 0.3  # of the box of the middles, to each side
_TOUCH = 1e-9  # of its sides: what a rectangle is closer to it may touch
_STEPS = 4  # steps to either side, each from where the bound of the one before ends


class TurnBound:
    """Bound of second order on the rectangles at angles near a middle one that enclose a box Q.

    A vertex of the outline that stands below Q, and neither left nor right of it at any of the angles, is below every
    such rectangle; likewise on the other sides. An edge that runs from beside Q to below Q holds the corner: no such
    rectangle crosses its line. So do the edges of a convex chain together. These vertices and lines, a choice of the
    outline's, leave a problem that is convex at each angle: the largest rectangle in a box whose sides turn about
    vertices, its corners cut by lines that stand.

    Weak duality bounds it at every angle. With the origin at the middle of the largest rectangle at the middle angle,
    w x h, let l be the multipliers there of log w + log h: at each side the pushes across it are 1 / w or 1 / h. For a
    rectangle at an angle t with its middle at c the constraints, weighed with these same l, give

        w(t) G1(t) + h(t) G2(t) <= L(t) + N(t) c,  so  w(t) h(t) <= (L(t) + N(t) c)^2 / (4 G1(t) G2(t)),

    where G1 and G2 are half the pushes along the two sides, G1(0) = 1 / w, G2(0) = 1 / h, L the levels, L(0) = 2, and
    N what is left of the pushes: none at 0, where they balance. Lines stand and vertices' pushes turn with the
    rectangle, so |N(t)| <= |t| n, n the push of the lines alone, which is at most (1 / w^2 + 1 / h^2)^(1/2); it is none
    where there are no lines, or no vertices.

    The part without N: G1'' >= -G1, |G1'| <= G2, and likewise G2, since only the lines' pushes change. L'' <= 0, as a
    vertex on a side stays on its side of the origin while |c v| tan t <= w / 2 or h / 2. So the second derivative of
    its logarithm is at most 2 + (G1 / G2)^2 + (G2 / G1)^2 = (2 / sin 2 a)^2, with `a` the angle between diagonal and
    longer side, which shrinks by as much as t grows. The part with N: it raises the logarithm by 2 |t| n |c| / L(t) at
    most, a slope, where |c| is bounded by the boxes that all rectangles in question enclose and stand in.

    With these and the areas at the middle and a little beside it follows how far from there the target is not reached;
    from where that ends it goes on.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.lean = 0.0
        self.aside = 0.0
        self.x = 0.0
        self.y = 0.0
        self.lines = 0
        self.line = work_arrays.numbers(4 * _LINES, self.lists)
        self.ring = work_arrays.numbers(2 * _LINES + 16, self.lists)
        self.cut = work_arrays.numbers(2 * _LINES + 16, self.lists)
        self.work = work_arrays.numbers(8 * _LINES + 80, self.lists)
        self.corner = work_arrays.numbers(8, self.lists)
        self.bearings = 0
        self.bearing = work_arrays.places(64, self.lists)
        self.side = work_arrays.places(64, self.lists)
        self.edge = work_arrays.places(_LINES, self.lists)
        self.known_bearings = -1
        self.known_lines = 0
        self.known_bearing = work_arrays.places(64, self.lists)
        self.known_side = work_arrays.places(64, self.lists)
        self.known_edge = work_arrays.places(_LINES, self.lists)
        self.known_reach = work_arrays.numbers(2, self.lists)
        self.foremost = work_arrays.places(8, self.lists)
        self.most = work_arrays.numbers(8, self.lists)
        self.level = work_arrays.numbers(4, self.lists)
        self.middles = work_arrays.numbers(4, self.lists)
        self.known_middles = work_arrays.numbers(4, self.lists)
        self.centre = work_arrays.numbers(2, self.lists)
        self.sides = work_arrays.numbers(4, self.lists)

    def narrow(self, ring, n, corner, least, box):
        """Find a box that all rectangles of more than some area in a convex ring enclose, at angle 0.

        Args:
            ring: Convex ring of n vertices, counter-clockwise, flat.
            n: Their number, up to 16.
            corner: Corners of its largest rectangle, flat.
            least: The area.
            box: Box that is enclosed, x from and to, y from and to; the larger one that was found.
        """
        width = corner[4] - corner[0]
        height = corner[5] - corner[1]
        share = math.sqrt(2.0 * math.log(max(1.0, width * height / least))) + 1e-9
        for side in range(4):
            sign = -1.0 if side % 2 else 1.0
            for wide in range(2):
                reach = (1.2 if wide == 0 else 3.0) * share
                if side < 2:
                    at = (corner[4] if side else corner[0]) + sign * reach * width
                    size = cut_ring(ring, n, sign, 0.0, sign * at, self.ring)
                else:
                    at = (corner[5] if side == 3 else corner[1]) + sign * reach * height
                    size = cut_ring(ring, n, 0.0, sign, sign * at, self.ring)
                if sign * (at - box[side]) >= 0.0:
                    break
                if (
                    size < 3
                    or rectangle.largest_rectangle(self.ring, size, 0.0, least, self.work, self.corner) <= least
                ):
                    box[side] = at
                    break

    def clear(self, xs, ys, start, rings, box, around, half, target, wanted_low, wanted_high, reach):
        """How far from the middle angle no rectangle that encloses a box has more than some area.

        Between two calls of `forget` only the box may change, and the distances that are looked at may shrink.

        Args:
            xs: Abscissae of the outline's vertices at the middle angle; ys ordinates.
            start: Offsets (rings + 1) of the rings.
            rings: Their number.
            box: Box Q: x from and to, y from and to.
            around: Box in which all rectangles in question stand once they are turned back about their middles.
            half: Half the interval in rad.
            target: The area.
            wanted_low: Distance in rad towards smaller angles that is looked at, up to `half`; wanted_high likewise.
            reach: Receives the distances in rad towards smaller and towards larger angles, up to those wanted; what
                stands there is the least that is returned.
        """
        if box[0] >= box[1] or box[2] >= box[3]:
            return
        self._find_bearing(xs, ys, start[rings], box, half)
        self._find_lines(xs, ys, start, rings, box, math.tan(half) * (1.0 - 1e-9))
        self._find_middles(box, around)
        if self._is_known():
            reach[0] = max(reach[0], min(wanted_low, self.known_reach[0]))
            reach[1] = max(reach[1], min(wanted_high, self.known_reach[1]))
            return
        self._widen_middles()
        self._keep()
        middle = self._room(xs, ys, box, 0.0)
        if not 0.0 < middle < target:
            return
        self._stand(box, 1.125 * max(wanted_low, wanted_high), 0.0)
        lean = self.lean
        aside = self.aside
        x = self.x
        y = self.y
        for side in range(2):
            wanted = wanted_low if side == 0 else wanted_high
            at = self._advance(xs, ys, box, -1.0 if side == 0 else 1.0, wanted, middle, target)
            self.known_reach[side] = at
            reach[side] = max(reach[side], min(wanted, at))
            self.lean = lean
            self.aside = aside
            self.x = x
            self.y = y

    def _advance(self, xs, ys, box, sign, wanted, middle, target):
        """How far to one side the area stays below the target, in some steps up to the distance that is wanted."""
        area = middle
        at = 0.0
        for _ in range(_STEPS):
            left = wanted - at
            beside = 0.125 * left
            lean = self.lean - left - beside
            if lean <= 0.0 or self.aside < 0.0:
                return at
            # The slope is at most what the areas rose by from a little before, and a bit for the bend in between.
            before = self._room(xs, ys, box, sign * (at - beside))
            if before == _INF:
                return at
            bend = 2.0 / math.sin(2.0 * lean)
            bend *= bend
            gap = math.log(target / area)
            slope = math.log(area / max(1e-300, before)) / beside + 0.5 * bend * beside
            if self.aside > 0.0:
                self._find_centre(sign * (at - beside))
                moved = math.hypot(self.centre[0] - self.x, self.centre[1] - self.y)
                slope += self.aside * (moved + self._farthest(self.middles, self.x, self.y))
            root = math.sqrt(slope * slope + 2.0 * bend * gap)
            far = 2.0 * gap / (slope + root) if slope > 0.0 else (root - slope) / bend
            at += far
            if far < 0.5 * left or at >= wanted:
                return at
            area = self._room(xs, ys, box, sign * at)
            if not 0.0 < area < target:
                return at
            self._stand(box, 1.125 * (wanted - at), sign * at)
        return at

    def _stand(self, box, turn, at):
        """Look at the rectangle in `corner`, which stands at an angle: its lean, its middle, and what may push aside.

        `aside` is the slope per distance between middles that pushes out of balance make up to a turn; below 0 where
        that is too far.
        """
        self.lean = rectangle.lean(self.corner)
        self._find_centre(at)
        self.x = self.centre[0]
        self.y = self.centre[1]
        width = self.corner[4] - self.corner[0]
        height = self.corner[5] - self.corner[1]
        reach = self._farthest(box, self.x, self.y)
        self.aside = -1.0
        if reach * math.tan(turn) > 0.5 * min(width, height):
            return
        push = self._push(width, height, at)
        # L(t) >= 2 - |t| sum l |c v| - t^2, and the pushes l of the vertices on two sides are 2 / w or 2 / h at most.
        left = 1.0 - reach * (1.0 / width + 1.0 / height) * turn - 0.5 * turn * turn
        if push == 0.0:
            self.aside = 0.0
        elif left >= 0.25:
            self.aside = push / left

    def _push(self, width, height, turn):
        """What the lines that the rectangle in `corner` touches push in all, at most: only what touches does.

        Where it touches lines alone their pushes balance, and likewise across where it touches no vertices on two
        opposite sides.
        """
        close = _TOUCH * (width + height)
        across = 0.0
        along = 0.0
        if self.sides[0] >= self.corner[0] - close or self.sides[1] <= self.corner[4] + close:
            across = 1.0 / width
        if self.sides[2] >= self.corner[1] - close or self.sides[3] <= self.corner[5] + close:
            along = 1.0 / height
        if across == 0.0 and along == 0.0:
            return 0.0
        cosine = math.cos(turn)
        sine = math.sin(turn)
        for k in range(self.lines):
            ax = cosine * self.line[4 * k] + sine * self.line[4 * k + 1]
            ay = cosine * self.line[4 * k + 1] - sine * self.line[4 * k]
            dx = cosine * self.line[4 * k + 2] + sine * self.line[4 * k + 3]
            dy = cosine * self.line[4 * k + 3] - sine * self.line[4 * k + 2]
            x = self.corner[0 if dy < 0.0 else 4]
            y = self.corner[1 if dx > 0.0 else 5]
            if dx * (y - ay) - dy * (x - ax) <= close * (abs(dx) + abs(dy)):
                return math.hypot(across, along)
        return 0.0

    def _find_centre(self, turn):
        """Find the middle of the rectangle in `corner`, which stands at an angle, as seen at the middle angle."""
        x = 0.5 * (self.corner[0] + self.corner[4])
        y = 0.5 * (self.corner[1] + self.corner[5])
        cosine = math.cos(turn)
        sine = math.sin(turn)
        self.centre[0] = cosine * x - sine * y
        self.centre[1] = sine * x + cosine * y

    def _farthest(self, box, x, y):
        """Largest distance of a point of a box from a point."""
        return math.hypot(max(abs(box[0] - x), abs(box[1] - x)), max(abs(box[2] - y), abs(box[3] - y)))

    def _find_middles(self, box, around):
        """Find the box in which the middles stand of all rectangles that enclose one box and stand in another."""
        for k in range(0, 4, 2):
            self.middles[k] = 0.5 * (around[k] + box[k + 1])
            self.middles[k + 1] = 0.5 * (box[k] + around[k + 1])

    def _widen_middles(self):
        """Take more middles into account than asked for: those of neighbouring pairs lie among them more often."""
        for k in range(0, 4, 2):
            more = _WIDER * (self.middles[k + 1] - self.middles[k])
            self.middles[k] -= more
            self.middles[k + 1] += more

    def forget(self):
        """Forget the vertices and lines that bore before, as at a new angle or for another target."""
        self.known_bearings = -1

    def _is_known(self):
        """Whether the same vertices and lines bear as the last time, as those of neighbouring pairs often do."""
        if self.bearings != self.known_bearings or self.lines != self.known_lines:
            return False
        for k in range(self.bearings):
            if self.bearing[k] != self.known_bearing[k] or self.side[k] != self.known_side[k]:
                return False
        for k in range(self.lines):
            if self.edge[k] != self.known_edge[k]:
                return False
        if self.lines == 0 or self.bearings == 0:
            return True
        for k in range(0, 4, 2):
            if self.middles[k] < self.known_middles[k] or self.middles[k + 1] > self.known_middles[k + 1]:
                return False
        return True

    def _keep(self):
        """Keep which vertices and lines bear."""
        self.known_bearings = self.bearings
        self.known_lines = self.lines
        for k in range(self.bearings):
            self.known_bearing[k] = self.bearing[k]
            self.known_side[k] = self.side[k]
        for k in range(self.lines):
            self.known_edge[k] = self.edge[k]
        for k in range(4):
            self.known_middles[k] = self.middles[k]
        self.known_reach[0] = 0.0
        self.known_reach[1] = 0.0

    def _find_bearing(self, xs, ys, m, box, half):
        """Find the vertices that bear on a side at every angle, and those of each side that do so most at either end.

        Sides count as left, right, bottom, top; `level` is where they stand at the middle angle.
        """
        if m > len(self.bearing):
            self.bearing = work_arrays.places(2 * m, self.lists)
            self.side = work_arrays.places(2 * m, self.lists)
            self.known_bearing = work_arrays.places(2 * m, self.lists)
            self.known_side = work_arrays.places(2 * m, self.lists)
            self.known_bearings = -1
        cosine = math.cos(half)
        sine = math.sin(half)
        lean = math.tan(half)
        middle_x = 0.5 * (box[0] + box[1])
        middle_y = 0.5 * (box[2] + box[3])
        most = self.most
        level = self.level
        for k in range(8):
            most[k] = -_INF
        for k in range(4):
            level[k] = _INF if k == 1 or k == 3 else -_INF
        count = 0
        for v in range(m):
            x = xs[v]
            y = ys[v]
            side = -1
            gap = lean * max(0.0, max(box[2] - y, y - box[3]))
            if box[0] + gap < x < box[1] - gap:
                side = 2 if y < middle_y else 3
                along = y
                across = x
            else:
                gap = lean * max(0.0, max(box[0] - x, x - box[1]))
                if box[2] + gap < y < box[3] - gap:
                    side = 0 if x < middle_x else 1
                    along = x
                    across = y
            if side < 0:
                continue
            self.bearing[count] = v
            self.side[count] = side
            count += 1
            if side == 1 or side == 3:
                level[side] = min(level[side], along)
                along = -along
            else:
                level[side] = max(level[side], along)
            for end in range(2):
                reached = cosine * along + (sine if end else -sine) * across
                if reached > most[2 * side + end]:
                    most[2 * side + end] = reached
                    self.foremost[2 * side + end] = v
        self.bearings = count

    def _is_behind(self, xs, ys, side, x, y, lean):
        """Whether a point stands beyond a vertex that bears on a side, at every angle."""
        for k in range(2 * side, 2 * side + 2):
            if self.most[k] > -_INF:
                dx = xs[self.foremost[k]] - x
                dy = ys[self.foremost[k]] - y
                if side == 1 or side == 3:
                    dx = -dx
                    dy = -dy
                if (dx >= lean * abs(dy)) if side < 2 else (dy >= lean * abs(dx)):
                    return True
        return False

    def _find_lines(self, xs, ys, start, rings, box, lean):
        """Find the edges that hold a corner, alone or in a convex chain, at every angle of the interval."""
        line = self.line
        self.lines = 0
        for r in range(rings):
            low = start[r]
            high = start[r + 1]
            a = high - 1
            for b in range(low, high):
                dx = xs[b] - xs[a]
                dy = ys[b] - ys[a]
                if self.lines < _LINES and abs(dx) >= lean * abs(dy) and abs(dy) >= lean * abs(dx):
                    # The corner of Q that it would hold, on its left or it is none of these.
                    qx = box[0] if dy < 0.0 else box[1]
                    qy = box[2] if dx > 0.0 else box[3]
                    # Where the sides that vertices bear on meet, if both do: beyond the line, or it says nothing.
                    lx = self.level[0 if dy < 0.0 else 1]
                    ly = self.level[2 if dx > 0.0 else 3]
                    if (
                        dx * (qy - ys[a]) - dy * (qx - xs[a]) > 0.0
                        and not dx * (ly - ys[a]) - dy * (lx - xs[a]) >= 0.0
                        and self._is_anchored(xs, ys, low, high, a, b, -1, box, lean)
                        and self._is_anchored(xs, ys, low, high, b, a, 1, box, lean)
                    ):
                        self.edge[self.lines] = a
                        line[4 * self.lines] = xs[a]
                        line[4 * self.lines + 1] = ys[a]
                        line[4 * self.lines + 2] = dx
                        line[4 * self.lines + 3] = dy
                        self.lines += 1
                a = b

    def _is_anchored(self, xs, ys, low, high, end, other, step, box, lean):
        """Whether no rectangle passes an edge beyond one end, or that of the convex chain that goes on from there.

        One that does has the end above its top, say, and right of its left side. So none does where the end is below
        the top of Q, or left of a vertex that bears on the left. The chain may turn once from one corner of a side to
        the other: an edge that holds that one runs across such a rectangle.

        Args:
            low: First vertex of the ring; high the one behind its last.
            end: The end; other the edge's other one.
            step: 1 where the edge runs to the end, else -1.
        """
        turned = False
        for _ in range(_CHAIN):
            x = xs[end]
            y = ys[end]
            dx = step * (x - xs[other])
            dy = step * (y - ys[other])
            beside = (dx > 0.0) == ((dy < 0.0) == (step < 0))
            if beside:  # the end beside Q: not above, or below, any rectangle
                gap = lean * max(0.0, max(box[0] - x, x - box[1]))
                if (y > box[2] + gap) if dx > 0.0 else (y < box[3] - gap):
                    return True
                if self._is_behind(xs, ys, 0 if dy < 0.0 else 1, x, y, lean):
                    return True
            else:
                gap = lean * max(0.0, max(box[2] - y, y - box[3]))
                if (x > box[0] + gap) if dy < 0.0 else (x < box[1] - gap):
                    return True
                if self._is_behind(xs, ys, 2 if dx > 0.0 else 3, x, y, lean):
                    return True
            following = end + step
            following = low if following >= high else high - 1 if following < low else following
            ex = step * (xs[following] - x)
            ey = step * (ys[following] - y)
            if (ex > 0.0) != (dx > 0.0) or (ey > 0.0) != (dy > 0.0):
                if turned or ((ey > 0.0) != (dy > 0.0) if beside else (ex > 0.0) != (dx > 0.0)):
                    return False
                turned = True
            if abs(ex) < lean * abs(ey) or abs(ey) < lean * abs(ex) or step * (dx * ey - dy * ex) < 0.0:
                return False
            if turned:
                qx = box[0] if ey < 0.0 else box[1]
                qy = box[2] if ex > 0.0 else box[3]
                if ex * (qy - y) - ey * (qx - x) <= 0.0:
                    return False
            other = end
            end = following
        return False

    def _room(self, xs, ys, box, turn):
        """Area that vertices and lines leave at one angle, infinite where it is open; rectangle in `corner`."""
        cosine = math.cos(turn)
        sine = math.sin(turn)
        middle_x = 0.5 * (box[0] + box[1])
        middle_y = 0.5 * (box[2] + box[3])
        left = -_INF
        right = _INF
        bottom = -_INF
        top = _INF
        for k in range(self.bearings):
            x = xs[self.bearing[k]]
            y = ys[self.bearing[k]]
            side = self.side[k]
            if side == 0:
                left = max(left, cosine * x + sine * y)
            elif side == 1:
                right = min(right, cosine * x + sine * y)
            elif side == 2:
                bottom = max(bottom, cosine * y - sine * x)
            else:
                top = min(top, cosine * y - sine * x)
        sides = self.sides
        sides[0] = left
        sides[1] = right
        sides[2] = bottom
        sides[3] = top
        # A side that only lines bear on: a bound that cuts nothing off them.
        open_sides = 0
        reach = 4.0 * (box[1] - box[0] + box[3] - box[2])
        if left == -_INF:
            left = middle_x - reach
            open_sides = 1
        if right == _INF:
            right = middle_x + reach
            open_sides = 1
        if bottom == -_INF:
            bottom = middle_y - reach
            open_sides = 1
        if top == _INF:
            top = middle_y + reach
            open_sides = 1
        if right <= left or top <= bottom:
            return 0.0
        ring = self.ring
        ring[0] = left
        ring[1] = bottom
        ring[2] = right
        ring[3] = bottom
        ring[4] = right
        ring[5] = top
        ring[6] = left
        ring[7] = top
        n = 4
        for k in range(self.lines):
            ax = cosine * self.line[4 * k] + sine * self.line[4 * k + 1]
            ay = cosine * self.line[4 * k + 1] - sine * self.line[4 * k]
            dx = cosine * self.line[4 * k + 2] + sine * self.line[4 * k + 3]
            dy = cosine * self.line[4 * k + 3] - sine * self.line[4 * k + 2]
            size = cut_ring(ring, n, -dy, dx, dx * ay - dy * ax, self.cut)
            if size < 3:
                return 0.0
            n = size
            for i in range(2 * n):
                ring[i] = self.cut[i]
        area = rectangle.largest_rectangle(ring, n, 0.0, 0.0, self.work, self.corner)
        if open_sides and (
            self.corner[0] < middle_x - 0.99 * reach
            or self.corner[4] > middle_x + 0.99 * reach
            or self.corner[1] < middle_y - 0.99 * reach
            or self.corner[5] > middle_y + 0.99 * reach
        ):
            return _INF
        return area


def cut_ring(ring, n, nx, ny, level, out):
    """Cut a ring by a half-plane nx x + ny y >= level.

    Args:
        ring: Ring of n vertices, flat.
        n: Their number.
        nx: First coordinate of the half-plane's normal; ny the second one.
        level: Its level.
        out: Receives what is left, flat; along the cut it runs to and fro where the ring is not convex.

    Returns:
        Number of vertices left.
    """
    count = 0
    i = n - 1
    before = nx * ring[2 * i] + ny * ring[2 * i + 1] - level
    for j in range(n):
        after = nx * ring[2 * j] + ny * ring[2 * j + 1] - level
        if (before < 0.0) != (after < 0.0):
            share = before / (before - after)
            out[2 * count] = ring[2 * i] + share * (ring[2 * j] - ring[2 * i])
            out[2 * count + 1] = ring[2 * i + 1] + share * (ring[2 * j + 1] - ring[2 * i + 1])
            count += 1
        if after >= 0.0:
            out[2 * count] = ring[2 * j]
            out[2 * count + 1] = ring[2 * j + 1]
            count += 1
        before = after
        i = j
    return count
