"""Tasks of a Gymnasium environment: ground, disturbances, observation and reward.

Velocities are in sqrt(g l), lengths in legs l, times in beats sqrt(l / g). Rewards are at most 1 a step.
"""

import math
from collections.abc import Mapping
from typing import Any, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.mechanics.rotation import rotation_from_angles
from plantar.mujoco.bound_skin import SkinReading
from plantar.robots.robot import Robot
from plantar.sim.model.world import World
from plantar.sim.terrain import CORNERS, Ground, Motion, Solid, Terrain


class Simulated(Protocol):
    """What a task reads of its environment (`plantar.sim.environments.walker.PlantarEnv`)."""

    robot: Robot
    body: BodyScale
    world: World
    model: Any
    data: Any
    readings: Mapping[Side, SkinReading]
    difficulty: float
    period: float

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity (forward, left) in m/s and turn in rad/s."""

    @property
    def up(self) -> float:
        """The torso's z, upwards."""


class Task:
    """Stand still, on flat ground. `size`: numbers that `observe` returns."""

    size = 1

    def __init__(self, env: Simulated) -> None:
        self.env = env
        self.leg = env.body.leg
        self.speed = math.sqrt(GRAVITY * self.leg)
        self.beat = math.sqrt(self.leg / GRAVITY)

    def ground(self) -> Ground:
        """The ground to compile."""
        return Ground((), 0.0, Terrain.friction)

    def reset(self, rng: np.random.Generator) -> None:
        """Draw an episode."""

    def disturb(self, rng: np.random.Generator) -> None:
        """Before a step's physics, and after a reset."""

    def observe(self) -> NDArray[np.float64]:
        """What the task asks for."""
        return np.zeros(self.size)

    def reward(self) -> float:
        """Between 0 and 1."""
        moved = float(np.square(self.env.velocity[:2]).sum()) / (0.1 * self.speed) ** 2
        return 0.5 * self.upright + 0.5 * math.exp(-moved)

    def info(self) -> dict[str, Any]:
        """Figures of the task."""
        return {}

    @property
    def failed(self) -> bool:
        """Whether the task can no longer be done, though the robot stands; ends the episode."""
        return False

    @property
    def upright(self) -> float:
        """1 for an upright torso, 0.37 at 0.2 rad."""
        return math.exp(-2.0 * (1.0 - self.env.up) / 0.04)


class Stand(Task):
    """Stand still; each 8 beats a push changes the velocity by up to 0.4 sqrt(g l)."""

    def reset(self, rng: np.random.Generator) -> None:
        self._next = 8.0 * self.beat

    def disturb(self, rng: np.random.Generator) -> None:
        if self.env.data.time >= self._next:
            self._next += 8.0 * self.beat
            way = rng.uniform(0.0, 2.0 * math.pi)
            size = self.env.difficulty * rng.uniform(0.0, 0.4) * self.speed
            self.env.data.qvel[:2] += size * np.array([math.cos(way), math.sin(way)])


class Step(Task):
    """Step onto targets: each 3 beats one foot, left first, up to a sixth of a leg ahead.

    Observed: swing foot (1 left, -1 right), share of its time, target (2,) from its sole in the torso's heading. `info`
    has "steps": landings within 0.1 leg, and "missed": the other ones, of which the third fails.
    """

    size = 4

    def reset(self, rng: np.random.Generator) -> None:
        self._begin = 0.0
        self._swing = 0
        self.steps = 0
        self.missed = 0
        self._lifted = False
        self._target: NDArray[np.float64] | None = None

    def disturb(self, rng: np.random.Generator) -> None:
        now = float(self.env.data.time)
        env = self.env
        passed = now - self._begin >= 3.0 * self.beat
        if passed:
            landed = self._lifted and self._load() > 0.05 and self._off() < 0.1 * self.leg
            self.steps += int(landed)
            self.missed += int(not landed)
            self._begin = now
            self._swing = 1 - self._swing
            self._lifted = False
        if passed or self._target is None:
            other = env.data.site_xpos[env.world.sole_sites[SIDES[1 - self._swing]], :2]
            c, s = self._heading()
            aside = env.robot.stance_width * (1.0 if self._swing == 0 else -1.0)
            ahead = env.difficulty * rng.uniform(0.0, self.leg / 6.0)
            self._target = other + np.array([c * ahead - s * aside, s * ahead + c * aside])

    def _load(self) -> float:
        env = self.env
        return float(env.readings[SIDES[self._swing]].wrench[2]) / (env.body.mass * GRAVITY)

    def _heading(self) -> tuple[float, float]:
        turn = self.env.data.xmat[self.env.world.torso]
        length = math.hypot(turn[0], turn[3]) or 1.0
        return turn[0] / length, turn[3] / length

    def _to_target(self) -> NDArray[np.float64]:
        env = self.env
        return np.asarray(self._target - env.data.site_xpos[env.world.sole_sites[SIDES[self._swing]], :2])

    def _off(self) -> float:
        return float(np.hypot(*self._to_target()))

    def _share(self) -> float:
        return min((float(self.env.data.time) - self._begin) / (3.0 * self.beat), 1.0)

    def observe(self) -> NDArray[np.float64]:
        x, y = self._to_target() / self.leg
        c, s = self._heading()
        return np.array([1.0 - 2.0 * self._swing, self._share(), c * x + s * y, c * y - s * x])

    def reward(self) -> float:
        share = self._share()
        in_air = self._load() < 0.05
        self._lifted = self._lifted or in_air
        lifted = 0.2 * in_air if share < 0.8 else 0.2
        return lifted + 0.4 * self.upright + 0.4 * share * math.exp(-((self._off() / (0.1 * self.leg)) ** 2))

    def info(self) -> dict[str, Any]:
        return {"steps": self.steps, "missed": self.missed}

    @property
    def failed(self) -> bool:
        return self.missed > 2


class Walk(Task):
    """Walk at a velocity on square tiles within a fortieth of a leg, friction 0.5 to 1.

    Drawn every 16 beats and observed (3,): forward -0.1 to 0.3, left -0.1 to 0.1 sqrt(g l), turn -0.1 to 0.1 sqrt(g /
    l). `info` has "behind": how far the robot is in legs from where it was told to be, in its heading at each time; a
    leg fails.
    """

    size = 3
    _LOW = np.array([-0.1, -0.1, -0.1])
    _HIGH = np.array([0.3, 0.1, 0.1])

    def ground(self) -> Ground:
        side = 0.6 * self.leg
        solids = []
        for i in range(-3, 16):
            for j in range(-5, 6):
                centre = np.array([i * side, j * side, -0.1])
                solids.append(Solid("box", (0.5 * side, 0.5 * side, 0.1), centre))
        self._level = np.array([np.hypot(*s.position[:2]) < self.leg for s in solids])  # where the robot stands up
        return Ground(tuple(solids), -0.04 * self.leg, Terrain.friction)

    def reset(self, rng: np.random.Generator) -> None:
        model = self.env.model
        world = self.env.world
        seen = model.geom("ground_0").id
        touched = model.geom(f"ground_0{CORNERS}").id
        rises = self.env.difficulty * self.leg / 40.0 * rng.uniform(-1.0, 1.0, len(self._level))
        for first in (seen, touched):
            model.geom_pos[first : first + len(rises), 2] = np.where(self._level, 0.0, rises) - 0.1
        soles = [g for geoms in world.sole_geoms.values() for g in geoms]
        tiles = range(touched, touched + len(rises))
        model.geom_friction[[*tiles, model.geom("ground").id, *soles], 0] = rng.uniform(0.5, 1.0)
        self._next = 0.0
        self.command = np.zeros(3)
        self._behind = np.zeros(2)

    def disturb(self, rng: np.random.Generator) -> None:
        if self.env.data.time >= self._next:
            self._next += 16.0 * self.beat
            self.command = self.env.difficulty * rng.uniform(self._LOW, self._HIGH)

    def observe(self) -> NDArray[np.float64]:
        return self.command

    def info(self) -> dict[str, Any]:
        return {"behind": float(np.hypot(*self._behind))}

    @property
    def failed(self) -> bool:
        return float(np.hypot(*self._behind)) > 1.0

    def reward(self) -> float:
        told = self.command[:2] / self.beat * self.env.period
        self._behind += told - self.env.velocity[:2] * self.env.period / self.leg
        off = self.env.velocity / np.array([self.speed, self.speed, 1.0 / self.beat]) - self.command
        return (
            0.3 * self.upright
            + 0.5 * math.exp(-float(off[:2] @ off[:2]) / 0.01)
            + 0.2 * math.exp(-(off[2] ** 2) / 0.01)
        )


class Board(Task):
    """Stand on a board that tilts about both horizontal axes by up to 7 degrees, 0.05 to 0.15 swings a beat."""

    def ground(self) -> Ground:
        half = (1.5 * self.leg, 1.5 * self.leg, 0.05)
        centre = np.array([0.0, 0.0, -0.05])
        return Ground(
            (Solid("box", half, centre, motions=(Motion(math.inf, 0.0, centre),)),), -self.leg, Terrain.friction
        )

    def reset(self, rng: np.random.Generator) -> None:
        self._size = self.env.difficulty * math.radians(7.0) * rng.uniform(0.5, 1.0, 2)
        self._rate = 2.0 * math.pi * rng.uniform(0.05, 0.15, 2) / self.beat
        self._board = int(self.env.model.body("ground_0").mocapid[0])
        self.env.data.mocap_quat[self._board] = [1.0, 0.0, 0.0, 0.0]

    def disturb(self, rng: np.random.Generator) -> None:
        roll, pitch = self._size * np.sin(self._rate * self.env.data.time)
        rotation = rotation_from_angles(0.0, pitch, roll)
        mujoco.mju_mat2Quat(self.env.data.mocap_quat[self._board], rotation.ravel())
        self.env.data.mocap_pos[self._board] = -0.05 * rotation[:, 2]


TASKS: dict[str, type[Task]] = {"stand": Stand, "step": Step, "walk": Walk, "board": Board}
"""The tasks by name."""
