"""Convex rings as rounding makes them: near-duplicates, spikes back along an edge, points on edges, far away or tiny.

What each of them stands for is known exactly: the hull of its vertices in fractions, in a frame of its own size.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.polygon import convex_hull
from plantar.layouts.hex_lattice import HexLattice

from ..references import exact_hull, turn

Array = NDArray[np.float64]
Corner = tuple[Fraction, Fraction]
_RESOLVED = Fraction(1, 10**11)


@dataclass(frozen=True, eq=False)
class ExactRing:
    """What a ring stands for: the convex hull of its vertices, in fractions.

    Attributes:
        polygon: Corners (k, 2) of the hull, counter-clockwise, in units of its size about its lower left; left out are
            those within 1e-11 of another one, or of the line of their neighbours.
        origin: The lower left corner of its box in m.
        size: Larger side of its box in m.
    """

    polygon: Array
    origin: Corner
    size: Fraction

    @classmethod
    def of(cls, ring: Array) -> "ExactRing":
        """The exact ring of vertices (k, 2) in m, not all at one place."""
        hull = exact_hull([(Fraction(float(x)), Fraction(float(y))) for x, y in ring])
        low = min(x for x, _ in hull), min(y for _, y in hull)
        size = max(max(x for x, _ in hull) - low[0], max(y for _, y in hull) - low[1])
        left = [((x - low[0]) / size, (y - low[1]) / size) for x, y in hull]
        i = 0
        while i < len(left) > 2:
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            height = turn(a, b, c) / max(abs(c[0] - a[0]), abs(c[1] - a[1]))
            if max(abs(b[0] - a[0]), abs(b[1] - a[1])) < _RESOLVED or height < _RESOLVED:
                left.pop(i)
                i = 0
            else:
                i += 1
        return cls(np.array([[float(x), float(y)] for x, y in left]), low, size)

    @property
    def step(self) -> float:
        """What one unit in the last place of the largest coordinate is, in units of the size."""
        return float(np.spacing(float(max(abs(self.origin[0]), abs(self.origin[1])) + self.size))) / float(self.size)

    def local(self, points: Array) -> Array:
        """Points (n, 2) in m in units of the size about the origin, rounded once."""
        where = [
            [float((Fraction(float(v)) - low) / self.size) for v, low in zip(p, self.origin, strict=True)]
            for p in np.asarray(points).reshape(-1, 2)
        ]
        return np.array(where).reshape(-1, 2)

    def place(self, point: Array) -> Array:
        """A local point (2,) in m, rounded."""
        x, y = (low + Fraction(float(v)) * self.size for v, low in zip(point, self.origin, strict=True))
        return np.array([float(x), float(y)])

    def depth(self, points: Array) -> Array:
        """Least distance (n,) of local points (n, 2) to the lines of the edges, negative outside."""
        edge = np.roll(self.polygon, -1, axis=0) - self.polygon
        normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
        away: Array = points[:, None] - self.polygon
        return np.asarray((away * normal).sum(axis=2).min(axis=1))


def chamfered_rectangle(rng: np.random.Generator) -> Array:
    """A rectangle (8, 2) in m with its corners cut off, by as little as 1e-17 of its sides."""
    w, h = rng.uniform(0.05, 1.0, 2).tolist()
    cut = min(w, h) * 10.0 ** rng.uniform(-17.0, -0.4)
    x, y = rng.permutation([cut, cut * float(rng.choice([1.0, 0.3, 1e-3]))]).tolist()
    return np.array([[x, 0], [w - x, 0], [w, y], [w, h - y], [w - x, h], [x, h], [0, h - y], [0, y]])


def convex_ring(rng: np.random.Generator) -> Array:
    """A turned convex polygon (k, 2) in m: a hull, part of an ellipse, cells, a rectangle, a sliver, a regular one."""
    kind = int(rng.integers(8))
    if kind == 0:
        ring = convex_hull(rng.normal(0.0, 0.1, (int(rng.integers(3, 14)), 2)) * [1.0, rng.uniform(0.05, 1.0)])
    elif kind == 1:
        t = np.sort(rng.uniform(0.0, 2.0 * math.pi, int(rng.integers(3, 24))))
        ring = convex_hull(np.column_stack([0.12 * np.cos(t), 0.06 * np.sin(t)]))
    elif kind == 2:
        lattice = HexLattice(691e-6, (0.0, 0.0), [0.0, 0.5, math.pi / 6][rng.integers(3)])
        ring = convex_hull(lattice.corners(rng.integers(-3, 4, (int(rng.integers(1, 12)), 2))).reshape(-1, 2))
    elif kind == 3:
        w, h = rng.uniform(0.05, 1.0, 2).tolist()
        ring = np.array([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]])
    elif kind < 6:
        ring = chamfered_rectangle(rng)
    elif kind == 6:
        h = 10.0 ** rng.uniform(-7.0, -1.0)
        ring = np.array([[0.0, 0.0], [1.0, 0.0], [rng.uniform(0.3, 1.0), h], [0.0, h * rng.uniform(0.1, 1.0)]])
    else:
        t = 2.0 * math.pi * np.arange(k := int(rng.integers(3, 9))) / k
        ring = np.column_stack([np.cos(t), np.sin(t)])
    c, s = (1.0, 0.0) if rng.random() < 0.5 else (math.cos(a := rng.uniform(0.0, 6.3)), math.sin(a))
    return np.asarray(ring @ np.array([[c, s], [-s, c]]))


def dirty_ring(rng: np.random.Generator) -> Array:
    """A convex polygon (k, 2) in m whose vertices rounding has spoilt.

    Some of them come twice or more often, up to 3 units in the last place apart, with points on the edges beside them,
    or with spikes back along the edges; from any of them on, either way round; 1e-6 to 1e3 times as large and up to
    1e6 m away, but at least 1e6 units in the last place wide.
    """
    ring = convex_ring(rng) * 10.0 ** int(rng.choice([0, 0, 0, -1, -6, 3]))
    away = float(rng.choice([0.0, 0.0, 0.0, 0.0, 1.0, 1e3, 1e6]))
    if np.ptp(ring, axis=0).max() > 1e6 * np.spacing(away):
        ring = ring + away * rng.normal(size=2)
    spoilt = rng.random(len(ring)) < rng.choice([0.2, 0.5, 1.0])
    spoilt[rng.integers(len(ring))] = True
    found: list[Array] = []
    for i, p in enumerate(ring):
        back, on = ring[i - 1] - p, ring[(i + 1) % len(ring)] - p
        kind = int(rng.integers(7)) if spoilt[i] else -1
        if kind == 1:
            found += [p, _off(p, rng)]
        elif kind == 2:
            found += [_off(p, rng), p, _off(p, rng)]
        elif kind == 3:
            found += [p, p + on * 10.0 ** rng.uniform(-17.0, -0.5)]
        elif kind == 4:
            found += [p, _off(p + back * 10.0 ** rng.uniform(-17.0, -12.0), rng)]
        elif kind == 5:
            found += [p, _off(p + on * rng.uniform(0.05, 0.95), rng)]
        elif kind == 6:
            found += [_off(p, rng) for _ in range(int(rng.integers(2, 6)))]
        else:
            found += [p, p] if kind == 0 else [p]
    turned = np.roll(np.array(found), int(rng.integers(len(found))), axis=0)
    return turned[::-1] if rng.random() < 0.3 else turned


def _off(point: Array, rng: np.random.Generator) -> Array:
    """A point with each coordinate up to 3 units in the last place off."""
    moved = point.copy()
    for axis in range(2):
        steps = int(rng.integers(-3, 4))
        for _ in range(abs(steps)):
            moved[axis] = np.nextafter(moved[axis], math.copysign(math.inf, steps))
    return moved


def vanishing_depths(ring: Array) -> Array:
    """Depths in m at which edges of a convex polygon vanish while all of them move inwards, the least first."""
    local = convex_hull(ring) - ring[0]
    edge = np.roll(local, -1, axis=0) - local
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    level = (normal * local).sum(axis=1)
    found = []
    for i in range(len(local)):
        rows = [i - 1, i, (i + 1) % len(local)]
        matrix = np.column_stack([normal[rows], -np.ones(3)])
        if abs(float(np.linalg.det(matrix))) > 1e-9:
            depth = float(np.linalg.solve(matrix, level[rows])[2])
            found += [depth] if depth > 0.0 else []
    return np.sort(np.array(found))
