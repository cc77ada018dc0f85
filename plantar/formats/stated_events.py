"""Heel strikes and toe offs of another program."""

import os
import re
import zipfile
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import open_input
from plantar.common.files.text_table import read_text_table
from plantar.common.files.xml_file import parse_xml
from plantar.common.files.zip_archive import open_archive, read_part
from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.side import side_of
from plantar.formats.text import number
from plantar.recordings.pressure_recording import StatedEvents

_MOST = 50e6  # bytes that a report may unpack to
_MOST_SHEETS = 200
_MOST_ROWS = 100_000
_SHEET = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_LINK = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"
_ALLOWED = (
    "allowed: a Moticon report (.xlsx) with sheets of left and right steps, or a CSV table with the columns side, "
    "heel_strike_s and toe_off_s"
)
# Heel strike and toe off in s, NaN where there is none, of each row by its number, by side.
Pairs = dict[Side, dict[int, tuple[float, float]]]


def read_events(path: str | os.PathLike[str]) -> dict[Side, StatedEvents]:
    """Read each foot's events from a file.

    `path`: moticon report (.xlsx) whose sheets "Left Steps" and "Right Steps" have initial contact and toe off in s as
    second and third columns; or CSV with columns side, heel_strike_s and toe_off_s.
    """
    with open_input(path, FormatError) as stream:
        zipped = stream.read(2) == b"PK"
    rows = _report_rows(path) if zipped else _table_rows(path)
    if not rows:
        raise FormatError(f"{os.fspath(path)}: no events; {_ALLOWED}")
    return {side: _events(path, side, rows[side]) for side in SIDES if side in rows}


def _events(path: str | os.PathLike[str], side: Side, rows: dict[int, tuple[float, float]]) -> StatedEvents:
    # A row may be repeated; by its text, as NaN equals nothing.
    pairs = {repr(pair): (line, pair) for line, pair in rows.items() if np.isfinite(pair).any()}
    last = -np.inf
    for line, pair in sorted(pairs.values(), key=lambda row: float(np.nanmin(row[1]))):
        times = [at for at in pair if np.isfinite(at)]
        if not np.all(np.diff([last, *times]) > 0.0):
            raise FormatError(
                f"{os.fspath(path)}, line {line}: the {side} foot lands at {pair[0]:g} s and lifts at {pair[1]:g} s, "
                "out of order; allowed: each toe off after its heel strike and before the foot's next one"
            )
        last = times[-1]
    table: NDArray[np.float64] = np.array(list(rows.values()), dtype=float).reshape(-1, 2)
    return StatedEvents(*(np.unique(column[np.isfinite(column)]) for column in table.T))


def _table_rows(path: str | os.PathLike[str]) -> Pairs:
    table = read_text_table(path, FormatError)
    columns = [table.column(name) for name in ("side", "heel_strike_s", "toe_off_s")]
    out: Pairs = {}
    if None in columns[:2]:
        return out
    for line, cells in table.rows:
        text, *times = ("" if at is None or at >= len(cells) else cells[at].strip() for at in columns)
        side = side_of(text)
        if side is None:
            raise FormatError(f"{path}, line {line}: side is {text[:40]!r}, so it has no events; allowed: left, right")
        values = [float("nan") if not time else number(time) for time in times]
        if None in values:
            raise FormatError(f"{path}, line {line}: a time is none; allowed: numbers in s, or empty")
        out.setdefault(side, {})[line] = (values[0] or 0.0, values[1] or 0.0)
    return out


def _report_rows(path: str | os.PathLike[str]) -> Pairs:
    out: Pairs = {}
    with open_archive(path, FormatError, _MOST) as (archive, _):
        for name, part in _sheets(path, archive):
            side = side_of(name)
            if side is None or "step" not in name.lower():
                continue
            for count, row in enumerate(_root(path, archive, part).iter(f"{_SHEET}row"), 1):
                if count > _MOST_ROWS:
                    raise FormatError(f"{path}: a sheet of more than {_MOST_ROWS} rows")
                cells = {re.sub(r"\d", "", c.get("r", "")): c for c in row}
                strike, lift = (_number(cells.get(column)) for column in ("B", "C"))
                if np.isfinite(strike):
                    out.setdefault(side, {})[count] = (strike, lift)
    return out


def _number(cell: ElementTree.Element | None) -> float:
    text = None if cell is None or cell.get("t") == "s" else cell.findtext(f"{_SHEET}v")
    found = None if text is None else number(text)
    return float("nan") if found is None else found


def _root(path: str | os.PathLike[str], archive: zipfile.ZipFile, part: str) -> ElementTree.Element:
    return parse_xml(read_part(archive, part, FormatError, f"{path}: no events ({part[:80]})"), FormatError, str(path))


def _sheets(path: str | os.PathLike[str], archive: zipfile.ZipFile) -> list[tuple[str, str]]:
    links = {r.get("Id"): r.get("Target", "") for r in _root(path, archive, "xl/_rels/workbook.xml.rels")}
    sheets = list(_root(path, archive, "xl/workbook.xml").iter(f"{_SHEET}sheet"))
    if len(sheets) > _MOST_SHEETS:
        raise FormatError(f"{path}: a report of {len(sheets)} sheets; allowed: up to {_MOST_SHEETS}")
    found = [(s.get("name", ""), f"xl/{links.get(s.get(_LINK), '').removeprefix('/xl/')}") for s in sheets]
    return list({part: (name, part) for name, part in found}.values())
