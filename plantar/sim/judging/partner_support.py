"""Whether partners and hands carry a robot that they touch: one that leans on them does not walk.

A force F at a height h holds a body that leans by h F / W. What a partner may do, push, pull and lead, is over within a
few seconds, or small; what carries stays. Both show in the force's mean, by a first-order low pass.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.sim.judging.unmet import unmet

_MEAN = 16.0  # beats, time constant of the mean: three steps of h1
# Largest means in weights. In the scenes with hands, partner and guide the largest over 16 beats is 0.02 aside and
# 0.001 upwards; a push of 1 m/s, three times theirs, makes 0.025.
_ASIDE = 0.05
_UPWARDS = 0.02


class PartnerSupport:
    """Follows the force on a robot of size `body` of all that touches it, at each control period in s.

    Attributes:
        aside: Largest mean horizontal force in N.
        upwards: Largest mean vertical force in N.
    """

    def __init__(self, body: BodyScale, period: float) -> None:
        self._weight = body.weight
        self._share = min(1.0, period / (_MEAN * body.beat))
        self._mean = np.zeros(3)
        self.aside = 0.0
        self.upwards = 0.0

    def update(self, force: NDArray[np.float64]) -> None:
        """Take the true `force` (3,) on the robot in N, world frame."""
        self._mean = self._mean + self._share * (force - self._mean)
        x, y, z = self._mean.tolist()
        self.aside = max(self.aside, math.hypot(x, y))
        self.upwards = max(self.upwards, z)

    def reasons(self) -> list[dict[str, Any]]:
        """Failed criteria, as `plantar.sim.judging.unmet`."""
        aside = self.aside / self._weight
        upwards = self.upwards / self._weight
        leans = f"the robot leaned on what touches it with {aside:.1%} of its weight; allowed: {_ASIDE:.0%}"
        hangs = f"what touches the robot carried {upwards:.1%} of its weight; allowed: {_UPWARDS:.0%}"
        return unmet(
            (aside <= _ASIDE, "leaned", aside, _ASIDE, leans),
            (upwards <= _UPWARDS, "carried", upwards, _UPWARDS, hangs),
        )
