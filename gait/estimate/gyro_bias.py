"""Bias of the gyro, by feet that carry: a sole on the ground does not turn, so the base turns as the leg's joints do.

With R_s the rotation from a sole that stands to the base frame, R_s(k-1) R_s(k)^T is how the base turned in a tick,
seen in its own frame. What the gyro says beyond that is bias and noise. A single tick says little of it, as the noise
of the encoders is differentiated (5e-5 rad in 5 ms: 14 mrad/s), but in a mean over time that telescopes: after T
seconds an angle of 0.1 mrad over T is left of it. No accelerometer is needed, so all three axes are found, the vertical
one too.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.rotation import sine_vector
from plantar.sides import SIDES, Side

__all__ = ["GyroBias"]


class GyroBias:
    """Mean of what the gyro measures beyond the turn of the legs: of all that came so far, then over a time constant.

    A foot weighs in with its load, so what turns while it lands or lifts off counts little. Slow turns of a sole that
    carries, on soft ground or an edge, are not told from a bias; over steps they cancel, or come to 0.3 mrad/s.

    Attributes:
        value: The bias (3,) in the base frame in rad/s.
        rate: Angular velocity (3,) of the base in its own frame in rad/s by the legs; None while no foot carries.

    Args:
        period: Control period in s.
        time_constant: Time constant in s of the mean.
        largest: Largest bias of an axis in rad/s; what would be beyond it is something else.

    Example:
        >>> bias = GyroBias(0.005, 20.0, 0.05)
        >>> still = {"left": np.eye(3), "right": np.eye(3)}
        >>> bias.update(np.array([0.0, 0.0, 0.004]), still, still, {"left": 400.0, "right": 400.0}).tolist()
        [0.0, 0.0, 0.004]
    """

    def __init__(self, period: float, time_constant: float, largest: float) -> None:
        self.value = np.zeros(3)
        self.rate: NDArray[np.float64] | None = None
        self._period = period
        self._largest = largest
        self._samples = 0
        self._most = max(1, round(time_constant / period))

    def update(
        self,
        gyro: NDArray[np.float64],
        before: Mapping[Side, NDArray[np.float64]],
        now: Mapping[Side, NDArray[np.float64]],
        weights: Mapping[Side, float],
    ) -> NDArray[np.float64]:
        """One control tick.

        Args:
            gyro: Angular velocity (3,) of the base in its own frame in rad/s, as measured.
            before: Rotation (3, 3) from each sole to the base frame a tick ago.
            now: The same rotations now.
            weights: How much each foot carries, in any unit; 0 for one that does not count as loaded.

        Returns:
            The bias (3,) in rad/s; the last one while no foot carries.
        """
        turn = np.zeros(3)
        total = 0.0
        for side in SIDES:
            weight = weights[side]
            if weight <= 0.0:
                continue
            turn += weight * sine_vector(before[side].dot(now[side].T))
            total += weight
        if total <= 0.0:
            self.rate = None
            return self.value
        self.rate = turn / (total * self._period)
        self._samples = min(self._samples + 1, self._most)
        moved = self.value + (gyro - self.rate - self.value) / self._samples
        self.value = np.minimum(np.maximum(moved, -self._largest), self._largest)
        return self.value
