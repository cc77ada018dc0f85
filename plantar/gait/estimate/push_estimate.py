"""Push by disagreeing ZMP and acceleration: x'' - w^2 (x - p) = F / m + w^2 u_tau (K 9-12)."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.settings.part import Part
from plantar.common.settings.schema import share
from plantar.kernels.base.vectors import vector2
from plantar.kernels.gait.push_filter import PushFilter

NO_PUSH = read_only(np.zeros(2))
"""What an estimate returns without a push."""


class PushRules(Part, table="push_estimate", needs={"control.push_estimate": ("soles", "skin")}):
    """When the disagreement is a push; walking alone leaves up to 0.117 g.

    Attributes:
        time_constant: Its low pass in s.
        begins: Acceleration in m/s^2 above which a push begins.
        ends: Below which it ends, in m/s^2.
    """

    time_constant: float = share(0.0396, "beat", 0, 1)  # derived: two ticks of 5 ms
    begins: float = share(0.13, "leg/beat^2", 0, 100)  # measured: above the 0.117 g that walking alone leaves
    # derived: a little below half of `begins`, so that a push neither ends nor begins by noise
    ends: float = share(0.0612, "leg/beat^2", 0, 100)


class PushEstimate:
    """CoM acceleration by a push. `period` of control in s. Attributes `kernel`: what it is computed by."""

    def __init__(self, rules: PushRules, period: float) -> None:
        share = 1.0 if rules.time_constant == 0.0 else -math.expm1(-period / rules.time_constant)
        self.kernel = PushFilter(share, rules.begins, rules.ends)

    @property
    def disagreement(self) -> NDArray[np.float64]:
        """Of the last tick, low-passed, (2,) in m/s^2, a push's or not."""
        return vector2(self.kernel.x, self.kernel.y)

    @property
    def acts(self) -> bool:
        """Whether a push acts."""
        return bool(self.kernel.acts)

    @property
    def acceleration(self) -> NDArray[np.float64]:
        """CoM's (2,) in m/s^2 by a push now; zero without."""
        return self.disagreement if self.kernel.acts else NO_PUSH

    def update(self, measured: tuple[float, float], pendulum: tuple[float, float] | None) -> NDArray[np.float64]:
        """Returns CoM acceleration (2,) in m/s^2 by a push after a tick; zero without.

        By the base's `measured` horizontal one, world frame, and the `pendulum`'s w^2 (x - p), along x and y in m/s^2,
        None without load.
        """
        if pendulum is None:
            self.kernel.rest()
        else:
            self.kernel.update(*measured, *pendulum)
        return self.acceleration
