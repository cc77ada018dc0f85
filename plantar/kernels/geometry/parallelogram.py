# cython: infer_types=True
"""Largest parallelogram in a convex ring.

One corner A of some largest parallelogram A B C D is a vertex. For each A, corner B walks once round; C and D end the
far chord parallel and equal to AB. While B, C and D stay on their edges the area is a parabola.
"""

__all__ = ["largest_parallelogram"]

_B_ENDS = 0  # what ends a stretch of the walk: B meets a vertex; nature: a code
_D_ENDS = 1  # D does; nature: a code
_C_ENDS = 2  # C does; nature: a code
_C_RETURNS = 3  # or C does, walking back; nature: a code


class _ChordWalk:
    """Walk of B round a ring from A, with C and D opposite, relative to A. `best`: largest area so far."""

    def start(self, ring, n):
        self.ring = ring
        self.n = n
        self.size = 0.0
        for i in range(2 * n):
            self.size = max(self.size, abs(ring[i]))
        self.slack = 1e-11 * self.size * self.size  # nature: of an area: what rounding moves it by
        self.best = -1.0
        self.corner = 0
        self.side_x = 0.0
        self.side_y = 0.0
        self.other_x = 0.0
        self.other_y = 0.0

    def walk_from(self, a):
        """Walk B once round from vertex a, keeping the best parallelogram."""
        self.a = a
        self.x = self.ring[2 * a]
        self.y = self.ring[2 * a + 1]
        far = self.farthest()
        # B starts at A on edge a; C = D is the first vertex farthest from this edge. Edges count on from a.
        self.b = 0
        self.c = far - 1
        self.d = far
        self.t = 0.0
        steps = 8 * self.n
        while self.b < self.n and self.d < self.n and self.c >= self.b and steps > 0:
            steps -= 1
            self.read_edges()
            # nature: floating point, 500 roundings: edges that are parallel to rounding
            if self.c >= self.d or self.turn <= 1e-13 * self.lengths():
                self.slide()
                continue
            self.read_motion()
            event = self.read_end()
            if self.may_hold_better():
                self.try_places(event)
            self.t = self.end
            self.step_over(event)

    def farthest(self):
        """First vertex farthest from edge a."""
        ring = self.ring
        n = self.n
        i = self.a + 1 if self.a + 1 < n else 0
        ux = ring[2 * i] - self.x
        uy = ring[2 * i + 1] - self.y
        far = 1
        height = 0.0
        for k in range(2, n):
            i = self.a + k if self.a + k < n else self.a + k - n
            reach = ux * (ring[2 * i + 1] - self.y) - uy * (ring[2 * i] - self.x)
            if reach > height * (1.0 + 1e-12):  # nature: floating point, 5000 roundings of a height
                height = reach
                far = k
        return far

    def read_edges(self):
        """Beginning and direction of the edges of B, C and D."""
        i = self.vertex(self.b)
        j = self.after(i)
        self.b0x = self.ring[2 * i] - self.x
        self.b0y = self.ring[2 * i + 1] - self.y
        self.bx = self.ring[2 * j] - self.ring[2 * i]
        self.by = self.ring[2 * j + 1] - self.ring[2 * i + 1]
        i = self.vertex(self.c)
        j = self.after(i)
        self.c0x = self.ring[2 * i] - self.x
        self.c0y = self.ring[2 * i + 1] - self.y
        self.cx = self.ring[2 * j] - self.ring[2 * i]
        self.cy = self.ring[2 * j + 1] - self.ring[2 * i + 1]
        i = self.vertex(self.d)
        j = self.after(i)
        self.d0x = self.ring[2 * i] - self.x
        self.d0y = self.ring[2 * i + 1] - self.y
        self.dx = self.ring[2 * j] - self.ring[2 * i]
        self.dy = self.ring[2 * j + 1] - self.ring[2 * i + 1]
        self.turn = self.cx * self.dy - self.cy * self.dx

    def vertex(self, k):
        return self.a + k if self.a + k < self.n else self.a + k - self.n

    def after(self, i):
        return i + 1 if i + 1 < self.n else 0

    def lengths(self):
        """Product of C's and D's edge lengths."""
        return (abs(self.cx) + abs(self.cy)) * (abs(self.dx) + abs(self.dy))

    def slide(self):
        """Slide the chord between parallel edges: C back or D on, until a vertex."""
        if self.c >= self.d:  # the chord lies on one edge: slide along it, D to the next
            self.d = self.c + 1
            return
        # B - A + D = C: with D at the end of its edge, C would stand at D1 + u; is that still on C's edge?
        ux = self.b0x + self.t * self.bx
        uy = self.b0y + self.t * self.by
        ex = self.d0x + self.dx + ux - self.c0x
        ey = self.d0y + self.dy + uy - self.c0y
        if ex * self.cx + ey * self.cy >= 0.0:
            self.d += 1
        else:
            self.c -= 1

    def read_motion(self):
        """How C and D move with B: C0 + g c = D0 + e d + B(t), with g = g0 + g1 t and e = e0 + e1 t."""
        wx = self.d0x - self.c0x + self.b0x
        wy = self.d0y - self.c0y + self.b0y
        self.g0 = (wx * self.dy - wy * self.dx) / self.turn
        self.g1 = (self.bx * self.dy - self.by * self.dx) / self.turn
        self.e0 = (wx * self.cy - wy * self.cx) / self.turn
        self.e1 = (self.bx * self.cy - self.by * self.cx) / self.turn

    def read_end(self):
        """Find where the stretch ends, and by what."""
        end = 1.0
        event = _B_ENDS
        if self.e1 > 0.0:
            s = (1.0 - self.e0) / self.e1
            if s < end:
                end = s
                event = _D_ENDS
        if self.g1 > 0.0:
            s = (1.0 - self.g0) / self.g1
            if s < end:
                end = s
                event = _C_ENDS
        elif self.g1 < 0.0:
            s = -self.g0 / self.g1
            if s < end:
                end = s
                event = _C_RETURNS
        self.end = max(end, self.t)
        return event

    def may_hold_better(self):
        """Whether the area's parabola rises above the best, or is too coarse."""
        px = self.d0x + self.e0 * self.dx
        py = self.d0y + self.e0 * self.dy
        self.q1 = self.bx * py - self.by * px + self.e1 * (self.b0x * self.dy - self.b0y * self.dx)
        self.q2 = self.e1 * (self.bx * self.dy - self.by * self.dx)
        here = self.t * (self.q1 + self.q2 * self.t)
        there = self.end * (self.q1 + self.q2 * self.end)
        if there > here:
            here = there
        if self.q2 < 0.0 and self.t < -0.5 * self.q1 / self.q2 < self.end:
            here = -0.25 * self.q1 * self.q1 / self.q2  # nature: the extremum of a parabola, q1^2 / 4 q2
        higher = here + self.b0x * py - self.b0y * px + self.slack > self.best
        # derived: nearly parallel edges, where the bound is no bound, are walked in any case
        return higher or self.turn <= 1e-3 * self.lengths()

    def try_places(self, event):
        """Try both ends of the stretch and the summit between, with D from its edge, then C, against rounding."""
        self.try_from_d(self.t, -1)
        self.try_from_c(self.t, -1)
        self.try_from_d(self.end, event)
        self.try_from_c(self.end, event)
        if self.q2 < 0.0:
            s = -0.5 * self.q1 / self.q2
            if self.t < s < self.end:
                self.try_from_d(s, -1)
                self.try_from_c(s, -1)

    def try_from_d(self, s, event):
        """Keep the parallelogram at s, D on its edge, if larger with C on its own."""
        ux = self.b0x + s * self.bx
        uy = self.b0y + s * self.by
        e = min(1.0, max(0.0, self.e0 + self.e1 * s))
        if event == _D_ENDS:
            e = 1.0
        vx = self.d0x + e * self.dx
        vy = self.d0y + e * self.dy
        if ux * vy - uy * vx > self.best:
            wx = vx + ux - self.c0x
            wy = vy + uy - self.c0y
            if self.is_on(wx, wy, self.cx, self.cy):
                self.keep(ux, uy, vx, vy)

    def try_from_c(self, s, event):
        """Keep the parallelogram at s, C on its edge, if larger with D on its own."""
        ux = self.b0x + s * self.bx
        uy = self.b0y + s * self.by
        g = min(1.0, max(0.0, self.g0 + self.g1 * s))
        if event == _C_ENDS:
            g = 1.0
        elif event == _C_RETURNS:
            g = 0.0
        vx = self.c0x + g * self.cx - ux
        vy = self.c0y + g * self.cy - uy
        if ux * vy - uy * vx > self.best and self.is_on(vx - self.d0x, vy - self.d0y, self.dx, self.dy):
            self.keep(ux, uy, vx, vy)

    def is_on(self, wx, wy, ex, ey):
        """Whether a point lies on an edge to rounding, relative to its beginning."""
        off = wx * ey - wy * ex
        along = (wx * ex + wy * ey) / (ex * ex + ey * ey)
        # nature: floating point, fifty roundings of a product and 500 of a quotient
        return abs(off) <= 1e-14 * self.size * (abs(ex) + abs(ey)) and -1e-13 <= along <= 1.0 + 1e-13

    def keep(self, ux, uy, vx, vy):
        self.best = ux * vy - uy * vx
        self.corner = self.a
        self.side_x = ux
        self.side_y = uy
        self.other_x = vx
        self.other_y = vy

    def step_over(self, event):
        """Continue on the next edge of the corner at a vertex."""
        if event == _B_ENDS:
            self.b += 1
            self.t = 0.0
        elif event == _D_ENDS:
            self.d += 1
        elif event == _C_ENDS:
            self.c += 1
        else:
            self.c -= 1


def largest_parallelogram(ring, n, out):
    """Largest parallelogram in a clean ring of n vertices, 3 or more: writes 4 corners to `out`, flat; returns its
    area.
    """
    walk = _ChordWalk()
    walk.start(ring, n)
    for a in range(n):
        walk.walk_from(a)
    x = ring[2 * walk.corner]
    y = ring[2 * walk.corner + 1]
    out[0] = x
    out[1] = y
    out[2] = x + walk.side_x
    out[3] = y + walk.side_y
    out[4] = x + walk.side_x + walk.other_x
    out[5] = y + walk.side_y + walk.other_y
    out[6] = x + walk.other_x
    out[7] = y + walk.other_y
    return walk.best
