"""Rows that a file states or counts, beside those that are there."""

import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.formats.text import number

_ROWS = re.compile(r"(?:n|num|number ?of|data|total|#)? ?[_.]?(?:rows|samples|frames)(?: ?\(?(?:count|total)\)?)?")
_COUNTER = re.compile(
    r"(?i)#?\s*(?:sample|frame|row|index|counter|packet|count)s?(?:[ _-]?(?:#|no\.?|nr\.?|number|index|count))?"
)
_MOST = 10.0  # times as many rows as are there, from which a counter is no counter of rows
_TOLD = 0.005  # Share of lost rows that is reported


def on_counted_rows(table: NDArray[np.float64], names: list[str], warnings: list[str]) -> NDArray[np.float64]:
    """Returns a table (n, k) with a row of NaN for each that its counter shows to be lost, with a warning."""
    at = next((i for i, n in enumerate(names) if _COUNTER.fullmatch(n.strip())), None)
    count = np.zeros(0) if at is None else table[:, at]
    steps = np.diff(count)
    if at is None or not np.isfinite(count).all() or not (steps >= 1.0).all() or (count != np.round(count)).any():
        return table
    unit = float(np.median(steps))  # every tenth sample may be exported
    place = (count - count[0]) / unit
    rows = int(place[-1]) + 1
    if rows == len(table) or rows > _MOST * len(table) or (place != np.round(place)).any():
        return table
    whole = np.full((rows, table.shape[1]), np.nan)
    whole[place.astype(int)] = table
    whole[:, at] = count[0] + unit * np.arange(rows)
    lost = rows - len(table)
    warnings.append(
        f"{lost} of {rows} rows ({100.0 * lost / rows:.2g} %) are lost, as {names[at]!r} shows: they count as not "
        "measured, and the others keep their times"
    )
    return whole


def report_lost_rows(rows: int, facts: Mapping[str, str], warnings: list[str]) -> None:
    """Add to `warnings` what a file states of its rows, where other than so many are there."""
    for name, text in facts.items():
        stated = number(text) if _ROWS.fullmatch(name.strip().lower().removeprefix("number_of_")) else None
        if stated is None or stated != round(stated) or not 0.0 < stated < 1e9:
            continue
        if abs(stated - rows) <= max(1.0, _TOLD * stated):
            return
        share = 100.0 * abs(stated - rows) / stated
        what = "are lost" if rows < stated else "are more than that"
        warnings.append(
            f"the file states {stated:.0f} rows ({name}) and holds {rows}: {share:.2g} % {what}; where they are lost "
            "between others, times, steps and loads are wrong by that"
        )
        return
