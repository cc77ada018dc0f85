"""One sole's kernels: loads and support polygon of its active taxels.

A call borrows its work arrays, so that threads do not share them.
"""

import numpy as np

from plantar.errors import ReadingError

from ..base import memory, vectors
from ..geometry import convex, hull
from . import cell_rows

__all__ = ["SoleKernel", "SoleScratch"]

_NONE = float("nan")
_INFINITE = float("inf")
_NOT_LOWER = 1  # nature: bits of a corner: where its cell keeps it from being on the hull
_NOT_UPPER = 2  # nature: the next bit


class SoleScratch:
    """Work arrays of one call.

    `corners`: number of corner points of their cells; `levels`: number of different x of those.
    """

    def __init__(self, taxels, corners, levels):
        self.kept = np.zeros(taxels)
        self.covered = np.zeros(taxels)
        self.lowest = np.full(levels, corners, dtype=np.intp)  # at each x, between calls; `find_hull` leaves it so
        self.highest = np.full(levels, -1, dtype=np.intp)
        self.way = np.zeros(2 * corners + 2, dtype=np.intp)
        self.ring = np.zeros(2 * corners + 2, dtype=np.intp)
        self.polygon = np.zeros((corners, 2))
        self.force = np.zeros(taxels)
        self.mask = np.zeros(taxels, dtype=bool)
        self.other_mask = np.zeros(taxels, dtype=bool)
        self.sums = np.zeros(9)
        self.offset = convex.OffsetRoom(corners)

    def summed(self, first, count):
        """New array (count,) of the sums from one."""
        made = memory.new_vector(count)
        out = memory.room(made)
        for i in range(count):
            out[i] = self.sums[first + i]
        return made

    def hull(self, size):
        """Hull (size, 2) in m in `polygon`, as a new array."""
        return vectors.points_of(self.polygon, size)

    def copy_hull(self, size, out):
        """Copy the hull in `polygon` to `out` (size, 2) in m."""
        for i in range(size):
            out[i, 0] = self.polygon[i, 0]
            out[i, 1] = self.polygon[i, 1]

    def measure_hull(self, size):
        """Area in m^2 and centroid in m of the hull of `size` corners; NaN if empty."""
        if size == 0:
            return 0.0, _NONE, _NONE
        return convex.area_and_centroid(self.polygon[:size])


class SoleKernel:
    """One sole's taxels, prepared for the kernels. Taxels up to `threshold` in N, from `saturation` on, and NaN are not
    active, nor is any of a sole that measures no more than its noise (`plantar.layouts.contact_levels`).

    Args:
        positions: Taxel centers (n, 3) in sole frame in m.
        normals: z axes (n, 3) of taxels in sole frame.
        areas: Cell areas (n,) in m^2.
        vertices: Corner points (v, 2) in m in sole plane, shared between cells that meet.
        corner_start: Offsets (n + 1,) of each taxel's corners.
        corner_vertex: Vertex indices of corners, taxel by taxel, counter-clockwise.
        threshold: Default activation threshold in N.
        limit: Force in N from which one is saturated.
        cell_contact: At the default threshold a sole is in contact above this force in N of one cell.
        sole_contact: Or above this sum in N of its positive forces.
    """

    def __init__(
        self,
        positions,
        normals,
        areas,
        vertices,
        corner_start,
        corner_vertex,
        threshold=0.0,
        limit=_INFINITE,
        cell_contact=0.0,
        sole_contact=0.0,
    ):
        self.threshold = float(threshold)
        self.limit = float(limit)
        self.level = self.threshold
        self.cell_contact = float(cell_contact)
        self.sole_contact = float(sole_contact)
        self.noisy = self.cell_contact > 0.0
        positions = np.asarray(positions, dtype=np.float64).reshape(-1, 3)
        normals = np.asarray(normals, dtype=np.float64).reshape(-1, 3)
        vertices = np.asarray(vertices, dtype=np.float64).reshape(-1, 2)
        corner_vertex = np.asarray(corner_vertex, dtype=np.intp)
        vertical = normals[:, 2:3]
        self.columns = np.ascontiguousarray(
            np.hstack([normals, np.cross(positions, normals), vertical * positions[:, :2]])
        )
        plain = np.array([0.0, 0.0, 1.0])
        self.flat = bool((normals == plain).all() and (positions[:, 2] == 0.0).all())
        self.lever_x = np.ascontiguousarray(positions[:, 1])  # moments about x and y of a unit force
        self.lever_y = np.ascontiguousarray(-positions[:, 0])
        self.areas = np.ascontiguousarray(areas, dtype=np.float64)
        order = np.lexsort((vertices[:, 1], vertices[:, 0]))
        rank = np.empty(len(order), dtype=np.intp)
        rank[order] = np.arange(len(order))
        ordered = np.ascontiguousarray(vertices[order])
        self.points = ordered
        self.taxels = len(self.areas)
        self.corners = len(order)
        largest = float(np.abs(vertices).max(initial=0.0))
        extent = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
        self.tolerance = hull.hull_tolerance(largest, extent)
        starts = np.asarray(corner_start, dtype=np.intp).tolist()
        rings = [corner_vertex[starts[i] : starts[i + 1]] for i in range(self.taxels)]
        rows, first_end, last_begin = cell_rows.ordered_rows(vertices, rings, starts, self.tolerance)
        self.first_end = np.array(first_end, dtype=np.intp)
        self.last_begin = np.array(last_begin, dtype=np.intp)
        self.row_taxel = np.array([i for row in rows for i in row], dtype=np.intp)
        self.row_start = np.cumsum([0, *map(len, rows)], dtype=np.intp)
        self.corner_rank = np.concatenate([*(rank[ring] for ring in rings), np.empty(0, dtype=np.intp)])
        self.corner_sign = np.concatenate(
            [*(_signs(vertices[ring], rank[ring]) for ring in rings), np.empty(0)]
        ).astype(np.uint8)
        self.corner_start = np.array(starts, dtype=np.intp)
        new = np.ones(len(order), dtype=bool)  # x that differ, to the last bit: on a lattice few of them
        new[1:] = ordered[1:, 0] != ordered[:-1, 0]
        level = np.cumsum(new) - 1
        self.levels = int(new.sum())
        self.corner_level = np.ascontiguousarray(level[np.asarray(self.corner_rank)], dtype=np.intp)
        self.free = [SoleScratch(self.taxels, self.corners, self.levels)]

    def borrow(self):
        """Work arrays, owned until given back; dropped by a failed call."""
        try:
            return self.free.pop()
        except IndexError:
            return SoleScratch(self.taxels, self.corners, self.levels)

    def give_back(self, scratch):
        self.free.append(scratch)
        return 0

    def active(self, force, threshold, saturation):
        """Mask (n,) of active taxels (T 4.22), as `plantar.activation.active_taxels`."""
        scratch = self._borrow_with_active(force, threshold, saturation)
        mask = self._copied(scratch.mask)
        self.give_back(scratch)
        return mask

    def _copied(self, mask):
        made = memory.new_mask(self.taxels)
        out = memory.flags(made)
        for i in range(self.taxels):
            out[i] = mask[i]
        return made

    def _borrow_with(self, force):
        """Borrowed arrays with the forces, copied without a buffer unless strided or of another kind."""
        if memory.size(force) != self.taxels:
            self._check(force)
        scratch = self.borrow()
        if memory.size(force) == self.taxels:
            values = memory.values(force)
            for i in range(self.taxels):
                scratch.force[i] = values[i]
        else:
            self._read(force, scratch)
        return scratch

    def _take_mask(self, active, scratch):
        if memory.is_mask(active, self.taxels):
            values = memory.flags(active)
            for i in range(self.taxels):
                scratch.mask[i] = values[i]
        else:
            self._read_mask(active, scratch)
        return 0

    def _check(self, force):
        """Refuse forces that are not one a taxel, which would be read past."""
        if force is None or force.shape[0] != self.taxels:
            raise ReadingError(f"{_count(force)} forces for {self.taxels} taxels; expected one each")
        return 0

    def _read(self, force, scratch):
        for i in range(self.taxels):
            scratch.force[i] = force[i]

    def _read_mask(self, active, scratch):
        """Copy a mask through its buffer; refuse a wrong length."""
        if active is None or active.shape[0] != self.taxels:
            raise ReadingError(f"mask has {_count(active)} values for {self.taxels} taxels; expected one each")
        for i in range(self.taxels):
            scratch.mask[i] = active[i]
        return 0

    def _borrow_with_active(self, force, threshold, saturation):
        """Borrowed arrays with the forces, and `active` in their mask."""
        scratch = self._borrow_with(force)
        self.activate(scratch.force, threshold, saturation, scratch.mask)
        return scratch

    def activate(self, force, threshold, saturation, out):
        """`active` into an array (n,)."""
        touching = self.touches(force, threshold)
        for i in range(self.taxels):
            out[i] = touching & (force[i] > threshold) & (force[i] < saturation)

    def touches(self, force, threshold):
        """Whether forces (n,) in N are more than noise; always with another threshold than the layout's own."""
        if not self.noisy or threshold != self.level:
            return True
        total = 0.0
        for i in range(self.taxels):
            if force[i] > self.cell_contact:
                return True
            if force[i] > 0.0:
                total += force[i]
        return total > self.sole_contact

    def faults(self, force, saturation):
        """Masks (n,) of dead and of saturated taxels, as `plantar.health.dead_taxels` and `saturated_taxels`."""
        scratch = self._borrow_with(force)
        for i in range(self.taxels):
            finite = -_INFINITE < scratch.force[i] < _INFINITE
            scratch.mask[i] = not finite
            scratch.other_mask[i] = finite and scratch.force[i] >= saturation
        masks = self._copied(scratch.mask), self._copied(scratch.other_mask)
        self.give_back(scratch)
        return masks

    def loads(self, force, active):
        """Wrench about the sole origin, area in m^2 and CoP in m (9,) of the active taxels (T 4.21-4.23); NaN without
        load.

        Each sum's error is below n * 1.2e-16 of its absolute terms' sum.
        """
        scratch = self._borrow_with(force)
        self._take_mask(active, scratch)
        self._loads(scratch.force, scratch.mask, scratch.sums)
        sums = scratch.summed(0, 9)
        self.give_back(scratch)
        return sums

    def loads_above(self, force, threshold, saturation):
        """`loads` of the taxels of `active`, without a mask."""
        scratch = self._borrow_with_active(force, threshold, saturation)
        self._loads(scratch.force, scratch.mask, scratch.sums)
        sums = scratch.summed(0, 9)
        self.give_back(scratch)
        return sums

    def unsaturated_loads(self, force, threshold, saturation):
        """`loads_above`, but None where a taxel is saturated."""
        if not self.flat or memory.size(force) != self.taxels:
            return None if self.reaches(force, saturation) else self.loads_above(force, threshold, saturation)
        # What is active is finite here, so that of the sums those with a column of 0 are 0, and two others are the
        # negative of each other, or the same.
        values = memory.values(force)
        fz = 0.0
        tx = 0.0
        ty = 0.0
        area = 0.0
        largest = 0.0
        total = 0.0
        for i in range(self.taxels):
            f = values[i]
            if f >= saturation:
                return None
            if f > largest:
                largest = f
            if f > 0.0:
                total += f
            if f > threshold:
                fz += f
                tx += f * self.lever_x[i]
                ty += f * self.lever_y[i]
                area += self.areas[i]
        if self.noisy and threshold == self.level and not (largest > self.cell_contact or total > self.sole_contact):
            fz = 0.0  # `touches`, in the same pass
            tx = 0.0
            ty = 0.0
            area = 0.0
        sums = memory.new_vector(9)
        out = memory.room(sums)
        out[0] = 0.0
        out[1] = 0.0
        out[5] = 0.0
        out[2] = fz
        out[3] = tx
        out[4] = ty
        out[6] = area
        # Not -ty: without load on either side of x = 0 that is -0.
        out[7], out[8] = ((0.0 - ty) / fz, tx / fz) if 0.0 < fz < _INFINITE else (_NONE, _NONE)
        return sums

    def reaches(self, force, level):
        """Whether some force reaches a level in N; False for NaN."""
        scratch = self._borrow_with(force)
        largest = -_INFINITE
        for i in range(self.taxels):
            if scratch.force[i] > largest:
                largest = scratch.force[i]
        self.give_back(scratch)
        return bool(self.taxels and largest >= level)

    def _loads(self, force, active, out):
        fx = 0.0
        fy = 0.0
        fz = 0.0
        tx = 0.0
        ty = 0.0
        tz = 0.0
        area = 0.0
        sx = 0.0
        sy = 0.0
        for i in range(self.taxels):
            if active[i]:
                f = force[i]
                fx += f * self.columns[i, 0]
                fy += f * self.columns[i, 1]
                fz += f * self.columns[i, 2]
                tx += f * self.columns[i, 3]
                ty += f * self.columns[i, 4]
                tz += f * self.columns[i, 5]
                sx += f * self.columns[i, 6]
                sy += f * self.columns[i, 7]
                area += self.areas[i]
        out[0] = fx
        out[1] = fy
        out[2] = fz
        out[3] = tx
        out[4] = ty
        out[5] = tz
        out[6] = area
        if 0.0 < fz < _INFINITE:
            out[7] = sx / fz
            out[8] = sy / fz
        else:
            out[7] = _NONE
            out[8] = _NONE

    def hull(self, active):
        """Convex hull (k, 2) in m of the active cells (T 4.24), with area and centroid x, y, NaN without contact.

        Only the ends of each row of shifted copies count. Errors as `hull.convex_hull`, `convex.area_and_centroid`.
        """
        scratch = self.borrow()
        self._take_mask(active, scratch)
        return self._hull(scratch)

    def hull_above(self, force, threshold, saturation):
        """`hull` of the taxels of `active`, without a mask."""
        return self._hull(self._borrow_with_active(force, threshold, saturation))

    def _hull(self, scratch):
        """`hull` of the mask in borrowed arrays, then given back."""
        size = self.find_hull(scratch.mask, scratch)
        area, x, y = scratch.measure_hull(size)
        polygon = scratch.hull(size)
        self.give_back(scratch)
        return polygon, area, x, y

    def tick(self, force, threshold, saturation, offset, x, y):
        """Controller's needs of one foot: `active`, `loads`, `hull`, `convex.inner_offset`, `convex.closest_point`.

        `offset`: how far hull's edges move inwards in m; not if 0 or less; `x`: point in m to be close to; y likewise.
        Returns mask (n,); wrench (6,) in N and N m; contact area in m^2; CoP (2,) in m or None; polygon (k, 2), its
        area, centroid (2,); smaller polygon (m, 2); its closest point (2,), in m. Points are None without contact.
        """
        scratch = self._borrow_with_active(force, threshold, saturation)
        self._loads(scratch.force, scratch.mask, scratch.sums)
        mask = self._copied(scratch.mask)
        wrench = scratch.summed(0, 6)
        contact = scratch.sums[6]
        cop = scratch.summed(7, 2) if 0.0 < scratch.sums[2] < _INFINITE else None
        size = self.find_hull(scratch.mask, scratch)
        polygon = scratch.hull(size)
        if size == 0:
            self.give_back(scratch)
            return mask, wrench, contact, cop, polygon, 0.0, None, memory.new_matrix(0, 2), None
        area, middle_x, middle_y = scratch.measure_hull(size)
        if offset <= 0.0:
            safe = scratch.hull(size)
            _margin, near_x, near_y = convex._nearest_of_any(scratch.polygon[:size], x, y)
        else:
            left = convex.offset(scratch.polygon[:size], offset, scratch.offset)
            safe = scratch.offset.copied(left)
            _margin, near_x, near_y = convex._nearest_of_any(scratch.offset.result[:left], x, y)
        self.give_back(scratch)
        centroid = vectors.vector2(middle_x, middle_y)
        nearest = vectors.vector2(near_x, near_y)
        return mask, wrench, contact, cop, polygon, area, centroid, safe, nearest

    def find_hull(self, active, scratch):
        """Find the `active` cells' hull in the scratch's `polygon`; returns its size."""
        left = self.levels
        right = -1
        for row in range(self.row_start.shape[0] - 1):
            first = self.row_start[row]
            last = self.row_start[row + 1] - 1
            while first <= last and not active[self.row_taxel[first]]:
                first += 1
            if first > last:
                continue
            while not active[self.row_taxel[last]]:
                last -= 1
            for end in range(2 if last > first else 1):
                i = self.row_taxel[last if end else first]
                from_corner = self.last_begin[i] if end else self.corner_start[i]
                to_corner = self.corner_start[i + 1] if end or last == first else self.first_end[i]
                for c in range(from_corner, to_corner):
                    v = self.corner_rank[c]
                    kind = self.corner_sign[c]
                    at = self.corner_level[c]
                    if not kind & _NOT_LOWER:
                        scratch.lowest[at] = min(scratch.lowest[at], v)
                    if not kind & _NOT_UPPER:
                        scratch.highest[at] = max(scratch.highest[at], v)
                    left = min(left, at)
                    right = max(right, at)
        if right < 0:
            return 0
        # The lower chain takes the lowest corner at each x, the upper one the highest; where a chain turns, both.
        scratch.way[0] = scratch.lowest[left]
        forth = 1
        for at in range(left + 1, right + 1):
            if scratch.lowest[at] < self.corners:
                scratch.way[forth] = scratch.lowest[at]
                forth += 1
                scratch.lowest[at] = self.corners
        scratch.lowest[left] = self.corners
        count = forth
        scratch.way[count] = scratch.highest[right]  # where it is the lowest too, the walk steps over it
        count += 1
        forth += 1
        scratch.highest[right] = -1
        for at in range(right - 1, left, -1):
            if scratch.highest[at] >= 0:
                scratch.way[count] = scratch.highest[at]
                count += 1
                scratch.highest[at] = -1
        if left < right:
            scratch.way[count] = scratch.highest[left]
            count += 1
            scratch.highest[left] = -1
        scratch.way[count] = scratch.way[0]
        count += 1
        size = hull.hull_ring(self.points, scratch.way, forth, count, self.tolerance, scratch.ring)
        for i in range(size):
            v = scratch.ring[i]
            scratch.polygon[i, 0] = self.points[v, 0]
            scratch.polygon[i, 1] = self.points[v, 1]
        return size


def _count(values):
    return "no" if values is None else values.shape[0]


def _signs(cell, rank):
    """Bits (k,) of where each corner can be on a hull that holds the cell, by its ranks (k,) by x, then y."""
    low = cell[np.argmin(rank)]
    high = cell[np.argmax(rank)]
    along = high - low
    away = cell - low
    above = along[0] * away[:, 1] - along[1] * away[:, 0]
    # nature: floating point, far above roundings of a cell's size and far below a taxel
    sure = 1e-9 * float((along * along).sum())
    return np.where(above > sure, _NOT_LOWER, np.where(above < -sure, _NOT_UPPER, 0))
