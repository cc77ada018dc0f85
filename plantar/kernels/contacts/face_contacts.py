"""Sole's contacts with ground of a flat face, continuous in both poses.

Contacts are the corners of both faces' overlap, each as deep as the sole is there, along the normal of the ground's
face, which the boxes' smallest overlap along their axes selects.
"""

import math

from ..base import addresses, memory

__all__ = ["FaceContacts"]

_SAME = 1e-9  # m: corners closer than this are one
_ROOM = 16  # corners of a rectangle cut by a rectangle, with room to spare
_TILTED = 0.9  # cosine of the angle to a cylinder's axis up to which a sole lies on its end


class FaceContacts:
    """Writes one pair's contacts into the simulator's memory.

    `stride`: bytes from one contact to the next; each: gap, position (3,), normal (3,) from first geom to second, first
    tangent (3,). Attributes `count`: number of pairs so far.
    """

    def __init__(self, stride):
        self.stride = stride
        self.count = 0
        self.from_memory = memory.new_vector(3 * _ROOM)
        self.cut_memory = memory.new_vector(3 * _ROOM)
        self.turn_memory = memory.new_vector(9)
        self.shift_memory = memory.new_vector(3)
        self.corners = memory.room(self.from_memory)
        self.cut = memory.room(self.cut_memory)
        self.turn = memory.room(self.turn_memory)
        self.shift = memory.room(self.shift_memory)

    def box(self, places, turns, sizes, ground, sole, margin, out, sign):
        """Number of contacts of a box on a box.

        `places`: address of all geoms' positions (n, 3) in m; `turns`: address of their rotations (n, 9) to world;
        `sizes`: address of their half sizes (n, 3) in m; `margin`: largest gap in m of contact; `sign`: 1 if ground is
        first in pair, else -1.
        """
        self.count += 1
        base = addresses.at(places)
        rows = addresses.at(turns)
        half = addresses.at(sizes)
        self._look(base, rows, ground, sole)
        turn = self.turn
        shift = self.shift
        g = 3 * ground
        s = 3 * sole
        best = math.inf
        axis = 0
        own = -1
        for i in range(3):
            reach = half[g + i]
            for j in range(3):
                reach += abs(turn[3 * i + j]) * half[s + j]
            overlap = reach - abs(shift[i])
            if overlap < best:
                best = overlap
                axis = i
        for j in range(3):
            along = 0.0
            reach = half[s + j]
            for i in range(3):
                along += turn[3 * i + j] * shift[i]
                reach += abs(turn[3 * i + j]) * half[g + i]
            overlap = reach - abs(along)
            if overlap < best:
                best = overlap
                own = j
        if best < -margin:
            return 0
        if own >= 0:
            axis = 0
            for i in range(1, 3):
                if abs(turn[3 * i + own]) > abs(turn[3 * axis + own]):
                    axis = i
        side = 1.0 if shift[axis] >= 0.0 else -1.0
        self._place_face(half, s, axis, side * half[g + axis], side)
        count = self._cut_by(4, (axis + 1) % 3, half[g + (axis + 1) % 3])
        count = self._cut_by(count, (axis + 2) % 3, half[g + (axis + 2) % 3])
        return self._write(base, rows, ground, count, axis, side, half[g + axis], margin, out, sign)

    def cylinder(self, places, turns, sizes, ground, sole, margin, out, sign):
        """Contacts of a box on a cylinder's end, at the corners furthest along the box's diagonals; as `box`.

        Returns number of contacts; -1 off the end.
        """
        self.count += 1
        base = addresses.at(places)
        rows = addresses.at(turns)
        half = addresses.at(sizes)
        self._look(base, rows, ground, sole)
        turn = self.turn
        shift = self.shift
        s = 3 * sole
        radius = half[3 * ground]
        height = half[3 * ground + 1]
        own = 0
        for j in range(1, 3):
            if abs(turn[6 + j]) > abs(turn[6 + own]):
                own = j
        if abs(turn[6 + own]) < _TILTED:
            return -1
        reach = height + radius * math.sqrt(turn[own] * turn[own] + turn[3 + own] * turn[3 + own]) + half[s + own]
        along = turn[own] * shift[0] + turn[3 + own] * shift[1] + turn[6 + own] * shift[2]
        if reach - abs(along) < -margin:
            return 0
        side = 1.0 if shift[2] >= 0.0 else -1.0
        self._place_face(half, s, 2, side * height, side)
        return self._write_disc(base, rows, ground, radius, height, reach - abs(along), side, margin, out, sign)

    def _look(self, base, rows, ground, sole):
        g = 3 * ground
        s = 3 * sole
        for i in range(3):
            self.shift[i] = 0.0
            for k in range(3):
                self.shift[i] += rows[3 * g + 3 * k + i] * (base[s + k] - base[g + k])
            for j in range(3):
                self.turn[3 * i + j] = 0.0
                for k in range(3):
                    self.turn[3 * i + j] += rows[3 * g + 3 * k + i] * rows[3 * s + 3 * k + j]

    def _place_face(self, half, s, axis, height, side):
        """Put the sole's facing face into `corners`, with the gap along the normal."""
        own = 0
        for j in range(1, 3):
            if abs(self.turn[3 * axis + j]) > abs(self.turn[3 * axis + own]):
                own = j
        facing = -side if self.turn[3 * axis + own] >= 0.0 else side
        a = (own + 1) % 3
        b = (own + 2) % 3
        for k in range(4):
            u = half[s + a] if k == 1 or k == 2 else -half[s + a]
            v = half[s + b] if k >= 2 else -half[s + b]
            for i in range(3):
                self.corners[3 * k + i] = (
                    self.shift[i]
                    + facing * half[s + own] * self.turn[3 * i + own]
                    + u * self.turn[3 * i + a]
                    + v * self.turn[3 * i + b]
                )
            self.corners[3 * k + axis] = side * (self.corners[3 * k + axis] - height)

    def _cut_by(self, count, axis, reach):
        """Cut `corners` to -reach <= x <= reach along an axis; number left."""
        for side in (-1.0, 1.0):
            kept = 0
            for k in range(count):
                n = 3 * (k + 1) if k + 1 < count else 0
                here = side * self.corners[3 * k + axis] - reach
                there = side * self.corners[n + axis] - reach
                if here <= 0.0:
                    for i in range(3):
                        self.cut[3 * kept + i] = self.corners[3 * k + i]
                    kept += 1
                if (here < 0.0 < there) or (there < 0.0 < here):
                    share = here / (here - there)
                    for i in range(3):
                        self.cut[3 * kept + i] = self.corners[3 * k + i] + share * (
                            self.corners[n + i] - self.corners[3 * k + i]
                        )
                    kept += 1
            count = 0
            for k in range(kept):
                before = 3 * (k - 1) if k > 0 else 3 * (kept - 1)
                apart = 0.0
                for i in range(3):
                    apart = max(apart, abs(self.cut[3 * k + i] - self.cut[before + i]))
                if apart <= _SAME and kept > 1:
                    continue
                for i in range(3):
                    self.corners[3 * count + i] = self.cut[3 * k + i]
                count += 1
        return count

    def _write(self, base, rows, ground, count, axis, side, height, margin, out, sign):
        found = 0
        for k in range(count):
            if found < 8 and self.corners[3 * k + axis] < margin:
                self._write_one(base, rows, ground, k, axis, side, height, out + found * self.stride, sign)
                found += 1
        return found

    def _write_one(self, base, rows, ground, k, axis, side, height, address, sign):
        to = addresses.at(address)
        gap = self.corners[3 * k + axis]
        to[0] = gap
        g = 3 * ground
        for i in range(3):
            place = base[g + i]
            for j in range(3):
                at = side * (height + 0.5 * gap) if j == axis else self.corners[3 * k + j]
                place += rows[3 * g + 3 * i + j] * at
            to[1 + i] = place
            to[4 + i] = sign * side * rows[3 * g + 3 * i + axis]
            to[7 + i] = 0.0

    def _write_disc(self, base, rows, ground, radius, height, depth, side, margin, out, sign):
        """Write the covered disc's points along the face's diagonals; -1 at the wall."""
        ax = 0.5 * (self.corners[3] - self.corners[0])
        ay = 0.5 * (self.corners[4] - self.corners[1])
        az = 0.5 * (self.corners[5] - self.corners[2])
        bx = 0.5 * (self.corners[9] - self.corners[0])
        by = 0.5 * (self.corners[10] - self.corners[1])
        bz = 0.5 * (self.corners[11] - self.corners[2])
        mx = 0.5 * (self.corners[0] + self.corners[6])
        my = 0.5 * (self.corners[1] + self.corners[7])
        mz = 0.5 * (self.corners[2] + self.corners[8])
        size = ax * by - ay * bx
        # The disc's middle in the face's own coordinates, -1 to 1, and how far the face's nearest place is from it.
        p = (-mx * by + my * bx) / size
        q = (mx * ay - my * ax) / size
        u = min(max(p, -1.0), 1.0)
        v = min(max(q, -1.0), 1.0)
        nx = mx + u * ax + v * bx
        ny = my + u * ay + v * by
        nearest = math.sqrt(nx * nx + ny * ny)
        if nearest - radius > -max(depth, 0.0):
            return 0 if nearest - radius > margin else -1
        found = 0
        for k in range(4):
            da = 1.0 if k == 1 or k == 2 else -1.0
            db = 1.0 if k >= 2 else -1.0
            if self._furthest(ax, ay, bx, by, mx, my, radius, p, q, da, db):
                u = self.cut[0]
                v = self.cut[1]
                gap = mz + u * az + v * bz
                if gap < margin:
                    self.corners[12] = mx + u * ax + v * bx
                    self.corners[13] = my + u * ay + v * by
                    self.corners[14] = gap
                    self._write_one(base, rows, ground, 4, 2, side, height, out + found * self.stride, sign)
                    found += 1
        return found

    def _furthest(self, ax, ay, bx, by, mx, my, radius, p, q, da, db):
        """Put a diagonal's furthest point, inside disc and face, into `cut`."""
        la = math.sqrt(ax * ax + ay * ay)
        lb = math.sqrt(bx * bx + by * by)
        wx = da * ax / la + db * bx / lb
        wy = da * ay / la + db * by / lb
        size = math.sqrt(wx * wx + wy * wy)
        wx = wx / size
        wy = wy / size
        area = ax * by - ay * bx
        best = -math.inf
        u = p + radius * (wx * by - wy * bx) / area
        v = q + radius * (wy * ax - wx * ay) / area
        if abs(u) <= 1.0 and abs(v) <= 1.0:
            self.cut[0] = u
            self.cut[1] = v
            return True
        x = mx + da * ax + db * bx
        y = my + da * ay + db * by
        if x * x + y * y <= radius * radius:
            self.cut[0] = da
            self.cut[1] = db
            return True
        for k in range(4):
            fixed = 1.0 if k % 2 == 0 else -1.0
            ox, oy = (mx + fixed * ax, my + fixed * ay) if k < 2 else (mx + fixed * bx, my + fixed * by)
            ex, ey = (bx, by) if k < 2 else (ax, ay)
            a = ex * ex + ey * ey
            b = ox * ex + oy * ey
            c = ox * ox + oy * oy - radius * radius
            root = b * b - a * c
            if root < 0.0:
                continue
            root = math.sqrt(root)
            for way in (-1.0, 1.0):
                t = (way * root - b) / a
                if abs(t) > 1.0:
                    continue
                along = wx * (ox + t * ex) + wy * (oy + t * ey)
                if along > best:
                    best = along
                    self.cut[0], self.cut[1] = (fixed, t) if k < 2 else (t, fixed)
        return best > -math.inf
