"""What a policy of the environments sees of a trial, and what its action does there.

Observation, action and period are those of `plantar.sim.environments.walker.PlantarEnv`; joint velocities and gravity's
direction are found from encoders and IMU, as on a robot.
"""

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.gait.command import Sensors
from plantar.sim.bench.footholds.policy import Action, WalkTask

PERIOD = 0.02
"""Time in s between two observations."""

SCALE = 0.3
"""Angle in rad of an action of 1."""

_UP_RATE = 1.0  # 1/s at which gravity's direction follows the accelerometer; a step sways for less than a second
_UP = np.array([0.0, 0.0, 1.0])


class ActingPolicy(Protocol):
    """A policy of the environments."""

    def act(self, observation: dict[str, NDArray[np.float32]]) -> NDArray[np.float32]:
        """Action (k,) of -1 to 1."""


class Observer:
    """Makes observations of a trial's sensors: joints, imu, task, skin_left and skin_right, float32.

    `task` is (4,) where footsteps are asked for, as of `PlantarStep-v0`: swing foot (1 left, -1 right), share of the
    time to its landing, and way (2,) in legs from where it stood to its next footstep, in the heading of the other one;
    (3,) where a velocity is, as of `PlantarWalk-v0`: forward and left in sqrt(g l), turn in sqrt(g / l). Zeros before
    the first and after the last step.
    """

    def __init__(self, task: WalkTask) -> None:
        self._task = task
        self._every = max(1, round(PERIOD / task.period))
        self._up = _UP.copy()
        self._before: NDArray[np.float64] | None = None
        self._velocity = np.zeros(len(task.joints))
        self._ticks = 0
        stood = dict(task.feet)
        self._ways = []
        for step in task.steps:
            other = stood["right" if step.side == "left" else "left"]
            c, s = math.cos(other.yaw), math.sin(other.yaw)
            x, y = step.x - stood[step.side].x, step.y - stood[step.side].y
            self._ways.append((step.side, (c * x + s * y) / task.leg, (c * y - s * x) / task.leg))
            stood[step.side] = step

    def sense(self, sensors: Sensors) -> bool:
        """Take in a tick's `sensors`; whether an observation is due."""
        dt = self._task.period
        up = self._up - dt * np.cross(sensors.gyro, self._up)
        size = float(np.linalg.norm(sensors.accelerometer))
        if size > 0.0:
            up += _UP_RATE * dt * (sensors.accelerometer / size - up)
        self._up = up / np.linalg.norm(up)
        due = self._ticks % self._every == 0
        if due:
            if self._before is not None:
                self._velocity = (sensors.joint_positions - self._before) / (self._every * dt)
            self._before = np.array(sensors.joint_positions)
        self._ticks += 1
        return due

    def observation(self, sensors: Sensors) -> dict[str, NDArray[np.float32]]:
        """The observation of the last tick taken in."""
        off = sensors.joint_positions - self._task.stance.angles
        seen: dict[str, Any] = {
            "joints": np.concatenate([off, self._velocity]),
            "imu": np.concatenate([sensors.gyro, sensors.accelerometer, -self._up]),
            "task": self._asked(sensors.time),
        }
        for side, reading in sensors.readings.items():
            seen[f"skin_{side}"] = np.nan_to_num(reading.force) / self._task.weight
        return {name: np.asarray(value, dtype=np.float32) for name, value in seen.items()}

    def _asked(self, time: float) -> NDArray[np.float64]:
        task = self._task
        if task.velocities is not None:
            told = task.velocities.at(time)
            beat = math.sqrt(task.leg / GRAVITY)
            if told is None:
                return np.zeros(3)
            return np.array([told.forward / task.leg * beat, told.left / task.leg * beat, told.turn * beat])
        begin = 0.0
        for (_, landing), (side, x, y) in zip(task.swings, self._ways, strict=False):
            if time < landing:
                share = (time - begin) / (landing - begin)
                return np.array([1.0 if side == "left" else -1.0, share, x, y])
            begin = landing
        return np.zeros(4)


def set_points(task: WalkTask, action: Any) -> Action:
    """Joint set-points of an action (k,) of -1 to 1; InputError if it is none."""
    try:
        given = np.asarray(action, dtype=np.float64)
    except (TypeError, ValueError):
        given = np.empty(0)
    if given.shape != task.stance.angles.shape or not np.isfinite(given).all():
        raise InputError(
            f"policy's act returned {action!r:.80}; allowed: an action of {len(task.joints)} finite numbers, -1 to 1"
        )
    return Action(task.stance.angles + SCALE * np.clip(given, -1.0, 1.0), task.stance.torques)


class Observing:
    """Calls a policy of the environments once an observation, and holds its action until the next."""

    def __init__(self, policy: ActingPolicy, task: WalkTask) -> None:
        self._policy = policy
        self._task = task
        self._observer = Observer(task)
        self._held: Action | None = None

    def step(self, sensors: Sensors) -> Action:
        """The action of a control tick, from `sensors`."""
        if self._observer.sense(sensors) or self._held is None:
            self._held = set_points(self._task, self._policy.act(self._observer.observation(sensors)))
        return self._held
