"""Recordings from paths, arrays of cells, or data frames."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

import numpy as np

from plantar.errors import InputError
from plantar.formats import ReadOptions, read_recording
from plantar.formats.array_file import recording_of_arrays, seconds
from plantar.formats.column_map import column_map, mapped_columns
from plantar.formats.plausibility import checked
from plantar.formats.side import names_a_foot, number_of_side
from plantar.formats.table_columns import recording_of_columns
from plantar.formats.table_text import CountedSeconds, seconds_of_time, time_unit
from plantar.formats.text import row_of_numbers
from plantar.recordings.pressure_recording import Kind, PressureRecording, possible_rate


def recording_of(given: Any, format: str | None = None, options: ReadOptions | None = None) -> PressureRecording:
    """Returns recording.

    Args:
        given: Recording; path of a file; array (n, k) of n frames and k cells (or n x rows x columns); mapping of an
            NPZ file's arrays; or data frame (pandas, polars) named as a CSV table. Masked values are NaN.
        format: By content where None.
        options: What else is known. Arrays without unit are raw counts.
    """
    known = options or ReadOptions()
    if isinstance(given, PressureRecording):
        return _whole(given)
    if isinstance(given, str | os.PathLike):
        return read_recording(given, format, options=known)
    if hasattr(given, "columns") and not isinstance(given, Mapping):
        table, names = _columns(given)
        stated = mapped_columns(column_map(known.columns), names, len(names))
        if stated:
            table = table[:, list(stated)]
            names = list(stated.values())
        found = recording_of_columns(table, names, known, Path("data frame"))
    elif isinstance(given, Mapping):
        held = {str(k): _array(v) for k, v in given.items()}
        times = {k: _numbers(v) for k, v in held.items() if v.ndim == 1 and time_unit(k) is not None}
        found = recording_of_arrays(held | times, known, Path("arrays"))
    elif isinstance(given, np.ndarray | list | tuple):
        found = recording_of_arrays({"values": _array(given)}, known, Path("array"))
    else:
        raise InputError(
            f"a {type(given).__name__} is no recording; allowed: a path, a PressureRecording, an array of frames and "
            "cells, a mapping of arrays, a data frame"
        )
    return checked(found)


def _whole(recording: PressureRecording) -> PressureRecording:
    time = recording.time
    rate = possible_rate(recording.rate_hz, "the recording states")
    if not recording.feet or not len(time):
        raise InputError("a recording without feet or frames; allowed: a foot and a frame at least")
    steps = np.diff(time)
    if not (steps > 0.0).all() or (len(steps) and not 0.8 <= float(np.median(steps)) * rate <= 1.25):
        raise InputError(f"a recording's times do not increase by 1 / {rate:g} s a frame, as its rate states")
    if recording.kind not in get_args(Kind):
        raise InputError(f"a recording's kind is {recording.kind!r}; allowed: {', '.join(get_args(Kind))}")
    for side, foot in recording.feet.items():
        if side != foot.side or {len(foot.force), len(foot.vertical_force)} != {len(time)}:
            raise InputError(
                f"the {side} foot is not {foot.side!r}, or does not have a force for each of {len(time)} times"
            )
        if np.isinf(foot.vertical_force).any():
            raise InputError(f"the {side} foot holds infinite forces; allowed: numbers, NaN for what was not measured")
    return recording


def _array(given: Any) -> Any:
    try:
        return np.asarray(np.ma.filled(given.astype(float), np.nan) if isinstance(given, np.ma.MaskedArray) else given)
    except (TypeError, ValueError) as error:
        raise InputError(f"an array holds what is no number ({error}); allowed: frames of numbers") from None


def _columns(frame: Any) -> tuple[np.ndarray[Any, Any], list[str]]:
    at = getattr(frame, "iloc", None)  # pandas has columns of one name, and names of several words
    names = [" ".join(map(str, name)) if isinstance(name, tuple) else str(name) for name in frame.columns]
    columns = [np.asarray(frame[n] if at is None else at[:, i]) for i, n in enumerate(frame.columns)]
    values = np.asarray(index := getattr(frame, "index", ()))
    if values.ndim == 1 and len(values):
        dated = values.dtype.kind in "mM" or seconds_of_time(str(values[0])) is not None
        if name := "time" if dated else getattr(index, "name", None):
            names = [str(name), *names]
            columns = [values, *columns]
    return np.column_stack(list(map(_numbers, columns))) if columns else np.zeros((0, 0)), names


def _numbers(column: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if column.dtype.kind in "iufbmM":
        return seconds(column)
    cells = [str(cell) for cell in column]
    of_feet = bool(cells) and all(map(names_a_foot, cells[:100]))
    read = number_of_side if of_feet else CountedSeconds()  # of times of day, or dates with a zone
    return row_of_numbers([read(cell) for cell in cells])[0]
