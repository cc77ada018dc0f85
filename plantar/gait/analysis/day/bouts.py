"""Bouts of a day: walking by its steps, standing and sitting by the load, gaps where nothing was measured."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.day.seconds import DaySeconds, Footfall

ACTIVITIES = ("walking", "standing", "sitting", "unloaded", "gap")
"""What a body does; unloaded: lying, or shoes not worn; gap: not measured."""

PAUSE = 3.0
"""Pause in s between two steps that ends a bout of walking (Kluge et al. 2021, PLoS ONE 16:e0256541)."""

_STRIDES = 2  # Strides of each foot in a bout of walking at least, likewise
# Shares of the weight: of an upright body the feet carry all of it, of a sitting one about a fifth (the lower legs and
# feet have 12 %, thighs bear on them), and 0.6 is midway; without shoes they carry nothing, and sensors read 0.03.
_STANDING = 0.6
_SITTING = 0.03
_SHORTEST = 5  # Shortest posture in s: shorter ones are turns of weight, and count to what is around them


@dataclass(frozen=True)
class Bout:
    """One bout: activity, begin and end in s of the recording's clock, steps of all feet, and cadence in steps/min."""

    activity: str
    begin: float
    end: float
    steps: int = 0
    cadence: float | None = None

    @property
    def lasts(self) -> float:
        """Duration in s."""
        return self.end - self.begin


def bouts_of(day: DaySeconds, feet: int) -> list[Bout]:
    """Returns all bouts in order. `feet`: number of feet that were measured."""
    walks = walking_bouts(day.steps, feet)
    kinds = _kinds(day, walks)
    out = list(walks)
    begin = 0
    for number, run in groupby(kinds.tolist()):
        end = begin + len(list(run))
        if number != 0:
            out.append(Bout(ACTIVITIES[number], day.begin + begin, day.begin + end))
        begin = end
    return sorted(out, key=lambda bout: bout.begin)


def walks_of(bouts: Sequence[Bout]) -> list[Bout]:
    """Bouts of walking among all bouts."""
    return [bout for bout in bouts if bout.activity == "walking"]


def walking_bouts(steps: Sequence[Footfall], feet: int) -> list[Bout]:
    """Returns bouts of two strides of each foot or more without a pause.

    Example:
        >>> steps = [Footfall(("left", "right")[k % 2], 0.5 * k, 0.5 * k + 0.6) for k in range(8)]
        >>> walking_bouts(steps, 2)
        [Bout(activity='walking', begin=0.0, end=4.1, steps=8, cadence=120.0)]
    """
    groups: list[list[Footfall]] = []
    for step in steps:
        if groups and step.strike - groups[-1][-1].strike <= PAUSE:
            groups[-1].append(step)
        else:
            groups.append([step])
    out = []
    for group in groups:
        sides = [sum(step.side == side for step in group) for side in {step.side for step in group}]
        if len(sides) < feet or min(sides) <= _STRIDES:
            continue
        strikes = np.array([step.strike for step in group])
        whole = float(strikes[-1] - strikes[0])
        count = len(group) * 2 // feet
        cadence = 60.0 * (len(group) - 1) * 2 / feet / whole
        out.append(Bout("walking", float(strikes[0]), max(step.lift for step in group), count, cadence))
    return out


def _kinds(day: DaySeconds, walks: Sequence[Bout]) -> NDArray[np.int64]:
    """Number of the activity (n,) of each second."""
    share = day.load / day.weight
    kinds = np.where(share >= _STANDING, 1, np.where(share >= _SITTING, 2, 3))
    kinds[~day.measured] = 4
    middle = day.begin + np.arange(len(kinds)) + 0.5
    for bout in walks:
        kinds[(middle >= bout.begin) & (middle < bout.end)] = 0
    return _without_short(kinds)


def _without_short(kinds: NDArray[np.int64]) -> NDArray[np.int64]:
    """Postures of less than 5 s become what is before or after them; the last second of a walk belongs to it."""
    out = kinds.copy()
    edges = np.flatnonzero(np.diff(out, prepend=-1, append=-1))
    for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        if b - a < _SHORTEST and 0 < out[a] < 4:
            beside = [int(out[k]) for k in (a - 1, b) if 0 <= k < len(out) and 0 < out[k] < 4]
            if beside:
                out[a:b] = beside[0]
            elif b - a == 1 and 0 in out[max(0, a - 1) : b + 1]:
                out[a:b] = 0
    return out
