"""A push on a body: what it does over time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Shove"]


@dataclass(frozen=True)
class Shove:
    """One push.

    Attributes:
        start: Time in s at which it begins.
        end: Time in s at which it ends.
        impulse: Impulse (3,) in N s, world frame.
        smooth: Whether the force swells and fades as a half sine, as a hand's does; else it is constant.
    """

    start: float
    end: float
    impulse: NDArray[np.float64]
    smooth: bool

    def force(self, time: float) -> NDArray[np.float64]:
        """Force (3,) in N at a time in s."""
        length = self.end - self.start
        share = (time - self.start) / length
        if not 0.0 <= share < 1.0:
            return np.zeros(3)
        shape = 0.5 * math.pi * math.sin(math.pi * share) if self.smooth else 1.0
        return np.asarray(self.impulse * (shape / length))
