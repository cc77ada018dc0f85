"""Force on, or distance from, a surface along a skin patch's normal (A 5-9)."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

_FELT = 0.3  # Force in N up to which a patch counts as not touching: noise of 40 taxels adds up, as none reads below 0


class ContactGains(Settings):
    """Force and distance control (A 9).

    On stiffness k_c: natural frequency sqrt(gain k_c / inertia), critical damping = 2 sqrt(gain k_c inertia).

    Attributes:
        inertia: Lambda_1: hand's apparent mass along the normal.
        damping: D_1.
        gain: K_1 on the force error.
        integral: Correction rate of a lasting error; 0 for none.
        distance_stiffness: Force per metre of excess distance, in place of the force error.
        free_damping: Damping without contact, if above D_1; all gains grow with it, so that mass errors matter less at
            equal speeds.
    """

    inertia: float = number(2.0, "kg", 1e-3, 1e3)
    damping: float = number(120.0, "N s/m", 0, 1e6)
    gain: float = number(1.0, "1", 0, 1e4)
    integral: float = number(2.0, "1/s", 0, 100)
    distance_stiffness: float = number(200.0, "N/m", 0, 1e6)
    free_damping: float = number(0.0, "N s/m", 0, 1e6)


class ContactForce(Task):
    """x''* = (K (w (f_d - f_c) + (1 - w) k (d - d_d)) - D x') / Lambda along a patch's outward normal (A 6, 9).

    `patch`: touching one by name; InputError if unknown; `point`: its middle (3,), link frame, in m; `normal`: out of
    the body (3,), link frame: h_z of A. Attributes `weight`: w of A 6: 0 for distance, 1 for force; `target_force`: f_d
    in N; `force` the last demand's f_c; `target_distance`: d_d in m; `distance` the last demand's mean of taxels in
    range, inf without; `approach_speed`: speed in m/s without contact: the error is bounded to D v / K; infinite at
    first.
    """

    def __init__(
        self,
        skin: BodySkin,
        patch: str,
        point: NDArray[np.float64],
        normal: NDArray[np.float64],
        gains: ContactGains | None = None,
    ) -> None:
        self.gains = gains or ContactGains()
        self.weight = 0.0
        self.target_force = 0.0
        self.target_distance = 0.03
        self.approach_speed = float("inf")
        self.force = 0.0
        self.distance = np.inf
        self._link = skin.patch(patch).link
        self._own = skin.slices[patch]
        self._point = np.asarray(point, dtype=float)
        self._normal = np.asarray(normal, dtype=float)
        self._push = -skin.unit_wrenches[self._own, :3] @ self._normal  # share of each taxel's force along it
        self._reach = float(skin.ranges[self._own].max())
        self._sum = 0.0
        self._last: float | None = None

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        if skin is None:
            return None
        error = self._error(skin, robot.time)
        gains = self.gains
        outward = robot.pose(self._link)[1] @ self._normal
        jacobian = robot.jacobian(self._link, self._point)
        moving = jacobian @ robot.velocity
        pull = gains.gain * (error + gains.integral * self._sum)
        pace = max(1.0, gains.free_damping / max(gains.damping, 1e-9)) if self.force <= _FELT else 1.0
        wanted = pace * (pull - gains.damping * outward @ moving[:3]) / gains.inertia
        a, b, c = moving[3:]
        x, y, z = outward
        u, v, w = moving[:3]
        turning = (b * z - c * y) * u + (c * x - a * z) * v + (a * y - b * x) * w  # the normal turns with the hand
        drift = outward @ robot.drift(self._link, self._point)[:3] + turning
        return Demand((outward @ jacobian[:3])[None], acceleration=np.array([wanted]), drift=np.array([drift]))

    def _error(self, skin: Reading, time: float) -> float:
        measured = np.nan_to_num(skin.force[self._own], nan=0.0, posinf=0.0)
        seen = skin.distance[self._own]
        seen = seen[np.isfinite(seen)]
        self.force = float(self._push @ measured)
        self.distance = float(seen.mean()) if len(seen) else np.inf
        far = min(self.distance, self._reach) - self.target_distance
        missing = self.target_force - self.force
        gains = self.gains
        error = self.weight * missing + (1.0 - self.weight) * gains.distance_stiffness * far
        if self.force <= _FELT and gains.gain:
            error = min(error, self.approach_speed * gains.damping / gains.gain)
        period = 0.0 if self._last is None else max(0.0, time - self._last)
        self._last = time
        self._sum = self._sum + self.weight * missing * period if self.force > _FELT else 0.0
        return error
