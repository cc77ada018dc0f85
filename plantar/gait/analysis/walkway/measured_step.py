"""Measures of one footstep on a walkway, as those of steps on platforms (docs/metrics.md)."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from plantar.formats.walkway import THRESHOLD
from plantar.gait.analysis.masks import Masks
from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_cells
from plantar.gait.analysis.steps.cop_path import averaged_path, cop_measures, excursion_index
from plantar.gait.analysis.steps.events import EVENT_LEVELS
from plantar.gait.analysis.steps.pressure_measures import pressure_measures, region_measures
from plantar.gait.analysis.steps.step_footprint import cells_in_polygons, with_regions
from plantar.gait.analysis.steps.step_load import StepLoad
from plantar.gait.analysis.steps.step_measures import force_measures, landing_impact
from plantar.gait.analysis.steps.walk_geometry import Place
from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import Side
from plantar.recordings.walkway_step import WalkwayStep

_COP_WINDOW = 0.05  # s over which the centre of pressure is averaged, as on other sensors
_FEWEST = 4  # Frames of a contact whose force curve can be measured
STANCE = np.linspace(0.0, 1.0, 101)
"""Shares of the stance at which force curves are compared."""


@dataclass(frozen=True, eq=False)
class MeasuredStep:
    """One step: measures, regions, place on the walkway, force curve (101,) in N, and map (rows, columns) in Pa.

    `strike`, `lift`: heel strike and toe off in s; `walk`: number of its pass; `unused`: why it is not in the means, or
    empty; `map`: largest pressure from heel to toes and from lateral to medial, 0 where nothing was loaded.
    """

    side: Side
    strike: float
    lift: float
    walk: int
    unused: str
    measures: Mapping[str, float]
    regions: Mapping[str, Mapping[str, float]]
    place: Place | None
    curve: NDArray[np.float64]
    map: NDArray[np.float64]


def measure_step(step: WalkwayStep, masks: Masks, grid: tuple[int, int]) -> MeasuredStep | None:
    """Returns measures of a step that need no other one; None where no cell reaches the threshold.

    `masks`: regions; `grid`: rows and columns of the map.
    """
    area = step.cells.pitch[0] * step.cells.pitch[1]
    threshold = THRESHOLD * area
    highest = step.force.max(axis=0)
    loaded = highest > threshold
    print_ = footprint_of_cells(step.cells, highest / area, loaded, step.side, step.forward)
    if print_ is None or len(step.time) < _FEWEST:
        return None
    print_, region = with_regions(masks, step.cells, print_, None, loaded)
    total = step.force.sum(axis=1)
    cop = _path(step, total)
    # Cells of a region side by side: its sums are then taken where the cells lie.
    order = np.argsort(region, kind="stable")
    region = region[order]
    cells = step.cells.of_cells(order)
    force = step.force[:, order]
    load = StepLoad(step.time, force, force / area, force > threshold, cells.areas)
    measures = force_measures(step.time, total, step.strike, step.lift) | pressure_measures(load, cells)[0]
    measures["landing_impact_N"] = landing_impact(step.time, total, step.strike)
    if measures["footprint_area_m2"] > 0.0:
        measures["force_time_integral_area_Pas"] = measures["impulse_Ns"] / measures["footprint_area_m2"]
    measures |= cop_measures(step.time, print_.in_foot(cop))
    measures["cpei_percent"] = excursion_index(print_, cop)
    measures |= {"arch_index": print_.arch_index(), "foot_length_m": print_.length, "foot_width_m": print_.width}
    moments = step.strike + STANCE * (step.lift - step.strike)
    return MeasuredStep(
        step.side,
        step.strike,
        step.lift,
        step.walk,
        step.unused,
        measures,
        _regions(load, masks, region, print_, cells, step.lift - step.strike),
        _place(step, print_),
        np.interp(moments, step.time, total),
        _map(step, print_, highest / area, grid),
    )


def _path(step: WalkwayStep, total: NDArray[np.float64]) -> NDArray[np.float64]:
    least = EVENT_LEVELS["platform"].strike * float(total.max())
    with np.errstate(invalid="ignore", divide="ignore"):
        cop = (step.force @ step.cells.positions[:, :2]) / total[:, None]
    cop[total < least] = np.nan
    period = (step.time[-1] - step.time[0]) / (len(step.time) - 1)
    return averaged_path(cop, total, round(_COP_WINDOW / period))


def _regions(
    load: StepLoad, masks: Masks, region: NDArray[np.int64], print_: Footprint, cells: CellGrid, duration: float
) -> Mapping[str, Mapping[str, float]]:
    names = [name for name, _ in masks.names]
    lasts = [duration]
    if masks.kind != "polygons":
        return region_measures(load, region, names, lasts)[0]
    out: dict[str, Mapping[str, float]] = {}
    for name, inside in zip(names, cells_in_polygons(masks, cells, print_), strict=True):
        out |= region_measures(load, np.where(inside, 0, -1), [name], lasts)[0]
    return out


def _place(step: WalkwayStep, print_: Footprint) -> Place | None:
    heel = print_.origin
    axis = print_.axis
    forward = step.forward
    if step.pose is not None:
        x, y, turn = step.pose
        turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        heel = turned @ heel + np.array([x, y])
        axis = turned @ axis
        # The walkway's own direction: forwards, or backwards where its frame is turned by more than a quarter.
        forward = np.array([1.0 if np.cos(turn) > 0.0 else -1.0, 0.0])
    return Place(step.strike, heel, axis, forward, step.walk)


@cache
def _shares(grid: tuple[int, int]) -> NDArray[np.float64]:
    """Middles (n, 2) of a map's places, in shares of its length and width."""
    along, across = np.meshgrid(*((np.arange(count) + 0.5) / count for count in grid), indexing="ij")
    return np.stack([along.ravel(), across.ravel()], axis=1)


def _map(
    step: WalkwayStep, print_: Footprint, picture: NDArray[np.float64], grid: tuple[int, int]
) -> NDArray[np.float64]:
    first, last = print_.ends
    low = first.min(axis=0)
    extent = last.max(axis=0) - low
    places = print_.from_foot(_shares(grid) * extent + low)
    row, column = np.floor(places / np.array(step.cells.pitch)).astype(np.int64).T
    numbers = step.cells.numbers()
    row -= int(step.cells.row.min())
    column -= int(step.cells.column.min())
    inside = (row >= 0) & (row < numbers.shape[0]) & (column >= 0) & (column < numbers.shape[1])
    cell = np.where(inside, numbers[row * inside, column * inside], -1)
    return np.where(cell >= 0, picture[cell], 0.0).reshape(grid)
