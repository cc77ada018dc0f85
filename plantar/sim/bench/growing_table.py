"""A table that grows by a row a run, so that a benchmark that was stopped goes on where it was."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plantar.csv_table import original_cell, write_csv_rows
from plantar.errors import InputError

__all__ = ["GrowingTable"]


class GrowingTable:
    """A CSV file whose rows are appended, each as its run ends.

    What a run that was killed left of a row is cut off. The file is made by the first row.

    Args:
        path: The file; its folder exists when the first row is added.
        columns: Its columns.
        what: What it is a table of, for the message that refuses another one.

    Attributes:
        rows: Its rows, as text by column.

    Raises:
        InputError: If the file has other columns.

    Example:
        >>> from tempfile import TemporaryDirectory
        >>> with TemporaryDirectory() as folder:
        ...     GrowingTable(Path(folder, "runs.csv"), ("seed", "time"), "runs").add({"seed": 3, "time": 0.5})
        ...     GrowingTable(Path(folder, "runs.csv"), ("seed", "time"), "runs").rows
        [{'seed': '3', 'time': '0.5'}]
    """

    def __init__(self, path: Path, columns: Sequence[str], what: str) -> None:
        self._path, self._columns = path, tuple(columns)
        self.rows: list[dict[str, str]] = []
        if not path.exists():
            return
        text = path.read_text(encoding="utf-8")
        whole = text[: text.rfind("\n") + 1]
        reader = csv.DictReader(io.StringIO(whole))
        if tuple(reader.fieldnames or ()) != self._columns:
            raise InputError(f"{path} is no table of {what}: its first line has to be {','.join(self._columns)}")
        self.rows = [{name: original_cell(text or "") for name, text in row.items()} for row in reader]
        if whole != text:
            path.write_text(whole, encoding="utf-8")

    def add(self, row: Mapping[str, Any]) -> None:
        """Append a row.

        Args:
            row: Values by column; what it leaves out is empty.
        """
        whole = {name: str(row.get(name, "")) for name in self._columns}
        new = not self._path.exists()
        with self._path.open("a", newline="", encoding="utf-8") as file:
            write_csv_rows(file, [*([self._columns] if new else []), list(whole.values())])
        self.rows.append(whole)
