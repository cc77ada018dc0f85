"""The hierarchy of A (Table 1) for a hand with skin on a mobile base, in two phases."""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import choice, number, switch
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.companion.experiment import CompanionControl, Controller
from plantar.sim.companion.machine import Machine
from plantar.wholebody.behaviours.contact_phases import ContactPhases
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.fusion.null_space import weighted_sum
from plantar.wholebody.fusion.priority_transition import PriorityTransition
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.base_avoidance import AvoidanceField, BaseAvoidance
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.compliant_wrist import CompliantWrist, WristGains
from plantar.wholebody.tasks.contact_force import ContactForce, ContactGains
from plantar.wholebody.tasks.posture import BodyCompliance, Posture
from plantar.wholebody.tasks.skin_interaction import DirectInteraction
from plantar.wholebody.tasks.tactile_guidance import GuidanceGains, TactileGuidance
from plantar.wholebody.tasks.task import Demand, Task

_ARM = ("upper_arm", "forearm", "wrist1")  # links from the shoulder to the wrist
_TOUCHED = 0.3  # N on the hand from which it is in contact
_TAKEN_OVER = 0.3  # s in which the wanted force is taken over into the joints after touching


class HandControl(CompanionControl):
    """Gains and switches of the hierarchy.

    On skin of about 90 kN/m an unknown force is corrected at the rate m force_gain force_integral, 20 1/s for m = 4 kg:
    two thirds of the limit by a delay of two periods.

    Attributes:
        approach_speed: Speed of the hand towards the surface.
        guidance_stiffness: Keeps an untouched hand's place before contact; critical. At 0 weight errors let it drift.
        base_stiffness: K_c of the base along x and y, and in N m/rad about z.
        base_damping: D_c likewise.
        wrist: Whether the wrist complies (ablation).
        avoidance: Whether the base avoids obstacles (ablation).
        feed_forward: Whether wanted and touching forces go into the joints (ablation), if drives take torques.
        priority: "strict", or "sum": torques of all tasks added (ablation).
    """

    force_gain: ClassVar[float] = 0.1  # m/(s^2 N): K_1 / Lambda_1 of A 9: acceleration for a newton that is missing
    approach_speed: float = number(0.1, "m/s", 1e-3, 10)
    # m/s: speed at which it comes to the surface in the contact phase, until it measures it
    landing_speed: ClassVar[float] = 0.01
    force_damping: ClassVar[float] = 12.0  # 1/s: D_1 / Lambda_1
    free_damping: ClassVar[float] = 100.0  # D_1 / Lambda_1 while the hand measures zero, in 1/s
    # 1/s: rate at which a lasting error is taken back, as a share of the proportional part
    force_integral: ClassVar[float] = 50.0
    distance_rate: ClassVar[float] = 6.0  # 1/s: rate at which an error of the distance decays
    wrist_gains: ClassVar = WristGains(inertia=1.0, damping=40.0, gain=50.0, proximity_stiffness=300.0)
    # 1/s^2: stiffness with which the hand keeps its place in contact, for a unit mass
    hand_stiffness: ClassVar[float] = 400.0
    guidance_stiffness: float = number(180.0, "N/m", 0, 1e6)
    arm_stiffness: ClassVar[float] = 30.0  # N m/rad: K_c of A 18 of each joint of the arm
    arm_damping: ClassVar[float] = 15.0  # N m s/rad: D_c of each joint of the arm
    # Bend of the elbow in degrees below which it resists: stretched, an arm cannot hold its hand still while the base
    # goes on
    elbow_least: ClassVar[float] = 40.0
    elbow_most: ClassVar[float] = 145.0  # deg: bend from which it resists likewise
    elbow_stiffness: ClassVar[float] = 150.0  # N m/rad: how stiffly
    base_stiffness: float = number(0.0, "N/m", 0, 1e6)
    base_damping: float = number(150.0, "N s/m", 0, 1e6)
    avoidance_field: ClassVar = AvoidanceField(300.0, 0.2)
    sigmoid: ClassVar[float] = 2.0  # Time in which w of A 6 goes from distance to force
    wrist: bool = switch(True)
    avoidance: bool = switch(True)
    feed_forward: bool = switch(True)
    priority: str = choice("strict", "sum")


class HandController(Controller):
    """Controls distance or force of the hand, its orientation, and its guidance or place.

    `machine`: a mobile base, patches "hand" on the hand's link and others on arm. Attributes `posture`: task of lowest
    level; its target and target velocity may be changed; `wanted_force`: f_d in N; `phases`: present arrangement of
    tasks.
    """

    def __init__(self, machine: Machine, skin: BodySkin, settings: HandControl) -> None:
        s = settings
        self.settings = settings
        taxels = next(p for p in skin.patches if p.name == "hand").positions
        # level with a surface all feel it alike
        middle = taxels.mean(axis=0)
        normal = np.array([0.0, 0.0, 1.0])
        arm_skin = [p.name for p in skin.patches if p.name != "hand"]
        self._touch = DirectInteraction(skin, patches=arm_skin)
        stiffness = s.distance_rate * s.force_damping / s.force_gain  # for the distance error's decay rate
        gains = ContactGains(1.0, s.force_damping, s.force_gain, s.force_integral, stiffness, s.free_damping)
        self.force = ContactForce(skin, "hand", middle, normal, gains)
        self.wrist = CompliantWrist(skin, "hand", middle, s.wrist_gains)
        held = PoseGains(stiffness=s.hand_stiffness, damping=2.0 * float(np.sqrt(s.hand_stiffness)))
        self._place = CartesianPose("hand", middle, held, rows="position")
        guidance = GuidanceGains(stiffness=s.guidance_stiffness)
        arm = len(machine.joints) - 3
        self.posture = Posture(
            machine.posture,
            np.array([s.base_stiffness] * 3 + [s.arm_stiffness] * arm),
            np.array([s.base_damping] * 3 + [s.arm_damping] * arm),
            torques=True,
        )
        half = np.abs(np.array(machine.base.footprint, dtype=float)).max(axis=0)
        self._keep_clear = BaseAvoidance(machine.base.link, (float(half[0]), float(half[1])), s.avoidance_field)
        away: list[Task] = [_BentElbow(list(machine.joints).index("elbow"), s)]
        away += [self._keep_clear] if s.avoidance else []
        first: list[list[Task]] = [[self.force], [self.wrist] if s.wrist else [_Still(self.wrist)]]
        self.phases = ContactPhases(
            [
                *first,
                [TactileGuidance(skin, arm_skin, "hand", middle, guidance, _ARM)],
                [BodyCompliance(self.posture, *away)],
            ],
            [*first, [self._place], [BodyCompliance(self.posture, self._touch, *away)]],
            s.sigmoid,
        )
        self._stack = TaskStack(self.phases.levels, fusion=weighted_sum if s.priority == "sum" else fuse)
        self._change = PriorityTransition()
        servo = machine.servo.kind if s.servo == "machine" else s.servo
        self._feeds_forward = s.feed_forward and servo == "torque"  # a resolver's virtual robot is pushed by nothing
        self._taken = 0.0
        self.wanted_force = 0.0

    def enter_contact(self, time: float) -> None:
        """Activate the contact phase at a time in s (A 4.2.2)."""
        if self.phases.enter(True, time):
            self._stack.levels = [list(level) for level in self.phases.levels]
            self._place.target_position = None
            self._change.begin(time)

    def scan(self, points: NDArray[np.float64]) -> None:
        """Take the nearest points (m, 2) of obstacles, base frame, in m."""
        self._keep_clear.obstacles = points

    def step(self, robot: RobotDynamics, reading: Reading) -> NDArray[np.float64]:
        self.wrist.weight = self.phases.weight(robot.time)
        self.force.weight = self.wrist.weight
        self.force.target_force = self.wanted_force
        s = self.settings
        self.force.approach_speed = s.landing_speed if self.phases.in_contact else s.approach_speed
        torque = self._stack.step(robot, reading, self._known(robot, reading)).torque
        return self._change.blend(torque, robot.time)

    def _known(self, robot: RobotDynamics, reading: Reading) -> NDArray[np.float64] | None:
        # Generalized force (n,) of wanted force and arm skin.
        if not self._feeds_forward:
            return None
        step = self.settings.period / _TAKEN_OVER
        touching = self.phases.in_contact and self.force.force > _TOUCHED
        self._taken = min(max(self._taken + (step if touching else -step), 0.0), 1.0)
        outward = robot.pose("hand")[1][:, 2]
        pressed = self._taken * self.force.weight * self.wanted_force
        known = -pressed * outward @ robot.jacobian("hand")[:3]
        touch = self._touch.demand(robot, reading)
        if touch is not None and touch.force is not None:
            known += touch.force @ touch.jacobian
        return np.asarray(known)


class _BentElbow(Task):
    """Keeps the elbow off its ends, critically damped at 1 kg m^2."""

    def __init__(self, joint: int, settings: HandControl) -> None:
        self._joint = joint
        self._low, self._high = np.radians([settings.elbow_least, settings.elbow_most]).tolist()
        self._stiffness = settings.elbow_stiffness

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        bend = float(robot.joint_positions[self._joint])
        missing = min(max(bend, self._low), self._high) - bend
        if missing == 0.0:
            return None
        place = robot.joints[self._joint]
        row = np.zeros((1, len(robot.velocity)))
        row[0, place] = 1.0
        damping = 2.0 * float(np.sqrt(self._stiffness)) * robot.velocity[place]
        return Demand(row, force=np.array([self._stiffness * missing - damping]))


class _Still(Task):
    def __init__(self, wrist: CompliantWrist) -> None:
        self._wrist = wrist
        self._pose = CartesianPose("hand", np.zeros(3), rows="orientation")

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        self._wrist.demand(robot, skin)
        return self._pose.demand(robot, skin)
