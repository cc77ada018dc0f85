"""Which cells and frames of a platform are one footprint.

A piece is loaded cells that touch, or have one cell between them, until they are unloaded for a while. Pieces that are
loaded at the same time, and together are no larger than a foot, are one footprint.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout

__all__ = ["PlatformLoad", "PrintCells", "cells_of_prints"]

_LONGEST, _WIDEST = 0.36, 0.17
"""Largest length and width in m of one footprint."""

_BREAK = 0.25
"""Time in s without load after which a part of the platform is stepped on again."""

_SAME_TIME = 0.1
"""Time in s by which two pieces of one footprint may miss each other: heel and toes are not always joined by load."""

_LEAST_PIECE, _LEAST_PRINT = 0.005, 0.05
"""Share of the largest piece's load that a piece carries at least, and the pieces of a footprint together."""


@dataclass(frozen=True, eq=False)
class PlatformLoad:
    """Load of a platform's cells.

    Attributes:
        layout: The platform, k cells.
        force: Force (n, k) in N, 0 where none was measured.
        time: Times (n,) in s.
    """

    layout: SoleLayout
    force: NDArray[np.float64]
    time: NDArray[np.float64]


@dataclass(frozen=True)
class _Piece:
    """Cells that are loaded together from one frame to before another, and their largest load in N."""

    cells: list[int]
    begin: int
    end: int
    load: float


@dataclass(frozen=True, eq=False)
class PrintCells:
    """The pieces of one footprint, the one that carries most first."""

    pieces: list[_Piece]

    @property
    def begin(self) -> int:
        """First frame in which it is loaded."""
        return min(p.begin for p in self.pieces)

    @property
    def end(self) -> int:
        """Frame after the last one in which it is loaded."""
        return max(p.end for p in self.pieces)

    @cached_property
    def cells(self) -> NDArray[np.int64]:
        """Its cells (n,), increasing."""
        return np.array(sorted({cell for piece in self.pieces for cell in piece.cells}))

    @property
    def load(self) -> float:
        """Sum of the largest loads of its pieces in N."""
        return sum(p.load for p in self.pieces)


def cells_of_prints(load: PlatformLoad, threshold: float) -> list[PrintCells]:
    """Returns the pieces of each footprint on a platform by its load, in order; with 5 % of the largest piece's load or
    more.

    Args:
        load: Load of its cells.
        threshold: Force in N above which a cell counts as loaded.
    """
    pieces = list(_pieces(load, load.force > threshold))
    top = max((p.load for p in pieces), default=0.0)
    prints: list[PrintCells] = []
    for piece in sorted((p for p in pieces if p.load >= _LEAST_PIECE * top), key=lambda p: -p.load):
        near = [g for g in prints if _one_foot(load, g, piece)]
        if near:
            min(near, key=lambda g: _apart(load.layout, g.pieces[0], piece)).pieces.append(piece)
        else:
            prints.append(PrintCells([piece]))
    return sorted((g for g in prints if g.load >= _LEAST_PRINT * top), key=lambda g: g.begin)


def _pieces(load: PlatformLoad, loaded: NDArray[np.bool_]) -> Iterator[_Piece]:
    """Parts of the platform that are loaded without a break."""
    for cells in _components(load.layout, np.asarray(loaded.any(axis=0))):
        frames = np.flatnonzero(loaded[:, cells].any(axis=1))
        cuts = np.flatnonzero(np.diff(load.time[frames]) > _BREAK)
        for a, b in zip([0, *(cuts + 1).tolist()], [*cuts.tolist(), len(frames) - 1], strict=True):
            begin, end = int(frames[a]), int(frames[b]) + 1
            yield _Piece(cells, begin, end, float(load.force[begin:end][:, cells].sum(axis=1).max()))


def _components(layout: SoleLayout, active: NDArray[np.bool_]) -> list[list[int]]:
    """Active cells that touch, or have one cell between them."""
    left = active.copy()
    out: list[list[int]] = []
    for start in np.flatnonzero(active).tolist():
        if left[start]:
            left[start] = False
            out.append(sorted(_flooded(layout, start, left)))
    return out


def _flooded(layout: SoleLayout, start: int, left: NDArray[np.bool_]) -> list[int]:
    """Cells joined to one, itself included, which are removed from `left`."""
    stack, cells = [start], []
    while stack:
        cell = stack.pop()
        cells.append(cell)
        for other in _within_two(layout, cell):
            if left[other]:
                left[other] = False
                stack.append(other)
    return cells


def _within_two(layout: SoleLayout, cell: int) -> Iterator[int]:
    for near in layout.neighbours[cell]:
        yield near
        yield from layout.neighbours[near]


def _apart(layout: SoleLayout, one: _Piece, other: _Piece) -> float:
    a, b = (layout.positions[p.cells, :2].mean(axis=0) for p in (one, other))
    return float(np.hypot(*(a - b)))


def _one_foot(load: PlatformLoad, group: PrintCells, piece: _Piece) -> bool:
    """Whether a piece belongs to a footprint: loaded at the same time, and together no larger than a foot."""
    time = load.time
    if time[piece.begin] > time[group.end - 1] + _SAME_TIME or time[piece.end - 1] < time[group.begin] - _SAME_TIME:
        return False
    points = load.layout.positions[[c for p in [*group.pieces, piece] for c in p.cells], :2]
    values, vectors = np.linalg.eigh(np.cov(points.T) if len(points) > 2 else np.eye(2))
    extent = np.ptp(points @ vectors[:, np.argsort(values)], axis=0)
    return bool(extent[1] <= _LONGEST and extent[0] <= _WIDEST)
