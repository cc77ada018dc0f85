"""Arrays in numpy's own files (.npz, .npy): a frame a row, a cell a column, and the times beside them.

In an NPZ the arrays are found by their names: "time" (s), "left" and "right" or one array whose name names no foot;
"unit", "rate_hz", "side" and "layout_left" (JSON of a layout file) are read where they are there. `Recording.to_npz`
writes such a file.
"""

from __future__ import annotations

import json
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError, LayoutError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.layout import Side, SoleLayout
from plantar.layout_file import layout_from_dict
from plantar.pressure_recording import FootRecording, PressureRecording, sampling

__all__ = ["FORMAT"]

_USUAL_RATE = 100.0
_BROKEN: tuple[type[Exception], ...] = (
    AttributeError,
    EOFError,
    IndexError,
    KeyError,
    MemoryError,
    NotImplementedError,
    OSError,
    OverflowError,
    RuntimeError,
    SyntaxError,
    TypeError,
    ValueError,
    zipfile.BadZipFile,
    zlib.error,
)
_LARGEST = 4e9
"""Largest size of all arrays in bytes."""


def _recognises(head: bytes) -> bool:
    return head.startswith(b"\x93NUMPY") or (head.startswith(b"PK\x03\x04") and b".npy" in head[:4096])


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    """Read an NPZ or NPY file.

    Raises:
        FormatError: If it is damaged, or holds no array of frames and cells.
    """
    arrays = _arrays(path)
    warnings: list[str] = []
    tables = {k: _frames(a) for k, a in arrays.items() if a.ndim in (2, 3) and a.dtype.kind in "iufb" and a.size}
    if not tables:
        held = ", ".join(f"{k} {a.shape}" for k, a in arrays.items()) or "nothing"
        raise FormatError(f"{path}: no array of frames and cells; the file holds {held}")
    force_like = {k: t for k, t in tables.items() if k.split("/")[-1] in ("force", "pressure")}
    by_side: dict[Side, tuple[str, NDArray[np.float64]]] = {}
    for key, table in (force_like or tables).items():
        side = side_of(key.replace("/", " "))
        if side is not None:
            by_side.setdefault(side, (key, table))
    own_export = any(k.startswith("skin/") for k, _ in by_side.values())
    unit = unit_of_values(_text(arrays, "unit", "units") or ("N" if own_export else None), options, warnings)
    feet: dict[Side, FootRecording] = {}
    if by_side:
        first = by_side.get("left") or by_side["right"]
        for side in ("left", "right"):
            if side in by_side:
                values = by_side[side][1]
                if len(values) != len(first[1]):
                    raise FormatError(f"{path}: the feet have {len(first[1])} and {len(values)} frames")
                feet[side] = cells_of_foot(side, values, unit, options, warnings, own=_layout(arrays, side, warnings))
        frames = len(first[1])
        prefix = first[0].rsplit("/", 1)[0] + "/time" if "/" in first[0] else ""
    else:
        key, table = max((force_like or tables).items(), key=lambda item: item[1].size)
        if len(tables) > 1:
            warnings.append(f"no array names a foot: the largest one, {key!r}, is read")
        stated = options.side or side_of(_text(arrays, "side", "foot") or "")
        split = [(stated, table)] if stated else halves(table, options, warnings)
        for side, values in split:
            feet[side] = cells_of_foot(side, values, unit, options, warnings, own=_layout(arrays, side, warnings))
        frames, prefix = len(table), ""
    time, rate, notes = _times(path, arrays, prefix, frames, options, warnings)
    if len(feet) == 1:
        warnings.append(f"the file holds the {next(iter(feet))} foot only")
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={"unit": unit.name},
        warnings=(*warnings, *notes),
        raw=unit.kind == "raw",
        kind="robot" if own_export else "insole",
    )


def _arrays(path: Path) -> dict[str, NDArray[Any]]:
    if not path.is_file():
        raise FormatError(f"{path}: cannot be read (no such file)")
    try:
        with path.open("rb") as stream:
            if stream.read(2) != b"PK":
                stream.seek(0)
                return {"values": np.lib.format.read_array(stream, allow_pickle=False)}
            with zipfile.ZipFile(stream) as archive:
                if sum(i.file_size for i in archive.infolist()) > _LARGEST:
                    raise FormatError(f"{path}: the arrays are larger than {_LARGEST / 1e9:g} GB")
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as loaded:
                return {name: loaded[name] for name in loaded.files}
    except FormatError:
        raise
    except _BROKEN as error:
        raise FormatError(f"{path}: not an array file that can be read ({type(error).__name__}: {error})") from None


def _frames(array: NDArray[Any]) -> NDArray[np.float64]:
    """An array as (frames, cells); a matrix of cells is laid out row by row."""
    table = np.asarray(array, dtype=float).reshape(len(array), -1)
    infinite = np.isinf(table)
    if infinite.any():
        table[infinite] = np.nan
    return table


def _text(arrays: dict[str, NDArray[Any]], *keys: str) -> str | None:
    for key in keys:
        if key in arrays and arrays[key].dtype.kind in "US" and arrays[key].size == 1:
            value = arrays[key].reshape(-1)[0]
            return value.decode("latin-1") if isinstance(value, bytes) else str(value)
    return None


def _layout(arrays: dict[str, NDArray[Any]], side: Side, warnings: list[str]) -> SoleLayout | None:
    text = _text(arrays, f"layout_{side}")
    if text is None:
        return None
    try:
        return layout_from_dict(json.loads(text), where=f"layout_{side}")
    except (LayoutError, ValueError, TypeError) as error:
        warnings.append(f"the layout of the {side} sole cannot be read: {error}")
        return None


def _times(
    path: Path,
    arrays: dict[str, NDArray[Any]],
    prefix: str,
    frames: int,
    options: ReadOptions,
    warnings: list[str],
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    rate = options.rate_hz
    for key in ("rate_hz", "rate", "frequency", "fs"):
        if rate is None and key in arrays and arrays[key].size == 1 and arrays[key].dtype.kind in "iuf":
            value = float(arrays[key].reshape(-1)[0])
            rate = value if 0.1 <= value <= 1e5 else None
    for key in (prefix, "time", "time_s", "t", "times", "timestamps"):
        if options.rate_hz is None and key in arrays and arrays[key].dtype.kind in "iuf" and arrays[key].size == frames:
            return sampling(np.asarray(arrays[key], dtype=float).reshape(-1), rate)
    if rate is None:
        warnings.append(f"the file holds no times and no rate: {_USUAL_RATE:g} Hz is assumed (--rate overrides)")
        rate = _USUAL_RATE
    return np.arange(frames) / rate, rate, ()


FORMAT = Format(
    name="arrays",
    title="numpy arrays, with --layout and --unit",
    suffixes=(".npz", ".npy"),
    recognises=_recognises,
    read=_read,
)
"""The entry of the registry."""
