"""A tip that goes to its goal among unknown things (T 3.4.2)."""

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import choice, number
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.companion.experiment import CompanionControl, Controller
from plantar.sim.companion.machine import Machine
from plantar.wholebody.behaviours.intentional_contact import ContactSettings, ContactSigns, IntentionalContact
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchical_qp import HierarchicalQP, JointLimits
from plantar.wholebody.fusion.null_space import weighted_sum
from plantar.wholebody.fusion.priority_transition import PriorityTransition
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.point_force import AlongForce
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.skin_interaction import DirectInteraction, ProximityInteraction
from plantar.wholebody.tasks.task import Task

_SMOOTHED = 0.5  # s: time constant of what is smoothed
_SEEN = 0.01  # N of virtual force from which something is near
_ARRIVED = 0.01  # m from the goal
_OFF_STOPS = 0.02  # share of a joint's range that it keeps off each of its stops
_DEEPEST = 1e-3  # m of sensing range that is left where the policy wants none


class ReachControl(CompanionControl):
    """Gains and switches of reaching.

    Attributes:
        policy: "intentional" for T Table 1; "avoid" for its first arrangement; "fields" for a sum of both.
        speed: V_max of T 3.44 while it avoids.
        range: Used sensing range, d_range of T 3.30.
        proximity: k_prox of T 3.30 of a taxel.
        yielding: Gain on contact forces, tau_c of T 3.41.
        slow: epsilon_v of T Table 1.
        stuck: How long it is slow before it approaches.
        acceleration: Largest of a joint, for things on two sides.
        joint_speed: Largest of a joint, against striking unseen things.
        upright: Level that holds the tip's orientation; "last" in T.
    """

    policy: str = choice("intentional", "avoid", "fields")
    speed: float = number(0.2, "m/s", 0.01, 2.0)
    # While it approaches: what is stuck is pushed by k_v V_max times the tip's effective mass (T 3.43)
    pushing: ClassVar = PoseGains(stiffness=600.0, damping=150.0, speed=0.05)
    range: float = number(0.04, "m", 0.002, 0.2)
    proximity: float = number(25.0, "N/m", 0.0, 1e4)
    brake: ClassVar[float] = 40.0  # N s/m: damping of motion along what repels, towards it and away from it
    yielding: float = number(0.5, "1", 0.0, 20.0)
    # Share of the tolerable force from which it retreats: what is left is for the time it takes
    limit_share: ClassVar[float] = 0.75
    slow: float = number(0.02, "m/s", 0.0, 1.0)
    stuck: float = number(0.3, "s", 0.0, 10.0)
    transition: ClassVar[float] = 0.05  # s: time in which priorities change
    acceleration: float = number(40.0, "rad/s^2", 1.0, 1e6)
    joint_speed: float = number(0.8, "rad/s", 0.01, 100.0)
    upright: str = choice("no", "last", "first")


class ReachController(Controller):
    """Tasks, policy and transitions.

    `machine`: the machine; joints of a mobile base are held; `tip`: link of tip, and tip (3,) in its frame in m;
    `force_limit`: tolerable force in N. Attributes `goal`: task of the tip's position.
    """

    def __init__(
        self,
        machine: Machine,
        skin: BodySkin,
        settings: ReachControl,
        tip: tuple[str, NDArray[np.float64]],
        force_limit: float,
    ) -> None:
        self.settings = settings
        s = settings
        self._free = PoseGains(stiffness=60.0, damping=20.0, speed=s.speed)
        self.goal = CartesianPose(*tip, gains=self._free, rows="position")
        self._near = ProximityInteraction(skin, s.proximity, s.range)
        self._watch = ProximityInteraction(skin, s.proximity, s.range)  # sees the whole range always
        self._measured = DirectInteraction(skin)
        self._yielding = DirectInteraction(skin, s.yielding)
        base = 3 if machine.base.kind == "mobile" else 0
        self._held: list[list[Task]] = [[Posture(machine.posture, 400.0, joints=range(base))]] if base else []
        upright: list[list[Task]] = [[CartesianPose(*tip, rows="orientation")]]
        self._held += upright if s.upright == "first" else []
        self._rest: list[list[Task]] = [
            *(upright if s.upright == "last" else []),
            [Posture(machine.posture, 6.0, 12.0, joints=range(base, len(machine.posture)))],
        ]
        limits = ContactSettings(slow=s.slow, force_limit=s.limit_share * force_limit, stuck=s.stuck)
        contact = AlongForce(self._yielding, s.brake)
        avoidance = AlongForce(self._near, s.brake)
        self.policy = IntentionalContact([self.goal], [contact], [avoidance], limits)
        self.signs = ContactSigns(np.inf, 0.0, 0.0)
        self._velocity = np.zeros(3)
        self._seen = 0.0
        self._time = np.inf
        self._blend = PriorityTransition(s.transition)
        speeds = np.minimum(machine.velocities, s.joint_speed)
        low, high = machine.ranges(machine.spec().compile())
        inside = np.where(np.isfinite(high - low), _OFF_STOPS * (high - low), 0.0)
        within = HierarchicalQP(
            JointLimits(0.98 * machine.efforts, speeds, low + inside, high - inside, acceleration=s.acceleration)
        )
        self._stack = TaskStack([], fusion=weighted_sum if s.policy == "fields" else within)

    def step(self, robot: RobotDynamics, reading: Reading) -> NDArray[np.float64]:
        self.signs = self._look(robot, reading)
        if self.settings.policy == "intentional" and self.policy.update(self.signs, robot.time):
            self._blend.begin(robot.time)
        avoiding = self.policy.arrangement == "avoid"
        self.goal.gains = self._free if avoiding else self.settings.pushing
        self._near.sensing_range = max(_DEEPEST, self.settings.range * self.policy.range_share)
        levels: list[Sequence[Task]] = [*self._held, *self.policy.levels, *self._rest]
        self._stack.levels = [list(level) for level in levels]
        return self._blend.blend(self._stack.step(robot, reading).torque, robot.time)

    def _look(self, robot: RobotDynamics, reading: Reading) -> ContactSigns:
        # Signs of skin and tip (T Table 1), smoothed against flicker.
        period = robot.time - self._time if np.isfinite(self._time) else 0.0
        self._time = robot.time
        share = period / (_SMOOTHED + period)
        velocity = robot.jacobian(self.goal.link, self.goal.point)[:3] @ robot.velocity
        near = sum(float(np.linalg.norm(w.wrench[:3])) for w in self._watch.wrenches(reading))
        self._velocity += share * (velocity - self._velocity)
        self._seen += share * (near - self._seen)
        measured = max((float(np.linalg.norm(w.wrench[:3])) for w in self._measured.wrenches(reading)), default=0.0)
        arrived = float(np.linalg.norm(self.goal.position_error(robot))) < _ARRIVED
        seen = self._seen if self._seen > _SEEN else 0.0
        return ContactSigns(float(np.linalg.norm(self._velocity)), seen, measured, arrived)
