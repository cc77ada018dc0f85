"""Links avoid each other (T 3.2.3.1): repulsive field between spheres."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import positive
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class Sphere(NamedTuple):
    """A sphere on a link. `center` (3,), link frame, in m; `radius` in m."""

    link: str
    center: NDArray[np.float64]
    radius: float


class SelfCollision(Task):
    """Pushes spheres apart along their centers' line, a row a near pair.

    `pairs` of spheres that must not meet; `margin`: gap in m from which pairs are pushed; InputError unless above 0;
    `stiffness`: force in N per metre of missing gap; `damping`: force in N per m/s of closing.
    """

    def __init__(
        self, pairs: Sequence[tuple[Sphere, Sphere]], margin: float, stiffness: float, damping: float = 0.0
    ) -> None:
        self.margin = positive(margin, "margin of self-collision", "m")
        self.pairs = tuple(pairs)
        self.stiffness = stiffness
        self.damping = damping
        spheres = list({(s.link, *np.asarray(s.center).tolist()): s for pair in pairs for s in pair}.values())
        places = {(s.link, *np.asarray(s.center).tolist()): i for i, s in enumerate(spheres)}
        index = [[places[s.link, *np.asarray(s.center).tolist()] for s in pair] for pair in pairs]
        self._links = list(dict.fromkeys(s.link for s in spheres))
        self._link_of = [self._links.index(s.link) for s in spheres]
        self._centers = np.array([s.center for s in spheres], dtype=float).reshape(-1, 3, 1)
        self._index = np.array(index, dtype=int).reshape(-1, 2)
        self._reach = np.array([a.radius + b.radius for a, b in pairs]) + margin

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        poses = [robot.pose(link) for link in self._links]
        origins = np.array([origin for origin, _ in poses])[self._link_of]
        rotations = np.array([rotation for _, rotation in poses])[self._link_of]
        centers = origins + (rotations @ self._centers)[:, :, 0]
        apart = centers[self._index[:, 0]] - centers[self._index[:, 1]]
        distances = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        near = np.flatnonzero((distances < self._reach) & (distances > 0.0))
        if not len(near):
            return None
        rows = np.empty((len(near), len(robot.velocity)))
        forces = np.empty(len(near))
        for i, pair in enumerate(near):
            a, b = self.pairs[pair]
            toward = apart[pair] / distances[pair]
            rows[i] = toward @ (robot.jacobian(a.link, a.center)[:3] - robot.jacobian(b.link, b.center)[:3])
            closing = min(0.0, float(rows[i] @ robot.velocity))
            forces[i] = self.stiffness * (self._reach[pair] - distances[pair]) - self.damping * closing
        return Demand(rows, force=forces)
