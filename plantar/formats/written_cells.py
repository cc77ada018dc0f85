"""Cells of tables that are numbers in other forms: quoted ones with a comma inside, and times of day or dates."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from datetime import datetime

__all__ = ["has_quoted_commas", "names_of_row", "seconds_of_time", "time_unit", "with_seconds", "without_quotes"]

_QUOTED = re.compile(r'"([^"]*)"')
_QUOTED_COMMA = re.compile(r'"[^",]*,[^"]*"')
_CLOCK = re.compile(r"(?:\d[\d./-]+\d[ T]+)?(?:(\d{1,2}):)?(\d{1,2}):(\d{2}(?:[.,]\d+)?)(?: ?([AaPp])\.?[Mm]\.?)?")
"""A time of day, which may stand after a date of any order: by itself it goes on beyond midnight all the same."""
_SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "ms": 1e-3, "msec": 1e-3, "millisec": 1e-3, "millisecond": 1e-3}
_SECONDS |= {"millis": 1e-3, "micros": 1e-6}
_SECONDS |= {"us": 1e-6, "usec": 1e-6, "microsec": 1e-6, "microsecond": 1e-6, "ns": 1e-9, "nsec": 1e-9}
_SECONDS |= {"min": 60.0, "minute": 60.0, "h": 3600.0, "hour": 3600.0}
_BY = "abs|absolute|elapsed|frame|sample|sampling|relative|rel|recording|measurement|system|local|unix|utc"
_TIMES = "ts|t|times?|time[ _-]?stamps?|date[ /_-]?time|zeit|uhrzeit|zeitstempel|temps|tempo|tiempo|tijd"
_UNIT = "|".join(rf"{name}s?" for name in _SECONDS)
_NAMED = re.compile(
    rf"(?:(?:{_BY})[ _.-]*)?(?:{_TIMES})"
    r"(?:[ _/,.-]*(?:in )?(?:[\[(]\s*)?"
    rf"(?:(?P<unit>{_UNIT})\.?|(?P<clock>[hms:.,f ]{{4,}}))\s*[\])]?)?|(?P<alone>{_UNIT})"
)
_ALONE = ("sec", "second", "msec", "millisec", "millisecond", "millis", "micros")
"""Units that are a column's name by themselves; "min" may be the least of something."""
_DAY = 86400.0
_SINCE = datetime(2020, 1, 1)
"""Dates are counted from here: from the year 1 on, a second's millionth is less than a double resolves."""


def names_of_row(line: str, delimiter: str | None) -> list[str]:
    """Returns the unquoted cells of a line of names between a delimiter (None: blanks), which quotes may contain."""
    if delimiter is None or '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    (cells,) = csv.reader([line], delimiter=delimiter)
    return [cell.strip().strip('"') for cell in cells]


def time_unit(name: str) -> float | None:
    """Unit in s of the times that a column's name names, 0 where it states none; None where it names no times.

    Example:
        >>> [time_unit(name) for name in ("Time [ms]", "t_min", "Elapsed time (s)", "Date/Time", "T [°C]", "left 3")]
        [0.001, 60.0, 1.0, 0.0, None, None]
    """
    match = _NAMED.fullmatch(name.strip().strip('"').strip().lower().replace("µ", "u").replace("μ", "u"))
    if match is None:
        return None
    unit = match["unit"] or match["alone"] or ""
    known = next((unit[:k] for k in (len(unit), len(unit) - 1) if unit[:k] in _SECONDS), "")
    if match["alone"] and known not in _ALONE:
        return None
    return _SECONDS.get(known, 0.0)


def without_quotes(lines: Iterator[str]) -> Iterator[str]:
    """Yields lines with commas between cells: `"1,5","2,5"` as `1.5,2.5`, and those without a comma in quotes as they
    are.

    Example:
        >>> list(without_quotes(iter(['0.01,"1,5","-2,25"', '"0.02","1","1,234.5"'])))
        ['0.01,1.5,-2.25', '0.02,1,1234.5']
    """
    for line in lines:
        yield _QUOTED.sub(_plain, line) if '"' in line else line


def _plain(quoted: re.Match[str]) -> str:
    text = quoted[1]
    if "," in text and "." in text:  # one of them parts the thousands: the one that comes first
        return text.replace(",", "") if text.rfind(",") < text.rfind(".") else text.replace(".", "").replace(",", ".")
    return text.replace(",", ".")


def has_quoted_commas(line: str) -> bool:
    """Whether a cell of a line is in quotes and holds a comma."""
    return _QUOTED_COMMA.search(line) is not None


def seconds_of_time(text: str) -> float | None:
    """Seconds of a time of day, or since 2020 began of an ISO 8601 date and time, or None.

    Of another date, whose order is unknown, only the time of day counts.

    Example:
        >>> seconds_of_time("08:21:17.5"), seconds_of_time("01:02.25"), seconds_of_time("1/2/2024 1:00:00 PM")
        (30077.5, 62.25, 46800.0)
    """
    text = text.strip().strip('"')
    if ":" not in text:
        return None
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        match = _CLOCK.fullmatch(text)
        if match is None:
            return None
        hours = int(match[1] or 0)
        if match[4]:
            hours = hours % 12 + (12 if match[4] in "Pp" else 0)
        return 3600.0 * hours + 60.0 * int(match[2]) + float(match[3].replace(",", "."))
    return (moment.replace(tzinfo=None) - _SINCE).total_seconds()


def with_seconds(lines: Iterator[str], delimiter: str | None, column: int) -> Iterator[str]:
    """Yields lines in whose time column seconds, also beyond midnight, stand for times of day or dates; others as they
    are.

    Args:
        lines: The lines; the first one's time counts as 0.
        column: The time column.
        delimiter: The sign between cells; None for blanks.
    """
    first: float | None = None
    last = days = 0.0
    for line in lines:
        cells = line.split(delimiter)
        seconds = seconds_of_time(cells[column]) if column < len(cells) else None
        if seconds is not None:
            if first is None:
                first = last = seconds
            if seconds < last - 0.5 * _DAY:
                days += _DAY
            last = seconds
            cells[column] = f"{seconds - first + days:.6f}"
            line = (delimiter or " ").join(cells)
        yield line
