"""A wrist turns a skin patch to the surface by zeroing its moment (A 10)."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.sensing.body_skin import patch_signal
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class WristGains(Settings):
    """Wrist's yielding (A 10).

    Attributes:
        inertia: Lambda_2.
        damping: D_2.
        gain: K_2 on the moment.
        proximity_stiffness: Force per metre a taxel is nearer than its range.
    """

    inertia: float = number(0.02, "kg m^2", 1e-6, 1e3)
    damping: float = number(0.4, "N m s", 0, 1e4)
    gain: float = number(1.0, "1", 0, 1e4)
    proximity_stiffness: float = number(20.0, "N/m", 0, 1e6)


class CompliantWrist(Task):
    """omega'* = (K Gamma - D omega) / Lambda, Gamma the patch's moment about its middle (A 10 corrected).

    `patch` by name; InputError if unknown; `point`: its middle (3,), link frame, in m. Attributes `weight`: w of A 6: 0
    for proximity, 1 for force; `moment`: last demand's Gamma (3,), link frame, in N m.
    """

    def __init__(self, skin: BodySkin, patch: str, point: NDArray[np.float64], gains: WristGains | None = None) -> None:
        self.gains = gains or WristGains()
        self.weight = 0.0
        self.moment = np.zeros(3)
        self._link = skin.patch(patch).link
        self._own = skin.slices[patch]
        self._ranges = skin.ranges[self._own]
        unit = skin.unit_wrenches[self._own]
        self._arms = unit[:, 3:] - np.cross(np.asarray(point, dtype=float), unit[:, :3])  # about the middle

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        if skin is None:
            return None
        gains = self.gains
        near = gains.proximity_stiffness * np.maximum(self._ranges - np.maximum(skin.distance[self._own], 0.0), 0.0)
        self.moment = patch_signal(skin.force[self._own], near, self.weight) @ self._arms
        rotation = robot.pose(self._link)[1]
        jacobian = rotation.T @ robot.jacobian(self._link)[3:]
        wanted = (gains.gain * self.moment - gains.damping * (jacobian @ robot.velocity)) / gains.inertia
        return Demand(jacobian, acceleration=wanted, drift=rotation.T @ robot.drift(self._link)[3:])
