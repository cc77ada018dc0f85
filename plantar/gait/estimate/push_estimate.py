"""The push on the body that the soles alone tell of: what ZMP and acceleration disagree on (K 9-12 turned round).

A pendulum that nothing but its soles touches has x'' = w^2 (x - p). What the IMU measures beyond that is F / m + w^2
u_tau, the acceleration by a wrench on the body (K 12 with its moment): any robot with plantar skin feels a push, even
where it has no skin. It takes 10 ms; without it the push is a velocity that the kinematics show 0.2 s later.

Walking itself leaves some disagreement: a body is no point, and soles land. What stays below a share of the weight
counts as none, so that nothing changes while nobody pushes.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plantar.settings.part import Part
from plantar.settings.schema import share

__all__ = ["PushEstimate", "PushRules"]


class PushRules(Part, table="push_estimate", needs={"control.push_estimate": ("soles", "skin")}):
    """When a disagreement of ZMP and acceleration is a push.

    Attributes:
        time_constant: Time constant in s of the low pass on it: two ticks, against the IMU's noise.
        begins: Acceleration in m/s^2 above which it is one. (In five walks of h1 and hrp2kai on level ground the
            largest that nobody pushed for was 0.117 g, for some ticks as a sole landed.)
        ends: Acceleration in m/s^2 below which it is over.
    """

    time_constant: float = share(0.0396, "beat", 0, 1)
    begins: float = share(0.13, "leg/beat^2", 0, 100)
    ends: float = share(0.0612, "leg/beat^2", 0, 100)


class PushEstimate:
    """Follows the acceleration of the CoM by a push.

    Args:
        rules: When there is one.
        period: Control period in s.

    Example:
        >>> push = PushEstimate(PushRules(time_constant=0.01, begins=1.0, ends=0.6), 0.005)
        >>> for _ in range(8):
        ...     found = push.update(np.array([0.0, 4.5]), np.array([0.0, -0.5]))
        >>> found.round(2).tolist()
        [0.0, 4.91]
        >>> push.update(np.array([0.0, 0.2]), None).tolist()  # nothing carries: the soles say nothing
        [0.0, 0.0]
    """

    def __init__(self, rules: PushRules, period: float) -> None:
        self._rules = rules
        self._share = 1.0 if rules.time_constant == 0.0 else -math.expm1(-period / rules.time_constant)
        self._acceleration = np.zeros(2)
        self.acts = False

    def update(self, measured: NDArray[np.float64], pendulum: NDArray[np.float64] | None) -> NDArray[np.float64]:
        """One control tick.

        Args:
            measured: Horizontal acceleration (2,) of the base in the world frame in m/s^2.
            pendulum: w^2 (x - p), (2,) in m/s^2; None where no foot carries.

        Returns:
            Acceleration (2,) by the push in m/s^2; zero where there is none.
        """
        if pendulum is None:
            self._acceleration, self.acts = np.zeros(2), False
            return np.zeros(2)
        self._acceleration = self._acceleration + self._share * (measured - pendulum - self._acceleration)
        size = math.hypot(*self._acceleration.tolist())
        self.acts = size > (self._rules.ends if self.acts else self._rules.begins)
        return self._acceleration if self.acts else np.zeros(2)
