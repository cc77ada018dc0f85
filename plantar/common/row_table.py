"""Rows of a CSV file, appended as they come: a whole row stays whatever becomes of the process, and none is twice."""

import csv
import os
import re
import sys
from collections.abc import Callable, Hashable, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from plantar.common.table_writer import csv_row, original_cell
from plantar.errors import InputError

_BREAKS = re.compile("[\\r\\n\\0]+")
_LOCKED = 1 << 40  # the byte, far behind the rows, by which Windows locks the file


class RowTable:
    """A table of rows in a CSV file, for one process at a time; a part of a row that a killed one left is cut off.

    Args:
        path: The file, made if it is missing; its folder must exist.
        columns: Its columns.
        key: What names a row, from its texts by column; an error for a row that is none.

    Attributes:
        rows: Its rows by key, as texts by column.

    Raises:
        InputError: If another process has the file, it cannot be written, or holds other rows.

    Example:
        >>> from tempfile import TemporaryDirectory
        >>> with TemporaryDirectory() as folder:
        ...     for seed in (3, 4):
        ...         with RowTable(Path(folder, "runs.csv"), ("seed", "time"), lambda row: int(row["seed"])) as table:
        ...             table.append({"seed": seed, "time": 0.5})
        ...     table.rows
        {3: {'seed': '3', 'time': '0.5'}, 4: {'seed': '4', 'time': '0.5'}}
    """

    def __init__(self, path: Path, columns: Sequence[str], key: Callable[[Mapping[str, str]], Hashable]) -> None:
        self.path = path
        self._columns = tuple(columns)
        self._key = key
        self.rows: dict[Any, dict[str, str]] = {}
        try:
            self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        except OSError as error:
            raise InputError(f"{path} cannot be written ({error.strerror}); choose another folder with -o") from None
        try:
            self._lock()
            self._size = self._read(path.read_bytes())
            # What is whole stays untouched; what a killed process wrote of a row goes.
            os.ftruncate(self._handle, self._size)
            if self._size == 0:
                self._write(_line(self._columns))
        except BaseException:
            os.close(self._handle)
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        os.close(self._handle)

    def append(self, row: Mapping[str, Any]) -> None:
        """Add a row to file and table, on disk or not at all; line breaks become spaces, a missing value is empty.

        Raises:
            InputError: If the file cannot be written.
            ValueError: If the table has a row of the same key.
        """
        texts = {name: _BREAKS.sub(" ", str(row.get(name, ""))) for name in self._columns}
        key = self._key(texts)
        if key in self.rows:
            raise ValueError(f"a second row of {key}")
        self._write(_line(list(texts.values())))
        self.rows[key] = texts

    def _write(self, line: bytes) -> None:
        try:
            if os.write(self._handle, line) != len(line):
                raise OSError(0, "no space left")
            os.fsync(self._handle)
        except OSError as error:
            os.ftruncate(self._handle, self._size)
            raise InputError(f"{self.path} cannot be written ({error.strerror})") from None
        self._size += len(line)

    def _lock(self) -> None:
        try:
            if sys.platform == "win32":
                import msvcrt

                os.lseek(self._handle, _LOCKED, os.SEEK_SET)
                msvcrt.locking(self._handle, msvcrt.LK_NBLCK, 1)
            else:
                import fcntl

                fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            raise InputError(
                f"another process writes to {self.path}; wait for its end or choose another folder with -o"
            ) from None
        except OSError as error:
            raise InputError(
                f"{self.path} cannot be locked ({error.strerror}); choose a folder on another disk with -o"
            ) from None

    def _read(self, data: bytes) -> int:
        """Bytes of whole rows, which become `rows`."""
        # After a power cut a file may end in zeros.
        end = data.rfind(b"\n", 0, data.find(b"\0") if b"\0" in data else len(data)) + 1
        if end == 0 and _line(self._columns).startswith(data):
            return 0
        try:
            lines = data[:end].decode("utf-8-sig").split("\n")[:-1]
        except UnicodeDecodeError as error:
            raise InputError(f"{self.path} cannot be used ({error}); choose another folder with -o") from None
        csv.field_size_limit(max(csv.field_size_limit(), end))  # a long walk has a long row
        if not lines or _cells(lines[0]) != list(self._columns):
            raise InputError(
                f"{self.path} has other columns than {','.join(self._columns)}; choose another folder with -o"
            )
        for number, line in enumerate(lines[1:], 2):
            self._take(number, _cells(line))
        return end

    def _take(self, number: int, cells: Sequence[str]) -> None:
        row = dict(zip(self._columns, cells, strict=False))
        try:
            key = self._key(row)
        except (KeyError, ValueError, InputError):
            key = None
        if key is None or len(cells) != len(self._columns):
            raise InputError(f"{self.path}, line {number} is no row of this table; delete that line")
        if key in self.rows:
            raise InputError(f"{self.path}, line {number} is a row of a run that has one already; delete that line")
        self.rows[key] = row


def _line(cells: Sequence[str]) -> bytes:
    return csv_row(cells).encode(errors="backslashreplace")


def _cells(line: str) -> list[str]:
    return [original_cell(cell) for cell in next(csv.reader([line]), [])]
