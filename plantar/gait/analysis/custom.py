"""User-defined masks and measures: polygons in foot coordinates, and functions of a step.

Foot coordinates are shares: u from heel (0) to toes (1), v from lateral (0) to medial (1) edge of the sole, or on a
platform of the footprint.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from plantar.common.plane_points import plane_points
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.analysis.masks import masks_of_polygons
from plantar.gait.analysis.results import Analysis
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.gait.analysis.steps.pressure_measures import region_measures
from plantar.gait.analysis.steps.step_footprint import places_in_foot
from plantar.gait.analysis.steps.step_load import StepLoad, StepLoads


@dataclass(frozen=True, eq=False)
class StepView:
    """Input of a user-defined measure.

    `load`: times (m,), forces (m, k) in N, pressures (m, k) in Pa, loaded cells (m, k); `cop`: CoP (m, 2) in m, NaN
    without load; None without geometry; `places`: foot coordinates (k, 2) of cells; None without geometry.
    """

    step: Step
    load: StepLoad
    cop: NDArray[np.float64] | None
    places: NDArray[np.float64] | None


def custom_measures(
    analysis: Analysis, measures: Mapping[str, Callable[[StepView], float]]
) -> dict[Side, dict[str, NDArray[np.float64]]]:
    """Returns values (steps,) of user-defined functions for each foot's complete steps.

    Args:
        analysis: Analysis.
        measures: Functions by name; each gives a number, NaN if unknown, else an InputError.
    """
    views = {side: _views(analysis, gait) for side, gait in analysis.feet.items()}
    return {
        side: {name: np.array([_value(name, f(v), v.step) for v in own]) for name, f in measures.items()}
        for side, own in views.items()
    }


def _value(name: str, value: Any, step: Step) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        shown = f"measure {name} of step {step.number} of the {step.side} foot gave {str(value)[:40]!r}"
        raise InputError(f"{shown}; allowed: a number, NaN if unknown") from None


def mask_measures(analysis: Analysis, masks: Mapping[str, ArrayLike]) -> dict[Side, list[dict[str, dict[str, float]]]]:
    """Returns each foot's `REGION_MEASURES` of each mask with cells, for complete steps.

    Args:
        analysis: Analysis.
        masks: Polygon corners (n, 2) in foot coordinates, by name. May overlap.

    Raises:
        InputError: If a mask is no polygon.
    """
    checked = {name: plane_points(corners, f"mask {name}").tolist() for name, corners in masks.items()}
    polygons = masks_of_polygons(checked).polygons
    rings = {name: shapely.Polygon(ring) for name, ring in zip(masks, polygons, strict=True)}
    out: dict[Side, list[dict[str, dict[str, float]]]] = {}
    for side, gait in analysis.feet.items():
        rows: list[dict[str, dict[str, float]]] = []
        for view in _views(analysis, gait):
            row: dict[str, dict[str, float]] = {}
            if view.places is not None and view.load.pressure is not None:
                duration = view.step.toe_off_s - view.step.heel_strike_s
                for name, ring in rings.items():
                    region = np.where(shapely.contains_xy(ring, view.places), 0, -1)
                    row |= region_measures(view.load, region, [name], [duration])[0]
            rows.append(row)
        out[side] = rows
    return out


def _views(analysis: Analysis, gait: FootGait) -> Sequence[StepView]:
    loads = StepLoads(analysis.recording, gait.foot, gait.cell_threshold)
    cop = gait.cop
    return [
        StepView(
            step,
            loads.of(step.contact),
            None if cop is None else cop[step.contact.begin : step.contact.end],
            _places(analysis, gait, step),
        )
        for step in gait.steps
    ]


def _places(analysis: Analysis, gait: FootGait, step: Step | None) -> NDArray[np.float64] | None:
    layout = gait.foot.layout
    if layout is None:
        return None
    print_ = step.footprint if step is not None and analysis.recording.kind == "platform" else gait.sole
    if print_ is None:
        return None
    return places_in_foot(layout, print_)
