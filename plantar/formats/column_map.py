"""A stated map of a table's columns: "left=Fz1, right=Fz2, time=t", instead of what their names say."""

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.errors import InputError
from plantar.formats.field_names import OF_CELLS, OF_PLATES, heading_of
from plantar.formats.side import is_side_column, side_column, side_of
from plantar.formats.table_text import time_columns, time_unit
from plantar.formats.units import find_unit

_LOADS = {*OF_PLATES, *OF_CELLS}
_ALLOWED = (
    "allowed: time, left, right and side, or names such as Fz1, left Fz, FP2 COPx [mm], each with = and a column's "
    "name or number; the cells of a foot as left=A + B, or left=A..B for all from A to B"
)
_PLATE = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")  # The channels of a force plate, in the order of all makers
_HEAVY = 100.0  # What a plate's largest force reaches at least, in N: accelerations and turning rates reach less
_STEPPED = 150.0  # What a plate's force reaches at least, in N, where nothing but its size shows that it is one
_LONGEST_NUMBER = 20  # digits: Python reads no number of some thousands
_MOST_FILLED = 300  # Nameless columns, of which more may as well be the frames of a curve
_FEWEST = 3  # Numbered columns up to which they may be the axes of a marker
_SIGNED = 0.05  # Share of its largest value that a column reaches below zero, as only a plate's channels do


def column_map(text: str | Mapping[str, str | int] | None) -> dict[str, str]:
    """The columns of each name of a map as text or mapping; empty for None. InputError if it cannot be understood.

    Example:
        >>> column_map("left=Fz1, right=Fz2, time=t")
        {'left': 'Fz1', 'right': 'Fz2', 'time': 't'}
    """
    if text is None:
        return {}
    if isinstance(text, str):
        pairs = [part.partition("=") for part in text.split(",") if part.strip()]
        if not pairs or any(not sign or not held.strip() for _, sign, held in pairs):
            raise InputError(f"--columns is {text!r}; {_ALLOWED}")
        named = [(key.strip(), held.strip()) for key, _, held in pairs]
    else:
        named = [(str(key).strip(), str(held).strip()) for key, held in text.items()]
    out = dict(named)
    if len(out) < len(named):
        raise InputError("--columns gives a name twice; allowed: each once, with the cells of a foot as left=A + B")
    for key in out:
        known = key in ("left", "right") or time_unit(key) is not None or is_side_column(key)
        if not known and heading_of(key).quantity not in _LOADS:
            raise InputError(f"--columns names {key!r}, which is no load; {_ALLOWED}")
    return out


def mapped_columns(wanted: Mapping[str, str], names: Sequence[str], width: int) -> dict[int, str]:
    """Returns the new name of each column of a map, by its number from 0 in order; InputError for one not there.

    Args:
        wanted: Of `column_map`.
        names: Of the table's columns; may be empty.
        width: Their number.
    """
    out: dict[int, str] = {}
    for key, held in wanted.items():
        parts = [held] if held in names else [part.strip() for part in held.split("+")]
        columns = [i for part in parts for i in _columns(part, names, width)]
        side = side_of(key) if heading_of(key).quantity == "number" else None
        for count, i in enumerate(columns, 1):
            if i in out:
                raise InputError(f"--columns takes column {_shown(i, names)} twice; allowed: each once")
            unit = heading_of(names[i]).unit if names and not heading_of(key).unit else ""
            name = key if side is None else f"{key} force" if len(columns) == 1 else f"{key} {count}"
            out[i] = f"{name} [{unit}]" if unit and time_unit(key) is None else name
            if names and time_unit(key) == 0.0 and time_unit(names[i]):
                out[i] = names[i]  # which states the unit
        if len(columns) > 1 and side is None:
            raise InputError(
                f"--columns gives {key!r} {len(columns)} columns; allowed: one, or several of left or right"
            )
    return dict(sorted(out.items()))


def _columns(part: str, names: Sequence[str], width: int) -> list[int]:
    ends = [part] if part in names else part.split("..", 1)
    ends_at = [_column(end.strip(), names, width) for end in ends]
    if ends_at[0] > ends_at[-1]:
        first, last = (_shown(i, names) for i in ends_at)
        raise InputError(f"--columns: {first} comes after {last}; allowed: a range from left to right, {last}..{first}")
    return list(range(ends_at[0], ends_at[-1] + 1))


def _column(name: str, names: Sequence[str], width: int) -> int:
    found = [i for i, n in enumerate(names) if n == name]
    found = found or [i for i, n in enumerate(names) if n.lower() == name.lower()]
    if len(found) > 1:
        raise InputError(f"--columns: {len(found)} columns are called {name!r}; allowed: their numbers, from 1 on")
    if found:
        return found[0]
    number = int(name) if name.isdecimal() and len(name) < _LONGEST_NUMBER else 0
    if 1 <= number <= width:
        return number - 1
    shown = ", ".join(map(repr, names[:8])) or f"1 to {width}"
    raise InputError(f"--columns names {name!r}, which is no column; the table's are {shown}")


def _shown(i: int, names: Sequence[str]) -> str:
    """A column by its name, or by its number where the name is not its own or would not survive the map's signs."""
    name = names[i] if names else ""
    plain = name and not re.search(r"[,=+\"]|\.\.", name) and [n.lower() for n in names].count(name.lower()) == 1
    return name if plain else str(i + 1)


def proposed_map(names: Sequence[str], table: NDArray[np.float64], among: Sequence[int] | None = None) -> str:
    """Returns the map of a table (n, k) that names do not show, filled in as far as they and the numbers go.

    The loads are `among` some columns, where these are known.

    Six columns with negative values are a plate's channels; one that reaches 150 is its vertical force; others are one
    or two feet's cells. Columns that may be anything are not filled in.
    """
    columns = range(table.shape[1])
    steps = np.diff(table, axis=0)
    rising = [i for i in columns if len(steps) and (steps[:, i] > 0.0).all()]
    counters = [i for i in rising if (steps[:, i] == 1.0).all()]
    timed = (time_columns(names) or [i for i in rising if i not in counters])[:1]
    of_side = side_column(names or [""] * len(columns), table)
    rest = [i for i in columns if i not in (*timed, *counters, of_side)]
    loads = list(among) if among is not None else _possible_loads(names, table, rest) if names else rest
    parts = [f"time={_shown(i, names)}" for i in timed]
    if of_side is not None and (len(rest) == 1 or not loads):
        force = _shown(rest[0], names) if len(rest) == 1 else "COLUMN"
        parts += [f"side={_shown(of_side, names)}", f"force={force}"]
    else:
        parts += _proposed_loads(names, table, loads)
    return f'--columns "{", ".join(parts)}"'


def _proposed_loads(names: Sequence[str], table: NDArray[np.float64], rest: Sequence[int]) -> list[str]:
    unknown = "left=COLUMN, right=COLUMN" if names else "left=FIRST..LAST, right=FIRST..LAST"
    if not rest:
        return [unknown]
    lows = np.nanmin(table[:, rest], axis=0, initial=0.0)
    highs = np.nanmax(np.abs(table[:, rest]), axis=0, initial=1e-9)
    signed = bool((lows < -_SIGNED * highs).any())
    if len(rest) % len(_PLATE) == 0 and signed and max(highs) >= _HEAVY:
        count = len(rest) // len(_PLATE)
        channels = [f"{c}{plate + 1 if count > 1 else ''}" for plate in range(count) for c in _PLATE]
        return [f"{channel}={_shown(i, names)}" for channel, i in zip(channels, rest, strict=True)]
    if not names and (len(rest) > _MOST_FILLED or (signed and len(rest) > 2) or _has_constant(table[:, rest])):
        return [unknown]
    if not names and len(rest) == 1 and highs[0] >= _STEPPED:
        return [f"Fz={_shown(rest[0], names)}"]
    if len(rest) % 2 == 0:
        half = len(rest) // 2
        return [f"left={_span(rest[:half], names)}", f"right={_span(rest[half:], names)}"]
    return [f"left={_span(rest, names)}"]


def _has_constant(values: NDArray[np.float64]) -> bool:
    """Whether a column is one number other than 0, as a serial number or a setting is."""
    lowest = np.nanmin(values, axis=0, initial=np.inf)
    highest = np.nanmax(values, axis=0, initial=-np.inf)
    return bool(((lowest == highest) & (lowest != 0.0)).any())


def _possible_loads(names: Sequence[str], table: NDArray[np.float64], columns: Sequence[int]) -> list[int]:
    """Columns that names show as loads, else those in a unit of force, else numbered ones of one word without negative
    values; else none."""
    headings = {i: heading_of(names[i]) for i in columns}
    loads = [
        i for i, h in headings.items() if h.quantity in _LOADS and (h.quantity != "number" or h.number is not None)
    ]
    axes = {headings[i].axis for i in loads} & {"x", "y", "z"}
    if axes and not (axes == {"z"} and sorted(headings[i].side or "" for i in loads) == list(SIDES)):
        return []  # of a plate, and which is a force is not to be seen
    if loads:
        return loads
    stated = [i for i, h in headings.items() if (unit := find_unit(h.unit)) is not None and unit.kind == "force"]
    if stated:
        return stated
    numbered = [i for i, h in headings.items() if h.quantity == "unknown" and h.number is not None and not h.axis]
    alike = len({headings[i].words for i in numbered}) == 1 and len(numbered) > _FEWEST
    return numbered if alike and not (table[:, numbered] < 0.0).any() else []


def _span(columns: Sequence[int], names: Sequence[str]) -> str:
    if len(columns) > 2 and columns[-1] - columns[0] == len(columns) - 1:
        return f"{_shown(columns[0], names)}..{_shown(columns[-1], names)}"
    return " + ".join(_shown(i, names) for i in columns)
