"""Contacts that support a free base (T 3.12-3.13)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.mechanics.wrench_cone import Rectangle
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

_POINT = Rectangle(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Standing:
    """An unmoving contact: a link's point, and what the ground blocks.

    `point` (3,), link frame, in m, best where the force should be; `flat`: whether turning is blocked too, unlike point
    contacts; `area`: carrying area about the point in m, for force distribution; `rotation`: contact (z into the body)
    to link frame (3, 3); None for none.
    """

    link: str
    point: NDArray[np.float64]
    flat: bool = True
    area: Rectangle = _POINT
    rotation: NDArray[np.float64] | None = None
    friction: float = 0.6

    @property
    def rows(self) -> int:
        """Its rows in a support."""
        return 6 if self.flat else 3


class Support(Task):
    """Keeps contacts at rest: J_s q'' + J_s' q' = 0, above all tasks (T 3.13).

    `contacts` by name, such as the feet; assignable; InputError if empty.
    """

    def __init__(self, contacts: Mapping[str, Standing]) -> None:
        if not contacts:
            raise InputError("a support needs one contact at least")
        self.contacts = dict(contacts)

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        jacobian = np.vstack([robot.jacobian(c.link, c.point)[: c.rows] for c in self.contacts.values()])
        drift = np.concatenate([robot.drift(c.link, c.point)[: c.rows] for c in self.contacts.values()])
        return Demand(jacobian, acceleration=np.zeros(len(drift)), drift=drift)
