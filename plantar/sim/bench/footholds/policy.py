"""A policy of the foothold benchmark: input, output, and loading."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.command import Sensors
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.plan_change import MovedStep
from plantar.gait.propose.velocity_command import VelocityTable
from plantar.robots.controller import JointTargets, RobotController, load_controller, without_taxels
from plantar.sensing.reading import Reading


@dataclass(frozen=True)
class WalkTask:
    """What a policy knows of a trial: the walk on level ground.

    `joints`: names of its k leg joints, in order of all joint vectors; `period`: time in s between calls of `step`;
    `stance`: joint angles (k,) in rad and torques (k,) in N m at time 0; `steps`: footsteps to take, in order, world
    frame; none where a velocity is commanded; `end`: time in s the built-in controller needs; a run of footsteps has
    1.5 times that; `swings`: when in s the built-in controller lifts and lands the foot of each step; `velocities`:
    commanded over time, or None; `weight` in N and length of `leg` in m of the robot.
    """

    robot: str
    joints: tuple[str, ...]
    period: float
    stance: JointTargets
    feet: Mapping[Side, Footstep]
    steps: tuple[Footstep, ...]
    end: float
    walk: Mapping[str, Any]
    swings: tuple[tuple[float, float], ...] = ()
    velocities: VelocityTable | None = None
    weight: float = 1.0
    leg: float = 1.0


class Action(NamedTuple):
    """Demand of a policy on the leg joints.

    Attributes:
        angles: Joint angles (k,) in rad.
        torques: Feed-forward torques (k,) in N m, added to the servos'; or None.
        moved: Footsteps moved on purpose.
    """

    angles: NDArray[np.float64]
    torques: NDArray[np.float64] | None = None
    moved: Sequence[MovedStep] = ()


class Policy(Protocol):
    """A controller, made for each trial by its file's `make_policy(task)`."""

    def step(self, sensors: Sensors) -> Action:
        """The action of a control tick, from `sensors`."""


class OwnController(Policy):
    """Plantar's walking controller as a policy, by all that its taxels tell."""

    soles = "taxels"
    """What measures the soles' loads, as of `load_controller`."""

    def __init__(self, task: WalkTask) -> None:
        self._walker: RobotController = load_controller(task.robot, {"walk": task.walk}, soles=self.soles)
        self._walker.count_as_checked()

    def step(self, sensors: Sensors) -> Action:
        command = self._walker.step(sensors)
        targets = self._walker.joint_targets(command)
        return Action(targets.angles, targets.torques, command.moved_steps)


class ByAnkles(OwnController):
    """The controller by force-torque sensors at the ankles, every foothold a whole sole."""

    soles = "force_torque"


class ByNetForce(Policy):
    """The controller by each sole's net force alone, without its place; every foothold a whole sole."""

    def __init__(self, task: WalkTask) -> None:
        self._walker: RobotController = load_controller(
            task.robot, {"walk": task.walk, "control": without_taxels("skin")}
        )
        self._walker.count_as_checked()
        layouts = self._walker.robot.layouts
        self._shares = {side: layout.areas / layout.areas.sum() for side, layout in layouts.items()}

    def step(self, sensors: Sensors) -> Action:
        readings = {
            side: Reading.taken_over(reading.time, np.nansum(reading.force) * self._shares[side])
            for side, reading in sensors.readings.items()
        }
        command = self._walker.step(sensors.changed(readings=readings))
        targets = self._walker.joint_targets(command)
        return Action(targets.angles, targets.torques, command.moved_steps)


class Zero:
    """The action 0 of the environments: holds the standing posture, takes no step."""

    def __init__(self, task: WalkTask) -> None:
        self._action = np.zeros(len(task.joints))

    def act(self, observation: Mapping[str, NDArray[np.float32]]) -> NDArray[np.float64]:
        return self._action


BASELINES: Mapping[str, Any] = {"zero": Zero, "net-force": ByNetForce, "ankles": ByAnkles, "plantar": OwnController}
"""Rows that every trial has, by name: the action 0, and the controller by what measures its soles."""


def load_policy(path: str | os.PathLike[str]) -> Any:
    """Run a Python file and return its `make_policy`.

    Its text is compiled each time: a cached form counts as current where a file is changed twice within a second.
    """
    file = Path(path)
    if not file.is_file() or file.suffix != ".py":
        raise InputError(f"policy '{file}' is no Python file; allowed: a .py file with make_policy(task)")
    module = ModuleType(file.stem)
    module.__file__ = str(file)
    try:
        exec(compile(file.read_bytes(), str(file), "exec"), module.__dict__)
    except Exception as problem:  # whatever the file raises
        raise InputError(f"policy '{file}' cannot be run: {type(problem).__name__}: {problem}") from None
    make = getattr(module, "make_policy", None)
    if not callable(make):
        raise InputError(f"policy '{file}' has no function make_policy(task)")
    return make
