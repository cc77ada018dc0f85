"""Dynamics of a free-floating robot that moves its legs."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side

_BASE = 6  # velocities of the free base: three of its origin in the world frame, three turns in its own


class BodyDynamics:
    """M(q) a + h(q, v) = [0, tau] + sum J^T w over base (6) and leg joints (k).

    `model`: the robot alone, first joint free; `dofs`: place (k,) of each leg joint among the velocities; `sites`: sole
    site of each side. Attributes `rows`: places (6 + k,) of base's and joints' velocities; `mass`: M (6 + k, 6 + k),
    with rotors, after `place`; its first three rows over the mass are the CoM's Jacobian; `bias`: h (6 + k,), after
    `move`: Coriolis, centrifugal, gravity and damping terms; `soles`: Jacobian (6, 6 + k) of each sole site's velocity
    and turn, world frame; `drifts`: acceleration (6,) of each sole site for a = 0, after `move`.
    """

    def __init__(self, model: mujoco.MjModel, dofs: NDArray[np.int_], sites: Mapping[Side, int]) -> None:
        self._model = model
        self.data = mujoco.MjData(model)
        self._sites = sites
        self.rows = np.concatenate([np.arange(_BASE), dofs]).astype(np.intp)
        count = len(self.rows)
        size = model.nv
        self._grid = np.ix_(self.rows, self.rows)
        self._full = np.zeros((size, size))
        self._acceleration = np.zeros(size)
        self._force = np.zeros(size)
        self._wide = np.zeros((6, size))
        self._damping = model.dof_damping[self.rows]
        self.mass = np.zeros((count, count))
        self.bias = np.zeros(count)
        self.soles: dict[Side, NDArray[np.float64]] = {s: np.zeros((6, count)) for s in SIDES}
        self.drifts: dict[Side, NDArray[np.float64]] = {s: np.zeros(6) for s in SIDES}

    def place(self, configuration: NDArray[np.float64]) -> None:
        """Compute mass matrix and Jacobians at a configuration (nq,); then `move`."""
        model = self._model
        data = self.data
        data.qpos[:] = configuration
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, self._full)
        self.mass[:] = self._full[self._grid]
        for side, site in self._sites.items():
            mujoco.mj_jacSite(model, data, self._wide[:3], self._wide[3:], site)
            self.soles[side][:] = self._wide[:, self.rows]

    def move(self, velocity: NDArray[np.float64]) -> None:
        """Compute bias and drifts at a velocity (6 + k,)."""
        model = self._model
        data = self.data
        data.qvel[self.rows] = velocity
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, self._force)
        self.bias[:] = self._force[self.rows] + self._damping * velocity
        for side, site in self._sites.items():
            body = int(model.site_bodyid[site])
            point = data.site_xpos[site]
            mujoco.mj_jacDot(model, data, self._wide[:3], self._wide[3:], point, body)
            self.drifts[side][:] = self._wide @ data.qvel
