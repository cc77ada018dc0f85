"""A run whose motion, controls and computations are kept."""

from __future__ import annotations

import hashlib
import time
from collections import Counter
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command
from plantar.sim.run.runner import Simulation

__all__ = ["WatchedSimulation", "replay_physics"]


class WatchedSimulation(Simulation):
    """A simulation that keeps its controls and hashes its motion.

    Attributes:
        controls: Set-points of the servos at each physics step.
        members: How often each member of a percept was computed, over both soles and all ticks.
        percepts: Number of percepts.
    """

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        data = self.world.data
        self._began = mujoco.MjData(self.world.model)
        mujoco.mj_copyData(self._began, self.world.model, data)
        self.controls: list[NDArray[np.float64]] = []
        self.members: Counter[str] = Counter()
        self.percepts = 0
        self._motion = hashlib.sha256()

    def step_physics(self) -> None:
        """One step of the physics, whose controls and positions are kept."""
        self.controls.append(self.world.data.ctrl.copy())
        super().step_physics()
        self._motion.update(self.world.data.qpos.tobytes())

    def compute_rest(self, command: Command, everything: bool) -> int:
        """Returns as the runner's of `command` and `everything`, and counts what was computed."""
        left_out = super().compute_rest(command, everything)
        for percept in command.percepts.values():
            self.members.update(percept.__dict__.keys() & set(percept.members()))
            self.percepts += 1
        return left_out

    @property
    def motion(self) -> str:
        """Hash of all positions of all physics steps."""
        return self._motion.hexdigest()

    @property
    def replays(self) -> bool:
        """Whether the controls alone repeat the motion: without pushes and moving ground."""
        return self.touch is None and not self.pusher.shoves and not self.world.moving_ground


def replay_physics(run: WatchedSimulation) -> tuple[float, str]:
    """The physics alone of a finished run that `replays`: CPU time in s, and hash of the motion in an untimed second
    loop.
    """
    model = run.world.model
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, run._began)
    control, step = data.ctrl, mujoco.mj_step
    start = time.process_time()
    for row in run.controls:
        control[:] = row
        step(model, data)
    used = time.process_time() - start
    motion = hashlib.sha256()
    mujoco.mj_copyData(data, model, run._began)
    for row in run.controls:
        control[:] = row
        step(model, data)
        motion.update(data.qpos.tobytes())
    return used, motion.hexdigest()
