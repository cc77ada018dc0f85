"""Force on each taxel of a sole; together they have its contacts' wrench."""

import math

import numpy as np

from ..geometry import convex
from . import pressed_patch

__all__ = ["TaxelLoad"]

_SPREAD = 1e-3  # of the load: what cells next to the contact may carry where those in it cannot hold its moment
_FAINT = 0.02  # of a cell's area: how much the next row counts, so that the load is always between taxels
_EXACT = 1e-12  # of the load: how exactly a curved sole has the moments of all contacts


class TaxelLoad:
    """Spreads a sole's contact wrench over its taxels.

    - The contact points of each pair of geoms span a patch. A cell's weight w is its area times its covered share, a
      ramp over its width.
    - Each pair's normal load is spread as on springs that cannot pull: f = w max(0, a + b x + c y).
    - The sum is corrected likewise, with itself as weight, to the exact load and moments; if impossible, with
      neighbouring cells, then all.
    - Tangential forces follow the normal ones, with the rest of the wrench.
    - Contacts that press from above, within 45 degrees of straight down, are left out.

    `positions`: taxels (n, 3) in sole frame in m; `normals`: axis (n, 3) of each taxel into body; `areas`: area (n,) of
    each cell in m^2; `widths`: distance (n,) in m from each taxel to its cell's farthest corner; `hull`: convex hull
    (h, 2) of taxels in m, counter-clockwise. Attributes `vectors`: force (n, 3) on each taxel in sole frame in N;
    `forces`: its part (n,) along taxel's axis in N; `depths`: overlap (n,) of geoms at each taxel in m; `wrench`:
    wrench (6,) of contacts about sole origin in N and N m; `carried`: whether vectors have that wrench, or else only
    its force.
    """

    def __init__(self, positions, normals, areas, widths, hull):
        count = len(areas)
        self.positions = positions
        self.normals = normals
        self.areas = areas
        self.widths = widths
        self.hull = hull
        self.middle = hull.mean(axis=0)
        self.inner = _inner_radius(hull, self.middle)
        self.level = bool((positions[:, 2] == 0.0).all())
        self.block = pressed_patch.load_block(count)
        self.forces, self.depths, self.vectors, self.wrench = pressed_patch.load_parts(self.block)
        self._forces = self.forces
        self._depths = self.depths
        self._vectors = self.vectors
        self._wrench = self.wrench
        self.sums = np.zeros((2, 6))  # wrench of contacts that the sole has, and of those from above
        self.weights = np.zeros(count)
        self.prior = np.zeros(count)
        self.normal = np.zeros(count)
        self.gaps = np.zeros(count)
        self.rows = np.zeros((count, 3))  # of the cells with a weight: weight and place, scaled
        self.carried = True
        self._make_room(16)

    def _make_room(self, room):
        self.room = room
        self.points = np.zeros((room, 3))  # x, y and overlap
        self.ring = np.zeros((2 * room + 2, 2))
        self.edges = np.zeros((2 * room + 2, 3))  # direction and length of each edge of the ring

    def is_lost(self):
        """Whether the contacts' load is not a number: the simulation diverged."""
        return self._wrench[2] != self._wrench[2]

    def press(self, contacts, seen, reach):
        """Set the attributes from the sole's `FootContacts`, turned by `ContactsInSole`; a contact without load counts
        up to a gap of `reach` in m.
        """
        count = self.areas.shape[0]
        for i in range(6):
            self._wrench[i] = 0.0
        for i in range(count):
            self.prior[i] = 0.0
            self._depths[i] = 0.0
            self._forces[i] = 0.0
            self._vectors[i, 0] = 0.0
            self._vectors[i, 1] = 0.0
            self._vectors[i, 2] = 0.0
        self.carried = True
        seen.turn(contacts)
        if contacts.size == 0:
            return
        if contacts.size > self.room:
            self._make_room(2 * contacts.size)
        on_sole = self._sum(contacts, seen.vectors)
        force = self.sums[0, 2]
        if not force > 0.0:
            for i in range(6):
                if self._wrench[i] != 0.0:
                    self.carried = False
            return
        self._spread_pairs(contacts, seen.vectors, reach)
        self._balance(force)
        self.carried = self.carried and on_sole

    def _sum(self, contacts, vectors):
        """Sum contacts, drop those from above; whether there are none."""
        sums = self.sums
        for i in range(6):
            sums[0, i] = 0.0
            sums[1, i] = 0.0
        above = 0
        for k in range(contacts.size):
            row = 3 * k
            x = vectors[row, 0]
            y = vectors[row, 1]
            z = vectors[row, 2]
            fx = vectors[row + 1, 0]
            fy = vectors[row + 1, 1]
            fz = vectors[row + 1, 2]
            a = 1 if fz < 0.0 and fz * fz > fx * fx + fy * fy else 0
            sums[a, 0] += fx
            sums[a, 1] += fy
            sums[a, 2] += fz
            sums[a, 3] += vectors[row + 2, 0] + y * fz - z * fy
            sums[a, 4] += vectors[row + 2, 1] + z * fx - x * fz
            sums[a, 5] += vectors[row + 2, 2] + x * fy - y * fx
            above += a
            for j in range(3 * a):
                vectors[row + 1, j] = 0.0
                vectors[row + 2, j] = 0.0
        for i in range(6):
            self._wrench[i] = sums[0, i] + sums[1, i]
        return above == 0

    def _spread_pairs(self, contacts, vectors, reach):
        count = self.areas.shape[0]
        for k in range(contacts.size):
            size, force, about_x, about_y = contacts._pair_load(vectors, reach, k, self.points)
            if force > 0.0:
                self._cover(size)
                self._press_deep(size)
                if not self._tilt(self.weights, force, -about_y / force, about_x / force):
                    self._even(force)
                for i in range(count):
                    self.prior[i] += self.normal[i]

    def _even(self, force):
        """Set `normal` to the weights' shares of a load in N."""
        total = 0.0
        for i in range(self.areas.shape[0]):
            total += self.weights[i]
        for i in range(self.areas.shape[0]):
            self.normal[i] = force * self.weights[i] / total

    def _cover(self, size):
        """Set `weights` to each cell's area in m^2 under the patch, else the nearest's."""
        corners = self._hull_of(size)
        count = self.areas.shape[0]
        for k in range(corners):
            j = k + 1 if k + 1 < corners else 0
            x = self.ring[j, 0] - self.ring[k, 0]
            y = self.ring[j, 1] - self.ring[k, 1]
            length = math.sqrt(x * x + y * y)
            self.edges[k, 2] = length
            self.edges[k, 0], self.edges[k, 1] = (x / length, y / length) if corners > 1 else (1.0, 0.0)
        least = 1e300
        at_x = self.ring[0, 0]
        at_y = self.ring[0, 1]
        way_x = self.edges[0, 0]
        way_y = self.edges[0, 1]
        span = self.edges[0, 2]
        for i in range(count):
            x = self.positions[i, 0]
            y = self.positions[i, 1]
            if corners == 1:  # a point: as below, in a third of the time
                gap = math.sqrt((x - at_x) * (x - at_x) + (y - at_y) * (y - at_y))
            elif corners == 2:  # a line, as of a capsule: as below, in a fifth of the time
                along = way_x * (x - at_x) + way_y * (y - at_y)
                along = 0.0 if along < 0.0 else (span if along > span else along)
                px = x - at_x - along * way_x
                py = y - at_y - along * way_y
                gap = math.sqrt(px * px + py * py)
            else:
                gap = _distance(self.ring, self.edges, corners, x, y)
            self.gaps[i] = gap
            if gap - 0.5 * self.widths[i] < least:
                least = gap - 0.5 * self.widths[i]
        shift = least if least > 0.0 else 0.0
        for i in range(count):
            gap = (self.gaps[i] - shift) / self.widths[i]
            share = 0.5 - 0.5 * gap
            share = 0.0 if share < 0.0 else (1.0 if share > 1.0 else share)
            if gap < 2.0:
                share += _FAINT * (1.0 if gap < 0.0 else 1.0 - 0.5 * gap)
            self.weights[i] = self.areas[i] * share

    def _press_deep(self, size):
        """Raise `depths` of covered cells to the first points' overlap."""
        for i in range(self.areas.shape[0]):
            if self.weights[i] > 0.0:
                total = 0.0
                depth = 0.0
                for k in range(size):
                    x = self.points[k, 0] - self.positions[i, 0]
                    y = self.points[k, 1] - self.positions[i, 1]
                    near = 1.0 / (x * x + y * y + 1e-8)
                    total += near
                    depth += near * self.points[k, 2]
                if depth > total * self._depths[i]:
                    self._depths[i] = depth / total

    def _hull_of(self, size):
        """Put the first points' convex hull into `ring`, counter-clockwise; its size."""
        points = self.points
        ring = self.ring
        if size == 2 and (points[0, 0] != points[1, 0] or points[0, 1] != points[1, 1]):
            for k in range(2):
                ring[k, 0] = points[k, 0]
                ring[k, 1] = points[k, 1]
            return 2
        for k in range(1, size):  # in order of x, then y
            x = points[k, 0]
            y = points[k, 1]
            z = points[k, 2]
            j = k
            while j > 0 and (points[j - 1, 0] > x or (points[j - 1, 0] == x and points[j - 1, 1] > y)):
                points[j, 0] = points[j - 1, 0]
                points[j, 1] = points[j - 1, 1]
                points[j, 2] = points[j - 1, 2]
                j -= 1
            points[j, 0] = x
            points[j, 1] = y
            points[j, 2] = z
        corners = 0
        for k in range(size):
            corners = _join(ring, corners, 0, points[k, 0], points[k, 1])
        floor = corners - 1
        for k in range(size - 2, -1, -1):
            corners = _join(ring, corners, floor, points[k, 0], points[k, 1])
        return corners - 1 if corners > 1 else corners

    def _tilt(self, weights, force, x, y):
        """Set `normal` to weights (n,) times max(0, a + b x + c y), with a load in N at (x, y) in m; False, with
        `normal` unchanged, without solution.
        """
        cells = 0
        rows = self.rows
        if self._is_beyond(x, y):
            return False
        for i in range(self.areas.shape[0]):
            if weights[i] > 0.0:
                rows[cells, 0] = weights[i]
                rows[cells, 1] = self.positions[i, 0]
                rows[cells, 2] = self.positions[i, 1]
                cells += 1
        if cells == 0:
            return False
        cx, cy, scale = pressed_patch._centred(rows, cells, 1e-4)
        at_x = (x - cx) / scale
        at_y = (y - cy) / scale
        found, a, b, c = pressed_patch._tilted(rows, cells, at_x, at_y, 3)
        if found:
            cells = 0
            for i in range(self.areas.shape[0]):
                pressure = 0.0
                if weights[i] > 0.0:
                    pressure = a + b * rows[cells, 1] + c * rows[cells, 2]
                    w = rows[cells, 0]
                    cells += 1
                self.normal[i] = force * w * pressure if pressure > 0.0 else 0.0
        return found

    def _is_beyond(self, x, y):
        """Whether a place is beyond the outermost taxels: no pressure has its moment."""
        p = x - self.middle[0]
        q = y - self.middle[1]
        if p * p + q * q < self.inner * self.inner:
            return False
        return convex.margin_of_clean(self.hull, x, y) < -1e-12  # m: rounding

    def _balance(self, force):
        count = self.areas.shape[0]
        about_x = self.sums[0, 3]
        about_y = self.sums[0, 4]
        for _ in range(1 if self.level else 60):
            if not self._carry(force, -about_y / force, about_x / force):
                self.carried = False
            self._shear(force)
            if self.level:
                break
            # Tangential forces on taxels above or below z = 0 have moments about x and y.
            off_x = self.sums[0, 3]
            off_y = self.sums[0, 4]
            for i in range(count):
                x = self.positions[i, 0]
                y = self.positions[i, 1]
                z = self.positions[i, 2]
                off_x -= y * self._vectors[i, 2] - z * self._vectors[i, 1]
                off_y -= z * self._vectors[i, 0] - x * self._vectors[i, 2]
            if not self.carried or max(abs(off_x), abs(off_y)) <= _EXACT * force:
                break
            about_x += off_x
            about_y += off_y
        for i in range(count):
            self._forces[i] = (
                self._vectors[i, 0] * self.normals[i, 0]
                + self._vectors[i, 1] * self.normals[i, 1]
                + self._vectors[i, 2] * self.normals[i, 2]
            )

    def _carry(self, force, x, y):
        """Set `normal` to all contacts' load; whether the cells can carry it."""
        count = self.areas.shape[0]
        if self._tilt(self.prior, force, x, y):
            return True
        beyond = self._is_beyond(x, y)
        for stage in range(1 if beyond else 0, 2):
            area = 0.0
            for i in range(count):
                self.gaps[i] = self.areas[i] * stage
                if stage == 0:
                    for j in range(count):
                        p = self.positions[i, 0] - self.positions[j, 0]
                        q = self.positions[i, 1] - self.positions[j, 1]
                        if self.prior[j] > 0.0 and p * p + q * q < 4.0 * self.widths[j] * self.widths[j]:
                            self.gaps[i] = self.areas[i]
                            break
                area += self.gaps[i]
            for i in range(count):
                self.weights[i] = (0.0 if beyond else self.prior[i]) + _SPREAD * force * self.gaps[i] / area
            if self._tilt(self.weights, force, x, y):
                return True
        # From the nearest place among the outermost taxels, a little inside.
        _margin, near_x, near_y = convex._nearest(self.hull, 1.0, x, y)
        for _ in range(20):
            near_x += 1e-3 * (self.middle[0] - near_x)
            near_y += 1e-3 * (self.middle[1] - near_y)
            if self._tilt(self.weights, force, near_x, near_y):
                return False
        self._even(force)
        return False

    def _shear(self, force):
        """Set `vectors` to normal plus tangential forces with the wrench's rest."""
        count = self.areas.shape[0]
        cx = 0.0
        cy = 0.0
        for i in range(count):
            cx += self.normal[i] * self.positions[i, 0]
            cy += self.normal[i] * self.positions[i, 1]
        cx /= force
        cy /= force
        spread = 0.0
        for i in range(count):
            p = self.positions[i, 0] - cx
            q = self.positions[i, 1] - cy
            spread += self.normal[i] * (p * p + q * q)
        twist = self.sums[0, 5] - (cx * self.sums[0, 1] - cy * self.sums[0, 0])
        turn = 0.0
        if spread > 1e-12 * force:
            turn = twist / spread
        elif abs(twist) > _EXACT * force:
            self.carried = False
        for i in range(count):
            share = self.normal[i] / force
            p = self.positions[i, 0] - cx
            q = self.positions[i, 1] - cy
            self._vectors[i, 0] = share * self.sums[0, 0] - turn * self.normal[i] * q
            self._vectors[i, 1] = share * self.sums[0, 1] + turn * self.normal[i] * p
            self._vectors[i, 2] = self.normal[i]


def _inner_radius(hull, middle):
    """Distance in m from `middle` (2,) to the nearest side of a hull (h, 2); 0 without an inside."""
    if len(hull) < 3:
        return 0.0
    ways = np.roll(hull, -1, axis=0) - hull
    away = middle - hull
    margins = (ways[:, 0] * away[:, 1] - ways[:, 1] * away[:, 0]) / np.linalg.norm(ways, axis=1)
    return max(float(margins.min()), 0.0)


def _join(ring, corners, floor, x, y):
    """Add a point to a hull that turns left, dropping superfluous corners; its size."""
    while corners - floor >= 2:
        ax = ring[corners - 1, 0] - ring[corners - 2, 0]
        ay = ring[corners - 1, 1] - ring[corners - 2, 1]
        if ax * (y - ring[corners - 2, 1]) - ay * (x - ring[corners - 2, 0]) > 0.0:
            break
        corners -= 1
    if corners > 0 and ring[corners - 1, 0] == x and ring[corners - 1, 1] == y:
        return corners
    ring[corners, 0] = x
    ring[corners, 1] = y
    return corners + 1


def _distance(ring, edges, corners, x, y):
    """Signed distance in m of a point to the polygon of the first corners, negative inside."""
    deepest = -1e300
    for k in range(corners):
        out = edges[k, 1] * (x - ring[k, 0]) - edges[k, 0] * (y - ring[k, 1])
        if out > deepest:
            deepest = out
    if corners >= 3 and deepest <= 0.0:
        return deepest
    nearest = 1e300
    for k in range(corners):
        px = x - ring[k, 0]
        py = y - ring[k, 1]
        along = edges[k, 0] * px + edges[k, 1] * py
        along = 0.0 if along < 0.0 else (edges[k, 2] if along > edges[k, 2] else along)
        px -= along * edges[k, 0]
        py -= along * edges[k, 1]
        gap = px * px + py * py
        if gap < nearest:
            nearest = gap
    return math.sqrt(nearest)
