"""Load on a patch of an elastic sole, spanned by contact points."""

import math

import numpy as np

from ..geometry import clean, convex

__all__ = ["PressedPatch", "load_block", "load_parts", "patch_key", "spread_part", "spread_whole"]

_EXACT = 1e-12  # of the load and of the cells' extent: how exactly a pressure has the moment that is asked for


def load_block(count):
    """Room for what a number of cells carry, in one array, so that it is copied at once: see `load_parts`."""
    return np.zeros(5 * count + 6)


def load_parts(block):
    """Forces (n,) along the cells' axes, overlaps (n,), forces (n, 3) and the contacts' wrench (6,) in a block."""
    count = (len(block) - 6) // 5
    return block[:count], block[count : 2 * count], block[2 * count : 5 * count].reshape(count, 3), block[5 * count :]


def spread_whole(u, area, inverse, x, y, force, cells, out):
    """Spread a normal load over cells that all carry: pressure a + b x + c y, never negative.

    `u`: coordinates (m, 3) of cells' covered centroids: 1, and scaled place; `area`: share (m,) of each cell in covered
    area; `inverse`: load to field (3, 3) of all covered cells; `force`: load in N; `cells`: index (m,) of each cell in
    `out`; `out`: receives cells' forces in N, if all carry.
    """
    a = inverse[0, 0] + inverse[0, 1] * x + inverse[0, 2] * y
    b = inverse[1, 0] + inverse[1, 1] * x + inverse[1, 2] * y
    c = inverse[2, 0] + inverse[2, 1] * x + inverse[2, 2] * y
    total = 0.0
    for i in range(u.shape[0]):
        pressure = a + b * u[i, 1] + c * u[i, 2]
        if pressure < 0.0:
            return False
        total += pressure * area[i]
    for i in range(u.shape[0]):
        out[cells[i]] = force * (a + b * u[i, 1] + c * u[i, 2]) * area[i] / total
    return True


def spread_part(u, area, x, y, force, active, cells, out):
    """Spread a normal load where some cells lift off: pressure max(0, a + b x + c y).

    One or two 3 x 3 solves from the last carrying cells find them. Arguments as of `spread_whole`; `active` (m,) are
    the cells to start from, then those that carry. Returns whether eight rounds found them.
    """
    count = u.shape[0]
    for _ in range(8):
        m00 = 0.0
        m01 = 0.0
        m02 = 0.0
        m11 = 0.0
        m12 = 0.0
        m22 = 0.0
        for i in range(count):
            if active[i]:
                w = area[i]
                p = u[i, 1]
                q = u[i, 2]
                m00 += w
                m01 += w * p
                m02 += w * q
                m11 += w * p * p
                m12 += w * p * q
                m22 += w * q * q
        ridge = 1e-12 * (m00 + m11 + m22) + 1e-300
        determinant, a, b, c = _solved(m00 + ridge, m01, m02, m11 + ridge, m12, m22 + ridge, 1.0, x, y)
        if determinant == 0.0:
            return False
        same = True
        some = False
        total = 0.0
        for i in range(count):
            pressure = a + b * u[i, 1] + c * u[i, 2]
            carries = pressure > 0.0
            if carries != active[i]:
                same = False
                active[i] = carries
            if carries:
                some = True
                total += pressure * area[i]
        if same:
            for i in range(count):
                pressure = a + b * u[i, 1] + c * u[i, 2] if active[i] else 0.0
                out[cells[i]] = force * pressure * area[i] / total
            return True
        if not some:
            break
    return False


def _solved(m00, m01, m02, m11, m12, m22, x, y, z):
    """Determinant of a symmetric matrix (3, 3) and its solution of a right side (x, y, z); zeros where it is 0."""
    i00 = m11 * m22 - m12 * m12
    i01 = m02 * m12 - m01 * m22
    i02 = m01 * m12 - m02 * m11
    i11 = m00 * m22 - m02 * m02
    i12 = m01 * m02 - m00 * m12
    i22 = m00 * m11 - m01 * m01
    determinant = m00 * i00 + m01 * i01 + m02 * i02
    if determinant == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    a = (i00 * x + i01 * y + i02 * z) / determinant
    b = (i01 * x + i11 * y + i12 * z) / determinant
    c = (i02 * x + i12 * y + i22 * z) / determinant
    return determinant, a, b, c


def _centred(rows, cells, least):
    """Bring rows (at least cells, 3) of weight and place to weights in sum 1, and to places about their weighted centre
    in shares of their spread, which is `least` or more; returns centre x, y and spread.
    """
    total = 0.0
    cx = 0.0
    cy = 0.0
    for i in range(cells):
        total += rows[i, 0]
        cx += rows[i, 0] * rows[i, 1]
        cy += rows[i, 0] * rows[i, 2]
    cx /= total
    cy /= total
    spread = 0.0
    for i in range(cells):
        p = rows[i, 1] - cx
        q = rows[i, 2] - cy
        spread += rows[i, 0] * (p * p + q * q)
    scale = math.sqrt(spread / total)
    if scale < least:
        scale = least
    for i in range(cells):
        rows[i, 0] /= total
        rows[i, 1] = (rows[i, 1] - cx) / scale
        rows[i, 2] = (rows[i, 2] - cy) / scale
    return cx, cy, scale


def _tilted(rows, cells, x, y, tries):
    """Pressure max(0, a + b x + c y) of a unit load at (x, y): whether found, a, b, c.

    Damped Newton steps on 1/2 sum w max(0, p)^2 - load . field. Rows (at least cells, 3) are weight, in sum 1, and
    scaled place of cells; `tries`: ridges that are tried where too few cells carry for a step, 3, or more where a
    pressure is known to exist.
    """
    a = 1.0
    b = 0.0
    c = 0.0
    step_a = 0.0
    step_b = 0.0
    step_c = 0.0
    slope = 0.0
    value = 0.0
    rate = 1.0
    for turn in range(500):
        m00 = 0.0
        m01 = 0.0
        m02 = 0.0
        m11 = 0.0
        m12 = 0.0
        m22 = 0.0
        for i in range(cells):
            p = rows[i, 1]
            q = rows[i, 2]
            if a + b * p + c * q > 0.0:
                w = rows[i, 0]
                m00 += w
                m01 += w * p
                m02 += w * q
                m11 += w * p * p
                m12 += w * p * q
                m22 += w * q * q
        r0 = m00 * a + m01 * b + m02 * c
        r1 = m01 * a + m11 * b + m12 * c
        r2 = m02 * a + m12 * b + m22 * c
        energy = 0.5 * (a * r0 + b * r1 + c * r2) - a - b * x - c * y
        r0 -= 1.0
        r1 -= x
        r2 -= y
        if max(abs(r0), abs(r1), abs(r2)) <= _EXACT:
            return True, a, b, c
        if turn and energy > value - 1e-4 * rate * slope + 1e-15 and rate > (1e-3 if turn < 60 else 1e-8):
            rate *= 0.5  # too far: cells came on or off; a step uphill saves turns, but may lead round in a circle
            a += rate * step_a
            b += rate * step_b
            c += rate * step_c
            continue
        value = energy
        ridge = 1e-14 * (m00 + m11 + m22) + 1e-300
        for _ in range(tries):
            determinant, step_a, step_b, step_c = _solved(
                m00 + ridge, m01, m02, m11 + ridge, m12, m22 + ridge, r0, r1, r2
            )
            if determinant > 0.0 and max(abs(step_a), abs(step_b), abs(step_c)) <= 1e3 * (
                1.0 + abs(a) + abs(b) + abs(c)
            ):
                break
            ridge *= 3e4  # the cells that carry are in a row
        else:
            return False, a, b, c  # no pressure of these cells has this moment: the field grows without end
        slope = r0 * step_a + r1 * step_b + r2 * step_c
        rate = 1.0
        a -= step_a
        b -= step_b
        c -= step_c
        if turn == 0 and _all_carry(rows, cells, a, b, c):  # as at the first field: the same sums
            r0 = m00 * a + m01 * b + m02 * c - 1.0
            r1 = m01 * a + m11 * b + m12 * c - x
            r2 = m02 * a + m12 * b + m22 * c - y
            if max(abs(r0), abs(r1), abs(r2)) <= _EXACT:
                return True, a, b, c
    return False, a, b, c


def _all_carry(rows, cells, a, b, c):
    """Whether the pressure a + b x + c y is above 0 at all places."""
    least = 1.0
    for i in range(cells):
        least = min(least, a + b * rows[i, 1] + c * rows[i, 2])
    return least > 0.0


def patch_key(points, grid):
    """Points (x, y) in m on a grid, unique and sorted: equal for the same patch."""
    places = set()
    for x, y in points:
        places.add((round(x / grid), round(y / grid)))
    return tuple(sorted(places))


class PressedPatch:
    """What does not depend on the load: m covered cells, u = (1, (x - cx)/h, (y - cy)/h).

    Attributes `carried`: whether each cell (m,) carried last; search starts there.

    Args:
        cells: Index (m,) of each cell in sole.
        centre: Place (cx, cy) in m.
        scale: h in m.
        area: Share (m,) of each cell in covered area.
        u: Coordinates (m, 3).
        inverse: Load to field (3, 3) where every covered cell carries.
        reach: Polygon (k, 2) in scaled coordinates where cells can carry a load.
    """

    def __init__(self, cells, centre, scale, area, u, inverse, reach):
        self.cells = cells
        self.cx, self.cy = centre
        self.scale = scale
        self.area = area
        self.u = u
        self.inverse = inverse
        self.reach = reach
        self.turn = clean.turning(reach, 0.0, 0.0, 0.0)  # which way it goes round, 0 where it has to be cleaned first
        self.carried = np.zeros(len(cells), dtype=np.uint8)
        self.x = 0.0
        self.y = 0.0

    def spread(self, force, x, y, out):
        """Spread a normal load over the cells.

        `force`: load in N; `x`: where it acts in m; moved to where cells can carry it; y likewise; `out`: receives
        cells' forces in N, if carried. Returns whether carrying cells were found; else try `part` from others.
        """
        self.x = (x - self.cx) / self.scale
        self.y = (y - self.cy) / self.scale
        if spread_whole(self.u, self.area, self.inverse, self.x, self.y, force, self.cells, out):
            return True
        self._to_reach()
        return self._some_carried() and self.part(force, out)

    def _some_carried(self):
        some = False
        for i in range(self.carried.shape[0]):
            some = some or self.carried[i] != 0
        return some

    def _to_reach(self):
        if self.turn != 0:
            _margin, self.x, self.y = convex._nearest(self.reach, self.turn, self.x, self.y)
        else:
            self.x, self.y = convex.nearest(self.reach, self.x, self.y)

    def part(self, force, out):
        """Spread the last load, `force` in N, from `carried` cells into `out`; whether found."""
        return spread_part(self.u, self.area, self.x, self.y, force, self.carried, self.cells, out)

    def settle(self, force, out):
        """As `part` where `spread` found no carrying cells: from those that would press if all could pull, else by
        `_tilted`.
        """
        inverse = self.inverse
        if not self._some_carried():
            a = inverse[0, 0] + inverse[0, 1] * self.x + inverse[0, 2] * self.y
            b = inverse[1, 0] + inverse[1, 1] * self.x + inverse[1, 2] * self.y
            c = inverse[2, 0] + inverse[2, 1] * self.x + inverse[2, 2] * self.y
            self._press(a, b, c)
            if self.part(force, out):
                return 0
        rows = np.array(self.u)
        for i in range(self.area.shape[0]):
            rows[i, 0] = self.area[i]
        _found, a, b, c = _tilted(rows, self.area.shape[0], self.x, self.y, 3)
        total = self._press(a, b, c)
        if not (total > 0.0 and self.part(force, out)):
            for i in range(self.area.shape[0]):
                pressure = max(a + b * self.u[i, 1] + c * self.u[i, 2], 0.0) / total if total > 0.0 else 1.0
                out[self.cells[i]] = force * pressure * self.area[i]
        return 0

    def _press(self, a, b, c):
        """Let those cells carry on which pressure a + b x + c y is above 0; its sum over the area."""
        total = 0.0
        for i in range(self.area.shape[0]):
            pressure = a + b * self.u[i, 1] + c * self.u[i, 2]
            self.carried[i] = pressure > 0.0
            if pressure > 0.0:
                total += pressure * self.area[i]
        return total
