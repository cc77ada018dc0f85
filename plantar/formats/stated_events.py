"""Heel strikes and toe offs that somebody else found: a vendor's report of steps, or a table of events."""

from __future__ import annotations

import csv
import io
import os
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.files.input_file import open_input
from plantar.formats.side import side_of
from plantar.formats.text import number
from plantar.recordings.pressure_recording import StatedEvents
from plantar.sides import SIDES, Side

__all__ = ["read_events"]

_LARGEST = 50_000_000
"""Bytes of a report or of one of its parts that are read."""

_SHEET = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_LINK = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


def read_events(path: str | os.PathLike[str]) -> dict[Side, StatedEvents]:
    """Read the events of both feet.

    Args:
        path: A Moticon report (.xlsx) with the sheets "Left Steps" and "Right Steps", whose second and third columns
        are
            initial contact and toe off in s; or a CSV table with the columns side, heel_strike_s and toe_off_s.

    Returns:
        The events of each foot that the file names.

    Raises:
        FormatError: If the file is neither, or holds no event.
    """
    with open_input(path, FormatError) as stream:
        data = stream.read(_LARGEST)
    try:
        rows = _report_rows(data) if data[:2] == b"PK" else _table_rows(data.decode("utf-8-sig", errors="replace"))
    except (KeyError, ValueError, zipfile.BadZipFile, ElementTree.ParseError):
        rows = {}
    found = {side: _events(pairs) for side, pairs in rows.items() if pairs}
    if not found:
        raise FormatError(
            f"{os.fspath(path)}: no events; allowed: a Moticon report (.xlsx) with sheets of left and right steps, "
            "or a CSV "
            "table with the columns side, heel_strike_s and toe_off_s"
        )
    return {side: found[side] for side in SIDES if side in found}


def _events(pairs: list[tuple[float, float]]) -> StatedEvents:
    table: NDArray[np.float64] = np.array(pairs, dtype=float).reshape(-1, 2)
    return StatedEvents(*(np.sort(column[np.isfinite(column)]) for column in table.T))


def _value(text: str | None) -> float:
    """A time in s; NaN where a text is none."""
    found = None if text is None else number(text)
    return float("nan") if found is None else found


def _table_rows(text: str) -> dict[Side, list[tuple[float, float]]]:
    """Strike and lift of each row of a table, by side."""
    delimiter = ";" if text.partition("\n")[0].count(";") else "," if "," in text.partition("\n")[0] else "\t"
    out: dict[Side, list[tuple[float, float]]] = {}
    for row in csv.DictReader(io.StringIO(text), delimiter=delimiter):
        side = side_of(str(row.get("side", "")))
        if side is not None and "heel_strike_s" in row:
            out.setdefault(side, []).append((_value(row["heel_strike_s"]), _value(row.get("toe_off_s"))))
    return out


def _report_rows(data: bytes) -> dict[Side, list[tuple[float, float]]]:
    """Strike and lift of each row of the sheets that a side's steps are on."""
    out: dict[Side, list[tuple[float, float]]] = {}
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for name, part in _sheets(archive).items():
            side = side_of(name)
            if side is None or "step" not in name.lower():
                continue
            for row in _root(archive, part).iter(f"{_SHEET}row"):
                cells = {re.sub(r"\d", "", c.get("r", "")): c for c in row}
                strike, lift = (_number(cells.get(column)) for column in ("B", "C"))
                if np.isfinite(strike):
                    out.setdefault(side, []).append((strike, lift))
    return out


def _number(cell: ElementTree.Element | None) -> float:
    """Number of a cell; NaN where it holds a text, which is kept elsewhere, or nothing."""
    return float("nan") if cell is None or cell.get("t") == "s" else _value(cell.findtext(f"{_SHEET}v"))


def _root(archive: zipfile.ZipFile, part: str) -> ElementTree.Element:
    """A part of a report as XML; refused where it is large or declares entities, which may unpack without end."""
    if archive.getinfo(part).file_size > _LARGEST:
        raise ValueError("too large")
    data = archive.read(part)
    if b"<!ENTITY" in data or b"<!DOCTYPE" in data:
        raise ValueError("a document type in a report")
    return ElementTree.fromstring(data)


def _sheets(archive: zipfile.ZipFile) -> Mapping[str, str]:
    """Path of each sheet by its name."""
    links = {r.get("Id"): r.get("Target", "") for r in _root(archive, "xl/_rels/workbook.xml.rels")}
    sheets = _root(archive, "xl/workbook.xml").iter(f"{_SHEET}sheet")
    return {s.get("name", ""): str(Path("xl") / links.get(s.get(_LINK), "").removeprefix("/xl/")) for s in sheets}
