"""Number table with named columns as a recording."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.column_names import Heading, heading_of
from plantar.formats.format import ReadOptions
from plantar.formats.side import is_side_column, on_one_time, rows_of_sides, side_of
from plantar.formats.stated_rate import in_seconds, or_usual, stated_rate
from plantar.formats.table_forces import feet_of_forces, is_force_table
from plantar.formats.table_text import time_unit
from plantar.formats.units import find_unit, plain
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, sampling

_CLOCK = re.compile(r"(?i)time|zeit|tiempo|temp[os]|tijd|clock|elapsed|epoch|[\[({（]m?s([ei][cgk]\w*)?[\])}）]|秒|^s$")
_MOST_NAMED = 10  # Columns that are left out by name in the warnings; of more their number is given
_SUMS = 0.02  # How near a column is to the sum of others, relative to its largest value, where it is their total
_SIGNED = 0.3  # Share of the largest reading that cells do not reach on both sides of zero
_CURVES = 40  # Numbered columns without a time from which rows that name trials are curves and no frames


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
    warning. FormatError without load columns, for trial curves, or an unknown unit.

    `table`: numbers (n, k), NaN if missing; `names`: columns (k); may be empty; `facts`: "unit", "rate", "side" of
    comments.
    """
    facts = {} if facts is None else facts
    warnings = [] if warnings is None else warnings
    if not names:
        warnings.append("the table has no row of names: the first column is taken as time in s if it increases")
    at = next((i for i, n in enumerate(names) if time_unit(n) is not None), None)
    if at is None:
        like = 0 if not names or not names[0] else next((i for i, n in enumerate(names) if _CLOCK.search(n)), None)
        at = like if like is not None and (np.diff(table[:, like]) > 0.0).all() else None
    of_side = next((i for i, n in enumerate(names) if is_side_column(n)), None)
    if of_side is not None:
        table, names = _side_by_side(table, names, at, of_side, warnings)
        at = None if at is None else 0
    elif at is not None and names:
        table, names, at = _on_one_clock(table, names, at, warnings)
    clocks = [i for i, n in enumerate(names) if time_unit(n) is not None and i != at]
    headings = [heading_of(name) for name in names]
    _refuse_curves(headings, at)
    time, rate, notes = _times(table, names, at, facts, options, warnings)
    columns = [i for i in range(table.shape[1]) if i != at and i not in clocks]
    copies, both = _repeated(table, names, columns, warnings) if names else (set[int](), dict[Side, list[int]]())
    columns = [i for i in columns if i not in copies]
    kind = "insole"
    every = True
    raw = False
    if names and is_force_table([headings[i] for i in columns]):
        named = {i: headings[i] for i in columns}
        stated = options.side or side_of(facts.get("side", ""), facts.get("foot", ""))
        given = replace(options, side=stated)
        feet, every, kind, raw = feet_of_forces(table, named, rate, given, facts.get("unit"), warnings)
        used = {i for i in columns if headings[i].quantity in ("force", "cop", "moment", "place")}
        _report_left_out([names[i] for i in columns if i not in used], warnings, "load")
    else:
        feet, raw = _cells(table, names, headings, columns, both, facts, options, warnings)
    return PressureRecording(
        path=path,
        format="csv",
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={**facts, "sees_every_step": every},
        warnings=(*warnings, *notes),
        raw=raw,
        kind="plate" if kind == "plate" else "insole",
    )


def _repeated(
    table: NDArray[np.float64], names: list[str], columns: Sequence[int], warnings: list[str]
) -> tuple[set[int], dict[Side, list[int]]]:
    """Load columns that copy an earlier one, and each foot's cells where all names begin again halfway."""
    keys = {
        i: (h.quantity, h.axis, h.side, h.number, plain(h.unit), "" if h.axis else h.words)
        for i in columns
        if names[i] and (h := heading_of(names[i])).quantity in ("force", "pressure", "cell", "number")
    }
    loads = list(keys)
    half = len(keys) // 2
    one = loads[:half]
    other = loads[half:]
    axes_or_sides = any(axis or side for _, axis, side, *_ in keys.values())
    again = half >= 2 and not axes_or_sides and [keys[i] for i in one] == [keys[i] for i in other]
    if again and not np.array_equal(table[:, one], table[:, other], equal_nan=True):
        warnings.append("the cells' names begin again: the first ones are taken as the left foot's, then the right's")
        return set(), {"left": one, "right": other}
    copies: set[int] = set()
    firsts: dict[tuple[object, ...], int] = {}
    for i, key in keys.items():
        first = firsts.setdefault(key, i)
        if first == i or not np.nan_to_num(table[:, i]).any():
            continue
        if not np.array_equal(table[:, first], table[:, i], equal_nan=True):
            raise FormatError(
                f"columns {first + 1} and {i + 1} have one name, {names[i]!r}, and different values; allowed: a name "
                "for each, such as left 1, left 2 or FP1 Fz, FP2 Fz"
            )
        copies.add(i)
        warnings.append(f"column {names[i]!r} is there twice with the same values: it counts once")
    return copies, {}


def _refuse_curves(headings: Sequence[Heading], at: int | None) -> None:
    trial = any({"subject", "trial", "session", "participant"} & set(h.words.split()) for h in headings)
    if at is None and (trial or any("trialid" in h.words for h in headings)):
        stems = [h.words for h in headings if h.number is not None]
        if stems and max(map(stems.count, set(stems))) >= _CURVES:
            raise FormatError(
                "each row is a curve of a trial, since columns name subjects or trials and the rest is numbered; "
                "allowed: a row a frame, with a column of times or --rate"
            )


def _side_by_side(
    table: NDArray[np.float64], names: list[str], at: int | None, of_side: int, warnings: list[str]
) -> tuple[NDArray[np.float64], list[str]]:
    rows = rows_of_sides(table[:, of_side], warnings)
    cells = [i for i in range(table.shape[1]) if i not in (at, of_side)]
    time = np.arange(len(table), dtype=float) if at is None else table[:, at]
    if at is None:
        for own in rows.values():
            time[own] = np.arange(len(own))
    time, feet = on_one_time({side: (time[own], table[own][:, cells]) for side, own in rows.items()}, warnings)
    head = [] if at is None else [names[at]]
    found = [*head, *(f"{side} {names[i]}" for side in feet for i in cells)]
    return np.column_stack([*([] if at is None else [time]), *feet.values()]), found


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
    table: NDArray[np.float64],
    names: list[str],
    at: int | None,
    facts: dict[str, str],
    options: ReadOptions,
    warnings: list[str],
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    stated = options.rate_hz or stated_rate(facts, warnings)
    if at is None or options.rate_hz is not None:
        rate = or_usual(stated, "the table has no times and states no rate", warnings)
        return np.arange(len(table)) / rate, rate, ()
    time = in_seconds(table[:, at], time_unit(names[at]) if names else None, stated, warnings)
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
    """Cell columns by name; without known names, those of one unknown word and numbers."""
    stated = any(find_unit(headings[i].unit) is not None for i in columns if headings[i].unit)

    def foreign(i: int) -> bool:  # where some state a unit of load, what is in another one is no load
        return bool(stated and headings[i].unit and find_unit(headings[i].unit) is None)

    known = [i for i in columns if headings[i].quantity in ("cell", "number", "pressure", "force") and not foreign(i)]
    known = [i for i in known if headings[i].quantity != "number" or headings[i].number is not None or headings[i].side]
    cells = [i for i in known if headings[i].quantity != "force" or headings[i].number is not None]
    if known:
        return cells or known
    rest = [
        i for i in columns if headings[i].quantity == "unknown" and headings[i].number is not None and not foreign(i)
    ]
    stems = {re.sub(r"left|right|links|rechts", "", headings[i].words) for i in rest}
    stems = {s[1:] if s[:1] in "lr" and {"l" + s[1:], "r" + s[1:]} <= stems else s for s in stems}
    return rest if len(stems) == 1 else []


def _sampled(table: NDArray[np.float64], columns: Sequence[int]) -> NDArray[np.float64]:
    values = table[:: max(1, len(table) // 2000)][:, columns]
    return np.asarray(values[np.isfinite(values).all(axis=1)])


def _is_sum(total: NDArray[np.float64], parts: NDArray[np.float64]) -> bool:
    top = float(np.abs(total).max(initial=0.0))
    return top > 0.0 and float(np.abs(total - parts.sum(axis=1)).max()) <= _SUMS * top


def _total_of(table: NDArray[np.float64], columns: list[int]) -> int | None:
    values = _sampled(table, columns)
    if len(columns) < 3 or not len(values):
        return None
    k = int(np.argmax(values.sum(axis=0)))
    return columns[k] if _is_sum(values[:, k], np.delete(values, k, axis=1)) else None


def _nameless_cells(
    table: NDArray[np.float64], columns: list[int], warnings: list[str]
) -> tuple[list[int], dict[Side, list[int]]]:
    """Columns, and each foot's before their two sums; FormatError for a plate's."""
    low = float(np.nanmin(table[:, columns], initial=0.0))
    high = float(np.nanmax(table[:, columns], initial=0.0))
    if min(-low, high) > _SIGNED * max(-low, high):
        raise FormatError(
            f"columns without names go from {low:.4g} to {high:.4g}, as forces and moments of a plate do and no "
            "cells; allowed: a row of names (FP1 Fx, FP1 Fy, FP1 Fz, FP1 Mx, ...)"
        )
    values = _sampled(table, columns)
    half = (len(columns) - 2) // 2
    pairs = len(columns) % 2 == 0 and half >= 2 and len(values) > 0
    if pairs and _is_sum(values[:, -2], values[:, :half]) and _is_sum(values[:, -1], values[:, half:-2]):
        warnings.append(
            f"the last two of {len(columns)} columns are the sums of {half} before them each: taken as {half} cells of "
            "the left foot, then of the right one, in N, and their totals left out (as in PhysioNet's gaitpdb)"
        )
        return columns[:-2], {"left": columns[:half], "right": columns[half:-2]}
    return columns, {}


def _cells(
    table: NDArray[np.float64],
    names: list[str],
    headings: Sequence[Heading],
    columns: list[int],
    both: dict[Side, list[int]],
    facts: dict[str, str],
    options: ReadOptions,
    warnings: list[str],
) -> tuple[dict[Side, FootRecording], bool]:
    chosen = _chosen_cells(headings, columns) if names else columns
    if names:
        _report_left_out([names[i] for i in columns if i not in chosen], warnings, "cell")
    else:
        chosen, both = _nameless_cells(table, chosen, warnings)
    found = [headings[i].unit for i in chosen if headings[i].unit] if names else []
    if len({find_unit(u) for u in found}) > 1:
        raise FormatError(f"the columns are in different units: {', '.join(sorted(set(found)))}")
    stated = facts.get("unit", facts.get("units")) or (max(set(found), key=found.count) if found else None)
    if both and not names and not stated and not options.unit:
        stated = "N"
    unit = unit_of_values(stated, options, warnings, "the table")
    if not chosen:
        raise FormatError(
            f"no column of the table is a load; its columns are {', '.join(map(repr, names[:8]))}; allowed: names of "
            "cells (left 3 [kPa], heel) or of forces (Left Fz [N], FP1 Fz)"
        )
    by_side: dict[Side | None, list[int]] = {}
    for i in chosen:
        side = next((s for s, own in both.items() if i in own), headings[i].side if names else None)
        by_side.setdefault(side, []).append(i)
    for own in by_side.values():
        if (total := _total_of(table, own)) is not None:
            own.remove(total)
            name = repr(names[total]) if names else total + 1
            warnings.append(f"column {name} is the sum of its foot's others: left out as their total")
    nameless = by_side.get(None, [])
    if len(by_side) > 1 and nameless:
        _report_left_out([names[i] for i in nameless], warnings, "named foot's cell")
    parts: list[tuple[Side, NDArray[np.float64]]]
    parts = [(side, _taken(table, by_side[side])) for side in SIDES if side in by_side]
    if not parts:
        stated_side = options.side or side_of(facts.get("side", ""), facts.get("foot", ""))
        values = _taken(table, nameless)
        parts = [(stated_side, values)] if stated_side else halves(values, options, warnings)
    feet = {}
    for side, part in parts:
        ids = [n for i in by_side.get(side, nameless) if names and (n := headings[i].number) is not None]
        feet[side] = cells_of_foot(side, part, unit, options, warnings, ids if len(ids) == part.shape[1] else None)
    return feet, unit.kind == "raw"
