"""A walking robot's arm that yields to contact."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import BodySkin, link_wrenches
from plantar.sensing.reading import Reading
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.standing.joint_range import JointRange
from plantar.sim.model.world import World
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.posture import BodyCompliance, Posture
from plantar.wholebody.tasks.skin_interaction import DirectInteraction

_MARGIN = math.radians(5.0)  # from the end of a joint's range at which it is pushed back
_AT_END = 0.5  # of a joint's largest torque, with which it is pushed back at the end of its range
_DAMPED = 0.1  # s: damping there over its stiffness


class CompliantArm:
    """Encoders, motors and tasks of the arm; an upright base is assumed.

    Joints avoid their limits; below that springs hold a posture and skin forces move it (A 13-14, 18).

    `skin`: the robot's skin, or None; `period`: control period in s; `encoder_noise`: standard deviation in rad.
    Attributes `angles`: last measured (k,) in rad; `posture` of the springs at rest (k,) in rad.
    """

    def __init__(
        self,
        worn: WornArm,
        skin: BodySkin | None,
        settings: ArmSettings,
        world: World,
        period: float,
        encoder_noise: float,
        seed: int,
    ) -> None:
        self._settings = settings
        self._world = world
        self._encoder_noise = encoder_noise
        self._rng = np.random.default_rng([seed, 0xA3])
        model = world.model
        joints = [model.joint(name) for name in worn.joints]
        self._places = np.array([int(joint.qposadr[0]) for joint in joints])
        self._speeds = np.array([int(joint.dofadr[0]) for joint in joints])
        self._motors = np.array([int(model.actuator(name).id) for name in worn.joints])
        self._skin = skin
        self._own = np.zeros(0, dtype=bool) if skin is None else skin.taxels_of([p.name for p in worn.skin.patches])
        self._links = [link for link in worn.skin.links if skin is not None]
        self.posture = worn.posture
        self._efforts = worn.efforts
        self._robot = MujocoDynamics(worn.model)
        self._stack = _tasks(worn, skin, settings)
        self._share = period / (period + settings.filter)
        self._force = np.zeros(len(self._own))
        self.angles = self.posture.copy()

    @property
    def torque(self) -> NDArray[np.float64]:
        """Torque (k,) in N m commanded to the motors."""
        return np.array(self._world.data.ctrl[self._motors])

    @property
    def true_angles(self) -> NDArray[np.float64]:
        """True joint angles (k,) in rad, for the judge."""
        return np.array(self._world.data.qpos[self._places])

    def read(self) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Read the encoders.

        Returns origin (3,) in m and rotation (3, 3) in the base frame of each skinned link, by name.
        """
        data = self._world.data
        rng = self._rng
        k = len(self._places)
        self.angles = data.qpos[self._places] + self._encoder_noise * rng.standard_normal(k)
        speeds = data.qvel[self._speeds] + self._settings.speed_noise * rng.standard_normal(k)
        self._robot.update(self.angles, speeds, float(data.time))
        return {link: self._robot.pose(link) for link in self._links}

    def hold(self) -> None:
        """Read the encoders and hold the posture, without skin."""
        self.read()
        self.step(None)

    def step(self, measured: Reading | None) -> None:
        """Set motor torques for a control period by encoders and the skin's `measured`."""
        external = None
        if measured is not None and self._skin is not None:
            self._force = self._force + self._share * (np.nan_to_num(measured.force) - self._force)
            measured = Reading(measured.time, self._force, measured.distance)
            external = self._external(self._skin, measured)
        torque = self._stack.step(self._robot, measured, external).torque
        self._world.data.ctrl[self._motors] = np.clip(torque, -self._efforts, self._efforts)

    def _external(self, skin: BodySkin, measured: Reading) -> NDArray[np.float64] | None:
        total: NDArray[np.float64] | None = None
        for link, wrench, _ in link_wrenches(skin, measured.force, self._own & (measured.force >= skin.thresholds)):
            turned = (wrench.reshape(2, 3) @ self._robot.pose(link)[1].T).ravel()
            own = turned @ self._robot.jacobian(link)
            total = own if total is None else total + own
        return total


def _tasks(worn: WornArm, skin: BodySkin | None, settings: ArmSettings) -> TaskStack:
    low, high = worn.ranges
    stiff = _AT_END * worn.efforts / _MARGIN
    ends = JointRange(low, high, _MARGIN, stiff, _DAMPED * stiff)
    springs = Posture(worn.posture, settings.spring * worn.efforts, settings.damper * worn.efforts, torques=True)
    patches = [patch.name for patch in worn.skin.patches]
    yields = [] if skin is None else [DirectInteraction(skin, settings.gain, patches)]
    return TaskStack([[ends], [BodyCompliance(springs, *yields)]])
