"""Hands that push a machine's links, and a person at its base."""

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.easing import minimum_jerk
from plantar.sim.companion.experiment import AWAY, World, add_moved

FIST = 0.03
"""Radius in m of the hand that pushes."""

PERSON = 0.2
"""Radius in m of the person."""

_AWAY = 0.05  # m above the surface where the hand waits
_YIELD = 4e-3  # m/(N s): how fast the pushing hand goes on where force is missing, 30 1/s on one taxel
_RAMP = 0.4  # s in which a push comes and goes


def come_and_go(time: float, start: float, end: float, ramp: float) -> float:
    """Returns a share, 0 to 1, at `time` that rises from `start` and is 0 at `end`, over `ramp` each, in s:
    minimum-jerk blends.

    Example:
        >>> [come_and_go(t, 1.0, 5.0, 2.0) for t in (0.0, 2.0, 3.0, 4.0, 6.0)]
        [0.0, 0.5, 1.0, 0.5, 0.0]
    """
    return minimum_jerk((time - start) / ramp)[0] * minimum_jerk((end - time) / ramp)[0]


@dataclass(frozen=True)
class Push:
    """One push on a link.

    `start` in s; `end` in s; `along`: place in m along the link's z axis; `angle`: direction about it of push, in rad
    from the link's x axis; `radius`: distance of surface and axis in m; `force` in N.
    """

    start: float
    end: float
    link: str
    along: float
    angle: float
    radius: float
    force: float

    def wanted(self, time: float) -> float:
        """Force in N at a time in s."""
        return self.force * come_and_go(time, self.start, self.end, _RAMP)


class Fist:
    """A person's hand that pushes and follows what it pushes."""

    def __init__(self, pushes: list[Push]) -> None:
        self.pushes = pushes
        self._depth = -_AWAY

    def add_to(self, spec: Any) -> None:
        """Put it into a world, far away."""
        add_moved(spec, "fist", mujoco.mjtGeom.mjGEOM_SPHERE, (FIST, 0.0, 0.0), (0.9, 0.7, 0.55, 1.0))

    def act(self, world: World, time: float, measured: float) -> None:
        """Move in the `world` at `time` in s, by its `measured` force in N."""
        push = next((p for p in self.pushes if p.start <= time < p.end), None)
        place = world.model.body("fist").mocapid[0]
        if push is None:
            self._depth = -_AWAY
            world.data.mocap_pos[place] = AWAY
            return
        period = float(world.model.opt.timestep)
        wanted = push.wanted(time)
        if measured == 0.0 and time > 0.5 * (push.start + push.end):
            self._depth -= 0.3 * period
        elif measured == 0.0:  # it comes near, and touches slowly
            self._depth += period * (0.3 if self._depth < -0.005 else 0.03)
        else:
            self._depth += period * _YIELD * (wanted - measured)
        origin, rotation = world.pose(push.link)
        away = push.radius + FIST - self._depth
        offset = np.array([away * math.cos(push.angle), away * math.sin(push.angle), push.along])
        world.data.mocap_pos[place] = origin + rotation @ offset


@dataclass(frozen=True)
class Visit:
    """One visit of a person.

    `start` in s; `end` in s; `goal`: nearest place (2,) in m, in the base's frame at the start; `far`: first place
    (2,), likewise; `speed` in m/s.
    """

    start: float
    end: float
    goal: NDArray[np.float64]
    far: NDArray[np.float64]
    speed: float

    def place(self, time: float) -> NDArray[np.float64]:
        """Place (2,) in m of the person at a time in s."""
        way = float(np.linalg.norm(self.goal - self.far)) / self.speed
        return self.far + come_and_go(time, self.start, self.end, way) * (self.goal - self.far)


class Visitor:
    """A person who visits the base: an upright cylinder."""

    def __init__(self, visits: list[Visit]) -> None:
        self.visits = visits
        self._frame: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None

    def add_to(self, spec: Any) -> None:
        """Put the person into a world, far away."""
        body = spec.worldbody.add_body(name="person", pos=[-9.0, 0.0, 0.85], mocap=True)
        body.add_geom(
            name="person",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[PERSON, 0.85, 0.0],
            contype=0,
            conaffinity=0,
            rgba=[0.85, 0.5, 0.3, 1.0],
        )

    def act(self, world: World, time: float) -> None:
        """Move in the `world` to the place at `time` in s."""
        visit = next((v for v in self.visits if v.start <= time < v.end), None)
        place = np.array([-9.0, 0.0])
        if visit is None:
            self._frame = None
        else:
            self._frame = self._frame or world.pose(world.machine.base.link)
            origin, rotation = self._frame
            place = origin[:2] + rotation[:2, :2] @ visit.place(time)
        world.data.mocap_pos[world.model.body("person").mocapid[0], :2] = place
