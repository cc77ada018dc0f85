"""A hand or a massless object that comes straight towards a link and goes back."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sim.companion.experiment import AWAY, add_moved


class Visitor:
    """A moved body without weight or collision, which only skin measures.

    `size` of the geom (3,) in m; `face`: distance in m from middle to front.
    """

    def __init__(self, name: str, kind: Any, size: tuple[float, float, float], face: float) -> None:
        self.name = name
        self.face = face
        self._kind = kind
        self._size = size
        self._target = np.zeros(3)
        self._way = np.array([0.0, 0.0, 1.0])
        self._times = (np.inf, np.inf)
        self._speed = 0.0
        self._far = 0.0
        self._beyond = 0.0

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        add_moved(spec, self.name, self._kind, self._size)

    def plan(
        self,
        target: NDArray[np.float64],
        way: NDArray[np.float64],
        begin: float,
        speed: float,
        far: float,
        beyond: float,
    ) -> float:
        """Plan its visit; returns the time in s at which it is back.

        It sets out at `begin` in s with `speed` in m/s, `far` in m before the `target` (3,) of its face in the world in
        m, comes along `way` (3,) and goes `beyond` by so many m.
        """
        self._target = target
        self._way = way / np.linalg.norm(way)
        self._speed = speed
        self._far = far
        self._beyond = beyond
        self._times = (begin, begin + 2.0 * (far + beyond) / speed)
        return self._times[1]

    def act(self, world: Any, time: float) -> None:
        """Move it in the `world` to its place at `time` in s."""
        begin, end = self._times
        number = int(world.model.body(self.name).mocapid[0])
        if not begin <= time < end:
            world.data.mocap_pos[number] = AWAY
            return
        path = self._far + self._beyond
        gone = path - abs((time - begin) * self._speed - path)
        world.data.mocap_pos[number] = self._target + (gone - self._far - self.face) * self._way
        turn = np.zeros(4)
        mujoco.mju_quatZ2Vec(turn, self._way)
        world.data.mocap_quat[number] = turn
