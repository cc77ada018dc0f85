"""Footsteps of a walkway or a stack, by its table metadata.csv where it has one, else found in the load."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.formats.step_stack import steps_of_stack
from plantar.formats.step_table import StatedStep, StepTable
from plantar.formats.walkway import PITCH, THRESHOLD, WalkwayFile
from plantar.formats.walkway_passes import WalkwayPass, passes_of
from plantar.gait.analysis.prints.platform_walk import (
    PlatformLoad,
    PlatformWalk,
    PrintCells,
    cells_of_prints,
    direction_of_walk,
    extent_of,
    passes_over,
    sides_of_walk,
)
from plantar.layouts.cell_grid import CellGrid
from plantar.recordings.walkway_step import WalkwayStep

# Share by which a footprint at the walkway's edge is shorter than the median of the others where it is cut off.
_SHORTER = 0.1


def steps_of_file(file: WalkwayFile, table: StepTable | None, notes: list[str]) -> Iterator[WalkwayStep]:
    """Yields footsteps in the order of the file; notes get what had to be assumed.

    The table decides on feet, frames and boxes. Of a walkway without one, feet lie left and right of the line of
    walking of their pass.
    """
    if file.stack:
        yield from steps_of_stack(file, table)
        return
    for walk, load in enumerate(passes_of(file)):
        if table is None:
            yield from steps_of_pass(load, walk, file.rate_hz, notes)
        else:
            end = load.first + len(load.force)
            own = [step for step in table.steps if step.begin < end and step.end >= load.first]
            yield from (step for stated in own if (step := _stated_step(load, stated, file.rate_hz)) is not None)


def _stated_step(load: WalkwayPass, stated: StatedStep, rate: float) -> WalkwayStep | None:
    if stated.box is None:
        first_row, last_row, first_column, last_column = 0, load.shape[0] - 1, 0, load.shape[1] - 1
    else:
        first_row, last_row, first_column, last_column = stated.box
    begin = max(0, stated.begin - load.first)
    end = min(len(load.force), stated.end + 1 - load.first)
    row = load.cells.row
    column = load.cells.column
    inside = (row >= first_row) & (row <= last_row) & (column >= first_column) & (column <= last_column)
    chosen = np.flatnonzero(inside)
    force = load.force[begin:end, chosen]
    held = np.flatnonzero(force.max(axis=0, initial=0.0) > 0.0)
    if not len(held):
        return None
    return WalkwayStep(
        side=stated.side,
        cells=load.cells.of_cells(chosen[held]),
        force=force[:, held],
        time=(load.first + np.arange(begin, end)) / rate,
        strike=stated.begin / rate,
        lift=stated.end / rate,
        walk=stated.walk,
        forward=_forward(stated, force[:, held], row[chosen[held]]),
        unused=stated.unused,
    )


def _forward(stated: StatedStep, force: NDArray[np.float64], row: NDArray[np.int64]) -> NDArray[np.float64]:
    """Direction of walking along the rows: as stated, else as the load moves from the first half to the second."""
    backwards = stated.backwards
    if backwards is None:
        halves = (part.sum(axis=0) + 1e-12 for part in np.array_split(force, 2))
        first, second = (float(np.average(row, weights=weights)) for weights in halves)
        backwards = second < first
    return np.array([-1.0 if backwards else 1.0, 0.0])


def steps_of_pass(load: WalkwayPass, walk: int, rate: float, notes: list[str]) -> list[WalkwayStep]:
    """Footsteps of one pass in the order they begin, found by cells that are loaded together.

    Those that the walkway's edge cuts off are not in the means.
    """
    time = (load.first + np.arange(len(load.force))) / rate
    whole = PlatformLoad(load.cells, load.force, time)
    prints = cells_of_prints(whole, THRESHOLD * PITCH**2)
    out: list[WalkwayStep] = []
    for part in passes_over(whole, prints):
        forward = direction_of_walk(part, notes)
        sides = sides_of_walk(part, forward, None, notes)
        cut = _cut_off(part, load.shape)
        for k, (cells, side) in enumerate(zip(part.prints, sides, strict=True)):
            own = _cells_around(load.cells, part.prints, k)
            span = slice(cells.begin, cells.end)
            out.append(
                WalkwayStep(
                    side=side,
                    cells=load.cells.of_cells(own),
                    force=load.force[span][:, own],
                    time=time[span],
                    strike=float(time[cells.begin]),
                    lift=float(time[cells.end - 1]),
                    walk=walk,
                    forward=forward,
                    unused="cut off by the walkway's edge" if cut[k] else "",
                )
            )
    return out


def _cells_around(grid: CellGrid, prints: Sequence[PrintCells], k: int) -> NDArray[np.int64]:
    """Cells of a footprint, and those beside it that carry less than the threshold and are no other footprint's."""
    own = prints[k].cells
    row = grid.row
    column = grid.column
    near = (row >= row[own].min() - 1) & (row <= row[own].max() + 1)
    near &= (column >= column[own].min() - 1) & (column <= column[own].max() + 1)
    for other in prints:
        if other is not prints[k] and other.begin < prints[k].end and other.end > prints[k].begin:
            near[other.cells] = False
    near[own] = True
    return np.flatnonzero(near)


def _cut_off(part: PlatformWalk, shape: tuple[int, int]) -> list[bool]:
    grid = part.load.layout
    lengths = [extent_of(grid, cells.cells)[1] for cells in part.prints]
    edge = [_at_edge(part, cells, shape) for cells in part.prints]
    inside = [length for length, at in zip(lengths, edge, strict=True) if not at]
    usual = float(np.median(inside)) if inside else np.inf
    return [at and length < (1.0 - _SHORTER) * usual for length, at in zip(lengths, edge, strict=True)]


def _at_edge(part: PlatformWalk, cells: PrintCells, shape: tuple[int, int]) -> bool:
    places = part.load.layout.positions[cells.cells, :2] / PITCH - 0.5
    low = places.min(axis=0)
    high = places.max(axis=0)
    return bool((low < 0.5).any() or (high > np.array(shape) - 1.5).any())
