"""Place of the center of mass (T 3.25)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class CenterOfMass(Task):
    """Draws the center of mass to its target: x''* = K (x_d - x) + D (x'_d - x') (T 3.25 corrected, A 4).

    `target`: wanted (3,), world frame, in m; `stiffness`: K in 1/s^2; `damping`: D in 1/s; critical if None. Attributes
    `target_velocity`: wanted (3,) in m/s.
    """

    def __init__(
        self,
        target: NDArray[np.float64],
        stiffness: float = 50.0,
        damping: float | None = None,
        axes: Sequence[int] = (0, 1, 2),
    ) -> None:
        self.target = np.asarray(target, dtype=float)
        self.target_velocity = np.zeros(3)
        self.stiffness = stiffness
        self.damping = 2.0 * float(np.sqrt(stiffness)) if damping is None else damping
        self._axes = list(axes)

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        position, jacobian, drift = robot.com()
        wanted = self.stiffness * (self.target - position)
        wanted += self.damping * (self.target_velocity - jacobian @ robot.velocity)
        axes = self._axes
        return Demand(jacobian[axes], acceleration=wanted[axes], drift=drift[axes])
