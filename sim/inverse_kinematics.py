"""Whole-body kinematics of the legs: soles and CoM forward, Newton steps on MuJoCo's Jacobians backward."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from gait.estimator import Posture
from plantar.layout import Side

__all__ = ["LegModel"]

_SIDES: tuple[Side, Side] = ("left", "right")


class LegModel:
    """Kinematics of a free-floating robot whose only joints are its legs.

    Args:
        model: The robot alone, first joint free, one hinge a leg joint.
        joints: Names of the leg joints in the order of all joint vectors.
        soles: Name of each sole's site.
        torso: Name of the body that is kept upright.
    """

    def __init__(self, model: mujoco.MjModel, joints: Sequence[str], soles: Mapping[Side, str], torso: str) -> None:
        self.model = model
        self._data = mujoco.MjData(model)  # of the solution
        self._probe = mujoco.MjData(model)  # of the measured posture, in the base frame
        self._probe.qpos[:7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        ids = [model.joint(name).id for name in joints]
        self._qpos = np.array([model.jnt_qposadr[i] for i in ids])
        self._dof = np.array([model.jnt_dofadr[i] for i in ids])
        free = model.jnt_limited[ids] == 0  # a joint without limits has the range 0 to 0 in the model
        self._lower = np.where(free, -np.inf, model.jnt_range[ids, 0])
        self._upper = np.where(free, np.inf, model.jnt_range[ids, 1])
        self._sites: dict[Side, int] = {s: model.site(soles[s]).id for s in _SIDES}
        self._torso = model.body(torso).id
        self._root = model.body_rootid[self._torso]
        self._columns = np.concatenate([np.arange(6), self._dof])
        self.mass = float(model.body_subtreemass[self._root])
        n = model.nv
        self._jac = np.zeros((18, n))
        self._velocity = np.zeros(n)
        self._static = mujoco.MjData(model)

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Forward kinematics in the base frame (see `gait.estimator.LegKinematics`)."""
        data = self._probe
        data.qpos[self._qpos] = joint_positions
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        return Posture(
            com=data.subtree_com[self._root].copy(),
            positions={s: data.site_xpos[i].copy() for s, i in self._sites.items()},
            rotations={s: data.site_xmat[i].reshape(3, 3).copy() for s, i in self._sites.items()},
        )

    def set_configuration(
        self, position: NDArray[np.float64], quaternion: NDArray[np.float64], joints: NDArray[np.float64]
    ) -> None:
        """Set the configuration that the next `solve` starts from.

        Args:
            position: Base position (3,) in the world frame in m.
            quaternion: Base orientation (4,), w first.
            joints: Joint angles (k,) in rad.
        """
        self._data.qpos[:3] = position
        self._data.qpos[3:7] = quaternion
        self._data.qpos[self._qpos] = joints

    @property
    def configuration(self) -> NDArray[np.float64]:
        """Configuration (nq,) of the last solution."""
        return np.array(self._data.qpos)

    def solve(
        self,
        com: NDArray[np.float64],
        rotation_torso: NDArray[np.float64],
        positions: Mapping[Side, NDArray[np.float64]],
        rotations: Mapping[Side, NDArray[np.float64]],
        iterations: int = 1,
    ) -> tuple[NDArray[np.float64], float]:
        """Joint angles for CoM, torso orientation and both soles: damped Newton steps from the last solution.

        The 18 task rows (CoM 3, torso orientation 3, two soles 6 each) meet the 18 unknowns of a 12-joint biped, so a
        step is one square solve; a damping of 1e-6 keeps a straight knee finite.

        Args:
            com: CoM (3,) in the world frame in m.
            rotation_torso: Rotation (3, 3) from the torso to the world frame.
            positions: Sole frame origin (3,) of each foot in m.
            rotations: Rotation (3, 3) from each sole to the world frame.
            iterations: Newton steps.

        Returns:
            Joint angles (k,) in rad within their limits, and the largest task error before the last step (m or rad).
        """
        model, data, jac = self.model, self._data, self._jac
        error: list[float] = []
        for _ in range(iterations):
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            mujoco.mj_jacSubtreeCom(model, data, jac[0:3], self._root)
            mujoco.mj_jacBody(model, data, None, jac[3:6], self._torso)
            error = (com - data.subtree_com[self._root]).tolist()
            error += _rotation_error(rotation_torso, data.xmat[self._torso].reshape(3, 3))
            row = 6
            for side in _SIDES:
                site = self._sites[side]
                mujoco.mj_jacSite(model, data, jac[row : row + 3], jac[row + 3 : row + 6], site)
                error += (positions[side] - data.site_xpos[site]).tolist()
                error += _rotation_error(rotations[side], data.site_xmat[site].reshape(3, 3))
                row += 6
            square = jac[:, self._columns]
            normal = square.T @ square
            normal.ravel()[:: len(normal) + 1] += 1e-8
            _, step, _ = dposv(normal, square.T.dot(np.array(error)))
            self._velocity[self._columns] = np.minimum(np.maximum(step, -0.5), 0.5)
            configuration = data.qpos
            mujoco.mj_integratePos(model, configuration, self._velocity, 1.0)
            joints = np.minimum(np.maximum(configuration[self._qpos], self._lower), self._upper)
            configuration[self._qpos] = joints
        return joints, max(map(abs, error))

    def static_torques(
        self, forces: Mapping[Side, NDArray[np.float64]], points: Mapping[Side, NDArray[np.float64]]
    ) -> NDArray[np.float64]:
        """Joint torques (k,) in N m that hold the last solution against gravity and given ground forces.

        Args:
            forces: Force (3,) in N that the ground exerts on each sole, world frame.
            points: Point (3,) in m at which it acts, world frame.

        Returns:
            tau = g(q) - sum J^T f.
        """
        model, data = self.model, self._static
        data.qpos[:] = self._data.qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        result = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 0, result)
        jac = np.zeros((3, model.nv))
        for side in _SIDES:
            if forces[side][2] <= 0.0:
                continue
            mujoco.mj_jac(model, data, jac, None, points[side], model.site_bodyid[self._sites[side]])
            result -= jac.T.dot(forces[side])
        torques: NDArray[np.float64] = result[self._dof]
        return torques


def _rotation_error(wanted: NDArray[np.float64], actual: NDArray[np.float64]) -> tuple[float, float, float]:
    """Rotation vector in the world frame that turns `actual` into `wanted`, exact to first order."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = wanted.dot(actual.T).tolist()
    return 0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy)
