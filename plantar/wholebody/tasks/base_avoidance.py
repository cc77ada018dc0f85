"""A mobile base avoids its distance sensors' obstacles (A 15-17)."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.errors import InputError
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class AvoidanceField(Settings):
    """The repulsive field (A 16).

    Attributes:
        force: f_max at distance 0, and of all obstacles together: more than the drives have disturbs higher priorities.
        decay: alpha: distance to 37 %.
        reach: Distance from which it is 0.
    """

    force: float = number(400.0, "N", 0, 1e5)
    decay: float = number(0.15, "m", 1e-3, 10)
    reach: float = number(1.0, "m", 1e-3, 100)


class BaseAvoidance(Task):
    """Pushes the base from each obstacle by f_max exp(-d / alpha) (A 15-16; from it to the base).

    `half_size`: half lengths (x, y) of its rectangle in m. Attributes `obstacles`: obstacles' nearest points (m, 2),
    base frame, in m, by its sensors.
    """

    def __init__(self, link: str, half_size: tuple[float, float], field: AvoidanceField | None = None) -> None:
        if not min(half_size) > 0.0:
            raise InputError(f"half lengths of the footprint are {half_size} m; allowed: above 0")
        self.field = field or AvoidanceField()
        self.obstacles: NDArray[np.float64] = np.zeros((0, 2))
        self._link = link
        self._half = np.asarray(half_size, dtype=float)

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        own = np.clip(self.obstacles, -self._half, self._half)
        apart = own - self.obstacles
        distance = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        near = (distance < self.field.reach) & (distance > 0.0)
        if not near.any():
            return None
        own = own[near]
        distance = distance[near]
        push = apart[near] * (self.field.force * np.exp(-distance / self.field.decay) / distance)[:, None]
        push *= min(1.0, self.field.force / max(float(np.linalg.norm(push.sum(axis=0))), 1e-12))
        moment = float((own[:, 0] * push[:, 1] - own[:, 1] * push[:, 0]).sum())  # A 17's last column
        rotation = robot.pose(self._link)[1]
        rows = np.vstack([rotation[:, :2].T @ robot.jacobian(self._link)[:3], robot.jacobian(self._link)[5]])
        return Demand(rows, force=np.array([*push.sum(axis=0), moment]))
