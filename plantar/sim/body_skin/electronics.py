"""A skin's electronics: saturation, noise, gain errors, resolution, rate, delay."""

from collections import deque
from collections.abc import Callable
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number, switch, whole
from plantar.mujoco.foam import Foam
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading


class SkinElectronicsSettings(Settings):
    """Quality of readings; white noise (1 sigma).

    Normalised signals saturate as in A: f / (f + half_force) and half_distance / (d + half_distance). Readers know only
    the nominal curve.

    Attributes:
        rate: Sampling rate in Hz.
        delay_periods: Sampling periods from sample to delivery.
        half_force: In N, where the signal is one half.
        half_distance: In m, where the signal is one half.
        noise: Of the normalised signals.
        gain_error: Share of each taxel's half_force and half_distance.
        bits: Resolution of the normalised signals.
        dead_taxels: Share that reads NaN, seeded.
    """

    rate: float = number(500.0, "Hz", 10.0, 1000.0)
    delay_periods: int = whole(0, "periods", 0, 250)
    half_force: float = number(10.0, "N", 0.01, 1e4)
    half_distance: float = number(0.02, "m", 1e-4, 1.0)
    noise: float = number(0.001, "1", 0.0, 0.5)
    temperature_noise: ClassVar[float] = 0.1  # Of the temperatures in K
    gain_error: float = number(0.05, "1", 0.0, 0.3)
    bits: int = whole(10, "bits", 4, 24)
    dead_taxels: float = number(0.0, "1", 0.0, 0.9)


class SkinSensing(SkinElectronicsSettings):
    """Material and quality of a skin.

    Attributes:
        stiffness: In Pa/m; by default 10 mm of 100 kPa foam.
        damping: In Pa s/m.
        friction: Coulomb's coefficient.
        slip_speed: In m/s, where friction reaches 71 % of Coulomb's.
        everything: Cast all rays, for comparison; same readings.
    """

    stiffness: float = number(1e7, "Pa/m", 1e4, 1e10)
    damping: float = number(3e4, "Pa s/m", 0.0, 1e8)
    friction: float = number(0.5, "1", 0.0, 2.0)
    slip_speed: float = number(0.02, "m/s", 1e-4, 1.0)
    everything: bool = switch(False)

    @property
    def foam(self) -> Foam:
        """What it is made of."""
        return Foam(self.stiffness, self.damping, self.friction, self.slip_speed)


class SkinElectronics:
    """Samples and delivers; `seed` draws noise, gain errors, dead taxels."""

    def __init__(self, skin: BodySkin, settings: SkinElectronicsSettings, seed: int) -> None:
        self.settings = settings
        self._skin = skin
        self._rng = np.random.default_rng([seed, 7])
        count = len(skin)
        gains = 1.0 + np.clip(self._rng.normal(0.0, settings.gain_error, (2, count)), -0.9, 0.9)
        self._half_force = settings.half_force * gains[0]
        self._half_distance = settings.half_distance * gains[1]
        self._dead = self._rng.permutation(count)[: round(settings.dead_taxels * count)]
        self._levels = float(2**settings.bits - 1)
        self._due = -np.inf
        self._waiting: deque[Reading] = deque()
        self._delivered: Reading | None = None

    def read(
        self,
        time: float,
        whole: Callable[[], Reading],
        temperature: NDArray[np.float64] | None = None,
    ) -> Reading:
        """Returns the reading delivered at a `time` in s: the latest sample old enough, or the first; samples where
        due.

        `whole` returns the true reading of the N taxels, as `FoamSkins.whole`; `temperature` (N,) in degC, or None.
        """
        if time >= self._due - 1e-9 or self._delivered is None:
            period = 1.0 / self.settings.rate
            self._due = time + period if self._due == -np.inf else self._due + period
            self._waiting.append(self._sample(time, whole(), temperature))
            if self._delivered is None:
                self._delivered = self._waiting[0]
            if len(self._waiting) > self.settings.delay_periods:
                self._delivered = self._waiting.popleft()
        return self._delivered

    def _sample(self, time: float, true: Reading, temperature: NDArray[np.float64] | None) -> Reading:
        s = self.settings
        force = true.force
        levels = self._levels
        noise = self._rng.standard_normal((2, len(self._skin))) * s.noise
        pressed = np.rint((force / (force + self._half_force) + noise[0]) * levels).clip(0.0, levels - 1.0)
        measured_force = s.half_force * pressed / (levels - pressed)
        near = np.maximum(true.distance, 0.0)
        seen = np.rint((self._half_distance / (near + self._half_distance) + noise[1]) * levels).clip(1.0, levels)
        measured_distance = s.half_distance * (levels - seen) / seen
        measured_distance[measured_distance >= self._skin.ranges] = np.inf
        warmth = None
        if temperature is not None:
            warmth = temperature + self._rng.standard_normal(len(temperature)) * s.temperature_noise
        for values in (measured_force, measured_distance, warmth):
            if values is not None:
                values[self._dead] = np.nan
        return Reading(time, measured_force, measured_distance, warmth)
