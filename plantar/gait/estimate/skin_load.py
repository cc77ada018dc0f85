"""Sole load from noisy taxels, low-passed before clipping makes noise a bias."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.kernels.skin.percept_fields import unsaturated
from plantar.layouts.layout import SoleLayout
from plantar.percepts.percept import Percept
from plantar.sensing.clipping import unclipped_mean
from plantar.sensing.reading import Reading


def at_its_limit(reading: Reading, layout: SoleLayout) -> Reading:
    """Returns a sole's `reading` on a `layout` with saturated taxels at their largest force; without, a loaded foot
    could seem in the air.
    """
    if not layout.kernel.reaches(reading.force, layout.force_limit):
        return reading
    return replace(reading, force=np.minimum(reading.force, np.nextafter(layout.force_limit, 0.0)))


def percept_to_its_limit(reading: Reading, layout: SoleLayout) -> Percept:
    """Returns the percept of a sole's `reading` on a `layout`, saturated as in `at_its_limit`, loads summed."""
    percept: Percept | None = unsaturated(Percept, layout, reading)
    return Percept(layout, at_its_limit(reading, layout)) if percept is None else percept


class SkinLoad:
    """Filtered wrench of a sole.

    `noise`: standard deviation of a taxel's white noise in N; `share`: new reading's in the running mean: period /
    (time constant + period).
    """

    def __init__(self, layout: SoleLayout, noise: float, share: float) -> None:
        self.layout = layout
        self.noise = noise
        self.share = share
        self._mean: NDArray[np.float64] | None = None

    def update(self, reading: Reading) -> SoleWrench:
        """Filtered wrench (T 4.23) with the latest reading; dead taxels count as unloaded."""
        force = reading.force
        sound = np.isfinite(reading.force)
        whole = bool(sound.all())
        if not whole:
            force = np.where(sound, force, 0.0)
        if self._mean is None:
            self._mean = force
        self._mean = self._mean + self.share * (force - self._mean)
        load = unclipped_mean(self._mean, self.noise)
        return SoleWrench(np.asarray(self.layout.wrench_map @ (load if whole else np.where(sound, load, 0.0))))
