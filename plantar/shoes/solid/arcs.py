"""Runs of narrow facets replaced by cylinders and cones. In mm."""

import itertools
import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.shoes.solid.polyhedron import Loops, Polyhedron

_BULGE = 0.25  # how far an arc may lie off a facet's middle, in mm

_OFF = 0.05  # mm: how far a corner may lie off its arc
# at a corner that may vanish, and of an arc
_TURN = math.radians(20.0)
_WHOLE = math.radians(150.0)
_FEWEST = 2  # facets of an arc
_LEVEL = 1e-6  # mm

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Arc:
    """Level arc between two corners: centre (2,), radius, midpoint (3,)."""

    centre: tuple[float, float]
    radius: float
    middle: tuple[float, float, float]


@dataclass(frozen=True)
class CurvedSolid:
    """Solid with arcs.

    `body`: corners and loops; curved faces have four corners; `arcs` by their two corners, smaller number first.
    """

    body: Polyhedron
    arcs: dict[tuple[int, int], Arc]
    curved: frozenset[int]


def with_arcs(body: Polyhedron) -> CurvedSolid:
    """Replace facet strips by curved faces where corners lie on arcs."""
    removed: set[int] = set()
    dropped: set[int] = set()
    added: list[Loops] = []
    arcs: dict[tuple[int, int], Arc] = {}
    for chain in _chains(body):
        for start, end, found in _arcs(body.corners, chain):
            ends = [_pair(level[start], level[end]) for level in chain]
            if any(e in arcs or e in body.neighbours or e[::-1] in body.neighbours for e in ends):
                continue  # an edge joins these two corners already
            arcs |= dict(zip(ends, found, strict=True))
            removed.update(n for level in chain for n in level[start + 1 : end])
            for low, high in itertools.pairwise(chain):
                facets = [_face_of(body, low[i], low[i + 1], high[i]) for i in range(start, end)]
                dropped.update(facets)
                loop = (low[start], low[end], high[end], high[start])
                added.append((loop if body.neighbours[low[start], low[start + 1]] == facets[0] else loop[::-1],))
    faces = [
        tuple(tuple(n for n in loop if n not in removed) for loop in face)
        for i, face in enumerate(body.faces)
        if i not in dropped
    ]
    kept = np.setdiff1d(np.arange(len(body.corners)), sorted(removed))
    number = np.full(len(body.corners), -1)
    number[kept] = np.arange(len(kept))
    renumbered = tuple(tuple(tuple(number[list(loop)].tolist()) for loop in face) for face in (*faces, *added))
    curved = frozenset(range(len(faces), len(renumbered)))
    moved = {_pair(int(number[a]), int(number[b])): arc for (a, b), arc in arcs.items()}
    return CurvedSolid(Polyhedron(body.corners[kept], renumbered), moved, curved)


def _pair(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _face_of(body: Polyhedron, a: int, b: int, above: int) -> int:
    one = body.neighbours[a, b]
    other = body.neighbours[b, a]
    return one if above in body.faces[one][0] and len(body.faces[one][0]) == 4 else other


def _chains(body: Polyhedron) -> Iterator[list[list[int]]]:
    """Strip corners, by level from below and along the strip; inner ones may vanish."""
    near: dict[int, list[int]] = defaultdict(list)
    for a, b in body.neighbours:
        near[a].append(b)
    columns = {column for v in near if (column := _column(body, near, v))}
    beside = {column: sides for column in columns if (sides := _sides(body, near, column))}
    left = set(beside)
    while left:
        line = [min(left)]
        left.discard(line[0])
        for side in beside[line[0]]:
            line.reverse()
            line.append(side)
            while line[-1] in left:
                left.discard(line[-1])
                one, other = beside[line[-1]]
                line.append(other if one == line[-2] else one)
        if line[0] == line[-2] and len(line) > 4:  # all the way round
            line = line[:-1]
        yield [list(level) for level in zip(*line, strict=True)]


def _column(body: Polyhedron, near: dict[int, list[int]], start: int) -> tuple[int, ...] | None:
    """Stacked corners about which outlines bend gently, from below; None if one must stay."""
    corners = body.corners
    found = [start]
    for v in found:
        level = [u for u in near[v] if abs(corners[u, 2] - corners[v, 2]) < _LEVEL]
        upright = [u for u in near[v] if u not in level]
        if len(level) != 2 or not 1 <= len(upright) <= 2:
            return None
        if len(upright) == 2 and (corners[upright[0], 2] > corners[v, 2]) == (corners[upright[1], 2] > corners[v, 2]):
            return None
        a = corners[v] - corners[level[0]]
        b = corners[level[1]] - corners[v]
        if a @ b < math.cos(_TURN) * np.linalg.norm(a) * np.linalg.norm(b):
            return None
        found += [u for u in upright if u not in found]
    return tuple(sorted(found, key=lambda n: float(corners[n, 2]))) if len(found) > 1 else None


def _sides(
    body: Polyhedron, near: dict[int, list[int]], column: tuple[int, ...]
) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
    """Corners next to a column on its two sides; None where a face between is no facet."""
    sides: tuple[list[int], list[int]] = ([], [])
    for low, high in itertools.pairwise(column):
        pairs = []
        for edge in ((low, high), (high, low)):
            face = body.faces[body.neighbours[edge]]
            if len(face) != 1 or len(face[0]) != 4:
                return None
            others = [n for n in face[0] if n not in edge]
            if abs(body.corners[others[0], 2] - body.corners[low, 2]) > _LEVEL:
                others.reverse()
            level = [abs(body.corners[o, 2] - body.corners[v, 2]) for o, v in zip(others, (low, high), strict=True)]
            if max(level) > _LEVEL or others[0] not in near[low] or others[1] not in near[high]:
                return None
            pairs.append(others)
        if sides[0] and pairs[0][0] != sides[0][-1]:
            pairs.reverse()
        for side, pair in zip(sides, pairs, strict=True):
            if side and side[-1] != pair[0]:
                return None
            side += pair if not side else pair[1:]
    return tuple(sides[0]), tuple(sides[1])


def _arcs(corners: Array, chain: list[list[int]]) -> Iterator[tuple[int, int, list[Arc]]]:
    """Longest chain parts with corners on arcs at every level: first and last place, and arcs."""
    points = [corners[level] for level in chain]
    start = 0
    count = len(chain[0])
    while start + _FEWEST < count:
        best: tuple[int, list[Arc]] | None = None
        for end in range(start + _FEWEST, count):
            found = [_arc(p[start : end + 1]) for p in points]
            if any(f is None for f in found):
                break
            best = end, [f for f in found if f is not None]
        if best is None:
            start += 1
            continue
        yield start, *best
        start = best[0]


def _arc(points: Array) -> Arc | None:
    """Best arc through the ends of corners (k, 3); None if those between are not near."""
    a = points[0, :2]
    b = points[-1, :2]
    flat = points[1:-1, :2]
    chord = b - a
    length = float(np.hypot(*chord))
    if length < 1e-6:
        return None
    across = np.array([-chord[1], chord[0]]) / length
    middle = 0.5 * (a + b)
    out = (flat - middle) @ across
    square = ((flat - middle) ** 2).sum(axis=1) - 0.25 * length**2
    if abs(out).max() < 1e-3:
        return None
    off = float(out @ square / (2.0 * out @ out))
    centre = middle + off * across
    radius = math.hypot(off, 0.5 * length)
    if np.abs(np.hypot(*(flat - centre).T) - radius).max() > _OFF:
        return None
    chords = np.hypot(*np.diff(points[:, :2], axis=0).T)
    if chords.max() >= 2.0 * radius or radius - math.sqrt(radius**2 - 0.25 * chords.max() ** 2) > _BULGE:
        return None
    side = 1.0 if out.mean() > 0.0 else -1.0
    angle = np.unwrap(np.arctan2(*(points[:, :2] - centre).T[::-1]))
    steps = np.diff(angle)
    if abs(steps.sum()) > _WHOLE or (np.sign(steps) != np.sign(steps[0])).any():
        return None
    top = centre + side * radius * across
    return Arc((float(centre[0]), float(centre[1])), radius, (float(top[0]), float(top[1]), float(points[0, 2])))
