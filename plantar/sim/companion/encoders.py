"""Measured motion of the machine: joints, and the state of a floating base."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sim.companion.experiment import CompanionControl, World

__all__ = ["Encoders"]


class Encoders:
    """Measures positions and velocities with white noise. A floating base's place is known as well as a joint's, by the
    kinematics of the standing feet; its orientation is the IMU's.
    """

    def __init__(self, world: World, settings: CompanionControl, seed: int) -> None:
        self._world, self._settings = world, settings
        self._floats = world.machine.base.kind == "floating"
        self._rng = np.random.default_rng([seed, 0xEC])

    def read(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions (nq,) and velocities (nv,) of the machine alone, in its own model's order."""
        world, s = self._world, self._settings
        qpos = world.data.qpos[world.positions]
        qvel = world.data.qvel[world.speeds]
        moved = self._rng.normal(0.0, s.encoder_noise, len(qvel))
        qvel = qvel + self._rng.normal(0.0, s.velocity_noise, len(qvel))
        if not self._floats:
            return qpos + moved, qvel
        qvel[3:6] += self._rng.normal(0.0, s.gyro_noise, 3)
        qpos[:3] += moved[:3]
        qpos[7:] += moved[6:]
        turned = qpos[3:7].copy()
        mujoco.mju_quatIntegrate(turned, self._rng.normal(0.0, s.attitude_noise, 3), 1.0)
        qpos[3:7] = turned
        return qpos, qvel
