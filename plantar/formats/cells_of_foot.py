"""Cell columns without geometry, as one foot's recording."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.format import ReadOptions
from plantar.formats.recorded_layouts import cells_by_id, grid_cells
from plantar.formats.units import Unit, find_unit
from plantar.layouts.layout import Side, SoleLayout
from plantar.recordings.frame_table import scale_frames
from plantar.recordings.pressure_recording import FootRecording, layout_for

# Share of its high readings below which a foot is in the air; share of the time in which one of two is alone.
_IN_AIR = 0.05
_ALONE = 0.15


def unit_of_values(
    stated: str | None, options: ReadOptions, warnings: list[str], what: str = "the file", pressures: bool = False
) -> Unit:
    """Returns unit of values: the options', the stated one, or raw counts with warnings that name what.

    FormatError if unknown, or a force's for pressures.
    """
    text = options.unit or stated
    if not text:
        warnings.append(f"{what} states no unit: the values are kept as raw counts (--unit names their unit)")
        return Unit("raw", 1.0, "raw")
    unit = find_unit(text)
    if unit is None or (pressures and unit.kind == "force"):
        kind, force = ("unit of pressure", "") if pressures else ("unit", "N, kg, ")
        raise FormatError(f"unknown {kind} {text!r}; allowed: kPa, N/cm2, mmHg, psi, {force}raw and their like")
    return unit


def cells_of_foot(
    side: Side,
    values: NDArray[np.float64],
    unit: Unit,
    options: ReadOptions,
    warnings: list[str],
    ids: Sequence[int] | None = None,
    own: SoleLayout | None = None,
) -> FootRecording:
    """Returns one foot's forces from values in a unit; FormatError for an unfit layout, or pressures without areas.

    `values`: values (n, k), NaN if unmeasured; become the forces in place; `unit`: their unit.
    """
    layout = layout_for(side, options.layout) or own
    if layout is not None and ids is not None:
        named = cells_by_id(layout, ids)
        if named is None and len(layout) == values.shape[1]:
            if sorted(ids) == list(range(min(ids), min(ids) + len(layout))):  # columns may be sorted as texts
                named = cells_by_id(layout, np.sort(layout.ids)[np.array(ids) - min(ids)].tolist())
            warnings.append("the cells' names are not the layout's ids: taken in the layout's order")
        layout = named or layout
    foot = FootRecording(side, values, layout)
    if layout is None and unit.kind == "pressure":
        raise FormatError(
            f"pressures in {unit.name} need the cells' areas to become forces: give a layout with --layout"
        )
    if layout is None:
        warnings.append(f"no layout of the {side} sole: forces only, give one with --layout for pressures and CoP")
    scale_to_force(values, unit, None if layout is None else layout.areas)
    return foot


def foot_of_matrix(
    side: Side,
    values: NDArray[np.float64],
    unit: Unit,
    options: ReadOptions,
    present: NDArray[np.bool_],
    pitch: tuple[float, float],
    name: str,
    threshold: float,
) -> FootRecording:
    """Returns forces of a cell matrix, on the user's layout or rectangles; FormatError if unfit.

    `values`: cell values (n, k) row by row, NaN if unmeasured; become the forces in place; `unit`: their unit;
    `present`: which matrix places (rows, columns) are cells; `pitch`: row and column distance in m; `threshold`: cell
    counts as loaded from this pressure in Pa.
    """
    layout = layout_for(side, options.layout) or grid_cells(present, *pitch, side=side, name=name, threshold=threshold)
    foot = FootRecording(side, values, layout)
    scale_to_force(values, unit, layout.areas)
    return foot


def scale_to_force(values: NDArray[np.float64], unit: Unit, areas: NDArray[np.float64] | None) -> None:
    """Convert values (n, k) in a unit to N in place, pressures by areas (k,) in m^2; raw counts stay."""
    if unit.kind == "pressure" and areas is not None:
        scale_frames(values, unit.factor * areas)
    elif unit.factor != 1.0:
        scale_frames(values, unit.factor)


def halves(
    values: NDArray[np.float64], options: ReadOptions, warnings: list[str]
) -> list[tuple[Side, NDArray[np.float64]]]:
    """Returns feet and columns of values (n, k) that name none, by options; warnings get assumptions."""
    k = values.shape[1]
    side = options.side
    why = ""
    if options.layout is not None and k == 2 * len(options.layout):
        why = "there are twice the layout's cells"
    elif side is None and options.layout is None and feet_in_turns(values):
        why = f"the two halves of {k} columns carry load in turns, as feet do (--side, if they are one foot's)"
    if why:
        warnings.append(f"{why}: the first half is taken as the left foot, the second as the right")
        return [("left", values[:, : k // 2]), ("right", values[:, k // 2 :])]
    if side is None:
        side = "left" if options.layout is None else options.layout.side
        warnings.append(f"the file does not state which foot it is: taken as the {side} one (--side overrides)")
    return [(side, values)]


def feet_in_turns(values: NDArray[np.float64]) -> bool:
    """Whether the halves of columns (n, k) carry load in turns, as two feet do."""
    if values.shape[1] < 4 or values.shape[1] % 2:
        return False
    half = values.shape[1] // 2
    one = np.nansum(values[:, :half], axis=1)
    other = np.nansum(values[:, half:], axis=1)
    loaded = [x > _IN_AIR * float(np.percentile(x, 98.0)) for x in (one, other)]
    alone = (float((loaded[0] & ~loaded[1]).mean()), float((loaded[1] & ~loaded[0]).mean()))
    on = np.flatnonzero(loaded[0] | loaded[1])
    return min(alone) > _ALONE and len(on) > (1.0 - 0.5 * _ALONE) * (on[-1] - on[0] + 1)
