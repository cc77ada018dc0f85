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

    def force(self, time: float, lasting: float) -> NDArray[np.float64]:
        """Mean force (3,) in N over an interval, so that forces held for whole steps add up to the impulse.

        Args:
            time: Begin of the interval in s.
            lasting: Its length in s, above 0.

        Returns:
            The force in the world frame.
        """
        return np.asarray(self.impulse * ((self._given(time + lasting) - self._given(time)) / lasting))

    def _given(self, time: float) -> float:
        """Share of the impulse that is given until a time in s."""
        share = min(1.0, max(0.0, (time - self.start) / (self.end - self.start)))
        return 0.5 - 0.5 * math.cos(math.pi * share) if self.smooth else share
