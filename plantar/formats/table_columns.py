"""Number table with named columns as a recording."""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import cells_of_foot, feet_in_turns, halves, unit_of_values
from plantar.formats.column_map import proposed_map
from plantar.formats.field_names import OF_CELLS, OF_PLATES, Heading, heading_of, spelled_out
from plantar.formats.format import ReadOptions
from plantar.formats.missing_cells import report_missing_cells
from plantar.formats.plausibility import possible
from plantar.formats.side import on_one_time, rows_of_sides, side_column, side_of
from plantar.formats.stated_rate import in_seconds, or_usual, stated_rate
from plantar.formats.stated_rows import on_counted_rows, report_lost_rows
from plantar.formats.table_forces import feet_of_forces, is_force_table
from plantar.formats.table_text import time_columns, time_unit
from plantar.formats.units import find_unit, plain
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, sampling

_CLOCK = re.compile(r"(?i)time|zeit|tiempo|temp[os]|tijd|clock|elapsed|epoch|[\[({（]m?s([ei][cgk]\w*)?[\])}）]|秒|^s$")
_MEASURE = re.compile(r"(?i)(?<![a-z])(?:step|stride|stance|swing)[ _]?(?:length|width|time|duration|velocity|speed)")
_TRIAL = re.compile(r"\b(?:subject|trial|session|participant)\b|trialid")
_MOST_NAMED = 10  # Columns that are left out by name in the warnings; of more their number is given
_CURVES = 40  # Numbered columns without a time from which rows that name trials are curves and no frames
_SLOWEST = 5.0  # Hz: rows that are farther apart are steps or minutes, and no frames
_SIGNED = 0.3  # Share of the largest reading that cells do not reach on both sides of zero
_FEWEST = 3  # Rows of a recording
_PAIRS = 20  # Times that are there twice, from which rows are of two feet; and how much more they differ so
_PARTED = 3.0


def recording_of_columns(
    table: NDArray[np.float64],
    names: list[str],
    options: ReadOptions,
    path: Path,
    facts: dict[str, str] | None = None,
    warnings: list[str] | None = None,
) -> PressureRecording:
    """Returns recording from a table of numbers and its column names.

    Columns are plates' forces, moments and CoP, a foot's forces, or cells, by quantity; others are left out with a
    warning. FormatError without load columns or names, for trial curves, or an unknown unit.

    `table`: numbers (n, k), NaN if missing; `names`: columns (k), empty where a layout has as many cells; `facts`:
    "unit", "rate", "side" of comments.
    """
    facts = facts or {}
    warnings = [] if warnings is None else warnings
    if len(table) < _FEWEST:
        raise FormatError(
            f"the table has {len(table)} row(s) of numbers, which is no recording over time; allowed: a row a frame"
        )
    names = spelled_out(names) if names else _laid_out(table, options, warnings)
    options = replace(options, side=options.side or side_of(facts.get("side", ""), facts.get("foot", "")))
    _refuse_measures(names)
    propose = partial(proposed_map, names, table)
    of_side = side_column(names, table)
    at = _clock(table, names)
    if of_side is not None:
        table, names, at = _side_by_side(table, names, at, of_side, warnings)
    elif at is not None:
        table, names, at = _on_one_clock(table, names, at, warnings)
    elif options.rate_hz is None:
        table = on_counted_rows(table, names, warnings)
    report_lost_rows(len(table), facts, warnings)
    columns = [i for i, n in enumerate(names) if i != at and time_unit(n) is None]
    for i in columns:
        table[:, i] = possible(table[:, i])
    if at is not None and of_side is None:
        _refuse_feet_in_turns(table, at)
    headings = [heading_of(name) for name in names]
    if at is None:
        _refuse_curves(headings)
    stated = options.rate_hz or stated_rate(facts, warnings)
    if at is None and stated is None:
        _refuse_steps(table, headings)
    time, rate, notes = _times(table, names, None if options.rate_hz else at, stated, warnings)
    if rate < _SLOWEST and options.rate_hz is None:
        raise FormatError(
            f"the rows are {1.0 / rate:.3g} s apart, as steps are and no frames; allowed: a row a frame, "
            f"{_SLOWEST:g} or more a second (--rate overrides)"
        )
    columns, both = _without_copies(table, names, headings, columns, warnings)
    if is_force_table([headings[i] for i in columns]):
        named = {i: headings[i] for i in columns}
        feet, every, kind, raw = feet_of_forces(table, named, rate, options, facts.get("unit"), warnings)
        _report_left_out([names[i] for i in columns if headings[i].quantity not in OF_PLATES], warnings, "load")
    else:
        kind = "insole"
        every = True
        feet, raw = _cells(table, names, headings, columns, both, facts, options, propose, warnings)
    return PressureRecording(
        path=path,
        format="csv",
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={**facts, "sees_every_step": every},
        warnings=(*warnings, *notes),
        raw=raw,
        kind=kind,
    )


def _laid_out(table: NDArray[np.float64], options: ReadOptions, warnings: list[str]) -> list[str]:
    """Names of nameless columns that are as many as a layout's cells, below a clock or not; else FormatError."""
    width = table.shape[1]
    cells = 0 if options.layout is None else len(options.layout)
    if not cells or width not in (cells, cells + 1, 2 * cells, 2 * cells + 1):
        raise FormatError(
            "the columns have no names, so that nothing shows which of them are loads; allowed: a row of names, or "
            f"the columns by their numbers, such as {proposed_map([], table)}"
        )
    warnings.append(
        f"the columns have no names: taken as the layout's {cells} cells in its order (--columns overrides)"
    )
    numbers = [str(i + 1) for _ in range(width // cells) for i in range(cells)]
    return ["time"] * (width % cells) + numbers


def _clock(table: NDArray[np.float64], names: list[str]) -> int | None:
    """Column of times: one that is called so, or rises throughout and is called like one."""
    if timed := time_columns(names):
        return timed[0]
    like = 0 if not names[0] else next((i for i, n in enumerate(names) if _CLOCK.search(n)), None)
    return like if like is not None and (np.diff(table[:, like]) > 0.0).all() else None


def _without_copies(
    table: NDArray[np.float64],
    names: list[str],
    headings: Sequence[Heading],
    columns: list[int],
    warnings: list[str],
) -> tuple[list[int], dict[int, Side]]:
    """Columns without loads that copy an earlier one, and the foot of each cell whose names begin again halfway."""
    keys = {
        i: (h.quantity, h.axis, h.side, h.number, plain(h.unit), "" if h.axis else h.words)
        for i in columns
        if names[i] and (h := headings[i]).quantity in OF_CELLS
    }
    loads = list(keys)
    half = len(keys) // 2
    one = loads[:half]
    other = loads[half:]
    axes_or_sides = any(axis or side for _, axis, side, *_ in keys.values())
    again = half >= 2 and not axes_or_sides and [keys[i] for i in one] == [keys[i] for i in other]
    if again and not np.array_equal(table[:, one], table[:, other], equal_nan=True):
        warnings.append(
            "the cells' names begin again: the first ones are taken as the left foot's, then the right's, else "
            "all of left and right is exchanged (--columns overrides)"
        )
        return columns, dict.fromkeys(one, SIDES[0]) | dict.fromkeys(other, SIDES[1])
    copies: set[int] = set()
    firsts: dict[tuple[object, ...], int] = {}
    for i, key in keys.items():
        first = firsts.setdefault(key, i)
        if first == i or not np.nan_to_num(table[:, i]).any():
            continue
        if not np.array_equal(table[:, first], table[:, i], equal_nan=True):
            raise FormatError(
                f"columns {first + 1} and {i + 1} have one name, {names[i]!r}, and different values; allowed: a name "
                f"for each, such as left 1, left 2 or FP1 Fz, FP2 Fz{_map_of_plates(names, headings)}"
            )
        copies.add(i)
        warnings.append(f"column {names[i]!r} is there twice with the same values: it counts once")
    return [i for i in columns if i not in copies], {}


def _map_of_plates(names: Sequence[str], headings: Sequence[Heading]) -> str:
    """The map of columns whose names begin again for each plate, as BioWare writes them; else empty."""
    letters = {"force": "F", "cop": "COP", "moment": "M"}
    parts = [f"time={i + 1}" for i in time_columns(names)[:1]]
    seen: list[str] = []
    for i, heading in enumerate(headings):
        if heading.axis in ("x", "y", "z") and heading.quantity in letters and not (heading.side or heading.number):
            what = f"{letters[heading.quantity]}{heading.axis}"
            seen.append(what)
            parts.append(f"FP{seen.count(what)} {what}={i + 1}")
    return f': --columns "{", ".join(parts)}"' if "Fz" in seen else ""


def _refuse_curves(headings: Sequence[Heading]) -> None:
    alike = Counter(h.words for h in headings if h.number is not None)
    if max(alike.values(), default=0) >= _CURVES and any(_TRIAL.search(h.words) for h in headings):
        raise FormatError(
            "each row is a curve of a trial, since columns name subjects or trials and the rest is numbered; "
            "allowed: a row a frame, with a column of times or --rate"
        )


def _refuse_feet_in_turns(table: NDArray[np.float64], at: int) -> None:
    """FormatError where each time is there twice, with loads that differ more within a time than from time to time."""
    time = table[:, at]
    pairs = len(time) // 2
    twice = pairs >= _PAIRS and (time[: 2 * pairs : 2] == time[1 : 2 * pairs : 2]).all()
    if not twice or not (np.diff(time[: 2 * pairs : 2]) > 0.0).all():
        return
    values = np.nan_to_num(np.delete(table[: 2 * pairs], at, axis=1))
    within = np.abs(values[1::2] - values[::2]).sum(axis=0)
    between = np.abs(np.diff(values[::2], axis=0)).sum(axis=0)
    if (within > _PARTED * between).any():
        raise FormatError(
            "each time is there twice, with different loads, as of two feet in turns, and no column names the foot; "
            "allowed: a column of feet (side: left or right), or a row a time"
        )


def _refuse_measures(names: Sequence[str]) -> None:
    """FormatError where columns are measures of steps, and none is called a load."""
    measures = [name for name in names if _MEASURE.search(name)]
    if len(measures) > 1 and not any(heading_of(name).quantity in ("force", "pressure", "cell") for name in names):
        raise FormatError(
            f"each row is a step, as {measures[0]!r} and {measures[1]!r} show; allowed: a row a frame, with forces or "
            "pressures"
        )


def _refuse_steps(table: NDArray[np.float64], headings: Sequence[Heading]) -> None:
    for i, heading in enumerate(headings):
        counts = {"step", "stride", "cycle"} & set(heading.words.split()) and not heading.unit
        if counts and (np.diff(table[:, i]) == 1.0).all():
            raise FormatError(
                f"each row is a {heading.words}, since a column counts them and none holds times; allowed: a row a "
                "frame (--rate, if the rows are frames)"
            )


def _side_by_side(
    table: NDArray[np.float64], names: list[str], at: int | None, of_side: int, warnings: list[str]
) -> tuple[NDArray[np.float64], list[str], int | None]:
    rows = rows_of_sides(table[:, of_side], warnings)
    cells = [i for i in range(table.shape[1]) if i not in (at, of_side)]
    times = {side: np.arange(len(own), dtype=float) if at is None else table[own, at] for side, own in rows.items()}
    time, feet = on_one_time({side: (times[side], table[own][:, cells]) for side, own in rows.items()}, warnings)
    named = [f"{side} {names[i]}" for side in feet for i in cells]
    if at is None:
        return np.column_stack(list(feet.values())), named, None
    return np.column_stack([time, *feet.values()]), [names[at], *named], 0


def _on_one_clock(
    table: NDArray[np.float64], names: list[str], at: int, warnings: list[str]
) -> tuple[NDArray[np.float64], list[str], int]:
    units = {i: unit for i, n in enumerate(names) if (unit := time_unit(n)) is not None}
    beside = {i: names[i : i + 2] if names[i] == names[at] else [names[i]] for i in units}
    clocks = {side: i for i in reversed(units) if (side := side_of(*beside[i])) is not None}
    if len(clocks) < 2 or at not in clocks.values():
        return table, names, at
    usual = max(units[i] for i in clocks.values())
    own = {side: list[int]() for side in SIDES}
    last = SIDES[0]
    for i, name in enumerate(names):
        if i in units:
            last = side_of(*beside[i]) or last
        else:
            own[heading_of(name).side or last].append(i)
    times = {side: table[:, clocks[side]] * (units[clocks[side]] or usual or 1.0) for side in SIDES}
    base, feet = on_one_time({side: (times[side], table[:, own[side]]) for side in SIDES}, warnings)
    named = [names[i] if heading_of(names[i]).side else f"{side} {names[i]}" for side in SIDES for i in own[side]]
    return np.column_stack([base, *feet.values()]), ["time [s]" if usual else "time", *named], 0


def _taken(table: NDArray[np.float64], columns: list[int]) -> NDArray[np.float64]:
    if columns == list(range(columns[0], columns[0] + len(columns))):
        return table[:, columns[0] : columns[0] + len(columns)]
    return table[:, columns]


def _times(
    table: NDArray[np.float64], names: list[str], at: int | None, stated: float | None, warnings: list[str]
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    if at is None:
        rate = or_usual(stated, "the table has no times and states no rate", warnings)
        return np.arange(len(table)) / rate, rate, ()
    time = in_seconds(table[:, at], time_unit(names[at]), stated, warnings)
    if len(known := time[np.isfinite(time)]) and abs(known[0]) > 1e5:
        warnings.append(f"the times begin at {known[0]:.10g} s: here they count from the first frame")
        time = time - known[0]
    return sampling(time, stated)


def _report_left_out(names: Sequence[str], warnings: list[str], what: str) -> None:
    shown = [n for n in names if n.strip()]
    if len(shown) > _MOST_NAMED:
        warnings.append(f"{len(shown)} columns are no {what}s: left out, {shown[0]!r} to {shown[-1]!r}")
    else:
        warnings += [f"column {name!r} is no {what}: left out" for name in shown]


def _chosen_cells(headings: Sequence[Heading], columns: Sequence[int]) -> list[int]:
    """Columns of cells: numbered, or placed on the sole; a foot's one column where it has no others."""
    units = {i: find_unit(headings[i].unit) for i in columns}
    # Where some state a unit of load, what is in another one is no load.
    foreign = {i for i, unit in units.items() if unit is None and headings[i].unit} if any(units.values()) else set()
    known = [i for i in columns if headings[i].quantity in OF_CELLS and i not in foreign]
    cells = [i for i in known if headings[i].number is not None or headings[i].quantity == "cell"]
    parted = {headings[i].side for i in cells}
    # A column of a foot without number or place is its only one, or the total of its cells.
    whole = [i for i in known if i not in cells and (headings[i].side or headings[i].quantity in ("pressure", "force"))]
    alone = [i for i in whole if headings[i].side not in parted and (headings[i].side or not cells)]
    return sorted([*cells, *alone])


def _refuse_two_loads(names: Sequence[str], headings: Sequence[Heading], columns: Sequence[int]) -> None:
    """FormatError where a column is called a load, and another one no more than a foot: either may be the load."""
    feet = [i for i in columns if (h := headings[i]).side and (h.quantity, h.number, h.unit) == ("number", None, "")]
    loads = [i for i in columns if (h := headings[i]).quantity in ("force", "pressure") and not h.side]
    if len(feet) == 1 and len(loads) == 1 and headings[loads[0]].number is None:
        raise FormatError(
            f"{names[loads[0]]!r} and {names[feet[0]]!r} may both be the foot's load; allowed: which is, such as "
            f'--columns "{headings[feet[0]].side}={names[loads[0]]}"'
        )


def _cells(
    table: NDArray[np.float64],
    names: list[str],
    headings: Sequence[Heading],
    columns: list[int],
    both: dict[int, Side],
    facts: dict[str, str],
    options: ReadOptions,
    propose: Callable[..., str],
    warnings: list[str],
) -> tuple[dict[Side, FootRecording], bool]:
    _refuse_two_loads(names, headings, columns)
    chosen = _chosen_cells(headings, columns)
    _report_left_out([names[i] for i in columns if i not in chosen], warnings, "cell")
    if not chosen:
        raise FormatError(
            f"no column of the table is a load; its columns are {', '.join(map(repr, names[:8]))}; allowed: names of "
            "cells (left 3 [kPa], heel) or of forces (Left Fz [N], FP1 Fz), or which is which: "
            f"{propose()}"
        )
    _refuse_signs(table[:, chosen])
    if options.layout is None:
        report_missing_cells(table, headings, chosen, columns, warnings)
    found = [headings[i].unit for i in chosen if headings[i].unit]
    if len({find_unit(u) for u in found}) > 1:
        forces = [i for i in chosen if (unit := find_unit(headings[i].unit)) is not None and unit.kind == "force"]
        raise FormatError(
            f"the columns are in different units: {', '.join(sorted(set(found)))}; allowed: those of one, such as "
            f"{propose(among=forces)}"
        )
    stated = facts.get("unit", facts.get("units")) or next((u for u, _ in Counter(found).most_common(1)), None)
    unit = unit_of_values(stated, options, warnings, "the table")
    by_side: dict[Side | None, list[int]] = {}
    for i in chosen:
        by_side.setdefault(both.get(i, headings[i].side), []).append(i)
    nameless = by_side.get(None, [])
    if len(by_side) > 1 and nameless:
        _report_left_out([names[i] for i in nameless], warnings, "named foot's cell")
    parts: list[tuple[Side, NDArray[np.float64]]]
    parts = [(side, _taken(table, by_side[side])) for side in SIDES if side in by_side]
    if not parts:
        values = _taken(table, nameless)
        if options.side is None and options.layout is None and feet_in_turns(values):
            raise FormatError(
                f"the two halves of {len(nameless)} cells carry load in turns, as two feet do, and name none; allowed: "
                f"names such as left 1, or which is which: {propose()} (--side, if they are one foot's)"
            )
        parts = halves(values, options, warnings)
    feet = {}
    for side, part in parts:
        ids = [n for i in by_side.get(side, nameless) if (n := headings[i].number) is not None]
        feet[side] = cells_of_foot(side, part, unit, options, warnings, ids if len(ids) == part.shape[1] else None)
    return feet, unit.kind == "raw"


def _refuse_signs(values: NDArray[np.float64]) -> None:
    known = values[:: max(1, len(values) // 2000)]
    known = known[np.isfinite(known)]
    low, high = (float(v) for v in np.percentile(known, (2.0, 98.0))) if len(known) else (0.0, 0.0)
    if min(-low, high) > _SIGNED * max(-low, high):
        raise FormatError(
            f"the cells go from {low:.4g} to {high:.4g}, as forces and moments of a plate do and no cells; allowed: "
            "names such as FP1 Fx, FP1 Fy, FP1 Fz, FP1 Mx, or which is which with --columns"
        )
