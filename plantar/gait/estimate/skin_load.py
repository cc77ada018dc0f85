"""Load of a sole from noisy taxels: a low pass on each, before noise is clipped at zero and becomes a bias."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.layouts.layout import SoleLayout
from plantar.percepts.percept import Percept
from plantar.sensing.clipping import unclipped_mean
from plantar.sensing.reading import Reading

__all__ = ["SkinLoad", "at_its_limit", "percept_to_its_limit"]


def at_its_limit(reading: Reading, layout: SoleLayout) -> Reading:
    """The reading with each saturated taxel at its largest force; left out, it could put a loaded foot in the air.

    Args:
        reading: The sole's reading.
        layout: The sole.

    Returns:
        The same reading where no taxel is saturated.
    """
    if not layout.kernel.reaches(reading.force, layout.force_limit):
        return reading
    return replace(reading, force=np.minimum(reading.force, np.nextafter(layout.force_limit, 0.0)))


def percept_to_its_limit(reading: Reading, layout: SoleLayout) -> Percept:
    """Percept of a sole with saturated taxels as in `at_its_limit` and its loads summed.

    Args:
        reading: The sole's reading.
        layout: The sole.

    Returns:
        The percept.
    """
    loads = layout.kernel.unsaturated_loads(reading.force, layout.force_threshold, layout.force_limit)
    return Percept(layout, at_its_limit(reading, layout)) if loads is None else Percept.summed(layout, reading, loads)


class SkinLoad:
    """Filtered wrench of one sole.

    Args:
        layout: The sole, n taxels.
        noise: Standard deviation of a taxel's white noise in N.
        share: Share of a new reading in the running mean: period / (time constant + period).
    """

    def __init__(self, layout: SoleLayout, noise: float, share: float) -> None:
        self.layout = layout
        self.noise = noise
        self.share = share
        self._mean: NDArray[np.float64] | None = None

    def update(self, reading: Reading) -> SoleWrench:
        """Filtered wrench on the sole (T 4.23) with its latest reading; dead taxels count as unloaded."""
        force, sound = reading.force, np.isfinite(reading.force)
        whole = bool(sound.all())
        if not whole:
            force = np.where(sound, force, 0.0)
        if self._mean is None:
            self._mean = force
        self._mean = self._mean + self.share * (force - self._mean)
        load = unclipped_mean(self._mean, self.noise)
        return SoleWrench(np.asarray(self.layout.wrench_map @ (load if whole else np.where(sound, load, 0.0))))
