"""Rows of steps that stay in the files in which each recording's result is kept, and tables that are written of them.

A study of any size holds the means of its recordings in memory; its steps are read when they are written or fitted.
"""

import json
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, overload

import numpy as np

from plantar.common.atomic import replacing
from plantar.common.optional_library import optional_library
from plantar.common.table_writer import mapping_rows, write_csv_rows
from plantar.errors import InputError

Rows = Sequence[Mapping[str, Any]]
_GROUP = 20_000  # rows that a Parquet file keeps together


class StoredRows(Rows):
    """Rows of a stored result's steps, read from its file each time: a count, and no more, in memory."""

    def __init__(self, path: Path, count: int) -> None:
        self.path = path
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

    def _read(self) -> list[Mapping[str, Any]]:
        try:
            with self.path.open("rb") as stream, np.load(stream, allow_pickle=False) as held:
                names, values = json.loads(held["rows"].tobytes())
                return [dict(zip(names, row, strict=True)) for row in values]
        except Exception as error:  # removed or cut short while the study goes on
            raise InputError(f"{self.path}: the stored steps are gone ({error}); run the study again") from None


def in_columns(rows: Rows) -> tuple[list[str], list[list[Any]]]:
    """Names of rows of steps, once, and the values of each; None where a row has none.

    Example:
        >>> in_columns([{"step": 1, "arch_index": 0.2}, {"step": 2}])
        (['step', 'arch_index'], [[1, 0.2], [2, None]])
    """
    names = columns_of(rows, ())
    return names, list(map(list, mapping_rows(names, rows)))


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


def write_csv(path: Path, names: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> Path:
    """Write a table of rows as they come; returns the path."""
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", errors="replace", newline="") as stream:
        write_csv_rows(stream, [names])
        write_csv_rows(stream, mapping_rows(names, rows))
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


def _cell(value: Any, text: bool) -> Any:
    if text:
        return "" if value is None else str(value)
    return None if value is None else float(value)
