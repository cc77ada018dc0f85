"""Marks for missing values in files, such as 9999, 65535 and -999."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.recordings.let_go import blocks_of_frames, let_go, room
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["without_marks"]

_FEWEST = 3
"""Readings of a mark from which they are no chance."""
_BEYOND = 3.0
"""How many times the next largest reading a mark is at least: what a sensor clips has readings right below it."""
_LEVELS = 10
"""Different readings that a sensor has below a mark: a switch has two, and its upper one is no mark."""
_BELOW, _SHARE = 4e3, 0.1
"""How far in Pa below zero a reading moves a result; and the same as a share of the largest reading, where no cell
areas make pressures of them."""
_MOST = 0.5
"""Share of the readings up to which the one value below zero is a mark: of more, it is where the sensor ends."""
_SEEN = 500_000
"""Readings that are looked at first, all over the recording."""
_SAME = 1e-6
"""Relative difference up to which readings are the same, after a conversion of units."""


def without_marks(recording: PressureRecording) -> PressureRecording:
    """The recording with marks as NaN, and a warning for each; those of robots and force plates are unchanged.

    A mark is one value that is read several times and is three times as large as any other reading, or the only one
    below zero.
    """
    if recording.kind in ("robot", "plate"):
        return recording
    feet, warnings = dict(recording.feet), list(recording.warnings)
    for side, foot in recording.feet.items():
        areas = None if foot.layout is None or recording.raw else foot.layout.areas
        per = np.ones(foot.force.shape[1]) if areas is None else areas
        force = foot.force
        for mark in _marks(force, per, areas is not None):
            force, count = _left_out(force, per, mark)
            shown = f"{mark / 1e3:.4g} kPa" if areas is not None else f"{mark:.6g}{'' if recording.raw else ' N'}"
            warnings.append(
                f"{count} value(s) of the {side} foot are {shown}, far from all others: taken as a mark for what "
                "was not measured"
            )
        if force is not foot.force:
            feet[side] = replace(foot, force=force)
    return recording if feet == recording.feet else replace(recording, feet=feet, warnings=tuple(warnings))


def _marks(force: NDArray[np.float64], per: NDArray[np.float64], are_pressures: bool) -> list[float]:
    """The marks among readings (n, k), each divided by one of (k,) numbers."""
    if not force.size:
        return []
    sample = force[:: max(1, force.size // _SEEN)] / per
    let_go(force)
    sample = np.unique(sample[np.isfinite(sample)])
    lowest, highest = _ends(force, per)
    found = []
    others = sample[(sample > 0.0) & ~_is(sample, highest)]
    if len(others) >= _LEVELS and highest >= _BEYOND * others[-1]:  # as of all that were read, or more
        count, next_one = 0, 0.0
        for rows in blocks_of_frames(force):
            value = force[rows] / per
            marked = _is(value, highest)
            count += int(marked.sum())
            next_one = max(next_one, float(np.nanmax(value, initial=0.0, where=~marked & np.isfinite(value))))
        if count >= _FEWEST and highest >= _BEYOND * next_one:
            found.append(highest)
            highest = next_one
    if lowest < -(_BELOW if are_pressures else _SHARE * highest):
        count = below = 0
        for rows in blocks_of_frames(force):
            value = force[rows] / per
            count += int(_is(value, lowest).sum())
            below += int((value < 0.0).sum())
        if _FEWEST <= count == below <= _MOST * force.size:
            found.append(lowest)
    return found


def _ends(force: NDArray[np.float64], per: NDArray[np.float64]) -> tuple[float, float]:
    low, high = np.zeros(len(per)), np.zeros(len(per))
    for rows in blocks_of_frames(force):
        np.fmin(low, np.fmin.reduce(force[rows], axis=0, initial=0.0), out=low)
        np.fmax(high, np.fmax.reduce(force[rows], axis=0, initial=0.0), out=high)
    return float((low / per).min()), float((high / per).max())


def _is(value: NDArray[np.float64], mark: float) -> NDArray[np.bool_]:
    return np.abs(value - mark) <= _SAME * abs(mark)


def _left_out(force: NDArray[np.float64], per: NDArray[np.float64], mark: float) -> tuple[NDArray[np.float64], int]:
    """The readings with NaN in place of a mark, and their number."""
    out, count = room(*force.shape), 0
    for rows in blocks_of_frames(force):
        marked = _is(force[rows] / per, mark)
        out[rows] = np.where(marked, np.nan, force[rows])
        count += int(marked.sum())
        let_go(out)
    return out, count
