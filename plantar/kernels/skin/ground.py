"""Ground's plane under a sole: least squares, or least median of squares if taxels disagree."""

import math

import numpy as np

try:
    import cython
except ImportError:
    from plantar.kernels.base import without_cython as cython

__all__ = ["GroundFit", "GroundScratch"]

_NONE = float("nan")
_INFINITE = float("inf")
# derived: triples of taxels that a robust fit tries: with 40 % outliers all but one fit in 10^8 holds a clean one; 1 -
# (1 - 0.6^3)^80 = 1 - 3.5e-9
_DRAWS = 80


class GroundScratch:
    """Work arrays of one reading's fit, n taxels."""

    def __init__(self, n):
        self.points = np.zeros((n, 3))
        self.taxel = np.zeros(n, dtype=np.intp)
        self.kept = np.zeros(n, dtype=np.uint8)
        self.miss = np.zeros(n)
        self.plane = np.zeros(3)
        self.triples = np.zeros((3, 0), dtype=np.intp)  # of the number of points below
        self.triples_of = -1


class GroundFit:
    """Fits planes to one sole's ground distances.

    `positions`: taxel centers (n, 3) in sole frame in m; `normals`: z axes (n, 3) of taxels in sole frame.
    """

    def __init__(self, positions, normals):
        self.positions = np.ascontiguousarray(positions, dtype=np.float64)
        self.normals = np.ascontiguousarray(normals, dtype=np.float64)
        n = len(self.positions)
        self.taxels = n
        self.triples = {}
        self.free = []

    def frames(self, distance, reach, tolerance, out, directions, inliers):
        """Fit a plane to each reading, without the interpreter lock.

        `distance`: distances (frames, n) in m; `reach`: distance in m, of either sign, out of range from there;
        `tolerance`: distance in m from plane that noise explains; `out`: receives height in m, slopes along x and y,
        and RMS residual in m (frames, 4): NaN without ground; `directions`: receives number of determined slopes
        (frames,); -1 without ground; `inliers`: receives used taxels (frames, n); of zeros.
        """
        scratch = self._borrow()
        with cython.nogil:
            self._fit_each(distance, reach, tolerance, out, directions, inliers, scratch)
        self.free.append(scratch)

    def _fit_each(self, distance, reach, tolerance, out, directions, inliers, scratch):
        for k in range(distance.shape[0]):
            directions[k] = self._fit(distance[k], reach, tolerance, out[k], inliers[k], scratch)
        return 0

    def fit(self, distance, reach, tolerance, out, inliers):
        """Fit a plane to one reading, as `frames`; returns the directions."""
        scratch = self._borrow()
        directions = self._fit(distance, reach, tolerance, out, inliers, scratch)
        self.free.append(scratch)
        return directions

    def _borrow(self):
        """Work arrays, owned until given back; dropped by a failed call."""
        try:
            return self.free.pop()
        except IndexError:
            return GroundScratch(self.taxels)

    def _fit(self, distance, reach, tolerance, out, inliers, scratch):
        seen = 0
        for i in range(self.taxels):
            d = distance[i]
            if abs(d) < reach:
                scratch.points[seen, 0] = self.positions[i, 0] - d * self.normals[i, 0]
                scratch.points[seen, 1] = self.positions[i, 1] - d * self.normals[i, 1]
                scratch.points[seen, 2] = self.positions[i, 2] - d * self.normals[i, 2]
                scratch.taxel[seen] = i
                scratch.kept[seen] = 1
                seen += 1
        if seen == 0:
            out[0] = _NONE
            out[1] = _NONE
            out[2] = _NONE
            out[3] = _NONE
            return -1
        directions = _least_squares(seen, scratch)
        worst = _misses(seen, scratch)
        if seen > 3 and worst > tolerance:
            if self._agree(seen, tolerance, scratch):
                directions = _least_squares(seen, scratch)
            _misses(seen, scratch)
        total = 0.0
        used = 0
        for i in range(seen):
            if scratch.kept[i]:
                total += scratch.miss[i] * scratch.miss[i]
                used += 1
                inliers[scratch.taxel[i]] = 1
        out[0] = -scratch.plane[0]
        out[1] = scratch.plane[1]
        out[2] = scratch.plane[2]
        out[3] = math.sqrt(total / used)
        return directions

    def _agree(self, seen, tolerance, scratch):
        """Keep points that agree with the least-median-of-squares plane through three; whether there is one."""
        if scratch.triples_of != seen:
            with cython.gil:
                self._find_triples(seen, scratch)
        table = scratch.triples
        points = scratch.points
        miss = scratch.miss
        half = (seen + 3) // 2 - 1  # the median of Rousseeuw: with three parameters, breakdown of one half
        best = _INFINITE
        best_z = 0.0
        best_x = 0.0
        best_y = 0.0
        for k in range(table.shape[1]):
            a = table[0, k]
            b = table[1, k]
            c = table[2, k]
            ux = points[b, 0] - points[a, 0]
            uy = points[b, 1] - points[a, 1]
            uz = points[b, 2] - points[a, 2]
            vx = points[c, 0] - points[a, 0]
            vy = points[c, 1] - points[a, 1]
            vz = points[c, 2] - points[a, 2]
            nx = uy * vz - uz * vy
            ny = uz * vx - ux * vz
            nz = ux * vy - uy * vx
            # Neither flat triangles nor planes steeper than 60 degrees or so, which no foot steps on.
            size = ux * ux + uy * uy + vx * vx + vy * vy
            # derived: 1 / tan(60 degrees)^2 = 1/3, rounded down: steeper planes are no ground; 1e-6 rounding of single
            # precision
            if not (nz * nz > 0.25 * (nx * nx + ny * ny) and abs(nz) > 1e-6 * size):
                continue
            rise_x = -nx / nz
            rise_y = -ny / nz
            level = points[a, 2] - rise_x * points[a, 0] - rise_y * points[a, 1]
            below = 0
            for i in range(seen):
                miss[i] = abs(points[i, 2] - level - rise_x * points[i, 0] - rise_y * points[i, 1])
                if miss[i] < best:
                    below += 1
            if below > half:
                best = _ranked(seen, half, scratch)
                best_z = level
                best_x = rise_x
                best_y = rise_y
        if best == _INFINITE:
            return False
        scratch.plane[0] = best_z
        scratch.plane[1] = best_x
        scratch.plane[2] = best_y
        _misses(seen, scratch)
        # nature: Rousseeuw and Leroy 1987, Robust Regression: 2.5 sigma, 1.4826 (1 + 5 / (n - p)) median of the misses
        limit = max(tolerance, 2.5 * 1.4826 * (1.0 + 5.0 / max(seen - 3, 1)) * best)
        for i in range(seen):
            scratch.kept[i] = scratch.miss[i] <= limit
        return True

    def _find_triples(self, seen, scratch):
        triples = self.triples.get(seen)
        if triples is None:
            triples = _triples(seen)
            self.triples[seen] = triples
        scratch.triples = triples
        scratch.triples_of = seen
        return 0


def _misses(seen, scratch):
    """Distance along z of every point from the plane; returns the kept ones' largest."""
    worst = 0.0
    for i in range(seen):
        scratch.miss[i] = abs(
            scratch.points[i, 2]
            - scratch.plane[0]
            - scratch.plane[1] * scratch.points[i, 0]
            - scratch.plane[2] * scratch.points[i, 1]
        )
        if scratch.kept[i]:
            worst = max(worst, scratch.miss[i])
    return worst


def _least_squares(seen, scratch):
    """Plane through the kept points, the flattest if not determined; its directions."""
    x = 0.0
    y = 0.0
    z = 0.0
    count = 0
    for i in range(seen):
        if scratch.kept[i]:
            x += scratch.points[i, 0]
            y += scratch.points[i, 1]
            z += scratch.points[i, 2]
            count += 1
    x = x / count
    y = y / count
    z = z / count
    xx = 0.0
    xy = 0.0
    yy = 0.0
    xz = 0.0
    yz = 0.0
    for i in range(seen):
        if scratch.kept[i]:
            dx = scratch.points[i, 0] - x
            dy = scratch.points[i, 1] - y
            dz = scratch.points[i, 2] - z
            xx += dx * dx
            xy += dx * dy
            yy += dy * dy
            xz += dx * dz
            yz += dy * dz
    # Eigenvalues of the 2 x 2 scatter; a direction with less than 1e-9 of the extent's square is rounding.
    middle = 0.5 * (xx + yy)
    half = 0.5 * (xx - yy)
    spread = math.sqrt(half * half + xy * xy)
    large = middle + spread
    small = middle - spread
    rise_x = 0.0
    rise_y = 0.0
    directions = 0
    if large > 1e-18 * count:  # nature: else one place: 1 nm
        if small <= 1e-9 * large:  # nature: floating point, the root of a rounding, of a ratio of variances
            angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
            c = math.cos(angle)
            s = math.sin(angle)
            rise = (c * xz + s * yz) / large
            rise_x = c * rise
            rise_y = s * rise
            directions = 1
        else:
            determinant = xx * yy - xy * xy
            rise_x = (yy * xz - xy * yz) / determinant
            rise_y = (xx * yz - xy * xz) / determinant
            directions = 2
    scratch.plane[0] = z - rise_x * x - rise_y * y
    scratch.plane[1] = rise_x
    scratch.plane[2] = rise_y
    return directions


def _ranked(seen, rank, scratch):
    """Value of `miss` with so many below it; reorders (Hoare's selection)."""
    miss = scratch.miss
    low = 0
    high = seen - 1
    while low < high:
        pivot = miss[(low + high) // 2]
        i = low
        j = high
        while i <= j:
            while miss[i] < pivot:
                i += 1
            while miss[j] > pivot:
                j -= 1
            if i <= j:
                miss[i], miss[j] = miss[j], miss[i]
                i += 1
                j -= 1
        if rank <= j:
            high = j
        elif rank >= i:
            low = i
        else:
            break
    return miss[rank]


def _triples(n):
    """Index triples (3, m) of n points: all of few, else fixed random ones."""
    if n * (n - 1) * (n - 2) <= 6 * _DRAWS:
        a, b, c = np.meshgrid(*[np.arange(n)] * 3, indexing="ij")
        ordered = (a < b) & (b < c)
        return np.stack([a[ordered], b[ordered], c[ordered]]).astype(np.intp)
    rng = np.random.default_rng(0)
    draws = [rng.choice(n, 3, replace=False) for _ in range(_DRAWS)]
    return np.ascontiguousarray(np.array(draws).T, dtype=np.intp)
