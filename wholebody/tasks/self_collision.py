"""Links keep away from each other (T 3.2.3.1): a repulsive field between spheres on them, silent while they are far."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from wholebody.dynamics import RobotDynamics
from wholebody.skin.reading import SkinReading
from wholebody.tasks.task import Demand, Task

__all__ = ["SelfCollision", "Sphere"]


class Sphere(NamedTuple):
    """A sphere on a link.

    Attributes:
        link: The link.
        center: Centre (3,) in the link's frame in m.
        radius: Radius in m.
    """

    link: str
    center: NDArray[np.float64]
    radius: float


class SelfCollision(Task):
    """Pushes two spheres apart along the line of their centres, one row a pair that is near.

    Args:
        pairs: Pairs of spheres that must not meet.
        margin: Gap in m from which on a pair is pushed apart.
        stiffness: Force in N a metre that the gap is smaller.
        damping: Force in N a m/s at which the gap closes.

    Raises:
        InputError: If the margin is not above 0.
    """

    def __init__(
        self, pairs: Sequence[tuple[Sphere, Sphere]], margin: float, stiffness: float, damping: float = 0.0
    ) -> None:
        if not margin > 0.0:
            raise InputError(f"margin of self-collision is {margin} m; allowed: above 0")
        self.pairs, self.margin, self.stiffness, self.damping = tuple(pairs), margin, stiffness, damping

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        rows, forces = [], []
        for a, b in self.pairs:
            apart = _center(robot, a) - _center(robot, b)
            distance = float(np.sqrt(apart @ apart))
            gap = distance - a.radius - b.radius
            if gap >= self.margin or distance == 0.0:
                continue
            toward = apart / distance
            row = toward @ (robot.jacobian(a.link, a.center)[:3] - robot.jacobian(b.link, b.center)[:3])
            closing = min(0.0, float(row @ robot.velocity))
            rows.append(row)
            forces.append(self.stiffness * (self.margin - gap) - self.damping * closing)
        return Demand(np.array(rows), force=np.array(forces)) if rows else None


def _center(robot: RobotDynamics, sphere: Sphere) -> NDArray[np.float64]:
    origin, rotation = robot.pose(sphere.link)
    return np.asarray(origin + rotation @ sphere.center)
