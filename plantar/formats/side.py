"""Foot of a one-sensor recording, force plate or table row."""

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import FormatError, InputError
from plantar.formats.field_names import heading_of

_LOOKED_AT = 200  # Rows that show whether a column names feet
_MARKS: dict[Side, re.Pattern[str]] = {
    "left": re.compile(
        r"(?i)left|links|linke[mnrs]?\b|gauche|izquierd|sinistr|esquerd|左|(?:(?<=[\W_\d])|^)(?:l|lf|lt)(?=[\W_\d]|$)"
    ),
    "right": re.compile(
        r"(?i)right|rechts|rechte[mnrs]?\b|droit|derech|destr[oa]|direit|右|(?:(?<=[\W_\d])|^)(?:r|rf|rt)(?=[\W_\d]|$)"
    ),
}


def side_of(*texts: str) -> Side | None:
    """Foot named by the first naming text, or None.

    Example:
        >>> side_of("HX210.11.31.M11-DFM-RF S0073"), side_of("walk_left.fsx"), side_of("walk", "left and right")
        ('right', 'left', None)
    """
    for text in texts:
        found = [side for side, mark in _MARKS.items() if mark.search(text)]
        if len(found) == 1:
            return found[0]
    return None


def sides_of_plates(text: str | None) -> tuple[Side | None, ...]:
    """Foot of each force plate (None: left out) of text such as "L,R" or "left,-,right"; else InputError.

    Example:
        >>> sides_of_plates("L,-,right"), sides_of_plates(None)
        (('left', None, 'right'), ())
    """
    out: list[Side | None] = []
    for part in (text or "").split(",") if text else []:
        side = side_of(part.strip())
        if side is None and part.strip() not in ("-", "none"):
            raise InputError(f"--plates names {part.strip()!r}; allowed: L, R or -, one a plate, as in L,R")
        out.append(side)
    return tuple(out)


_SIDE_COLUMN = re.compile(
    r"(?i)\W*(?:body )?(?:side|foot|sole|insole|shoe|leg|limb|laterality|left/right|l/r|right/left|r/l|fuss|fuß|seite|"
    r"pied|côté|pie|lado|lato|piede|zijde)(?:[ _-]?(?:side|id))?\W*|足"
)
_CODES = ({0.0, 1.0}, {1.0, 2.0})  # Numbers of the left and the right foot
# Usual distances between a foot's rows over which its values are interpolated, whatever the unit of the times: more
# was not measured, and is filled or not as in any recording.
_GAP = 2.5
# Usual distances by which one foot's rows may begin or end before the other's for no more than their shift.
_SHIFT = 1.5
# What stands for a foot by name in a table of numbers: no code of a foot is negative.
_MARK: dict[Side, str] = {"left": "-2", "right": "-1"}
_NAMED_SIDES = {-2.0, -1.0}


def is_side_column(name: str) -> bool:
    """Whether a column of this name gives a row's foot.

    Example:
        >>> [is_side_column(name) for name in ("Side", "foot", "sole_id", "left 12", "footprint 3")]
        [True, True, True, False, False]
    """
    return _SIDE_COLUMN.fullmatch(name) is not None


def side_column(names: Sequence[str], table: NDArray[np.float64]) -> int | None:
    """Column of a table (n, k) that gives each row's foot: one that holds names of feet, else one that is called so."""
    called = [i for i, name in enumerate(names) if is_side_column(name)]
    head = table[:_LOOKED_AT]
    of_feet = np.isin(head, list(_NAMED_SIDES)) | ~np.isfinite(head)
    known = np.flatnonzero(of_feet.all(axis=0) & np.isfinite(head).any(axis=0)).tolist()
    both = [i for i in known if len(np.unique(head[np.isfinite(head[:, i]), i])) == 2]
    return next(iter([*(i for i in called if i in known), *both, *called]), None)


@lru_cache(maxsize=64)
def number_of_side(cell: str) -> str:
    """Cell of a side column as -2 (left) or -1 (right); unchanged if it names no foot."""
    text = cell.strip().strip('"')
    side = side_of(text) or heading_of(text).side
    return cell if side is None else _MARK[side]


def names_a_foot(cell: str) -> bool:
    """Whether a cell is a foot's name and nothing else.

    Example:
        >>> [names_a_foot(cell) for cell in ("L", " right", "12", "left 3")]
        [True, True, False, True]
    """
    return len(cell) < 12 and number_of_side(cell) != cell


def rows_of_sides(values: NDArray[np.float64], warnings: list[str]) -> dict[Side, NDArray[np.int64]]:
    """Returns each foot's row indices by values (n,) of a side column; warnings get assumptions."""
    kinds = np.unique(values[np.isfinite(values)])
    if len(kinds) > 2 or len(kinds) == 0:
        raise FormatError(
            f"the column of sides holds {len(kinds)} different values; allowed: two, such as left and right"
        )
    codes = next((c for c in (_NAMED_SIDES, *_CODES) if set(kinds.tolist()) <= c), None)
    if codes is None:
        raise FormatError(
            f"the column of sides holds {' and '.join(f'{k:g}' for k in kinds)}, which name no foot; allowed: left and "
            "right, L and R, 0 and 1, or 1 and 2"
        )
    if codes != _NAMED_SIDES:
        warnings.append(
            f"the column of sides holds {' and '.join(f'{k:g}' for k in kinds)}: the smaller is taken as the left "
            "foot; else all of left and right is exchanged"
        )
    lost = int((~np.isfinite(values)).sum())
    if lost:
        warnings.append(f"{lost} row(s) name no foot: left out")
    if len(kinds) == 1:
        side: Side = "right" if kinds[0] == max(codes) else "left"
        return {side: np.flatnonzero(values == kinds[0])}
    return {side: np.flatnonzero(values == kind) for side, kind in zip(SIDES, kinds, strict=True)}


def on_one_time(
    feet: Mapping[Side, tuple[NDArray[np.float64], NDArray[np.float64]]], warnings: list[str]
) -> tuple[NDArray[np.float64], dict[Side, NDArray[np.float64]]]:
    """Returns feet, of times (n,) and values (n, k) each, on one time base: times (m,) and values (m, k).

    Where times differ, `warnings` tell that the right foot is interpolated at the left's; NaN where a foot pauses.
    FormatError for a foot without time.
    """
    first = next(iter(feet.values()))[0]
    if all(np.array_equal(time, first, equal_nan=True) for time, _ in feet.values()):
        return first, {side: values for side, (_, values) in feet.items()}
    times: dict[Side, NDArray[np.float64]] = {}
    timed: dict[Side, NDArray[np.float64]] = {}
    for side, (time, values) in feet.items():
        known = np.flatnonzero(np.isfinite(time))
        if len(known) == 0:
            raise FormatError(f"no row of the {side} foot has a time")
        known = known[np.argsort(time[known], kind="stable")]
        times[side] = time[known]
        timed[side] = values[known]
    warnings.append("the feet have times of their own: the right foot's values are interpolated at the left one's")
    base = _common_times(times)
    return base, {side: _at_times(base, times[side], timed[side]) for side in feet}


def _common_times(times: Mapping[Side, NDArray[np.float64]]) -> NDArray[np.float64]:
    # The left foot's times, and the right one's where the left foot has no rows; what one has more at the ends is left
    # out where it is no more than the rows' shift.
    alone = {side: times[side][~_covered(times[side], times[other_side(side)])] for side in SIDES}
    mine, more = (_without_ends(times[s], alone[s], times[other_side(s)]) for s in SIDES)
    return np.asarray(np.union1d(mine, more[np.isin(more, alone["right"])]))


def _usual(time: NDArray[np.float64]) -> float:
    return float(np.median(np.diff(time))) if len(time) > 1 else 0.0


def _without_ends(
    time: NDArray[np.float64], alone: NDArray[np.float64], others: NDArray[np.float64]
) -> NDArray[np.float64]:
    most = _SHIFT * _usual(time)
    low = others[0] if 0.0 < others[0] - time[0] <= most else -np.inf
    high = others[-1] if 0.0 < time[-1] - others[-1] <= most else np.inf
    return time[~np.isin(time, alone) | ((time >= low) & (time <= high))]


def _covered(wanted: NDArray[np.float64], time: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether wanted times (m,) lie between two ordered times (n,) without a gap."""
    after = np.searchsorted(time, wanted, side="left")
    covered = time[np.minimum(after, len(time) - 1)] == wanted
    inside = (after > 0) & (after < len(time))
    covered[inside] |= (time[after[inside]] - time[after[inside] - 1]) <= _GAP * _usual(time)
    return np.asarray(covered)


def _at_times(
    wanted: NDArray[np.float64], time: NDArray[np.float64], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    out = np.column_stack([np.interp(wanted, time, column) for column in values.T])
    out[~_covered(wanted, time)] = np.nan
    return out
