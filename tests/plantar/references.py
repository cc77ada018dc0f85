"""Independent slow references: exact integers and fractions where rational, else nested searches."""

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import combinations, pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[int, int]
Number = TypeVar("Number", int, Fraction)
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


def integers(points: Array) -> tuple[list[Point], int]:
    """Points (n, 2) in m as exact integers: times a returned power of 2.

    Example:
        >>> integers(np.array([[0.5, 3.0]]))
        ([(1, 6)], 2)
    """
    ratios = [float(v).as_integer_ratio() for v in np.asarray(points).reshape(-1)]
    scale = max((d for _, d in ratios), default=1)
    flat = [n * (scale // d) for n, d in ratios]
    return list(zip(flat[::2], flat[1::2], strict=True)), scale


def turn(a: tuple[Number, Number], b: tuple[Number, Number], c: tuple[Number, Number]) -> Number:
    """Returns a triangle's `a`, `b`, `c` exact doubled area; positive counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def exact_hull(points: Iterable[tuple[Number, Number]]) -> list[tuple[Number, Number]]:
    """Hull corners of exact points (x, y), counter-clockwise from the leftmost.

    Example:
        >>> exact_hull([(0, 0), (2, 0), (1, 0), (0, 2), (1, 1)])
        [(0, 0), (2, 0), (0, 2)]
    """
    ordered = sorted(set(points))
    ring: list[tuple[Number, Number]] = []
    for sequence in (ordered, ordered[::-1]):
        chain: list[tuple[Number, Number]] = []
        for p in sequence:
            while len(chain) > 1 and turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        ring += chain[:-1]
    return ring


def _twice(ring: Sequence[Point]) -> int:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*ring, ring[0]]))


def hull_area_exact(points: Array) -> float:
    """Hull area in m^2 of points (n, 2): monotone chain in integers.

    Example:
        >>> hull_area_exact(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.25, 0.25]]))
        0.5
    """
    whole, scale = integers(points)
    ring = exact_hull(whole)
    return float(Fraction(_twice(ring), 2 * scale * scale)) if len(ring) > 2 else 0.0


def area_exact(rings: Sequence[Array]) -> float:
    """Sum in m^2 of signed ring (k, 2) areas, in integers."""
    total = Fraction(0)
    for ring in rings:
        whole, scale = integers(ring)
        total += Fraction(_twice(whole), 2 * scale * scale)
    return float(total)


def centroid_exact(polygon: Array) -> Array:
    """Centroid (2,) in m of a simple polygon (k, 2), in fractions."""
    whole, scale = integers(polygon)
    twice = 0
    x = 0
    y = 0
    for (ax, ay), (bx, by) in pairwise([*whole, whole[0]]):
        cross = ax * by - bx * ay
        twice += cross
        x += (ax + bx) * cross
        y += (ay + by) * cross
    return np.array([float(Fraction(x, 3 * twice * scale)), float(Fraction(y, 3 * twice * scale))])


def closest_point_exact(polygon: Array, point: Array) -> Array:
    """Returns the point (2,) in m of a convex counter-clockwise `polygon` (k, 2) closest to `point` (2,)."""
    ring = [(Fraction(float(x)), Fraction(float(y))) for x, y in polygon]
    px, py = (Fraction(float(v)) for v in point)
    found = []
    outside = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1], strict=True):
        lx = bx - ax
        ly = by - ay
        outside |= (px - ax) * ly - (py - ay) * lx > 0
        t = max(Fraction(0), min(Fraction(1), ((px - ax) * lx + (py - ay) * ly) / (lx * lx + ly * ly)))
        qx = ax + t * lx
        qy = ay + t * ly
        found.append(((px - qx) ** 2 + (py - qy) ** 2, qx, qy))
    _, x, y = min(found)
    return np.array([float(x), float(y)]) if outside else np.asarray(point, dtype=float)


def inner_offset_area(polygon: Array, distance: float) -> float:
    """Returns the area in m^2 a `distance` in m inside a convex counter-clockwise `polygon` (k, 2).

    Half planes are cut in fractions rounded to 2^-200; lengths by integer square roots.
    """
    unit = 1 << 200
    ring = [(Fraction(float(x)), Fraction(float(y))) for x, y in polygon]
    left = ring
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1], strict=True):
        lx = bx - ax
        ly = by - ay
        squared = lx * lx + ly * ly
        length = Fraction(math.isqrt(squared.numerator * unit * unit // squared.denominator), unit)
        level = Fraction(distance) * length
        depth = [lx * (y - ay) - ly * (x - ax) - level for x, y in left]
        kept: list[tuple[Fraction, Fraction]] = []
        for i, (x, y) in enumerate(left):
            u, v = left[i - 1]
            if (depth[i] >= 0) != (depth[i - 1] >= 0):
                t = depth[i - 1] / (depth[i - 1] - depth[i])
                kept.append((_rounded(u + t * (x - u), unit), _rounded(v + t * (y - v), unit)))
            if depth[i] >= 0:
                kept.append((x, y))
        left = kept
    if len(left) < 3:
        return 0.0
    return float(sum((a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*left, left[0]])), Fraction(0)) / 2)


def _rounded(value: Fraction, unit: int) -> Fraction:
    return Fraction(value.numerator * unit // value.denominator, unit)


def triangle_area_exact(polygon: Array) -> float:
    """Largest vertex triangle's area in m^2 of a polygon (k, 2), in integers."""
    whole, scale = integers(polygon)
    most = max((abs(turn(a, b, c)) for a, b, c in combinations(whole, 3)), default=0)
    return float(Fraction(most, 2 * scale * scale))


def least_box_area(polygon: Array) -> float:
    """Least surrounding rectangle's area in m^2 of a convex polygon (k, 2)."""
    whole, scale = integers(polygon)
    areas = []
    for (ax, ay), (bx, by) in zip(whole, whole[1:] + whole[:1], strict=True):
        lx = bx - ax
        ly = by - ay
        along = [x * lx + y * ly for x, y in whole]
        across = [y * lx - x * ly for x, y in whole]
        areas.append(Fraction((max(along) - min(along)) * (max(across) - min(across)), lx * lx + ly * ly))
    return float(min(areas) / (scale * scale))


def least_parallelogram_area(polygon: Array) -> float:
    """Least surrounding parallelogram's area in m^2 of a convex polygon (k, 2)."""
    whole, scale = integers(polygon)
    edges = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(whole, whole[1:] + whole[:1], strict=True)]
    across = [[y * lx - x * ly for x, y in whole] for lx, ly in edges]
    widths = [max(places) - min(places) for places in across]
    areas = [
        Fraction(widths[i] * widths[j], abs(turn))
        for i, j in combinations(range(len(edges)), 2)
        if (turn := edges[i][0] * edges[j][1] - edges[i][1] * edges[j][0])
    ]
    return float(min(areas) / (scale * scale))


def circle_radius(polygon: Array) -> float:
    """Largest circle's radius in m in a convex counter-clockwise polygon (k, 2)."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    level = (normal * (polygon - polygon[0])).sum(axis=1)
    best = 0.0
    for rows in map(list, combinations(range(len(polygon)), 3)):
        matrix = np.column_stack([normal[rows], -np.ones(3)])
        if abs(float(np.linalg.det(matrix))) < 1e-9:
            continue
        x, y, radius = np.linalg.solve(matrix, level[rows]).tolist()
        depth = normal @ [x, y] - level
        if radius > best and float(depth.min()) >= radius * (1.0 - 1e-12) - 1e-15:
            best = radius
    return best


def _golden(gain: Callable[[Array], Array], low: Array, high: Array, steps: int = 60) -> Array:
    """Maxima of many concave functions, each between its bounds (m,), by golden section."""
    best: Array = np.full_like(low, -np.inf)
    for _ in range(steps + 1):
        c = high - _GOLDEN * (high - low)
        d = low + _GOLDEN * (high - low)
        at_c = gain(c)
        at_d = gain(d)
        best = np.maximum(best, np.maximum(at_c, at_d))
        left = at_c > at_d
        low = np.where(left, low, c)
        high = np.where(left, d, high)
    return best


def _chains(polygon: Array, angles: Array) -> tuple[Array, Array, Array, Array]:
    """Slopes and levels (m, k) of upper and lower edges, turned back by angles (m,)."""
    c = np.cos(angles)[:, None]
    s = np.sin(angles)[:, None]
    x, y = (polygon - polygon.mean(axis=0)).T
    px = c * x + s * y
    py = c * y - s * x
    dx = np.roll(px, -1, axis=1) - px
    dy = np.roll(py, -1, axis=1) - py
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = dy / dx
        level = py - slope * px
    upright = np.abs(dx) < 1e-13 * float(np.ptp(polygon))
    upper = np.where((dx < 0.0) & ~upright, level, np.inf)
    lower = np.where((dx > 0.0) & ~upright, level, -np.inf)
    slope = np.where(upright, 0.0, slope)
    return slope, upper, lower, px


def _rectangles(polygon: Array, angles: Array) -> Array:
    """Area (m,) of the largest rectangle in a convex polygon at each angle (m,)."""
    slope, upper, lower, px = _chains(polygon, angles)
    left = px.min(axis=1)
    right = px.max(axis=1)

    def height(x: Array, width: Array) -> Array:
        ends = (x[:, None], (x + width)[:, None])
        top = np.minimum(*((slope * e + upper).min(axis=1) for e in ends))
        bottom = np.maximum(*((slope * e + lower).max(axis=1) for e in ends))
        return np.asarray(top - bottom)

    def area(width: Array) -> Array:
        return width * _golden(lambda x: height(x, width), left, right - width)

    return _golden(area, np.zeros_like(left), right - left)


def rectangle_area(polygon: Array, angle: float = 0.0) -> float:
    """Returns the largest rectangle's area in m^2 at an `angle` in rad in a convex counter-clockwise `polygon` (k, 2)
    in m.

    Example:
        >>> round(rectangle_area(np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])), 9)
        3.0
    """
    return float(_rectangles(polygon, np.array([angle]))[0])


def search_period(values: Callable[[Array], Array], period: float, samples: int, finest: float = 1e-10) -> float:
    """Returns the largest of `values`, a function of angles (m,) in rad, over a `period` in rad: `samples` angles,
    then finer around the best down to a step `finest` in rad.

    Example:
        >>> round(search_period(lambda angles: np.cos(angles - 1.0), 2.0 * math.pi, 12), 12)
        1.0
    """
    step = period / samples
    angles: Array = np.arange(samples) * np.float64(step)
    found = values(angles)
    centres = np.asarray(angles[np.argsort(found)[-4:]], dtype=float)
    best = float(found.max())
    while step > finest:
        step *= 0.25
        tried = np.unique((centres[:, None] + step * np.arange(-4, 5)).reshape(-1))
        found = values(tried)
        best = max(best, float(found.max()))
        centres = tried[np.argsort(found)[-4:]]
    return best


def rectangle_area_any_angle(polygon: Array, samples: int = 120) -> float:
    """Returns the largest rectangle's area in m^2 at any angle in a convex counter-clockwise `polygon` (k, 2) in m.

    It tries `samples` of a quarter turn, then finer around the best four.
    """
    return search_period(lambda angles: _rectangles(polygon, angles), 0.5 * math.pi, samples)


def parallelogram_area(polygon: Array, samples: int = 240, finest: float = 1e-13) -> float:
    """Returns the best parallelogram's area in m^2 in a convex counter-clockwise `polygon` (k, 2) in m.

    For two sides of a length in one direction: that length times the distance of the farthest chords that have it;
    length by golden section, direction over `samples` of half a turn down to a step `finest` in rad.
    """
    size = len(polygon)

    def best(angles: Array) -> Array:
        slope, upper, lower, px = _chains(polygon, angles)
        place = np.sort(px, axis=1)  # between them the chord's length is linear
        length: Array = np.array(
            [
                (slope * place[:, k : k + 1] + upper).min(axis=1) - (slope * place[:, k : k + 1] + lower).max(axis=1)
                for k in range(size)
            ]
        ).T

        def area(chord: Array) -> Array:
            inside = length >= chord[:, None]
            first = np.argmax(inside, axis=1)
            last = size - 1 - np.argmax(inside[:, ::-1], axis=1)
            rows = np.arange(len(chord))
            ends = []
            for at, beside in ((first, np.maximum(first - 1, 0)), (last, np.minimum(last + 1, size - 1))):
                near = length[rows, at]
                far = length[rows, beside]
                gap = near - far
                share = np.where(gap > 0.0, (near - chord) / np.where(gap > 0.0, gap, 1.0), 0.0)
                ends.append(place[rows, at] + np.minimum(share, 1.0) * (place[rows, beside] - place[rows, at]))
            return np.where(inside.any(axis=1), chord * (ends[1] - ends[0]), 0.0)

        return _golden(area, np.zeros(len(angles)), length.max(axis=1))

    return search_period(best, math.pi, samples, finest)


def outline_rectangle_area(rings: Sequence[Array]) -> float:
    """Best axis-aligned rectangle's area in m^2 within rims (k, 2) in m of islands and holes.

    Between two abscissae edges block intervals of y, and the highest rectangle fills the largest gap. Pairs at and
    between the vertices are tried, then finer around the best.
    """
    tail = np.concatenate(rings)
    head = np.concatenate([np.roll(r, -1, axis=0) for r in rings])
    turn = tail[:, 0] > head[:, 0]
    left = np.where(turn[:, None], head, tail)
    right = np.where(turn[:, None], tail, head)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (right[:, 1] - left[:, 1]) / (right[:, 0] - left[:, 0])
    rise = np.where(left[:, 0] < right[:, 0], slope, 0.0)

    def areas(x0: Array, x1: Array) -> Array:
        low = np.maximum(left[:, 0], x0[:, None])
        high = np.minimum(right[:, 0], x1[:, None])
        upright = (low == high) & (x0[:, None] < low) & (high < x1[:, None])
        crossing = (low < high) | upright
        ends = [np.where(crossing, left[:, 1] + rise * (x - left[:, 0]), np.inf) for x in (low, high)]
        ends[1] = np.where(upright, right[:, 1], ends[1])
        bottom = np.minimum(*ends)
        top = np.maximum(*ends)
        order = np.argsort(bottom, axis=1)
        bottom = np.take_along_axis(bottom, order, axis=1)
        reach = np.where(np.isfinite(bottom), np.take_along_axis(top, order, axis=1), -np.inf)
        reach = np.maximum.accumulate(reach, axis=1)
        gap = bottom[:, 1:] - reach[:, :-1]
        # A gap is inside where an odd number of edges passes below it, halfway between the abscissae.
        middle = 0.5 * (x0 + x1)[:, None]
        passes = np.take_along_axis((left[:, 0] <= middle) & (middle < right[:, 0]), order, axis=1)
        inside = np.cumsum(passes, axis=1)[:, :-1] % 2 == 1
        height = np.where(inside & np.isfinite(gap), gap, 0.0).max(axis=1, initial=0.0)
        return np.asarray((x1 - x0) * np.maximum(height, 0.0))

    xs = np.unique(np.round(tail[:, 0], 12))
    xs = np.unique(np.concatenate([xs, 0.5 * (xs[1:] + xs[:-1])]))
    if len(xs) > 160:
        xs = xs[:: len(xs) // 160 + 1]
    i, j = np.triu_indices(len(xs), 1)
    found = np.concatenate([areas(xs[a], xs[b]) for a, b in zip(*(np.array_split(k, 40) for k in (i, j)), strict=True)])
    best = np.argsort(found)[-8:]
    step = float(np.ptp(xs)) / len(xs)
    grid = np.array([(p, q) for p in np.linspace(-1.0, 1.0, 9) for q in np.linspace(-1.0, 1.0, 9)])
    most = 0.0
    for k in best.tolist():
        at = np.array([xs[i[k]], xs[j[k]]])
        value = float(found[k])
        reach = step
        for _ in range(400):
            if reach < 1e-16:
                break
            tried = at + reach * grid
            values = areas(tried[:, 0], tried[:, 1])
            index = int(values.argmax())
            if values[index] > value * (1.0 + 1e-15):
                at = tried[index]
                value = float(values[index])
            else:
                reach *= 0.3
        most = max(most, value)
    return most


def wrench_exact(columns: Array, force: Array) -> Array:
    """Returns the wrench (6,) of `force` (n,) in N by unit wrenches `columns` (n, 6), rounded once."""
    loads = [Fraction(float(f)) for f in force]
    sums = [
        sum((Fraction(float(c)) * f for c, f in zip(column, loads, strict=True)), Fraction(0)) for column in columns.T
    ]
    return np.array([float(s) for s in sums])
