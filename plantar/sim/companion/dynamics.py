"""MuJoCo as the model library of `wholebody`."""

from difflib import get_close_matches
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError

_NAMED = 5  # links in an error where none has a similar name


class MujocoDynamics:
    """`plantar.wholebody.dynamics.RobotDynamics` from a MuJoCo model of the robot alone (T 3.1, 3.12, A 1).

    MuJoCo's stages run when results are read. A free base's angular velocity and its Jacobians are in its own frame.

    Attributes:
        velocity: Generalized (n,).
        joints: Indices (k,) of coordinates with an actuator of their own, ascending; without, all hinges and slides.
        jacobians: Computed so far.

    Raises:
        InputError: If no joint can move.
    """

    def __init__(self, model: Any) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.time = 0.0
        self.jacobians = 0
        simple = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)
        moved = np.flatnonzero(np.isin(model.jnt_type, [int(kind) for kind in simple]))
        if model.nu:
            own = model.actuator_trntype <= int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)  # others drive no single joint
            moved = np.intersect1d(moved, model.actuator_trnid[own, 0])
        if not len(moved):
            raise InputError("the model has no hinge or slide joint with an actuator; it needs one at least")
        self.joints: NDArray[np.int64] = model.jnt_dofadr[moved].astype(np.int64)
        self._places = model.jnt_qposadr[moved].astype(np.int64)
        self._bodies = {model.body(i).name: i for i in range(1, model.nbody)}
        self._places_of_links = self.data.xpos  # views: MuJoCo's attributes make one at each access
        self._turns_of_links = self.data.xmat.reshape(-1, 3, 3)
        self.velocity: NDArray[np.float64] = self.data.qvel
        self._forget()
        mujoco.mj_kinematics(model, self.data)

    def update(self, qpos: NDArray[np.float64], qvel: NDArray[np.float64], time: float) -> None:
        """Take `qpos` (nq,) and `qvel` (nv,) in MuJoCo's order at `time` in s."""
        self.data.qpos[:] = qpos
        self.data.qvel[:] = qvel
        self.time = time
        self._forget()
        mujoco.mj_kinematics(self.model, self.data)

    def _forget(self) -> None:
        self._placed = False
        self._moving = False
        self._mass: NDArray[np.float64] | None = None
        self._bias: NDArray[np.float64] | None = None
        self._made: dict[int, NDArray[np.float64]] = {}

    def _place(self) -> None:
        if not self._placed:
            mujoco.mj_comPos(self.model, self.data)
            self._placed = True

    def _move(self) -> None:
        if not self._moving:
            self._place()
            mujoco.mj_comVel(self.model, self.data)
            self._moving = True

    @property
    def joint_positions(self) -> NDArray[np.float64]:
        """Position (k,) of each actuated joint in rad or m."""
        return np.asarray(self.data.qpos[self._places])

    @property
    def mass_matrix(self) -> NDArray[np.float64]:
        """M (n, n) of T 3.1, with the rotors' inertia."""
        if self._mass is None:
            self._place()
            mujoco.mj_makeM(self.model, self.data)
            self._mass = np.zeros((self.model.nv, self.model.nv))
            mujoco.mj_fullM(self.model, self.data, self._mass)
        return self._mass

    @property
    def bias(self) -> NDArray[np.float64]:
        """C q' + g (n,) of T 3.1, without joint friction."""
        if self._bias is None:
            self._move()
            self._bias = np.zeros(self.model.nv)
            mujoco.mj_rne(self.model, self.data, 0, self._bias)
        return self._bias

    def pose(self, link: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Origin (3,) in m and rotation (3, 3) of a link; InputError if unknown."""
        body = self._body(link)
        return self._places_of_links[body].copy(), self._turns_of_links[body].copy()

    def place(self, link: str, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the place (3,) in m of a `point` (3,) in the frame of `link`."""
        origin, rotation = self.pose(link)
        return origin + rotation @ point

    def jacobian(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns the Jacobian (6, n) of a `point` (3,) in the frame of `link` in m, linear rows first, world frame;
        read-only, without a point the origin's, computed once an update. InputError if the link is unknown.
        """
        body = self._body(link)
        if point is None and body in self._made:
            return self._made[body]
        self._place()
        found = np.zeros((6, self.model.nv))
        mujoco.mj_jac(self.model, self.data, found[:3], found[3:], self._world(body, point), body)
        self.jacobians += 1
        if point is None:
            self._made[body] = found
        return found

    def drift(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns J' q' (6,) in m/s^2 and rad/s^2 for `link` and `point`, as of `jacobian`."""
        body = self._body(link)
        self._move()
        rate = np.zeros((6, self.model.nv))
        mujoco.mj_jacDot(self.model, self.data, rate[:3], rate[3:], self._world(body, point), body)
        return np.asarray(rate.dot(self.velocity))

    def com(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Centre of mass: (3,) in m, Jacobian (3, n), drift (3,) in m/s^2."""
        self._move()
        rows = np.zeros((3, self.model.nv))
        mujoco.mj_jacSubtreeCom(self.model, self.data, rows, 0)
        mujoco.mj_rnePostConstraint(self.model, self.data)  # q'' of this data is 0 always
        force = self.data.cfrc_int[0, 3:]
        drift = force / self.model.body_subtreemass[0] + self.model.opt.gravity
        return self.data.subtree_com[0].copy(), rows, drift

    def _body(self, link: str) -> int:
        found = self._bodies.get(link)
        if found is None:
            known = [name for name in self._bodies if name]
            near = get_close_matches(link, known, n=_NAMED, cutoff=0.4)
            hint = f"nearest: {', '.join(near)}" if near else f"there are {', '.join(known[:_NAMED])} and others"
            raise InputError(f"the robot has no link '{link}'; {hint}")
        return found

    def _world(self, body: int, point: NDArray[np.float64] | None) -> NDArray[np.float64]:
        origin: NDArray[np.float64] = self._places_of_links[body]
        return origin if point is None else origin + self._turns_of_links[body].dot(point)
