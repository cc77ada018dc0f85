"""Load of cells in contacts, and thresholds of loaded cells."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from statistics import median

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import Contact
from plantar.recordings.frame_table import LARGE, let_go
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

_BLOCK = 1_000_000  # Values of cells that are looked at together
CACHED = 200_000
"""Values of cells that are measured together: what a processor's cache holds of them and of what is made of them."""

NOISE_FRAMES = 5000  # Frames of swing from which a cell's noise is judged: enough for 2 %


@dataclass(frozen=True, eq=False)
class StepLoad:
    """Load of k cells in one contact, or in several in sequence.

    `time`: times (m,) in s; `force`: force (m, k) in N; `pressure` (m, k) in Pa, counts of raw recordings; None without
    areas; `loaded`: which cells (m, k) are; `areas`: areas (k,) in m^2; None without geometry; `starts`: first frame
    (c,) of each contact; `frame`: usual time in s between frames, None for that of these.
    """

    time: NDArray[np.float64]
    force: NDArray[np.float64]
    pressure: NDArray[np.float64] | None
    loaded: NDArray[np.bool_]
    areas: NDArray[np.float64] | None
    starts: NDArray[np.int64] = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    frame: float | None = None

    @cached_property
    def lengths(self) -> NDArray[np.int64]:
        """Frames (c,) of each contact."""
        return np.diff(np.append(self.starts, len(self.time)))

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Seconds (m,) each frame counts for in a contact's integral, by trapezoids."""
        step = np.diff(self.time, append=0.0)
        step[np.append(self.starts[1:], len(self.time)) - 1] = 0.0
        return np.asarray(0.5 * (step + np.append(0.0, step[:-1])))

    def integral(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Integral (c,) or (c, j) over each contact of values (m,) or (m, j)."""
        if values.ndim == 1:
            return np.asarray(np.add.reduceat(self.weights * values, self.starts))
        if len(self.starts) == 1:
            return np.asarray(self.weights @ values)[None]
        ends = self.starts + self.lengths
        return np.stack([self.weights[a:b] @ values[a:b] for a, b in zip(self.starts, ends, strict=True)])

    def most(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Largest (c,) or (c, j) in each contact of values (m,) or (m, j)."""
        return np.asarray(np.maximum.reduceat(values, self.starts, axis=0))


class StepLoads:
    """Cuts contacts out of a foot's recording: cell forces, gaps interpolated.

    `threshold`: cells count as loaded above this force (k,) in N.
    """

    def __init__(self, recording: PressureRecording, foot: FootRecording, threshold: NDArray[np.float64]) -> None:
        self.recording = recording
        self.foot = foot
        self.threshold = threshold
        self._read = 0

    def of(self, *contacts: Contact, frame: float | None = None) -> StepLoad:
        """Forces and pressures of contacts in sequence; `frame`: usual time in s between frames."""
        for contact in contacts:
            self._count(contact)
        parts = [self._part(c) for c in contacts]
        force = parts[0] if len(parts) == 1 else np.concatenate(parts)
        time = self.times(contacts)
        areas = self.foot.layout.areas if self.foot.layout is not None else None
        pressure = force if self.recording.raw else None if areas is None else force / areas
        starts = np.cumsum([0, *(len(part) for part in parts[:-1])])
        return StepLoad(time, force, pressure, force > self.threshold, areas, starts, frame)

    def times(self, contacts: Sequence[Contact]) -> NDArray[np.float64]:
        """Times (m,) in s of contacts in sequence."""
        return np.concatenate([self.recording.time[c.begin : c.end] for c in contacts])

    def _part(self, contact: Contact) -> NDArray[np.float64]:
        span = slice(contact.begin, contact.end)
        force = self.foot.force[span]
        if self.foot.missing is not None and self.foot.missing[span].any():
            return _filled(self.recording.time[span], force)
        return force

    def blocks(self, contacts: Sequence[Contact], values: int = _BLOCK) -> Iterator[list[Contact]]:
        """Contacts in groups of so many values of cells."""
        most = max(1, values // max(1, self.foot.force.shape[1]))
        group: list[Contact] = []
        frames = 0
        for contact in contacts:
            if group and frames + contact.end - contact.begin > most:
                yield group
                group = []
                frames = 0
            group.append(contact)
            frames += contact.end - contact.begin
        if group:
            yield group

    def highest(self, contacts: Sequence[Contact]) -> NDArray[np.float64]:
        """Largest force (c, k) of each cell in each contact; 0 if unmeasured."""
        out = [np.zeros((0, self.foot.force.shape[1]))]
        for group in self.blocks(contacts):
            for contact in group:
                self._count(contact)
            part = np.concatenate([self.foot.force[c.begin : c.end] for c in group])
            starts = np.cumsum([0, *(c.end - c.begin for c in group[:-1])])
            largest = np.maximum if self.foot.missing is None else np.fmax  # which takes longer, for NaN
            out.append(np.nan_to_num(largest.reduceat(part, starts, axis=0)))
        return np.concatenate(out)

    def _count(self, contact: Contact) -> None:
        self._read += (contact.end - contact.begin) * self.foot.force.shape[1] * 8
        if self._read > LARGE:
            let_go(self.foot.force)
            self._read = 0


def _filled(time: NDArray[np.float64], force: NDArray[np.float64]) -> NDArray[np.float64]:
    out = force.copy()
    for cell in np.flatnonzero(np.isnan(force).any(axis=0)):
        known = np.isfinite(force[:, cell])
        out[~known, cell] = np.interp(time[~known], time[known], force[known, cell]) if known.any() else 0.0
    return out


def usual_step(time: NDArray[np.float64]) -> float:
    """Median time in s between times (m,) in s that are later than the last; 0 without."""
    step = np.diff(time)
    later = step[step > 0.0].tolist()
    return median(later) if later else 0.0


def cell_threshold(
    recording: PressureRecording, foot: FootRecording, contacts: Sequence[Contact]
) -> NDArray[np.float64]:
    """Returns force (k,) in N above which a foot's cells count as loaded, by layout and 3 SD of noise.

    Noise is that between the recording's contacts; a cell that reads in most swing frames, as under a shoe's pressure,
    counts above that reading.
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
