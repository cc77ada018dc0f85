"""Table text: head (names, first row, facts), and quoted numbers or times."""

import csv
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise

from plantar.formats.field_names import heading_of
from plantar.formats.side import number_of_side, side_of
from plantar.formats.text import MISSING, cells_of_row, number, ungrouped
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, PASCALS, RAW, SECONDS, plain, seconds_of_unit

_ROWS = 10  # Rows of numbers in a row from which a table begins, where there are so many
_ALIKE = 3  # Rows from which a text that stands in all of them is a label
_LONGEST_NAME = 200
_OTHERS = "s sec secs ms hz - % %bw bw xbw n/kg deg"
# Rows above a table of Visual3D: file, signal, kind, folder, and ITEM beside the axes; kinds that name a quantity.
_VISUAL3D = ("FORCE", "COFP", "FREEMOMENT", "TARGET", "ANALOG")
_UNITS = {*FORCES, *PASCALS, *LENGTHS, *MOMENTS, *RAW, *_OTHERS.split(), ""}


@dataclass(frozen=True)
class TableHead:
    """Beginning of a table.

    `names`: column names; may be empty; `delimiter`: sign between cells; None for blanks; `first`: line number of the
    first row; `facts` of lines above the table, by lower-case name.
    """

    names: list[str]
    delimiter: str | None
    width: int
    first: int
    facts: dict[str, str]
    labels: tuple[int, ...] = ()


def head_of_table(lines: Sequence[str]) -> TableHead | None:
    """Beginning of a number table, from the first non-blank lines; None without number rows."""
    for first in range(len(lines)):
        if lines[first].startswith("#"):
            continue
        rows = [x for x in lines[first : first + 2 * _ROWS] if not x.startswith("#")][:_ROWS]
        delimiter = _delimiter(rows)
        labels = _labels(rows, delimiter)
        if labels:
            rows = list(with_columns(iter(rows), delimiter, dict.fromkeys(labels, lambda _: "nan")))
        above = lines[:first]
        width = _width(rows, delimiter, len(cells_of_row(above[-1], delimiter)) if above else 0)
        odd = (_name_alone(above, rows, width) or _wider_names(above[-1], rows, width)) if above else None
        if odd is not None:
            names, delimiter = odd
            return TableHead(names, delimiter, len(names), first, _facts(above[:-1], delimiter))
        good = [_is_row(x, delimiter, width) for x in rows]
        if width < 2 or sum(good) < 0.8 * len(good) or _are_numbered(names_of_row(lines[first], delimiter)):
            continue
        named = bool(above) and _names_columns(names_of_row(above[-1], delimiter), width)
        if not (good[0] or (named and _numbers(rows[0], delimiter))):
            continue
        numbers, *below = ([c.strip() for c in x.split(delimiter)] for x in rows[:2])
        if first == 0 and below and all(map(str.isdecimal, numbers)):
            ascending = list(map(int, numbers)) == list(range(1, width + 1))
            if ascending or not all(map(str.isdecimal, below[0])):
                return TableHead(numbers, delimiter, width, 1, {})
        names, at = _names(above, delimiter, width)
        return TableHead(names, delimiter, width, first, _facts(above[:at], delimiter), labels)
    data = [line for line in lines if not line.startswith("#")]
    if len(data) >= _ROWS and all(number(line) is not None for line in data):
        return TableHead([], "\t", 1, 0, {})
    return None


def _labels(rows: Sequence[str], delimiter: str | None) -> tuple[int, ...]:
    columns = zip(*(_cells(x, delimiter) for x in rows), strict=False)
    return tuple(i for i, c in enumerate(columns) if len(c) >= _ALIKE and len(set(c)) == 1 and not _is_cell(c[0]))


def _name_alone(above: Sequence[str], rows: Sequence[str], width: int) -> tuple[list[str], str | None] | None:
    """Name of the one column of forces, and a delimiter that is not in it."""
    if width != 1 or not _numbers(rows[0], "\t"):
        return None
    texts = [x.strip('"# ') for x in above[-2:]]
    name = f"{texts[0]} [{texts[1]}]" if len(texts) == 2 and plain(texts[1]) in _UNITS else texts[-1]
    return ([name[:_LONGEST_NAME]], "\t") if heading_of(name).quantity == "force" else None


def _delimiter(lines: Sequence[str]) -> str | None:
    return next((sign for sign in "\t;|," if all(sign in x for x in lines)), None)


def _cells(line: str, delimiter: str | None) -> list[str]:
    return (without_quotes(line) if delimiter == "," else line).split(delimiter)


def _width(rows: Sequence[str], delimiter: str | None, named: int) -> int:
    cells = [_cells(x, delimiter) for x in rows]
    counts = list(map(len, cells))
    width = max(set(counts), key=counts.count)
    while width > max(1, named) and all(len(c) >= width and not c[width - 1].strip() for c in cells):
        width -= 1
    return width


def _is_row(line: str, delimiter: str | None, width: int) -> bool:
    """Whether a line is a row of numbers, some missing or naming a foot."""
    cells = _cells(line, delimiter)
    if len(cells) < 0.8 * width:
        return False
    others = [c for c in cells if not _is_number(c)]
    numbers = len(cells) - len(others)
    known = numbers + sum(map(_is_cell, others))
    return known >= 0.9 * len(cells) and numbers >= max(1, 0.3 * len(cells))


def _numbers(line: str, delimiter: str | None) -> bool:
    # Names of two feet alone are names of columns.
    cells = _cells(line, delimiter)
    return all(map(_is_cell, cells)) and (any(map(_is_number, cells)) or sum(side_of(c) is not None for c in cells) < 2)


def _is_number(text: str) -> bool:
    return number(text) is not None or seconds_of_time(text[:40]) is not None


def _wider_names(above: str, rows: Sequence[str], width: int) -> tuple[list[str], str | None] | None:
    """Names of more columns than the first rows fill, and the delimiter between them."""
    delimiter = _delimiter([above])
    names = [c[:_LONGEST_NAME] for c in names_of_row(above.lstrip("#"), delimiter)]
    wide = delimiter is not None and len(names) > max(3, 2 * width)
    wide = wide and _with_letters(names[:1000]) >= 0.5 * min(len(names), 1000)
    return (names, delimiter) if wide and all(_numbers(x, delimiter) for x in rows) else None


def _is_cell(text: str) -> bool:
    stripped = text.strip(' "').lower()
    return (
        not stripped
        or _is_number(text)
        or stripped in MISSING
        or (len(text) < 12 and number_of_side(stripped) != stripped)
    )


_PLATE = re.compile(r".*\b(?:\w*plat(?:e|te|t?form|eforme)|fp|kistler|amti|bertec)\b.*?(\d+)\D*$", re.IGNORECASE)


def _names(above: Sequence[str], delimiter: str | None, width: int) -> tuple[list[str], int]:
    if len(above) >= len(_VISUAL3D) and above[-1].startswith("ITEM"):
        signals, kinds, _, axes = (names_of_row(line, delimiter) for line in above[-4:])
        if {len(signals), len(kinds), len(axes)} == {width}:
            parts = zip(signals, kinds, axes, strict=True)
            names = [f"{signal} {kind if kind in _VISUAL3D else ''} {axis}" for signal, kind, axis in parts]
            return ["Frame", *names[1:]], len(above) - len(_VISUAL3D)
    rows = [[c[:_LONGEST_NAME] for c in names_of_row(line.lstrip("#"), delimiter)] for line in above[-3:]]
    rows = [cells if any(cells[width:]) else cells[:width] for cells in rows]
    if rows and len(rows[-1]) == width - 1 > 1 and not rows[-1][0]:
        rows[-1] = ["", *rows[-1]]
    if not rows or not _names_columns(rows[-1], width):
        return [], len(above)
    at = len(above) - 1
    names = _padded(rows.pop(), width)
    if rows and all(plain(c) in _UNITS for c in names) and _names_columns(rows[-1], width):
        at -= 1
        named = zip(_padded(rows.pop(), width), names, strict=True)
        names = [f"{n} [{u}]" if u.strip("-[]() ") and not {"[", "("} & set(n) else n for n, u in named]
    if rows and 1 < len(rows[-1]) <= width and side_of(*names) is None:
        groups = [cell if side_of(cell) else _PLATE.sub(r"FP\1", cell) for cell in _padded(rows[-1], width)]
        if any(side_of(g) or heading_of(g).plate for g in groups):
            at -= 1
            for i in range(1, width):
                groups[i] = groups[i] or groups[i - 1]
            names = [n if time_unit(n) is not None else f"{g} {n}".strip() for g, n in zip(groups, names, strict=True)]
    return names, at


def _padded(cells: list[str], width: int) -> list[str]:
    return cells + [""] * (width - len(cells))


def _names_columns(cells: Sequence[str], width: int) -> bool:
    named = _are_numbered(cells) or _with_letters(cells) >= max(1, 0.25 * len(cells))
    return 0.6 * width <= len(cells) <= width and named


def _with_letters(cells: Sequence[str]) -> int:
    return sum(bool(re.search(r"[^\W\d_]", c)) for c in cells)


def _are_numbered(cells: Sequence[str]) -> bool:
    return len(cells) > 2 and time_unit(cells[0]) is not None and all(c.isdigit() for c in cells[1:])


def _facts(lines: Sequence[str], delimiter: str | None) -> dict[str, str]:
    """Facts of lines like "# unit: kPa", "SampleRate=1200", "rate<tab>100" and "200 Hz"."""
    out: dict[str, str] = {}
    for before, line in pairwise(["", *lines]):
        # Of Vicon Nexus: the rate, without a name.
        line = f"rate: {line}" if before.startswith("Devices") and line.strip(",;\t ").isdigit() else line
        line = line.lstrip("#").replace('"', "").strip(",;\t ")
        alone = _RATE_ALONE.fullmatch(line)
        line = f"{alone[1] or alone[3] or 'rate'}: {alone[2] or alone[4]}" if alone else line
        signs = "[:=]" if re.search("[:=]", line) else f"[\t{delimiter or ''}]"
        name, sign, value = re.sub(signs, "\n", line, count=1).partition("\n")
        if sign and re.fullmatch(r"[\w \[\]()/%.'’-]{1,60}", name):
            out.setdefault(name.strip().lower(), value.strip())
    return out


_QUOTED = re.compile(r'"([^"]*)"')
# A time of day, which may stand after a date of any order: by itself it goes on beyond midnight all the same.
_CLOCK = re.compile(
    r"(?:\d[\d./-]+\d[ T]+)?(?:(\d{1,2}):)?(\d{1,2}):(\d{2}(?:[.,]\d+|:\d{3})?)(?: ?([AaPp])\.?[Mm]\.?)?"
)
_BY = "abs|absolute|elapsed|frame|sample|sampling|relative|rel|recording|measurement|system|local|unix|utc"
_SIDE = "(?:l|r|left|right)"
_TIMES = f"ts|t|times?|times?[ _-]{_SIDE}|(?-i:t)[ _-]{_SIDE}|{_SIDE}[ _-]times?"  # a foot's own clock
_TIMES += "|time[ _-]?stamps?|date[ /_-]?time|zeit|uhrzeit|zeitstempel|temps|tempo|tiempo|tijd|czas|x_value|時間|時刻"
_UNIT = "|".join(rf"{name}s?" for name in SECONDS)
# Units that are a column's name by themselves; "min" may be the least of something.
_ALONE = "(?:sec|second|ms|us|msec|millisec|millisecond|millis|micros)s?"
_NAMED = re.compile(
    rf"(?:(?:{_BY})[ _.-]*)?(?:{_TIMES})"
    r"(?:[ _/,.-]*(?:in )?(?:[\[(]\s*)?"
    rf"(?:(?P<unit>{_UNIT})\.?|(?P<clock>[hms:.,f ]{{4,}}))\s*[\])]?)?|(?P<alone>{_ALONE})",
    re.IGNORECASE,
)
_LONGEST_NAME = 100  # characters: on a name of 500,000 blanks the expression takes hours
_RATE_ALONE = re.compile(r"(?i)([^\d:=;,\t]*?)\s*(\d[\d.,]*\s*(?:k?hz|fps))|([^\d:=;,\t]+?)\s+(\d[\d.,]*)")
_DAY = 86400.0
# Dates are counted from here: from the year 1 on, a second's millionth is less than a double resolves.
_SINCE = datetime(2020, 1, 1)


def names_of_row(line: str, delimiter: str | None) -> list[str]:
    """Returns unquoted cells of a names line between a delimiter (None: blanks), which quotes may contain."""
    if delimiter is None or '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    (cells,) = csv.reader([line], delimiter=delimiter)
    return [cell.strip().strip('"') for cell in cells]


def time_unit(name: str) -> float | None:
    """Unit in s of a time column's name, 0 if unstated; None for no times.

    Example:
        >>> [time_unit(name) for name in ("Time [ms]", "t_min", "Elapsed time (s)", "Date/Time", "T [°C]", "ms")]
        [0.001, 60.0, 1.0, 0.0, None, 0.001]
    """
    text = name.strip().strip('"').strip().replace("µ", "u").replace("μ", "u")
    match = _NAMED.fullmatch(text) if len(text) <= _LONGEST_NAME else None
    return None if match is None else seconds_of_unit((match["unit"] or match["alone"] or "").lower())


def time_columns(names: Sequence[str]) -> list[int]:
    """Which of some columns are called times."""
    return [i for i, name in enumerate(names) if time_unit(name) is not None]


def without_quotes(line: str) -> str:
    """A comma-separated line with numbers in quotes, which may have decimal commas, as plain numbers.

    Example:
        >>> without_quotes('0.01,"1,5","-2,25"'), without_quotes('"0.02","1","1,234.5"')
        ('0.01,1.5,-2.25', '0.02,1,1234.5')
    """
    return _QUOTED.sub(lambda cell: ungrouped(cell[1]).replace(",", "."), line)


def seconds_of_time(text: str) -> float | None:
    """Seconds of a time of day, or since 2020 of an ISO 8601 time, or None.

    Of other dates, whose order is unknown, only the time of day counts.

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
        return 3600.0 * hours + 60.0 * int(match[2]) + float(re.sub("[,:]", ".", match[3]))
    return (moment - (_SINCE.replace(tzinfo=UTC) if moment.tzinfo else _SINCE)).total_seconds()


def with_columns(
    lines: Iterator[str], delimiter: str | None, changes: Mapping[int, Callable[[str], str]]
) -> Iterator[str]:
    """Yields lines of cells between a delimiter (None: blanks), with those of some columns replaced by their change."""
    for line in lines:
        cells = line.split(delimiter)
        for column, change in changes.items():
            if column < len(cells):
                cells[column] = change(cells[column])
        yield (delimiter or " ").join(cells)


class CountedSeconds:
    """Times of day or dates as seconds from the first one, also beyond midnight."""

    def __init__(self) -> None:
        self._first: float | None = None
        self._last = 0.0
        self._days = 0.0

    def __call__(self, cell: str) -> str:
        seconds = seconds_of_time(cell)
        if seconds is None:
            return cell
        if self._first is None:
            self._first = seconds
            self._last = seconds
        if seconds < self._last - 0.5 * _DAY:
            self._days += _DAY
        self._last = seconds
        return f"{seconds - self._first + self._days:.6f}"
