"""How legs turn and move under an upright trunk.

The CoM goes a share mu of each foot's way from the base b: c = b + mu (f_l - b) + mu (f_r - b) + const. A swing f''
so accelerates the base against the CoM: c'' = (1 - 2 mu) b'' + mu f''.
"""

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record


class LegInertia(Record, frozen=True):
    """A leg's inertia, 0 where it is not counted.

    `turning`: D in s^2 (`plantar.gait.plan.leg_momentum`); `share`: mu, less than 1/2.
    """

    turning: float = 0.0
    share: float = 0.0

    def base_acceleration(self, com: NDArray[np.float64], foot: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the base's (2,) in m/s^2 by those of `com` and swinging `foot`."""
        return (com - self.share * foot) / (1.0 - 2.0 * self.share)
