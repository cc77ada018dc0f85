"""What the cells carried in one contact, and from which force on a cell counts as loaded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import Contact
from plantar.recordings.let_go import LARGE, let_go
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

__all__ = ["StepLoad", "StepLoads", "cell_threshold"]

NOISE_FRAMES = 5000
"""Frames of swing from which a cell's noise is judged: enough for 2 %."""


@dataclass(frozen=True, eq=False)
class StepLoad:
    """What the cells carried in one contact.

    Attributes:
        time: Times (m,) in s.
        force: Force (m, k) of each cell in N.
        pressure: Pressure (m, k) in Pa, counts of a raw recording; None where no areas are known.
        loaded: Which cells (m, k) count as loaded.
        areas: Area (k,) of each cell in m^2; None without geometry.
    """

    time: NDArray[np.float64]
    force: NDArray[np.float64]
    pressure: NDArray[np.float64] | None
    loaded: NDArray[np.bool_]
    areas: NDArray[np.float64] | None


class StepLoads:
    """Cuts contacts out of a foot's recording: forces of all cells, gaps interpolated.

    Args:
        threshold: Force (k,) in N above which a cell counts as loaded.
    """

    def __init__(self, recording: PressureRecording, foot: FootRecording, threshold: NDArray[np.float64]) -> None:
        self.recording, self.foot, self.threshold = recording, foot, threshold
        self._read = 0

    def of(self, contact: Contact) -> StepLoad:
        """Forces and pressures of one contact."""
        self._count(contact)
        span = slice(contact.begin, contact.end)
        time = self.recording.time[span]
        force = self.foot.force[span]
        if self.foot.missing is not None and self.foot.missing[span].any():
            force = _filled(time, force)
        areas = self.foot.layout.areas if self.foot.layout is not None else None
        pressure = force if self.recording.raw else None if areas is None else force / areas
        return StepLoad(time, force, pressure, force > self.threshold, areas)

    def highest(self, contact: Contact) -> NDArray[np.float64]:
        """Largest force (k,) of each cell in one contact."""
        self._count(contact)
        part = self.foot.force[contact.begin : contact.end]
        missing = np.isnan(part)
        return np.asarray((np.where(missing, 0.0, part) if missing.any() else part).max(axis=0))

    def _count(self, contact: Contact) -> None:
        """Let the contacts that were read before go, now and then."""
        self._read += (contact.end - contact.begin) * self.foot.force.shape[1] * 8
        if self._read > LARGE:
            let_go(self.foot.force)
            self._read = 0


def _filled(time: NDArray[np.float64], force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces with the missing values of each cell interpolated in time; 0 for cells that measured nothing."""
    out = force.copy()
    for cell in np.flatnonzero(np.isnan(force).any(axis=0)):
        known = np.isfinite(force[:, cell])
        out[~known, cell] = np.interp(time[~known], time[known], force[known, cell]) if known.any() else 0.0
    return out


def cell_threshold(
    recording: PressureRecording, foot: FootRecording, contacts: Sequence[Contact]
) -> NDArray[np.float64]:
    """Force above which each cell counts as loaded: its layout's threshold, and 3 standard deviations of its noise.

    A cell that reads something in most frames of swing, such as one that a shoe presses on, counts above that reading.

    Args:
        foot: One foot of it, n frames of k cells.
        contacts: Its contacts; between them the noise is measured.

    Returns:
        Threshold of each cell (k,) in N.
    """
    n, k = foot.force.shape
    base = 1e-3 if foot.layout is None else 0.0 if recording.raw else foot.layout.force_threshold
    air = np.ones(n, dtype=bool)
    for contact in contacts:
        air[contact.begin : contact.end] = False
    pairs = np.flatnonzero(air[:-1] & air[1:])[:NOISE_FRAMES]
    steps = np.abs(foot.force[pairs + 1] - foot.force[pairs])
    let_go(foot.force)
    steps = steps[np.isfinite(steps).all(axis=1)]
    if len(steps) < 20:
        return np.full(k, base)
    noise = np.median(steps, axis=0) / (0.6745 * np.sqrt(2.0))
    rest = np.nan_to_num(np.nanmedian(foot.measured[pairs], axis=0))
    return np.asarray(np.maximum(base, 3.0 * noise + np.where(rest > base, rest, 0.0)))
