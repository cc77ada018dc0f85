"""ROS bags with number arrays: ROS 2 (folder, .db3, .mcap) or ROS 1 (.bag).

Topics and fields that name a foot are the feet. Units are SI (REP 103): named forces in N, pressures in Pa, others raw
counts.
"""

import os
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input, is_file
from plantar.common.files.structured_text import JSON_MOST
from plantar.common.sides import SIDES
from plantar.errors import DependencyError, FormatError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import on_one_time, side_of
from plantar.layouts.layout import Side
from plantar.recordings.frame_table import FrameTable
from plantar.recordings.pressure_recording import PressureRecording, sampling

# Numbers in an array that may be a sole: a picture has more
_LEAST_CELLS = 3
_MOST_CELLS = 20_000
_DEPTH = 3
_FOLDERS = "metadata.yaml"


def read_bag(path: Path, options: ReadOptions) -> PressureRecording:
    """Returns recording of a bag's arrays.

    `path`: ROS 2 bag folder, or one of its files; `options`: layout, unit and side, which bags lack.
    """
    if os.path.isdir(path) and not is_file(path / _FOLDERS):
        raise FormatError("cannot be read (a folder that is no ROS 2 bag)")
    if find_spec("rosbags") is None:
        raise DependencyError("rosbags", "formats")
    held = read_apart("bag", path, FormatError, _size(path))
    series = {name: (held[f"{name}:times"], held[f"{name}:values"]) for name in held["names"].tolist()}
    if not series:
        raise FormatError(
            f"no topic of the bag carries an array of {_LEAST_CELLS} to {_MOST_CELLS} numbers more than once"
        )
    warnings: list[str] = []
    by_side: dict[Side, str] = {}
    for key in sorted(series, key=lambda k: -len(series[k][1])):  # of several arrays of a foot the longest
        side = side_of(key.replace("/", " "))
        if side is not None:
            by_side.setdefault(side, key)
    chosen = list(by_side.values()) or [max(series, key=lambda k: len(series[k][1]))]
    if left_out := sorted(set(series) - set(chosen)):
        warnings.append(f"other arrays are left out: {', '.join(left_out)}")
    words = " ".join(chosen).lower()
    agreed = "N" if "force" in words or "wrench" in words else "Pa" if "pressure" in words else None
    if agreed and options.unit is None:
        warnings.append(f"ROS messages state no unit: {agreed} is assumed from their names (--unit overrides)")
    unit = unit_of_values(agreed, options, warnings, "the bag")
    stamps, values = series[chosen[0]]
    if by_side:
        stamps, parts = on_one_time({s: series[by_side[s]] for s in SIDES if s in by_side}, warnings)
    else:
        parts = dict(halves(values, options, warnings))
    time, rate, notes = sampling(stamps - stamps[0], None, options.rate_hz)
    feet = {side: cells_of_foot(side, part, unit, options, warnings) for side, part in parts.items()}
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={"topics": chosen, "unit": unit.name},
        warnings=(*warnings, *notes),
        raw=unit.kind == "raw",
        kind="robot",
    )


def _size(path: Path) -> int:
    if not os.path.isdir(path):
        return check_input(path, FormatError)
    check_input(path / _FOLDERS, FormatError, JSON_MOST)
    return sum(check_input(p, FormatError) for p in path.iterdir() if p.suffix != "")


class _Series:
    def __init__(self) -> None:
        self.times: list[float] = []
        self.widths: list[int] = []
        self.rows: dict[int, FrameTable] = {}

    def add(self, time: float, row: NDArray[np.float64]) -> None:
        self.times.append(time)
        self.widths.append(len(row))
        self.rows.setdefault(len(row), FrameTable(len(row), 0)).add(row[None])

    def table(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Times (n,) in s, in order, and values (n, k); NaN for messages of unusual length."""
        width = int(np.median(self.widths))
        width = width if width in self.rows else max(self.rows, key=lambda w: len(self.rows[w]))
        values = np.full((len(self.times), width), np.nan)
        values[np.array(self.widths) == width] = self.rows[width].rows
        values[~np.isfinite(values)] = np.nan
        order = np.argsort(self.times, kind="stable")
        return np.array(self.times)[order], values[order]


def series_of_bag(path: Path) -> dict[str, Any]:
    """Arrays of a bag, a ROS 2 folder or file; called in a separate process.

    Returns "names" of the arrays, "<topic>/<field>", and of each "<name>:times" (n,) in s and "<name>:values" (n, k).
    """
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    gathered: dict[str, _Series] = {}
    with AnyReader([path], default_typestore=get_typestore(Stores.LATEST)) as reader:
        skipped: set[str] = set()
        for connection, nanoseconds, data in reader.messages():
            if connection.topic in skipped:
                continue
            message = reader.deserialize(data, connection.msgtype)
            found = False
            stamp = getattr(getattr(message, "header", None), "stamp", None)
            seconds = nanoseconds * 1e-9 if stamp is None else float(stamp.sec) + 1e-9 * float(stamp.nanosec)
            for name, values in _arrays(message, _DEPTH):
                found = True
                gathered.setdefault(f"{connection.topic}/{name}", _Series()).add(seconds, values)
            if not found:
                skipped.add(connection.topic)
    out: dict[str, Any] = {}
    names = [name for name, series in gathered.items() if len(series.times) > 1]
    for name in names:
        out[f"{name}:times"], out[f"{name}:values"] = gathered[name].table()
    return {"names": np.array(names, dtype=str), **out}


def _arrays(message: Any, depth: int) -> Iterator[tuple[str, NDArray[np.float64]]]:
    for name in getattr(message, "__dataclass_fields__", {}):
        value = getattr(message, name, None)
        if isinstance(value, np.ndarray) and value.dtype.kind in "iuf":
            if _LEAST_CELLS <= value.size <= _MOST_CELLS:
                yield name, np.asarray(value, dtype=float).reshape(-1)
        elif depth and name not in ("layout", "header") and hasattr(value, "__dataclass_fields__"):
            for inner, array in _arrays(value, depth - 1):
                yield f"{name}/{inner}", array


FORMAT = Format(
    name="rosbag",
    title="ROS bag with a topic of numbers, with --layout",
    suffixes=(".db3", ".mcap", ".bag", "folder"),
    recognises=lambda head: (
        head.startswith(b"#ROSBAG V2.0") or (head.startswith(b"SQLite format 3\0") and b"topics" in head)
    ),
    read=read_bag,
    folders=_FOLDERS,
    order=18,
)
