"""A robot's legs: forward and inverse kinematics, and torques."""

from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, FootTarget
from plantar.gait.estimate.estimator import Posture
from plantar.kernels.joints.carried_motion import CarriedMotion
from plantar.kernels.joints.leg_targets import JointEntries, LegTargets
from plantar.kernels.joints.motion_load import MotionLoad
from plantar.kernels.joints.static_load import StaticLoad
from plantar.kernels.joints.task_step import PointRows
from plantar.mechanics.lip import GRAVITY
from plantar.robots.kinematics.inverse_kinematics import InverseKinematics
from plantar.robots.kinematics.tasks.com_task import ComTask
from plantar.robots.kinematics.tasks.pose_task import OrientationTask, PoseTask, RollingPoseTask
from plantar.robots.kinematics.tasks.posture_task import PostureTask
from plantar.robots.kinematics.tasks.task import chain

_NOTHING = read_only(np.zeros(2))
_FULL_LEG = 6  # joints of a leg that can give its sole any pose
# Feet that miss their targets first, by which carry no load (`LegTargets.follow`)
_UNLOADED: tuple[tuple[Side, ...], ...] = ((), ("left",), ("right",), ("left", "right"))


class LegModel:
    """Kinematics of a free-floating robot that moves its legs only.

    `model`: the robot alone, first joint free, one hinge a leg joint; `joints`: leg joint names in order of all joint
    vectors; `torso`: body that is kept upright; `unit`: length in m that counts as 1 rad out of reach
    (`InverseKinematics`). Attributes `joints`: joint angles (k,) in rad of the last `follow`, overwritten by the next;
    `torques`: joint torques (k,) in N m of the last `carry` and `add_motion`, likewise; `rows`: places (6 + k,) of the
    base's and the joints' velocities among the model's; `known`: what callers found for these legs, by what it depends
    on, until other joints are moved.
    """

    def __init__(
        self, model: mujoco.MjModel, joints: Sequence[str], soles: Mapping[Side, str], torso: str, unit: float = 1.0
    ) -> None:
        self.model = model
        self._data = mujoco.MjData(model)  # of the solution
        self._configuration: NDArray[np.float64] = read_only(self._data.qpos.view())
        self._probe = mujoco.MjData(model)  # of the measured posture, in the base frame
        self._probe.qpos[:7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        ids = [model.joint(name).id for name in joints]
        # Of numpy's own integers: by those of MuJoCo, which it has to convert first, writing takes seven times as long.
        self._qpos = np.array([model.jnt_qposadr[i] for i in ids], dtype=np.intp)
        self._dof = np.array([model.jnt_dofadr[i] for i in ids], dtype=np.intp)
        held = np.isin(np.arange(model.njnt), ids, invert=True) & (model.jnt_type != int(mujoco.mjtJoint.mjJNT_FREE))
        self._others = model.jnt_qposadr[held]
        self._sites: dict[Side, int] = {s: model.site(soles[s]).id for s in SIDES}
        upright = model.body(torso).id
        self._root = int(model.body_rootid[upright])
        self.mass = float(model.body_subtreemass[self._root])
        self._com = ComTask(model, self._data, self._root)
        self._torso = OrientationTask(model, self._data, upright)
        # Views of what MuJoCo computes: asking the data for them costs more than reading them.
        probe = self._probe
        self._probe_joints = probe.qpos
        self._posture = Posture(
            read_only(probe.subtree_com[self._root]),
            {s: read_only(probe.site_xpos[i]) for s, i in self._sites.items()},
            {s: read_only(probe.site_xmat[i].reshape(3, 3)) for s, i in self._sites.items()},
        )
        sole = PoseTask if len(ids) >= 2 * _FULL_LEG else RollingPoseTask
        self._soles: dict[Side, PoseTask] = {s: sole(model, self._data, self._sites[s]) for s in SIDES}
        self._targets = LegTargets(
            *(self._com.target, self._torso.target),
            *((sole.position, sole.rotation) for sole in self._soles.values()),
        )
        self._yielding: tuple[Side, ...] = ()
        self._reference = PostureTask(model, self._data, ids)
        self.known: dict[tuple[Hashable, ...], Any] = {}
        self.joints = np.zeros(len(ids))
        self.torques = np.zeros(len(ids))
        self._angle_entries = JointEntries(self._data.qpos, self._qpos.astype(np.intp), self.joints)
        no_gravity = int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)
        self._gravity = np.zeros(3) if model.opt.disableflags & no_gravity else model.opt.gravity
        self._load = StaticLoad(
            *(model.body_parentid.astype(np.intp), model.dof_bodyid.astype(np.intp)),
            *(self._data.cinert, self._data.cdof, self._gravity),
            *(self._dof.astype(np.intp), self.torques),
        )
        self._levers = [(s, _lever(model, self._data, int(model.site_bodyid[i]))) for s, i in self._sites.items()]
        self._both_levers = tuple(lever for _, lever in self._levers)
        self.rows = np.concatenate([np.arange(6), self._dof]).astype(np.intp)
        self._inertial = np.zeros(model.nv)
        data = self._data
        root = self._root
        self._motion = MotionLoad(
            (data.qvel, data.qacc),
            self._gravity,
            self.rows,
            self._inertial,
            (data.qpos[:3], data.xmat[root], data.subtree_com[root]),
            (data.xaxis, np.array(ids, dtype=np.intp)),
            model.dof_armature[self._dof],
            self.torques,
        )
        self.inverse = InverseKinematics(
            model,
            self._data,
            [self._com, self._torso, *self._soles.values()],
            self._reference,
            self.rows,
            unit,
        )
        self._carried = CarriedMotion(
            self.inverse.place,
            self._load,
            self._both_levers,
            self._motion,
            partial(mujoco.mj_comVel, model, data),
            partial(mujoco.mj_rne, model, data, 1, self._inertial),
            self.mass * GRAVITY,
        )

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Forward kinematics, base frame (see `plantar.gait.estimate.estimator.LegKinematics`)."""
        posture = self.live_posture(joint_positions)
        places = posture.positions
        turns = posture.rotations
        return Posture(
            posture.com.copy(),
            {"left": places["left"].copy(), "right": places["right"].copy()},
            {"left": turns["left"].copy(), "right": turns["right"].copy()},
        )

    def live_posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """The same without copies (see `plantar.gait.estimate.estimator.LiveKinematics`)."""
        data = self._probe
        self._probe_joints[self._qpos] = joint_positions
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        return self._posture

    def place_of(self, site: str) -> NDArray[np.float64]:
        """Place (3,) in m of a `site` of the torso in the base frame."""
        mujoco.mj_kinematics(self.model, self._probe)
        return np.array(self._probe.site(site).xpos)

    def sole_motions(self, joint_positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """How the soles move with the joints (see `plantar.gait.estimate.estimator.MovingKinematics`)."""
        self.live_posture(joint_positions)
        moved = np.zeros((2, 3, self.model.nv))
        turned = np.zeros((2, 3, self.model.nv))
        for i, side in enumerate(SIDES):
            mujoco.mj_jacSite(self.model, self._probe, moved[i], turned[i], self._sites[side])
        return moved[:, :, self._dof], turned[:, :, self._dof]

    def set_configuration(
        self, position: NDArray[np.float64], quaternion: NDArray[np.float64], joints: NDArray[np.float64]
    ) -> None:
        """Set start and reference posture of the next `follow`.

        `position`: base position (3,) in the world in m; `quaternion`: base orientation (4,), w first; `joints`: joint
        angles (k,) in rad.
        """
        self._data.qpos[:3] = position
        self._data.qpos[3:7] = quaternion
        self._data.qpos[self._qpos] = joints
        self.inverse.move()
        self._reference.target = np.array(joints, dtype=float)

    def hold_others(self, joints: NDArray[np.float64]) -> None:
        """Set the joints of no leg. `joints`: positions (o,) in the model's order in rad or m."""
        self._data.qpos[self._others] = joints
        self.inverse.move()
        self._probe.qpos[self._others] = joints
        self.known.clear()

    def restore(self, configuration: NDArray[np.float64]) -> None:
        """Take the configuration (nq,) of an earlier solution, as `follow` left it."""
        self._data.qpos[:] = configuration
        self.inverse.move()
        self._angle_entries.take()

    @property
    def live_configuration(self) -> NDArray[np.float64]:
        """`configuration` without a copy, overwritten by the next `follow`."""
        return self._configuration

    @property
    def configuration(self) -> NDArray[np.float64]:
        """Configuration (nq,) of the last solution."""
        return np.array(self._data.qpos)

    def follow(
        self,
        com: NDArray[np.float64],
        rotation_torso: NDArray[np.float64],
        positions: Mapping[Side, NDArray[np.float64]],
        rotations: Mapping[Side, NDArray[np.float64]],
        iterations: int = 1,
        yielding: Collection[Side] = (),
        largest_step: float = 0.5,
    ) -> float:
        """Solve for the `joints` of CoM, torso orientation and soles, from the last solution, within limits.

        The 18 task rows (CoM 3, torso 3, two soles 6 each) meet the 18 unknowns of a 12-joint biped; legs of five
        joints leave the soles' roll to the ground.

        `com`: CoM (3,) in the world in m; `rotation_torso`: rotation (3, 3) from torso to world; `positions`: sole
        frame origin (3,) of each foot in m; `rotations` (3, 3) to the world; `yielding`: feet that miss their targets
        first: the unloaded ones; `largest_step`: largest change in rad or units of length in a step. Returns largest
        task error before the last step in units of length or rad, NaN if a target is.
        """
        left = positions["left"], rotations["left"]
        right = positions["right"], rotations["right"]
        targets = com, rotation_torso, *left, *right
        try:
            self._targets.take(*targets)
        except ValueError:  # one is of other strides or numbers than the kernel takes
            self._targets.take(*(np.ascontiguousarray(target, dtype=np.float64) for target in targets))
        self._yield_first(tuple(yielding))
        missed = self.inverse.solve(iterations, largest_step)
        self._angle_entries.take()
        return missed

    def _yield_first(self, yielding: tuple[Side, ...]) -> None:
        self._yielding = yielding
        for side, sole in self._soles.items():
            sole.level = 1 if side in yielding else 0

    def follow_command(self, command: Command, largest_step: float) -> float:
        """`follow` of a command in one step; feet without load miss their targets first."""
        try:
            yielding = _UNLOADED[self._targets.follow(command)]
        except ValueError:  # an array is of other strides or numbers than the kernel takes
            left, right = (_contiguous(command.feet[side]) for side in SIDES)
            com, torso = (np.ascontiguousarray(a, dtype=np.float64) for a in (command.com, command.rotation_torso))
            feet = {"left": left, "right": right}
            yielding = _UNLOADED[self._targets.follow(command.changed(com=com, rotation_torso=torso, feet=feet))]
        if yielding is not self._yielding:  # as it is in nearly all ticks
            self._yield_first(yielding)
        missed = self.inverse.solve(1, largest_step)
        self._angle_entries.take()
        return missed

    def carry_command(
        self, command: Command, velocity: NDArray[np.float64], acceleration: NDArray[np.float64], whole: bool
    ) -> None:
        """`carry` and `add_motion` of a command, whose forces act at its centers of pressure, as high as its soles.

        `velocity` of base and joints (6 + k,) in m/s and rad/s; `acceleration` in m/s^2 and rad/s^2; `whole`: as of
        `add_motion`.
        """
        feet = command.feet
        try:
            self._carried.take(feet["left"], feet["right"], velocity, acceleration, command.momentum, whole)
        except ValueError:  # an array is of other strides or numbers than the kernel takes
            left, right = (_contiguous(feet[side]) for side in SIDES)
            momentum = np.ascontiguousarray(command.momentum, dtype=np.float64)
            self._carried.take(left, right, velocity, acceleration, momentum, whole)

    def carry(self, forces: Mapping[Side, NDArray[np.float64]], points: Mapping[Side, Iterable[float]]) -> None:
        """Compute the joint `torques` of the last solution: tau = g(q) - sum J^T f.

        `forces`: ground force (3,) in N on each sole, world frame; `points`: point (3,) in m where it acts, world
        frame.
        """
        self.inverse.place()
        load = self._load
        load.weigh()
        for side, lever in self._levers:
            force = forces[side]
            if force.item(2) > 0.0:
                load.less(lever, force, *points[side])
        load.take()

    def add_motion(
        self,
        velocity: NDArray[np.float64],
        acceleration: NDArray[np.float64],
        left: float,
        momentum: NDArray[np.float64] = _NOTHING,
        whole: bool = True,
    ) -> None:
        """Add to the `torques` of the last `carry` those of the robot's motion: tau = M a + C v - J^T dL/dt.

        The ground changes the angular momentum L about the CoM, mostly of a swinging leg, by a couple on the soles.

        Args:
            velocity: Of base and joints (6 + k,) in m/s and rad/s.
            acceleration: In m/s^2 and rad/s^2.
            left: Share of the weight on the left sole.
            momentum: (-L_y', L_x') / (m g) (2,) in m that the forces of `carry` give already.
            whole: Whether an unloaded leg gets what moves it, too; a stiff servo lands softer without.
        """
        self._motion.move(velocity, acceleration)
        mujoco.mj_comVel(self.model, self._data)
        mujoco.mj_rne(self.model, self._data, 1, self._inertial)
        x, y = momentum.tolist()
        weight = self.mass * GRAVITY
        self._motion.add(acceleration, left, weight * y, -weight * x, whole)


def _contiguous(foot: FootTarget) -> FootTarget:
    """The same target in arrays that kernels take."""
    arrays = (foot.position, foot.rotation, foot.force, foot.center_of_pressure)
    return FootTarget(*(np.ascontiguousarray(array, dtype=np.float64) for array in arrays))


def _lever(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> PointRows:
    return PointRows(chain(model, body), data.cdof, data.subtree_com[model.body_rootid[body]], np.zeros((3, model.nv)))
