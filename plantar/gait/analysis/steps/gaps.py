"""Missing cell values: short gaps are filled, missing values reported."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.recordings.frame_table import table_of_blocks
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

LONGEST_GAP = 0.1
"""Longest gap in s that is filled."""

_REPORTED = 0.01  # Share of missing values of the cells that measure from which a warning is given


def without_gaps(recording: PressureRecording) -> PressureRecording:
    """Recording with short gaps of each cell filled linearly in time, and warnings of missing values.

    `metadata["missing_percent"]` holds each foot's missing share.
    """
    feet = dict(recording.feet)
    notes = list(recording.warnings)
    shares = {}
    most = int(LONGEST_GAP * recording.rate_hz)
    for side, foot in recording.feet.items():
        missing = foot.missing
        if missing is None:
            continue
        shares[side] = 100.0 * float(missing.mean())
        dead = np.asarray(missing.all(axis=0))
        rest = float(missing[:, ~dead].mean()) if not dead.all() else 0.0
        if dead.any() and not dead.all():
            notes.append(
                f"{int(dead.sum())} of {len(dead)} cells of the {side} foot never measure: its forces, areas and CoP "
                "are those of the others"
            )
        if rest > _REPORTED:
            notes.append(
                f"{100.0 * rest:.2g} % of the {side} foot's values are missing: gaps of up to {LONGEST_GAP:g} s are "
                "filled cell by cell"
            )
        if rest > 0.0 and most > 0:
            feet[side] = replace(foot, force=_filled_table(foot, most))
    if not shares:
        return recording
    metadata = {**recording.metadata, "missing_percent": shares}
    return replace(recording, feet=feet, warnings=tuple(notes), metadata=metadata)


def _filled_table(foot: FootRecording, most: int) -> NDArray[np.float64]:
    def block(rows: slice) -> NDArray[np.float64]:
        begin = max(0, rows.start - most - 1)
        return filled(foot.force[begin : rows.stop + most + 1], most)[rows.start - begin : rows.stop - begin]

    return table_of_blocks(foot.force, block)


def filled(force: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Returns forces (n, k) with short gaps of each cell filled linearly between their ends.

    `force` (n, k), NaN if unmeasured; `most`: longest filled gap in frames; gaps at the recording's ends stay.

    Example:
        >>> filled(np.array([[1.0], [np.nan], [3.0], [np.nan], [np.nan], [6.0], [np.nan]]), 1).ravel().tolist()
        [1.0, 2.0, 3.0, nan, nan, 6.0, nan]
    """
    out = force.copy()
    for cell in np.flatnonzero(np.isnan(force).any(axis=0)):
        known = np.flatnonzero(np.isfinite(force[:, cell]))
        wide = np.flatnonzero((np.diff(known) > 1) & (np.diff(known) <= most + 1))
        if not len(wide):
            continue
        at = np.concatenate([np.arange(known[i] + 1, known[i + 1]) for i in wide])
        out[at, cell] = np.interp(at, known, force[known, cell])
    return out
