"""ROS bags with topics that carry an array of numbers: a ROS 2 bag (folder, .db3, .mcap) or a ROS 1 bag (.bag).

Any message with a numeric array will do, for example std_msgs/Float64MultiArray or one of a robot's own. Topics and
fields that name a foot are the feet. ROS messages are in SI units by agreement (REP 103), and do not state them: what a
topic or field calls a force is taken as N, a pressure as Pa, anything else as raw counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, FormatError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.layout import Side
from plantar.pressure_recording import FootRecording, PressureRecording, sampling

__all__ = ["FORMAT", "read_bag"]

_LEAST_CELLS = 3
_DEPTH = 3


def _recognises(head: bytes) -> bool:
    return head.startswith(b"#ROSBAG V2.0") or (head.startswith(b"SQLite format 3\0") and b"topics" in head)


def read_bag(path: Path, options: ReadOptions) -> PressureRecording:
    """Read the arrays of a bag.

    Args:
        path: Folder of a ROS 2 bag, or one of its files.
        options: Layout, unit and side, which a bag does not hold.

    Returns:
        The recording.

    Raises:
        FormatError: If the bag is damaged or holds no topic with an array of numbers.
        DependencyError: If rosbags is not installed.
    """
    if not path.exists() or (path.is_dir() and not (path / "metadata.yaml").is_file()):
        raise FormatError(f"{path}: cannot be read (no such file, or a folder that is no ROS 2 bag)")
    try:
        import rosbags  # noqa: F401  0.1 s: only where a bag is read
    except ImportError:
        raise DependencyError("rosbags", "formats") from None
    try:
        series = _series(path)
    except FormatError:
        raise
    except Exception as error:  # the library raises what its parsing happens to hit: SQLite, YAML, struct, codec errors
        text = " ".join(str(error).split())[:200]
        raise FormatError(f"{path}: not a ROS bag that can be read ({type(error).__name__}: {text})") from None
    if not series:
        raise FormatError(f"{path}: no topic of the bag carries an array of {_LEAST_CELLS} numbers or more")
    warnings: list[str] = []
    named = {key: side_of(key.replace("/", " ")) for key in series}
    by_side: dict[Side, str] = {}
    for key, side in named.items():
        if side is not None:
            better = len(series[key][1]) > len(series[by_side[side]][1]) if side in by_side else True
            if better:
                by_side[side] = key
    chosen = list(by_side.values()) or [max(series, key=lambda k: len(series[k][1]))]
    left_out = sorted(set(series) - set(chosen))
    if left_out:
        warnings.append(f"other arrays are left out: {', '.join(left_out)}")
    words = " ".join(chosen).lower()
    agreed = "N" if "force" in words or "wrench" in words else "Pa" if "pressure" in words else None
    if agreed and options.unit is None:
        warnings.append(f"ROS messages state no unit: {agreed} is assumed from their names (--unit overrides)")
    unit = unit_of_values(agreed, options, warnings, "the bag")
    stamps, first = series[chosen[0]]
    time, rate, notes = sampling(stamps - stamps[0], options.rate_hz)
    feet: dict[Side, FootRecording] = {}
    if by_side:
        for side in ("left", "right"):
            if side in by_side:
                own, values = series[by_side[side]]
                if len(own) != len(stamps) or np.abs(own - stamps).max() > 1e-6:
                    warnings.append(f"the {side} foot has its own times: interpolated to those of the other")
                    values = _resampled(stamps, own, values)
                feet[side] = cells_of_foot(side, values, unit, options, warnings)
    else:
        for side, values in halves(first, options, warnings):
            feet[side] = cells_of_foot(side, values, unit, options, warnings)
    if len(feet) == 1:
        warnings.append(f"the bag holds the {next(iter(feet))} foot only")
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


def _series(path: Path) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Times (n,) in s and values (n, k) of each array in each topic, by "<topic>/<field>"."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    gathered: dict[str, tuple[list[float], list[NDArray[np.float64]]]] = {}
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
                times, rows = gathered.setdefault(f"{connection.topic}/{name}", ([], []))
                times.append(seconds)
                rows.append(values)
            if not found and not gathered.get(connection.topic):
                skipped.add(connection.topic)
    out: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}
    for key, (times, rows) in gathered.items():
        width = int(np.median([len(r) for r in rows]))
        values = np.full((len(rows), width), np.nan)
        for i, row in enumerate(rows):
            if len(row) == width:
                values[i] = np.where(np.isfinite(row), row, np.nan)
        order = np.argsort(times, kind="stable")
        if len(rows) > 1:
            out[key] = np.array(times)[order], values[order]
    return out


def _arrays(message: Any, depth: int) -> Iterator[tuple[str, NDArray[np.float64]]]:
    """Numeric arrays of a message and of the messages in it."""
    for name in getattr(message, "__dataclass_fields__", {}):
        value = getattr(message, name, None)
        if isinstance(value, np.ndarray) and value.dtype.kind in "iuf":
            if value.size >= _LEAST_CELLS:
                yield name, np.asarray(value, dtype=float).reshape(-1)
        elif depth and name not in ("layout", "header") and hasattr(value, "__dataclass_fields__"):
            for inner, array in _arrays(value, depth - 1):
                yield f"{name}/{inner}", array


def _resampled(time: NDArray[np.float64], own: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values at other times, NaN outside their own."""
    return np.column_stack([np.interp(time, own, column, left=np.nan, right=np.nan) for column in values.T])


FORMAT = Format(
    name="rosbag",
    title="ROS bag with a topic of numbers, with --layout",
    suffixes=(".db3", ".mcap", ".bag", "folder"),
    recognises=_recognises,
    read=read_bag,
    folders="metadata.yaml",
)
"""The entry of the registry."""
