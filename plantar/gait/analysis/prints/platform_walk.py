"""Footprints on a platform: their cells and frames, and direction and feet of a pass.

A piece is loaded cells that touch, or have one cell between them, without a pause. Pieces loaded together that are no
larger than a foot are one footprint.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side, other_side
from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_cells
from plantar.gait.analysis.prints.joined import joined
from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import SoleLayout

LONGEST = 0.36
PAUSE = 1.0
"""Largest length in m of one footprint, and time in s without load that ends a pass over the platform."""

_WIDEST = 0.17  # Largest width in m of one footprint
_BREAK = 0.25  # Time in s without load after which a part of the platform is stepped on again
# Time in s by which two pieces of one footprint may miss each other: heel and toes are not always joined by load.
_SAME_TIME = 0.1
# Share of the largest piece's load that a piece carries at least, and the pieces of a footprint together.
_LEAST_PIECE = 0.005
_LEAST_PRINT = 0.05


@dataclass(frozen=True, eq=False)
class PlatformLoad:
    """Load of platform cells. `force`: force (n, k) in N, 0 if unmeasured; `time`: times (n,) in s."""

    layout: SoleLayout | CellGrid
    force: NDArray[np.float64]
    time: NDArray[np.float64]


@dataclass(frozen=True)
class _Piece:
    """Cells loaded together from one frame to before another, and their largest load in N."""

    cells: list[int]
    begin: int
    end: int
    load: float


@dataclass(frozen=True, eq=False)
class PrintCells:
    """Pieces of one footprint, most loaded first."""

    pieces: list[_Piece]

    @property
    def begin(self) -> int:
        """First loaded frame."""
        return min(p.begin for p in self.pieces)

    @property
    def end(self) -> int:
        """Frame after the last loaded one."""
        return max(p.end for p in self.pieces)

    @cached_property
    def cells(self) -> NDArray[np.int64]:
        """Cells (n,), increasing."""
        return np.array(sorted({cell for piece in self.pieces for cell in piece.cells}))

    @property
    def load(self) -> float:
        """Sum of its pieces' largest loads in N."""
        return sum(p.load for p in self.pieces)


def cells_of_prints(load: PlatformLoad, threshold: float) -> list[PrintCells]:
    """Returns pieces of each footprint by a platform's load, in order; with 5 % of the largest piece's load or more.

    `threshold`: cell counts as loaded above this force in N.
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
    # A later pass loads the same cells again.
    for first, after in _without_breaks(load.time, np.asarray(loaded.any(axis=1))):
        part = loaded[first:after]
        for cells in _components(load.layout, np.asarray(part.any(axis=0))):
            for a, b in _without_breaks(load.time[first:after], np.asarray(part[:, cells].any(axis=1))):
                highest = float(load.force[first + a : first + b][:, cells].sum(axis=1).max())
                yield _Piece(cells, first + a, first + b, highest)


def _without_breaks(time: NDArray[np.float64], loaded: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and end frames of loaded ones (n,), parted by breaks."""
    frames = np.flatnonzero(loaded)
    parts = np.split(frames, np.flatnonzero(np.diff(time[frames]) > _BREAK) + 1)
    return [(int(part[0]), int(part[-1]) + 1) for part in parts if len(part)]


def _components(layout: SoleLayout | CellGrid, active: NDArray[np.bool_]) -> list[list[int]]:
    """Active cells that touch, or have one between them."""
    if isinstance(layout, CellGrid):
        return layout.groups(active)
    near = layout.neighbours
    reach = {cell: {*near[cell], *(j for k in near[cell] for j in near[k])} for cell in np.flatnonzero(active).tolist()}
    return [sorted(cells) for cells in joined(reach)]


def _apart(layout: SoleLayout | CellGrid, one: _Piece, other: _Piece) -> float:
    a, b = (layout.positions[p.cells, :2].mean(axis=0) for p in (one, other))
    return float(np.hypot(*(a - b)))


def _one_foot(load: PlatformLoad, group: PrintCells, piece: _Piece) -> bool:
    """Whether a piece belongs to a footprint: loaded together, no larger than a foot."""
    time = load.time
    if time[piece.begin] > time[group.end - 1] + _SAME_TIME or time[piece.end - 1] < time[group.begin] - _SAME_TIME:
        return False
    width, length = extent_of(load.layout, [c for p in [*group.pieces, piece] for c in p.cells])
    return length <= LONGEST and width <= _WIDEST


def extent_of(layout: SoleLayout | CellGrid, cells: Sequence[int] | NDArray[np.int64]) -> tuple[float, float]:
    """Returns width and length in m of a layout's cells along their main axes."""
    points = layout.positions[cells, :2]
    _, axes = np.linalg.eigh(np.cov(points.T) if len(points) > 2 else np.eye(2))
    width, length = np.ptp(points @ axes, axis=0).tolist()
    return width, length


_ALIKE = 0.02  # Distance in m to the line of walking from which it separates left from right
# Distance in m between the first and the last of three or more footprints from which they show the direction.
_TRAVEL = 0.5
_STANDING = 0.01  # Path of the CoP in m under which a footprint is one of standing
# Cosine of the angle to the platform's edge from which the mean axis of two whole footprints or more, whose toes point
# outwards alike, is the line of walking; share of the longest one's length from which a footprint is whole.
_TURNED = 0.985
_WHOLE = 0.85
# Shares of a footprint's length: the waist, heel and forefoot around it, the ball, and where the toes begin.
_WAIST = (0.33, 0.55)
_TRUNK = (0.25, 0.60)
_BALL = (0.60, 0.80)
_TOES = 0.82


@dataclass(frozen=True, eq=False)
class PlatformWalk:
    """One pass over a platform: footprints in the order they begin.

    `centres`: force-weighted centroid (m, 2) of each in m.
    """

    load: PlatformLoad
    prints: Sequence[PrintCells]
    centres: NDArray[np.float64]


def passes_over(load: PlatformLoad, prints: Sequence[PrintCells]) -> list[PlatformWalk]:
    """Returns platform passes of prints in order, separated by times without load."""
    passes: list[list[PrintCells]] = []
    for cells in prints:
        if passes and load.time[cells.begin] - max(load.time[p.end - 1] for p in passes[-1]) < PAUSE:
            passes[-1].append(cells)
        else:
            passes.append([cells])
    return [PlatformWalk(load, own, np.array([_centroid(load, p) for p in own])) for own in passes]


def direction_of_walk(walk: PlatformWalk, notes: list[str]) -> NDArray[np.float64]:
    """Returns walk direction (2,), from first to last footprints or along the platform; notes get assumptions."""
    centres = walk.centres
    if len(centres) >= 3 and np.hypot(*(centres[-1] - centres[0])) > _TRAVEL:
        half = len(centres) // 2
        ahead = centres[-half:].mean(axis=0) - centres[:half].mean(axis=0)
        return np.asarray(ahead / np.hypot(*ahead))
    path = np.array([_path(walk.load, p) for p in walk.prints]).sum(axis=0)
    if np.hypot(*path) < _STANDING:
        long, wide = np.ptp(walk.load.layout.positions[walk.prints[0].cells, :2], axis=0)
        path = np.array([1.0, 0.0] if long >= wide else [0.0, 1.0])
        notes.append("the centre of pressure hardly moves: the direction of walking is assumed along the platform")
    forward = np.where(np.eye(2)[np.argmax(np.abs(path))] > 0.0, np.sign(path), 0.0)
    ahead = _mean_axis(walk, forward)
    straight = ahead @ forward >= _TURNED
    edge = "parallel to the platform's edge, in the direction in which the CoP moves"
    notes.append(f"the line of walking is taken as {edge if straight else 'the mean axis of the footprints'}")
    return forward if straight else ahead


def _mean_axis(walk: PlatformWalk, forward: NDArray[np.float64]) -> NDArray[np.float64]:
    prints = [footprint_on(walk.load, cells, forward) for cells in walk.prints]
    whole = [p.axis for p in prints if p.length >= _WHOLE * max(q.length for q in prints)]
    mean = np.sum(whole, axis=0) if len(whole) > 1 else forward
    return np.asarray(mean / np.hypot(*mean))


def sides_of_walk(
    walk: PlatformWalk, forward: NDArray[np.float64], stated: Side | None, notes: list[str]
) -> list[Side]:
    """Returns the foot of each footprint of a walk: left ones lie left of the walking line.

    `forward`: walking direction (2,); `stated`: foot in the file, used if footprints lie in one line; else arch and
    hallux show it.
    """
    count = len(walk.prints)
    offset = walk.centres @ np.array([-forward[1], forward[0]])
    if count >= 2 and np.ptp(offset) >= 2.0 * _ALIKE:
        middle = _line_of_walking(walk.centres @ forward, offset)
        return ["left" if o > m else "right" for o, m in zip(offset, middle, strict=True)]
    if stated is not None:
        return [stated] * count
    first = side_by_shape(footprint_on(walk.load, walk.prints[0], forward))
    notes.append(
        f"the file does not state which foot it is: taken as the {first} one from the footprint's shape "
        "(--side overrides)"
    )
    return [first if k % 2 == 0 else other_side(first) for k in range(count)]


def _centroid(load: PlatformLoad, cells: PrintCells) -> NDArray[np.float64]:
    weights = load.force[cells.begin : cells.end][:, cells.cells].max(axis=0) + 1e-12
    return np.asarray(np.average(load.layout.positions[cells.cells, :2], axis=0, weights=weights))


def _path(load: PlatformLoad, cells: PrintCells) -> NDArray[np.float64]:
    part = load.force[cells.begin : cells.end][:, cells.cells]
    total = part.sum(axis=1)
    loaded = total > 0.02 * total.max()
    path = (part[loaded] @ load.layout.positions[cells.cells, :2]) / total[loaded, None]
    few = max(1, len(path) // 8)
    return np.asarray(path[-few:].mean(axis=0) - path[:few].mean(axis=0))


def _line_of_walking(along: NDArray[np.float64], offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """Straight line between the feet, halfway between the outermost footprints on either side of its slope."""
    slope = np.polyfit(along, offset, 1)[0] if len(along) >= 4 and np.ptp(along) > 1.0 else 0.0
    level = offset - slope * along
    return np.asarray(slope * along + 0.5 * (level.min() + level.max()))


def side_by_shape(print_: Footprint) -> Side:
    """The foot of a single print taken as a right one."""
    return "right" if rightness(print_) >= 0.0 else "left"


def rightness(print_: Footprint) -> float:
    """How far arch and hallux lie to the left, in lengths of a print taken as a right one; negative of a left foot."""
    u, v = print_.centres.T / print_.length  # of a right foot v runs to the left, which is medial
    trunk = _mean_where((u < _TRUNK[0]) | ((u > _TRUNK[1]) & (u < _BALL[1])), v, print_.areas)
    waist = _mean_where((u > _WAIST[0]) & (u < _WAIST[1]), v, print_.areas)
    return (trunk - waist) + 0.5 * _hallux_offset(print_, trunk)


def footprint_on(load: PlatformLoad, cells: PrintCells, forward: NDArray[np.float64]) -> Footprint:
    """Returns footprint of cells with their load, taken as a right one that points `forward` (2,)."""
    highest = load.force[cells.begin : cells.end].max(axis=0)
    chosen = np.isin(np.arange(len(load.layout)), cells.cells) & (highest > 0.0)
    return cast(Footprint, footprint_of_cells(load.layout, highest / load.layout.areas, chosen, "right", forward))


def _mean_where(chosen: NDArray[np.bool_], values: NDArray[np.float64], weights: NDArray[np.float64]) -> float:
    return float(np.average(values[chosen], weights=weights[chosen])) if chosen.any() else 0.0


def _hallux_offset(print_: Footprint, trunk: float) -> float:
    u, v = print_.centres.T / print_.length
    front = u > _TOES
    ball = (u > _BALL[0]) & (u < _BALL[1])
    if not front.any():
        return 0.0
    centre = 0.5 * float(v[ball].min() + v[ball].max()) if ball.any() else trunk
    return float(np.average(v[front], weights=print_.areas[front] * print_.pressure[front] + 1e-12)) - centre
