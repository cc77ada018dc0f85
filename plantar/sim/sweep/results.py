"""The rows of a sweep: a growing table, for one process at a time."""

import csv
import json
import os
import re
import socket
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from plantar.common.atomic import write_text
from plantar.common.files.structured_text import read_json
from plantar.common.table_writer import csv_row, original_cell
from plantar.errors import InputError
from plantar.sim.sweep.inputs import changes
from plantar.sim.sweep.plan import Key
from plantar.sim.sweep.value_range import canonical, is_word

_NAME = ".sweep.lock"
_PLACE = 1 << 20  # where Windows locks a byte: behind the owner's name, which stays readable


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold an existing folder's lock, which ends with its owner."""
    path = folder / _NAME
    handle = _acquire(path)
    try:
        os.ftruncate(handle, 0)
        os.write(handle, f"process {os.getpid()} on {socket.gethostname()}".encode())
        yield
    finally:
        with suppress(OSError):  # Windows does not delete what is open
            path.unlink(missing_ok=True)
        os.close(handle)


def _acquire(path: Path) -> int:
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(handle):
                owner = _owner(handle)
                raise InputError(
                    f"another sweep{owner} writes to {path.parent}; wait for its end or choose another folder with -o"
                )
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(handle), os.stat(path)):
                    return handle
        except BaseException as error:
            os.close(handle)
            if isinstance(error, OSError):
                raise InputError(
                    f"{path.parent} cannot be locked ({error.strerror}); choose a folder on another disk with -o"
                ) from None
            raise
        os.close(handle)  # its owner has just ended and deleted it: the next process makes another one


def _lock(handle: int) -> bool:
    """Lock an open file for this process; False where another has it."""
    if sys.platform == "win32":
        import msvcrt

        os.lseek(handle, _PLACE, os.SEEK_SET)
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        finally:
            os.lseek(handle, 0, os.SEEK_SET)
        return True
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _owner(handle: int) -> str:
    with suppress(OSError):
        os.lseek(handle, 0, os.SEEK_SET)
        if found := os.read(handle, 200).decode(errors="replace"):
            return f" ({found})"
    return ""


_BREAKS = re.compile("[\\r\\n\\0]+")


class Results:
    """Rows of results.csv, open to append to, made by `open_results`.

    `rows`: its rows by values of their axes and their seed.
    """

    def __init__(self, path: Path, axes: Sequence[str], columns: Sequence[str]) -> None:
        self.path = path
        self.axes = tuple(axes)
        self.header = (*self.axes, "seed", *columns)
        self.rows: dict[Key, dict[str, str]] = {}
        head = _line(self.header)
        if not path.exists():
            write_text(path, head.decode())
        whole = self._read(path.read_bytes(), head)
        self._handle = os.open(path, os.O_RDWR | os.O_APPEND)
        # A run that was killed while it wrote may have left a part of a row: what is whole stays untouched.
        os.ftruncate(self._handle, whole)
        os.fsync(self._handle)
        self._size = whole

    def append(self, row: Mapping[str, Any]) -> None:
        """Add a row to file and table, on disk or not at all; line breaks become spaces."""
        texts = {name: _BREAKS.sub(" ", str(row[name])) for name in self.header}
        key = self._key(texts)
        if key in self.rows:
            raise ValueError(f"a second row of {key}")
        line = _line([texts[name] for name in self.header])
        try:
            if os.write(self._handle, line) != len(line):
                raise OSError(0, "no space left")
            os.fsync(self._handle)
        except OSError as error:
            os.ftruncate(self._handle, self._size)
            raise InputError(f"{self.path} cannot be written ({error.strerror})") from None
        self._size += len(line)
        self.rows[key] = texts

    def close(self) -> None:
        """Close the file."""
        os.close(self._handle)

    def _read(self, data: bytes, head: bytes) -> int:
        end = data.rfind(b"\n", 0, data.find(b"\0") if b"\0" in data else len(data)) + 1
        lines = data[:end].decode("utf-8-sig").split("\n")[:-1]
        csv.field_size_limit(max(csv.field_size_limit(), end))  # a long walk has a long row
        if not lines or _cells(lines[0]) != list(self.header):
            raise InputError(f"{self.path} has other columns than this sweep; choose another folder with -o")
        for i, line in enumerate(lines[1:], 2):
            cells = _cells(line)
            row = dict(zip(self.header, cells, strict=False))
            try:
                key = self._key(row)
            except (KeyError, ValueError, InputError):
                key = None
            if key is None or len(cells) != len(self.header) or key in self.rows:
                what = "of a run that has one already" if key in self.rows else "not a row of this sweep"
                raise InputError(f"{self.path}, line {i} is {what}; delete that line")
            self.rows[key] = row
        return end

    def _key(self, row: Mapping[str, str]) -> Key:
        return tuple(canonical(row[axis], word=is_word(axis)) for axis in self.axes), int(row["seed"])


@contextmanager
def open_results(
    folder: Path,
    identity: Mapping[str, Any],
    inputs: Mapping[str, Mapping[str, str]],
    axes: Sequence[str],
    columns: Sequence[str],
) -> Iterator[Results]:
    """Open a sweep's results in a `folder` (made if needed), new or stopped, for this process alone; yields the table.

    `identity` is what all rows share (`Sweep.identity`), `inputs` per robot what its rows depend on (`inputs_of`),
    `axes` the grid's settings and first columns, `columns` those after the seed. An InputError if the folder is
    unusable, in use, or another sweep's.
    """
    path = folder / "results.csv"
    plan = folder / "sweep.json"
    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            stack.enter_context(locked(folder))
            if path.exists() and not plan.exists():
                raise InputError(f"{path} is there without sweep.json; choose another folder with -o")
            known = _known_inputs(plan, identity, inputs) if path.exists() else {}
            write_text(plan, json.dumps({**identity, "inputs": {**known, **inputs}}, indent=1) + "\n")
            results = stack.enter_context(closing(Results(path, axes, columns)))
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or error
            raise InputError(f"sweep folder {folder} cannot be used ({why}); choose another one with -o") from None
        yield results


def _known_inputs(
    plan: Path, identity: Mapping[str, Any], inputs: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    before = read_json(plan, InputError, str(plan))
    folder = plan.parent
    other = f"{folder} holds the results of another sweep"
    try:
        known = {robot: dict(found) for robot, found in before["inputs"].items()}
        differ = [name for name in identity if before[name] != identity[name]]
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError(f"{other}, or of another version of Plantar; choose another folder with -o") from None
    if differ:
        how = "; ".join(f"{k} was {json.dumps(before[k])} and is {json.dumps(identity[k])}" for k in differ)
        raise InputError(f"{other} ({how}); choose another folder with -o")
    for robot in inputs.keys() & known.keys():
        what = changes(known[robot], inputs[robot])
        if what:
            raise InputError(f"{what} since {folder} was begun; bring that back, or choose another folder with -o")
    return known


def _line(cells: Sequence[str]) -> bytes:
    return csv_row(cells).encode(errors="backslashreplace")


def _cells(line: str) -> list[str]:
    return [original_cell(cell) for cell in next(csv.reader([line]), [])]
