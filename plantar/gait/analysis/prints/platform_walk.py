"""Direction of a pass over a platform, and the foot of each of its footprints.

Of several footprints, those to the left of the line of walking are the left foot's; of a single one, the arch, which is
open to the medial side, and the hallux show the side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_cells
from plantar.gait.analysis.prints.platform_parts import PlatformLoad, PrintCells
from plantar.sides import Side, other_side

__all__ = ["PlatformWalk", "direction_of_walk", "passes_over", "sides_of_walk"]

_PAUSE = 1.0
"""Time in s without load that ends a pass over the platform."""

_ALIKE = 0.02
"""Distance in m to the line of walking from which it separates left from right."""

_TRAVEL = 0.5
"""Distance in m between the first and the last of three or more footprints from which they show the direction."""

_STANDING = 0.01
"""Path of the CoP in m under which a footprint is one of standing."""

_WAIST, _TRUNK, _BALL, _TOES = (0.33, 0.55), (0.25, 0.60), (0.60, 0.80), 0.82
"""Shares of a footprint's length: the waist, heel and forefoot around it, the ball, and where the toes begin."""


@dataclass(frozen=True, eq=False)
class PlatformWalk:
    """One pass over a platform: its footprints, in the order in which they begin.

    Attributes:
        load: Load of the platform's cells.
        prints: The cells of each footprint.
        centres: Centroid (m, 2) of each footprint in m, weighted by the largest force of each cell.
    """

    load: PlatformLoad
    prints: Sequence[PrintCells]
    centres: NDArray[np.float64]


def passes_over(load: PlatformLoad, prints: Sequence[PrintCells]) -> list[PlatformWalk]:
    """Returns the passes over a platform, each ended by a time without load, by the load of its cells and its prints in
    order.
    """
    passes: list[list[PrintCells]] = []
    for cells in prints:
        if passes and load.time[cells.begin] - max(load.time[p.end - 1] for p in passes[-1]) < _PAUSE:
            passes[-1].append(cells)
        else:
            passes.append([cells])
    return [PlatformWalk(load, own, np.array([_centroid(load, p) for p in own])) for own in passes]


def direction_of_walk(walk: PlatformWalk, notes: list[str]) -> NDArray[np.float64]:
    """Returns the direction (2,) of a walk: from the first footprints to the last ones, or along the platform.

    Args:
        walk: A pass.
        notes: List to which assumptions are added.
    """
    centres = walk.centres
    if len(centres) >= 3 and np.hypot(*(centres[-1] - centres[0])) > _TRAVEL:
        half = len(centres) // 2
        ahead = centres[-half:].mean(axis=0) - centres[:half].mean(axis=0)
        return np.asarray(ahead / np.hypot(*ahead))
    path = np.array([_path(walk.load, p) for p in walk.prints]).sum(axis=0)
    if np.hypot(*path) < _STANDING:
        path = _longer_side(walk.load.layout.positions[walk.prints[0].cells, :2])
        notes.append("the centre of pressure hardly moves: the direction of walking is assumed along the platform")
    along = int(np.argmax(np.abs(path)))
    forward = np.zeros(2)
    forward[along] = np.sign(path[along])
    notes.append(
        "the line of walking is taken as parallel to the platform's edge, in the direction in which the CoP moves"
    )
    return forward


def sides_of_walk(
    walk: PlatformWalk, forward: NDArray[np.float64], stated: Side | None, notes: list[str]
) -> list[Side]:
    """Returns the foot of each footprint of a pass.

    Args:
        walk: A pass.
        forward: Direction (2,) of walking.
        stated: The foot that the file names; used where the footprints lie in one line.
        notes: List to which assumptions are added.
    """
    count = len(walk.prints)
    offset = walk.centres @ np.array([-forward[1], forward[0]])
    if count >= 2 and np.ptp(offset) >= 2.0 * _ALIKE:
        middle = _line_of_walking(walk.centres @ forward, offset)
        return ["left" if o > m else "right" for o, m in zip(offset, middle, strict=True)]
    if stated is not None:
        return [stated] * count
    first = _side_by_shape(walk.load, walk.prints[0], forward)
    notes.append(
        f"the file does not say which foot it is: taken as the {first} one from the footprint's shape "
        "(--side overrides)"
    )
    return [first if k % 2 == 0 else other_side(first) for k in range(count)]


def _centroid(load: PlatformLoad, cells: PrintCells) -> NDArray[np.float64]:
    weight = load.force[cells.begin : cells.end][:, cells.cells].max(axis=0)
    return np.asarray(np.average(load.layout.positions[cells.cells, :2], axis=0, weights=weight + 1e-12))


def _path(load: PlatformLoad, cells: PrintCells) -> NDArray[np.float64]:
    """Displacement (2,) of the centre of pressure in a contact."""
    part = load.force[cells.begin : cells.end][:, cells.cells]
    total = part.sum(axis=1)
    part, total = part[total > 0.02 * total.max()], total[total > 0.02 * total.max()]
    path = (part @ load.layout.positions[cells.cells, :2]) / total[:, None]
    few = max(1, len(path) // 8)
    return np.asarray(path[-few:].mean(axis=0) - path[:few].mean(axis=0))


def _longer_side(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The axis along which points (n, 2) spread most."""
    return np.array([1.0, 0.0]) if np.ptp(points[:, 0]) >= np.ptp(points[:, 1]) else np.array([0.0, 1.0])


def _line_of_walking(along: NDArray[np.float64], offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """The line between the feet: straight, halfway between the outermost footprints on either side of its slope."""
    slope = np.polyfit(along, offset, 1)[0] if len(along) >= 4 and np.ptp(along) > 1.0 else 0.0
    level = offset - slope * along
    return np.asarray(slope * along + 0.5 * (level.min() + level.max()))


def _side_by_shape(load: PlatformLoad, cells: PrintCells, forward: NDArray[np.float64]) -> Side:
    """The side of a single footprint: as a left foot its arch is open to the right and its hallux lies there."""
    highest = load.force[cells.begin : cells.end].max(axis=0)
    chosen = np.zeros(len(load.layout), dtype=bool)
    chosen[cells.cells] = highest[cells.cells] > 0.0
    print_ = footprint_of_cells(load.layout, highest / load.layout.areas, chosen, "right", forward)
    if print_ is None:
        return "left"
    u, v = print_.centres.T / print_.length  # of a right foot v runs to the left, which is medial
    waist = _mean_where((u > _WAIST[0]) & (u < _WAIST[1]), v, print_.areas)
    rest = (u < _TRUNK[0]) | ((u > _TRUNK[1]) & (u < _BALL[1]))
    trunk = _mean_where(rest, v, print_.areas)
    return "right" if (trunk - waist) + 0.5 * _hallux_offset(print_, trunk) >= 0.0 else "left"


def _mean_where(chosen: NDArray[np.bool_], values: NDArray[np.float64], weights: NDArray[np.float64]) -> float:
    return float(np.average(values[chosen], weights=weights[chosen])) if chosen.any() else 0.0


def _hallux_offset(print_: Footprint, trunk: float) -> float:
    """Distance of the toes' load to the medial side of the ball (else the trunk), as a share of the length."""
    u, v = print_.centres.T / print_.length
    front, ball = u > _TOES, (u > _BALL[0]) & (u < _BALL[1])
    if not front.any():
        return 0.0
    centre = 0.5 * float(v[ball].min() + v[ball].max()) if ball.any() else trunk
    return float(np.average(v[front], weights=print_.areas[front] * print_.pressure[front] + 1e-12)) - centre
