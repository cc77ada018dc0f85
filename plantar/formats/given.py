"""Recordings from paths, arrays of cells, or data frames."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from plantar.errors import InputError
from plantar.formats import ReadOptions, read_recording
from plantar.formats.array_file import recording_of_arrays
from plantar.formats.plausibility import checked
from plantar.formats.table_columns import recording_of_columns
from plantar.recordings.pressure_recording import PressureRecording


def recording_of(given: Any, format: str | None = None, options: ReadOptions | None = None) -> PressureRecording:
    """Returns recording from any form.

    Args:
        given: Recording; path of a file; array (n, k) of n frames and k cells (or n x rows x columns); mapping of an
            NPZ file's arrays; or data frame (pandas, polars) with a column a cell and names as in a CSV table.
        format: By content where None.
        options: What else is known: layout, unit, rate, side. Arrays without unit are raw counts.

    Raises:
        InputError: For another type, or an empty recording.
        FormatError: Without frames of load.
    """
    known = options or ReadOptions()
    if isinstance(given, PressureRecording):
        if not given.feet or not len(given.time):
            raise InputError("a recording without feet or frames; allowed: a foot and a frame at least")
        if any(np.isinf(foot.vertical_force).any() for foot in given.feet.values()):
            raise InputError("a recording holds infinite forces; allowed: numbers, NaN for what was not measured")
        return given
    if isinstance(given, str | os.PathLike):
        return read_recording(given, format, options=known)
    if hasattr(given, "columns") and not isinstance(given, Mapping):
        found = recording_of_columns(*_columns(given), known, Path("data frame"))
    elif isinstance(given, Mapping):
        found = recording_of_arrays({str(k): np.asarray(v) for k, v in given.items()}, known, Path("arrays"))
    elif isinstance(given, np.ndarray | list | tuple):
        found = recording_of_arrays({"values": _array(given)}, known, Path("array"))
    else:
        raise InputError(
            f"a {type(given).__name__} is no recording; allowed: a path, a PressureRecording, an array of frames and "
            "cells, a mapping of arrays, a data frame"
        )
    return checked(found)


def _array(given: Any) -> np.ndarray[Any, Any]:
    try:
        return np.asarray(given, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"an array holds what is no number ({error}); allowed: frames of numbers") from None


def _columns(frame: Any) -> tuple[np.ndarray[Any, Any], list[str]]:
    names, at = [str(name) for name in frame.columns], getattr(frame, "iloc", None)  # pandas has columns of one name
    columns = [np.asarray(frame[n] if at is None else at[:, i]) for i, n in enumerate(frame.columns)]
    index = getattr(frame, "index", None)
    values = None if index is None else np.asarray(index)
    if values is not None and values.ndim == 1 and (values.dtype.kind in "mM" or getattr(index, "name", None)):
        names.insert(0, "time" if values.dtype.kind in "mM" else str(index.name))  # type: ignore[union-attr]
        columns.insert(0, values)
    return np.column_stack([_numbers(c) for c in columns]) if columns else np.zeros((0, 0)), names


def _numbers(column: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if column.dtype.kind in "mM":
        return (column - column[:1]) / np.timedelta64(1, "s") if len(column) else column.astype(float)
    if column.dtype.kind in "iufb":
        return column.astype(float)
    out = np.full(len(column), np.nan)
    for i, value in enumerate(column):
        try:
            out[i] = float(value)
        except (TypeError, ValueError):
            continue
    return out
