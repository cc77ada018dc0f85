"""A run that is watched from outside: its motion, its controls, and what was computed in it."""

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
    """A simulation that keeps what its physics was given and shows its motion in one number.

    Attributes:
        controls: Set-points of the servos at each physics step.
        members: How often each member of a percept was computed, over both soles and all ticks.
        percepts: How many percepts there were.
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
        """As the runner's, after which is counted what was computed.

        Args:
            command: The command of this tick, with its percepts.
            everything: Compute all members.

        Returns:
            How many were left out.
        """
        left_out = super().compute_rest(command, everything)
        for percept in command.percepts.values():
            self.members.update(percept.__dict__.keys() & set(percept.members()))
            self.percepts += 1
        return left_out

    @property
    def motion(self) -> str:
        """Hash of all positions of all physics steps: two runs have the same only if they agree to the last bit."""
        return self._motion.hexdigest()

    @property
    def replays(self) -> bool:
        """Whether the controls alone repeat the motion: without pushes and moving ground."""
        return self.touch is None and not self.pusher.shoves and not self.world.moving_ground


def replay_physics(run: WatchedSimulation) -> tuple[float, str]:
    """The physics of a run alone: `mj_step` in a loop, from the same state with the same controls.

    Args:
        run: A run that `replays`, after it has run.

    Returns:
        CPU time in s, and the hash of the motion in a second loop that is not timed.
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
