"""An arm taken from a machine with the same base and out of the robot's chest."""

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import numbers
from plantar.common.sides import Side
from plantar.errors import RobotError, SceneError
from plantar.mujoco.quaternions import rotation_of
from plantar.robots.robot import Robot
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.surface import skin_from_tables
from plantar.sim.companion.machine import JointTable, load_machine

_PREFIX = "arm/"  # What the names of its links and joints begin with: a robot may have some of these names already


class WornArm:
    """One arm to be added to a robot's model (`plantar.sim.model.world.Visitor`).

    `posture`: degrees from shoulder to wrist; empty: the machine file's. Attributes `joints`: limits by name, from
    shoulder to wrist; `posture` (k,) in rad; `model` of the arm alone, on an upright base in the world's origin.
    """

    def __init__(self, robot: Robot, side: Side, posture: Sequence[float] = ()) -> None:
        if robot.arms is None:
            raise SceneError(f"robot '{robot.name}' has no arm to move; allowed: robots with a table [arms], as h1")
        self.side = side
        self._chest = robot.arms.chest
        self._torso = robot.torso_body
        self._machine = load_machine(robot.arms.machine)
        self._root = robot.arms.roots[side]
        whole = self._machine.spec().compile()
        links = self._links_of(whole)
        every = self._machine.joints
        on_arm = [whole.body(int(whole.jnt_bodyid[whole.joint(name).id])).name in links for name in every]
        self.links = tuple(_PREFIX + link for link in links)
        self.joints: dict[str, JointTable] = {
            _PREFIX + name: table for (name, table), own in zip(every.items(), on_arm, strict=True) if own
        }
        self._resting = self._machine.posture[on_arm]
        self._shoulder = _shoulder(whole, self._root, self._machine.base.link)
        self.model = self._alone()
        self.posture = self._checked(posture) if posture else self._resting
        patches = [{**t, "link": _PREFIX + t["link"]} for t in self._machine.patches if t["link"] in links]
        self.skin: BodySkin = skin_from_tables(self.model, patches, f"machine '{self._machine.name}'")

    def _checked(self, posture: Sequence[float]) -> NDArray[np.float64]:
        names = [name.removeprefix(_PREFIX) for name in self.joints]
        degrees = numbers(list(posture), "[arm] posture", SceneError)
        if degrees.shape != (len(names),):
            raise SceneError(f"[arm] posture has {degrees.size} angles; allowed: {len(names)}, of {', '.join(names)}")
        for name, angle, low, high in zip(names, degrees.tolist(), *np.degrees(self.ranges).tolist(), strict=True):
            if not low <= angle <= high:
                raise SceneError(f"[arm] posture has {name} at {angle:g} deg; allowed: {low:g} to {high:g}")
        return np.asarray(np.radians(degrees))

    def surface(self, patch: str) -> tuple[str, NDArray[np.float64], float]:
        """The part of a link under a patch wrapped around its z axis.

        Returns the link, the patch's middle (3,) in its frame in m, and largest radius in m.
        """
        found = self.skin.patch(patch)
        at = found.positions
        middle = np.array([0.0, 0.0, 0.5 * (at[:, 2].min() + at[:, 2].max())])
        return found.link, middle, float(np.hypot(at[:, 0], at[:, 1]).max())

    @property
    def efforts(self) -> NDArray[np.float64]:
        """Largest torque (k,) of each joint in N m; infinite where there is no limit."""
        return np.array([joint.effort or math.inf for joint in self.joints.values()])

    @property
    def ranges(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest angle (k,) of each joint in rad."""
        low, high = np.array([self.model.joint(name).range for name in self.joints]).T
        return low, high

    def add_to(self, spec: Any) -> None:
        """Move the arm from the chest of a `spec` to the base."""
        chest = spec.body(self._chest)
        base = spec.body(self._torso)
        while base.parent is not None and base.parent.name != "world":
            base = base.parent
        if chest is None:
            raise RobotError(f"[arms] chest is '{self._chest}', which the robot's model does not have")
        self._lighten(chest, base.name)
        drawn = spec.geom(f"{self.side}_arm_shape")
        if drawn is not None:
            spec.delete(drawn)
        self._hang_on(base, spec)

    def _links_of(self, whole: Any) -> tuple[str, ...]:
        names = [whole.body(i).name for i in range(whole.nbody)]
        if self._root not in names:
            raise RobotError(f"[arms] {self.side} is '{self._root}'; machine '{self._machine.name}' has no such link")
        held = {names.index(self._root)}
        for i in range(whole.nbody):  # a body comes after the one that it hangs on
            if int(whole.body_parentid[i]) in held:
                held.add(i)
        return tuple(names[i] for i in sorted(held))

    def _hang_on(self, base: Any, spec: Any) -> None:
        arm = self._machine.spec()
        for motor in list(arm.actuators):
            arm.delete(motor)
        arm.option.timestep = spec.option.timestep
        arm.option.integrator = spec.option.integrator
        frame = base.add_frame(pos=self._shoulder)
        frame.attach_body(arm.body(self._root), _PREFIX, "").pos = np.zeros(3)  # the frame is in the shoulder
        for name, joint in self.joints.items():
            motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            motor.gainprm[0] = 1.0
            motor.ctrllimited = joint.effort > 0.0
            motor.ctrlrange = [-joint.effort, joint.effort]

    def _alone(self) -> Any:
        spec = mujoco.MjSpec()
        spec.option.gravity = self._machine.spec().option.gravity
        self._hang_on(spec.worldbody.add_body(name="base of the arm"), spec)
        return spec.compile()

    def _lighten(self, chest: Any, base: str) -> None:
        data = mujoco.MjData(self.model)
        data.qpos[:] = self._resting
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        mass = float(self.model.body_subtreemass[0])
        left = float(chest.mass) - mass
        if left <= 0.0:
            raise RobotError(f"body '{self._chest}' weighs {chest.mass:.2f} kg; its arm alone weighs {mass:.2f} kg")
        place, turn = _place_on_base(chest, base)
        arm = turn.T @ (data.subtree_com[0] - place)
        chest.ipos = (chest.mass * chest.ipos - mass * arm) / left
        chest.inertia = chest.inertia * left / chest.mass
        chest.mass = left


def _shoulder(whole: Any, root: str, base: str) -> NDArray[np.float64]:
    """Place (3,) in m of an arm's first link on its base, joints at 0."""
    data = mujoco.MjData(whole)
    mujoco.mj_kinematics(whole, data)
    turn = data.body(base).xmat.reshape(3, 3)
    return np.asarray(turn.T @ (data.body(root).xpos - data.body(base).xpos))


def _place_on_base(chest: Any, base: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place (3,) in m and rotation (3, 3) of a body welded to the base."""
    place = np.zeros(3)
    turn = np.eye(3)
    body = chest
    while body is not None and body.name != base:
        own = rotation_of(body.quat)
        place = body.pos + own @ place
        turn = own @ turn
        body = body.parent
    if body is None:
        raise RobotError(f"[arms] chest is '{chest.name}', which does not hang on '{base}'")
    return place, turn
