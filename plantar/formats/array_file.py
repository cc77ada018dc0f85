"""Arrays in numpy files (.npz, .npy): a frame a row, a cell a column.

NPZ arrays are "time" (s; ms as "time_ms"), "left" and "right" or one of another name, and optionally "unit", "rate_hz",
"side", "kind" ("insole", "platform", "robot") and "layout_left" (JSON of a layout file), as by `Recording.to_npz`.
"""

import json
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import IO, Any, get_args

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import open_input
from plantar.common.files.structured_text import JSON_MOST
from plantar.common.files.zip_archive import open_archive
from plantar.common.sides import SIDES
from plantar.errors import FormatError, LayoutError, PlantarError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.field_names import heading_of
from plantar.formats.format import Format, ReadOptions
from plantar.formats.grid_file import opened_array, read_header
from plantar.formats.side import on_one_time, side_of
from plantar.formats.stated_rate import in_seconds, or_usual, stated_rate
from plantar.formats.table_text import time_unit
from plantar.layouts.layout import Side, SoleLayout
from plantar.layouts.layout_file import layout_from_dict
from plantar.recordings.frame_table import LARGE, MOST_VALUES, let_go, put_rows, room
from plantar.recordings.pressure_recording import Kind, PressureRecording, sampling

_SLOWEST = 0.05  # s of a frame of times that are taken to be in ms, us or ns
_LARGEST = 4e9  # Largest size of all arrays in bytes
_NO_LOADS = ("foreign", "cop", "moment", "place")
_PIECE = 8_000_000  # Bytes of a large array that are read together
_SHOWN = 20  # arrays in a message
_LONGEST_FACT = 400  # bytes


@dataclass(frozen=True)
class _Array:
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    read: Callable[[], NDArray[Any]]
    opened: Callable[[], IO[bytes]] | None = None

    @property
    def size(self) -> int:
        return math.prod(self.shape)


_Feet = tuple[dict[str, _Array], str, list[tuple[Side, NDArray[np.float64]]]]


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    try:
        with _arrays(path) as arrays:
            return _recording(path, arrays, options)
    except PlantarError:
        raise
    except Exception as error:  # whatever numpy and zipfile hit in a damaged file
        raise FormatError(f"not an array file that can be read ({type(error).__name__}: {error})") from None


def recording_of_arrays(arrays: Mapping[str, NDArray[Any]], options: ReadOptions, name: Path) -> PressureRecording:
    """Returns recording of a name from arrays, by options; FormatError without cells."""
    held = {}
    for key, values in arrays.items():
        values = values[:, None] if values.ndim == 1 and side_of(key) is not None else values
        held[key] = _Array(values.shape, values.dtype, partial(np.array, values))
    return _recording(name, held, options)


def _recording(path: Path, arrays: dict[str, _Array], options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    tables = _tables(arrays)
    named = {side: key for key in reversed(tables) if (side := side_of(key.replace("/", " ")))}
    own_export = any(key.startswith("skin/") for key in named.values())
    unit = unit_of_values(_text(arrays, "unit", "units") or ("N" if own_export else None), options, warnings)
    found = _named_feet(arrays, tables, named, warnings) if named else _unnamed_feet(arrays, tables, options, warnings)
    arrays, clock, split = found
    feet = {
        side: cells_of_foot(side, values, unit, options, warnings, own=_layout(arrays, side, warnings))
        for side, values in split
    }
    time, rate, notes = _times(arrays, clock, len(split[0][1]), options, warnings)
    stated = _kind_of_metadata(_text(arrays, "metadata") or "{}") if own_export else _text(arrays, "kind")
    kind: Kind = next((k for k in get_args(Kind) if k == stated), "robot" if own_export else "insole")
    if len({foot.force.shape for foot in feet.values()}) < len(feet) and kind == "platform":
        feet = {"left": replace(feet["left"], force=feet["left"].force + feet["right"].force)}
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={"unit": unit.name},
        warnings=(*warnings, *notes),
        raw=unit.kind == "raw",
        kind=kind,
    )


def _kind_of_metadata(text: str) -> object:
    try:
        held = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"the text 'metadata' is no JSON ({error}); allowed: an object such as {{}}") from None
    return held.get("kind") if isinstance(held, dict) else None


def _tables(arrays: dict[str, _Array]) -> dict[str, _Array]:
    """Arrays of cells, or of force or pressure."""
    tables = {k: a for k, a in arrays.items() if len(a.shape) in (2, 3) and a.dtype.kind in "iufb" and a.size}
    if not tables:
        held = ", ".join(f"{k} {a.shape}" for k, a in islice(arrays.items(), _SHOWN)) or "nothing"
        raise FormatError(f"no array of frames and cells; the file holds {held}")
    if other := next((k for k, a in arrays.items() if side_of(k) and a.dtype.kind not in "iufbUS"), None):
        raise FormatError(f"the array {other!r} holds what is no real number; allowed: numbers, a row a frame")
    loads = {k: t for k, t in tables.items() if heading_of(k).quantity not in _NO_LOADS} or tables
    return {k: t for k, t in loads.items() if k.split("/")[-1] in ("force", "pressure")} or loads


def _named_feet(
    arrays: dict[str, _Array], tables: dict[str, _Array], named: dict[Side, str], warnings: list[str]
) -> _Feet:
    """Arrays, times' name, cells by foot."""
    parts = {side: _frames(tables[named[side]]) for side in SIDES if side in named}
    warnings += [f"the array {key!r} is left out" for key in tables if key not in named.values()]
    clocks = {side: f"{named[side].rpartition('/')[0]}/time" for side in parts}
    clock = next(iter(clocks.values()))
    if all(c in arrays and arrays[c].shape == (len(parts[s]),) for s, c in clocks.items()):
        timed = {side: (seconds(arrays[clocks[side]].read()), table) for side, table in parts.items()}
        base, parts = on_one_time(timed, warnings)
        arrays = {**arrays, clock: _Array(base.shape, base.dtype, lambda: base)}
    elif len({len(table) for table in parts.values()}) > 1:
        raise FormatError(f"the feet have {' and '.join(str(len(table)) for table in parts.values())} frames")
    return arrays, clock, list(parts.items())


def _unnamed_feet(
    arrays: dict[str, _Array], tables: dict[str, _Array], options: ReadOptions, warnings: list[str]
) -> _Feet:
    key, largest = max(tables.items(), key=lambda item: item[1].size)
    if len(tables) > 1:
        warnings.append(f"no array names a foot: the largest one, {key!r}, is read")
    stated = options.side or side_of(_text(arrays, "side", "foot") or "")
    table = _frames(largest)
    if "time" not in arrays and len(table) > 2 < table.shape[1] and (np.diff(table[:, 0]) > 0.0).all():
        warnings.append(f"the first column of {key!r} increases throughout: taken as times")
        time = table[:, 0]
        table = table[:, 1:]
        arrays = {**arrays, "time": _Array(time.shape, time.dtype, lambda: time)}
    return arrays, "", [(stated, table)] if stated else halves(table, options, warnings)


@contextmanager
def _arrays(path: Path) -> Iterator[dict[str, _Array]]:
    """File's arrays by name, readable while it is open."""
    with open_input(path, FormatError) as stream:
        if stream.read(2) != b"PK":
            stream.seek(0)
            yield {"values": _array(path, "values", lambda: path.open("rb"), path.stat().st_size)}
            return
    with open_archive(path, FormatError, _LARGEST) as (archive, _):
        yield {
            p.filename.removesuffix(".npy"): _array(path, p.filename, partial(archive.open, p.filename), p.file_size)
            for p in archive.infolist()
            if p.filename.endswith(".npy")
        }


def _array(path: Path, name: str, opened: Callable[[], IO[bytes]], size: int) -> _Array:
    with opened() as stream:
        shape, by_columns, dtype = read_header(stream)
        held = size - stream.tell()
    if dtype.hasobject:
        raise ValueError(f"array {name!r} holds Python objects, which are not unpickled")
    if min(shape, default=0) < 0 or math.prod(shape) * dtype.itemsize != held:
        raise FormatError(f"array {name!r} states a shape of {shape}, its {held} bytes are not: cut short?")
    if math.prod(shape) > MOST_VALUES:
        raise FormatError(f"array {name!r} of shape {shape} is too large; allowed: {MOST_VALUES:g} values")

    def read() -> NDArray[Any]:
        with opened() as stream:
            return np.asarray(np.lib.format.read_array(stream, allow_pickle=False))

    return _Array(shape, dtype, read, None if by_columns else opened)


def _frames(array: _Array) -> NDArray[np.float64]:
    if array.opened is not None and array.size * 8 > LARGE:
        return _large_frames(array, array.opened)
    table = np.asarray(array.read(), dtype=float).reshape(array.shape[0], -1)
    for start in range(0, len(table), 4096):  # by blocks: a mask of all would be as large as the file
        block = table[start : start + 4096]
        block[np.isinf(block)] = np.nan
    return table


def _large_frames(array: _Array, opened: Callable[[], IO[bytes]]) -> NDArray[np.float64]:
    """Table of a large array, read in pieces into a file that vanishes with it: never all of it in memory."""
    out = room(array.shape[0], array.size // max(1, array.shape[0]))
    filled = 0
    with opened() as stream:
        for block in opened_array(stream).blocks(_PIECE):
            part = block.reshape(len(block), -1).astype(float)
            part[np.isinf(part)] = np.nan
            put_rows(out, filled, part)
            filled += len(part)
            let_go(out)
    return out


def _text(arrays: dict[str, _Array], *keys: str) -> str | None:
    for key in keys:
        if key in arrays and arrays[key].dtype.kind in "US" and arrays[key].size == 1:
            if arrays[key].dtype.itemsize > 4 * JSON_MOST:
                raise FormatError(f"the text {key!r} is larger than {JSON_MOST / 1e6:g} MB")
            value = arrays[key].read().reshape(-1)[0]
            return value.decode("latin-1") if isinstance(value, bytes) else str(value)
    return None


def _layout(arrays: dict[str, _Array], side: Side, warnings: list[str]) -> SoleLayout | None:
    text = _text(arrays, f"layout_{side}")
    if text is None:
        return None
    try:
        return layout_from_dict(json.loads(text), where=f"layout_{side}")
    except (LayoutError, ValueError, TypeError, RecursionError) as error:
        warnings.append(f"the layout of the {side} sole cannot be read: {error}")
        return None


def seconds(values: NDArray[Any]) -> NDArray[np.float64]:
    """Values (n,), dates and durations in s from the first."""
    since = values - np.fmin.reduce(values) if values.dtype.kind in "mM" and len(values) else values
    return since / np.timedelta64(1, "s") if since.dtype.kind == "m" else since.astype(float)


def _times(
    arrays: dict[str, _Array], clock: str, frames: int, options: ReadOptions, warnings: list[str]
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    facts = {
        k: _text(arrays, k) or (str(a.read().reshape(-1)[0]) if a.size == 1 and a.dtype.kind in "iuf" else "an array")
        for k, a in arrays.items()
        if a.dtype.itemsize <= _LONGEST_FACT
    }
    rate = options.rate_hz or stated_rate(facts, warnings)
    for key in () if options.rate_hz else (clock, "time", *arrays):
        if key not in arrays or arrays[key].dtype.kind not in "iufmM" or (key != clock and time_unit(key) is None):
            continue
        if arrays[key].size == frames:
            time = seconds(arrays[key].read().reshape(-1))
            return sampling(in_seconds(time, time_unit(key), rate, warnings, _SLOWEST), rate)
        if side_of(key) is None and (rate is None or arrays[key].size > 1):
            raise FormatError(f"the array {key!r} holds {arrays[key].size} times for {frames} frames")
    rate = or_usual(rate, "the file holds no times and no rate", warnings)
    return np.arange(frames) / rate, rate, ()


FORMAT = Format(
    name="arrays",
    title="numpy arrays, with --layout and --unit",
    suffixes=(".npz", ".npy"),
    recognises=lambda head: (
        head.startswith(b"\x93NUMPY") or (head.startswith(b"PK\x03\x04") and b".npy" in head[:4096])
    ),
    read=_read,
    order=60,
)
