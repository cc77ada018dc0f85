"""CoM admittance: the CoM reference yields to the error of the ZMP (T 4.29)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["LARGEST_OFFSET", "ComAdmittance"]

LARGEST_OFFSET = 0.5
"""Length in legs that a balance law lets the CoM's reference be off its plan: no foot reaches both from there."""


class ComAdmittance:
    """Offset of the CoM reference from the plan.

    Attributes:
        x: Offset of the CoM reference from the plan along x in m.
        y: The same along y.
        rate_x: Its rate along x in m/s.
        rate_y: The same along y.

    Args:
        zmp_gain: k_f in 1/s: how fast the CoM reference yields to a ZMP error.
        com_gain: k_x in 1/s: how fast it returns to the plan.
        zmp_filter: Time constant in s of the low-pass on the measured ZMP error.
        period: Control period in s.
        largest: Length in m that the offset does not exceed, however large gains and errors are.

    Example:
        >>> admittance = ComAdmittance(zmp_gain=1.0, com_gain=4.0, zmp_filter=0.02, period=0.005)
        >>> for _ in range(2000):
        ...     admittance.update(np.array([0.02, 0.0]))
        >>> admittance.offset.round(4).tolist()
        [0.005, 0.0]
    """

    def __init__(
        self, zmp_gain: float, com_gain: float, zmp_filter: float, period: float, largest: float = math.inf
    ) -> None:
        self.x = self.y = self.rate_x = self.rate_y = 0.0
        self._zmp_gain = zmp_gain
        self._com_gain = com_gain
        self._period = period
        self._largest = largest
        self._share = period / (zmp_filter + period)
        self._error_x = self._error_y = 0.0  # filtered

    @property
    def offset(self) -> NDArray[np.float64]:
        """Offset (2,) of the CoM reference from the plan in m."""
        return np.array((self.x, self.y))

    @property
    def rate(self) -> NDArray[np.float64]:
        """Its rate (2,) in m/s."""
        return np.array((self.rate_x, self.rate_y))

    def update(self, error: NDArray[np.float64]) -> None:
        """One control tick.

        Args:
            error: Measured less desired ZMP (2,) in m; zeros where no foot carries load.
        """
        self.follow(*error.tolist())

    def follow(self, x: float, y: float) -> None:
        """One control tick, with plain numbers: see `update`.

        Args:
            x: Measured less desired ZMP along x in m.
            y: The same along y.
        """
        # Keeps the noise of the taxels out of the CoM's reference.
        self._error_x += self._share * (x - self._error_x)
        self._error_y += self._share * (y - self._error_y)
        # The second term brings the CoM back onto the plan; without it a bias of the ZMP would add up to a drift.
        self.rate_x = self._zmp_gain * self._error_x - self._com_gain * self.x
        self.rate_y = self._zmp_gain * self._error_y - self._com_gain * self.y
        self.x += self._period * self.rate_x
        self.y += self._period * self.rate_y
        size = math.sqrt(self.x * self.x + self.y * self.y)
        if size > self._largest:
            self.x, self.y = self.x * (self._largest / size), self.y * (self._largest / size)
