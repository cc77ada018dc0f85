"""Rows of steps that stay in the files in which each recording's result is kept, and tables that are written of them.

A study of any size holds the means of its recordings in memory; its steps are read when they are written or fitted.
"""

import csv
import json
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, overload

import numpy as np

from plantar.common.atomic import replacing
from plantar.common.optional_library import optional_library
from plantar.common.table_writer import csv_row, mapping_rows, original_cell, write_csv_rows
from plantar.errors import InputError

Rows = Sequence[Mapping[str, Any]]
TEXTS = ("side", "note")  # cells of a step that are no numbers
_GROUP = 20_000  # rows that a Parquet file keeps together


class StoredRows(Rows):
    """Rows of a stored result's steps, read from its file each time: their names and count, and no more, in memory."""

    def __init__(self, path: Path, names: Sequence[str], count: int) -> None:
        self.path = path
        self.names = names
        self._count = count
        self.folder: KeptFolder | None = None  # kept as long as these rows, where nobody else keeps it

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Mapping[str, Any]: ...

    @overload
    def __getitem__(self, index: slice) -> Rows: ...

    def __getitem__(self, index: int | slice) -> Any:
        return self._read()[index]

    def __iter__(self) -> Iterator[Mapping[str, Any]]:
        return iter(self._read())

    def lines(self) -> list[str]:
        """Each row as it stands in a CSV table, without the line's end."""
        try:
            with self.path.open("rb") as stream, np.load(stream, allow_pickle=False) as held:
                lines: list[str] = json.loads(held["rows"].tobytes())
                return lines
        except Exception as error:  # removed or cut short while the study goes on
            raise InputError(f"{self.path}: the stored steps are gone ({error}); run the study again") from None

    def _read(self) -> list[Mapping[str, Any]]:
        texts = [name in TEXTS for name in self.names]
        return [
            {
                name: original_cell(cell) if text else _number(cell)
                for name, text, cell in zip(self.names, texts, cells, strict=True)
            }
            for cells in csv.reader(self.lines())
        ]


def in_lines(rows: Rows) -> tuple[list[str], list[str]]:
    """Names of rows of steps, once, and each row as it stands in a CSV table, without the line's end.

    What measures a recording writes its rows as text: with several processes this is what would else be left to one.

    Example:
        >>> in_lines([{"step": 1, "arch_index": 0.2}, {"step": 2}])
        (['step', 'arch_index'], ['1,0.2', '2,'])
    """
    names = columns_of(rows, ())
    return names, [csv_row(cells)[:-1] for cells in mapping_rows(names, rows)]


class KeptFolder:
    """A temporary folder that lives as long as the rows that lie in it."""

    def __init__(self) -> None:
        folder = TemporaryDirectory(prefix="plantar-")
        self.path = Path(folder.name)
        weakref.finalize(self, folder.cleanup)

    def keep_for(self, each: Iterable[Rows]) -> None:
        """Keep it for stored rows; others hold what they need."""
        for rows in each:
            if isinstance(rows, StoredRows):
                rows.folder = self


def write_steps(
    path: Path, names: Sequence[str], parts: Iterable[tuple[Mapping[str, Any], Rows, Mapping[str, Any]]]
) -> Path:
    """Write a table of steps, one recording after another; returns the path.

    `parts`: what stands before each row of a recording, its rows, and what stands after each.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", errors="replace", newline="") as stream:
        write_csv_rows(stream, [names])
        for before, rows, after in parts:
            if isinstance(rows, StoredRows) and [*before, *rows.names, *after] == names:
                start = csv_row(list(before.values()))[:-1]
                end = csv_row(list(after.values()))
                stream.writelines(f"{start},{line},{end}" for line in rows.lines())
            else:
                write_csv_rows(stream, mapping_rows(names, ({**before, **row, **after} for row in rows)))
    return path


def write_parquet(path: Path, names: Sequence[str], rows: Iterable[Mapping[str, Any]], texts: set[str]) -> Path:
    """Write rows as they come, by pyarrow (optional); returns the path.

    `texts`: columns of text; the others are numbers, empty where unknown. DependencyError without pyarrow.
    """
    with optional_library("pyarrow", "parquet"):
        import pyarrow
        import pyarrow.parquet as parquet
    kinds = [pyarrow.string() if name in texts else pyarrow.float64() for name in names]
    schema = pyarrow.schema(list(zip(names, kinds, strict=True)))
    with replacing(path) as temporary, parquet.ParquetWriter(temporary, schema) as writer:
        for group in _groups(rows):
            columns = [[_cell(row.get(name), name in texts) for row in group] for name in names]
            arrays = [pyarrow.array(column, kind) for column, kind in zip(columns, kinds, strict=True)]
            writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))
    return path


def columns_of(heads: Iterable[Mapping[str, Any]], last: Sequence[str]) -> list[str]:
    """Names of all columns in order of appearance, `last` ones at the end."""
    names: dict[str, None] = {}
    for row in heads:
        if not names.keys() >= row.keys():
            names |= dict.fromkeys(row)
    ends = [name for name in last if name in names]
    return [*(name for name in names if name not in ends), *ends]


def _groups(rows: Iterable[Mapping[str, Any]]) -> Iterator[list[Mapping[str, Any]]]:
    group: list[Mapping[str, Any]] = []
    for row in rows:
        group.append(row)
        if len(group) == _GROUP:
            yield group
            group = []
    if group:
        yield group


def _number(cell: str) -> float | None:
    if not cell:
        return None
    return int(cell) if cell.lstrip("-").isdigit() else float(cell)


def _cell(value: Any, text: bool) -> Any:
    if text:
        return "" if value is None else str(value)
    return None if value is None else float(value)
