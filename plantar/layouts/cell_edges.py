"""Shared edges of a sole's cells, also with a corner inside an edge."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.plane_points import plane_points
from plantar.errors import InputError
from plantar.kernels import compiled
from plantar.kernels.geometry.outline import EdgeTable

__all__ = ["WELD", "EdgeTable", "cells_overlap", "edge_table"]

WELD = 1e-6
"""Corners closer than this share of a typical edge are one corner. Nature: floating point of single precision: files
state corners to six digits."""


def edge_table(vertices: ArrayLike, corners: Sequence[Sequence[int]]) -> EdgeTable | None:
    """Returns table of the directed edges of cells that tile a region: `vertices` (v, 2) in m, and `corners`, for each
    of n cells the indices of its corners in order.

    Corners without shared vertices are one within WELD of a typical edge; edges are cut at other cells' corners. None
    where cells overlap, and unshared edges give no outline; an InputError if invalid.
    """
    xy = plane_points(vertices, "vertices")
    if any(not 0 <= i < len(xy) for cell in corners for i in cell):
        raise InputError(f"corners of cells name vertices beyond the {len(xy)} vertices; allowed: 0 to {len(xy) - 1}")
    rings = [_counter_clockwise(xy, list(cell)) for cell in corners]
    lengths = [math.dist(xy[a], xy[b]) for ring in rings for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
    tolerance = WELD * float(np.median(lengths)) if lengths else 0.0
    for mend in (_weld, _cut_edges):
        lone = _lone_edges(rings)
        if lone:
            rings = mend(xy, rings, lone, tolerance)
    directed = [e for ring in rings for e in zip(ring, ring[1:] + ring[:1], strict=True)]
    if len(set(directed)) != len(directed):
        return None
    lone = _lone_edges(rings)
    if cells_overlap(xy[[a for a, _ in lone]], xy[[b for _, b in lone]], tolerance):
        return None
    index = {edge: h for h, edge in enumerate(directed)}
    sizes = [len(ring) for ring in rings]
    start = np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp)
    after = np.arange(1, len(directed) + 1, dtype=np.intp)
    after[start[1:] - 1] = start[:-1]
    straight = 1e-14 * float(np.ptp(xy, axis=0).max()) if len(xy) else 0.0  # nature: floating point, fifty roundings
    cell = np.repeat(np.arange(len(rings)), sizes).astype(np.intp)
    twin = np.array([index.get((b, a), -1) for a, b in directed], dtype=np.intp)
    origin = np.array([a for a, _ in directed], dtype=np.intp)
    flat = np.ascontiguousarray(xy).reshape(-1)
    if compiled:
        return EdgeTable((start, cell, twin, after, origin), flat, straight, True)
    # Without C, lists are faster to read than arrays.
    lists = tuple(numbers.tolist() for numbers in (start, cell, twin, after, origin))
    return EdgeTable(lists, flat.tolist(), straight, False)


def _counter_clockwise(xy: NDArray[np.float64], ring: list[int]) -> list[int]:
    x, y = (xy[ring] - xy[ring[0]]).T
    return ring if float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) >= 0.0 else ring[::-1]


def _lone_edges(rings: Sequence[Sequence[int]]) -> list[tuple[int, int]]:
    directed = {(a, b) for ring in rings for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)}
    return sorted((a, b) for a, b in directed if (b, a) not in directed)


def _weld(
    xy: NDArray[np.float64], rings: list[list[int]], lone: list[tuple[int, int]], tolerance: float
) -> list[list[int]]:
    if tolerance <= 0.0:
        return rings
    where: dict[tuple[int, int], int] = {}
    same: dict[int, int] = {}
    for v in sorted({v for edge in lone for v in edge}):
        x, y = xy[v]
        kx = math.floor(x / tolerance)
        ky = math.floor(y / tolerance)
        near = (where.get((kx + i, ky + j)) for i in (0, -1, 1) for j in (0, -1, 1))
        hit = next((w for w in near if w is not None and math.dist(xy[v], xy[w]) <= tolerance), None)
        if hit is None:
            where[kx, ky] = v
        else:
            same[v] = hit
    if not same:
        return rings
    out = []
    for ring in rings:
        ids = [same.get(v, v) for v in ring]
        out.append([v for v, before in zip(ids, [ids[-1], *ids[:-1]], strict=True) if v != before])
    return out


def _cut_edges(
    xy: NDArray[np.float64], rings: list[list[int]], lone: list[tuple[int, int]], tolerance: float
) -> list[list[int]]:
    """Cut lone edges at corners of others on them (T-junctions)."""
    ids = np.unique(np.array(lone))
    points = xy[ids]
    cuts: dict[tuple[int, int], list[int]] = {}
    for a, b in lone:
        along = xy[b] - xy[a]
        length = math.hypot(*along)
        if length == 0.0:
            continue
        along = along / length
        offset = points - xy[a]
        t = offset @ along
        on = (np.abs(offset[:, 1] * along[0] - offset[:, 0] * along[1]) <= tolerance) & (t > 0.0) & (t < length)
        on &= (ids != a) & (ids != b)
        if on.any():
            cuts[a, b] = ids[on][np.argsort(t[on], kind="stable")].tolist()
    if not cuts:
        return rings
    return [
        [v for a, b in zip(ring, ring[1:] + ring[:1], strict=True) for v in (a, *cuts.get((a, b), ()))]
        for ring in rings
    ]


def cells_overlap(tail: NDArray[np.float64], head: NDArray[np.float64], tolerance: float) -> bool:
    """Returns whether cells overlap, by their unshared edges from `tail` (b, 2) to `head` (b, 2) in m, the cell on
    their left; points nearer than `tolerance` are one.
    """
    d = head - tail
    length = np.hypot(d[:, 0], d[:, 1])
    length[length == 0.0] = 1.0
    middle = 0.5 * (tail + head)
    normal = np.column_stack([-d[:, 1], d[:, 0]]) / length[:, None]
    for i in range(0, len(tail), 256):  # rows in blocks: memory stays small
        block = slice(i, i + 256)
        # Distance of every edge's ends from these edges' lines, and of these edges' ends from every edge's line.
        far = [(np.einsum("ik,ijk->ij", normal[block], p[None] - tail[block, None])) for p in (tail, head)]
        near = [(np.einsum("jk,ijk->ij", normal, p[block, None] - tail[None])) for p in (tail, head)]
        apart = [(a * b < 0.0) & (np.minimum(np.abs(a), np.abs(b)) > tolerance) for a, b in (far, near)]
        if (apart[0] & apart[1]).any():
            return True
        for side, covered in ((0.5, 1), (-0.5, 0)):
            p = middle[block] + side * tolerance * normal[block]
            above = tail[None, :, 1] > p[:, None, 1]
            above_head = head[None, :, 1] > p[:, None, 1]
            left = d[None, :, 0] * (p[:, None, 1] - tail[None, :, 1]) - d[None, :, 1] * (
                p[:, None, 0] - tail[None, :, 0]
            )
            winding = ((~above & above_head & (left > 0)).sum(axis=1)) - (
                (above & ~above_head & (left < 0)).sum(axis=1)
            )
            if (winding != covered).any():
                return True
    return False
