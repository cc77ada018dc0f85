"""A push on a body over time."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Shove:
    """A push from `start` to `end` in s of `impulse` (3,) in N s, world frame; half sine if `smooth`, else constant."""

    start: float
    end: float
    impulse: NDArray[np.float64]
    smooth: bool

    def force(self, time: float, lasting: float) -> NDArray[np.float64]:
        """Returns the mean force (3,) in N, world frame, from `time` over `lasting` in s."""
        return np.asarray(self.impulse * ((self._given(time + lasting) - self._given(time)) / lasting))

    def _given(self, time: float) -> float:
        share = min(1.0, max(0.0, (time - self.start) / (self.end - self.start)))
        return 0.5 - 0.5 * math.cos(math.pi * share) if self.smooth else share
