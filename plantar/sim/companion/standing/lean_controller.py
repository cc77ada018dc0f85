"""The controller of a robot that leans on a table with one forearm."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import number
from plantar.geometry.polygon import convex_hull
from plantar.mechanics.easing import minimum_jerk
from plantar.mechanics.wrench_cone import Rectangle
from plantar.mechanics.wrench_distribution import DistributionWeights
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.companion.experiment import Controller
from plantar.sim.companion.standing.controller import StandingControl
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.contact_forces import ContactForces
from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.support import Standing
from plantar.wholebody.tasks.task import Demand, Task

_ARM = "right_lower_arm"
PATCH = "right_lower_arm"
"""Patch whose skin measures the table."""
_UNDERSIDE = np.array([-0.045, 0.0, -0.12])
# Rotation of a forearm that points forward, its underside down.
LEVEL = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
HAND = np.array([0.0, 0.0, -0.09])
"""Point of the left hand that reaches, in its frame in m."""
# How the load is shared where there is a choice: little on the foot that stands on an edge.
SHARES = {"left_foot": 0.55, "right_foot": 0.3, _ARM: 0.15}

_NEAR = 0.02  # m: a taxel that sees ground nearer than this stands on it
_CATCHING_UP = 1.0  # s in which what is aimed at makes up for what is missing: slower than a lean and its load
_MOST_AHEAD = 0.04  # m
_MARGIN = 0.004  # m by which what can carry is smaller than the middles of the taxels that see ground


class LeanControl(StandingControl):
    """How it leans.

    Attributes:
        touch: Force, as a share of body weight, from which the forearm counts as lying on the table.
        pitch: Angle by which the trunk bends forward.
    """

    touch: float = number(0.01, "1", 1e-3, 0.2)
    lowering: ClassVar[float] = 0.05  # Speed in m/s of the forearm while it looks for the table
    pitch: float = number(10.0, "deg", 0.0, 45.0)
    posture_rate: ClassVar[float] = 30.0  # 1/s^2: stiffness of the posture
    press_gain: ClassVar[float] = 0.2  # Gain on what the forearm presses less than it should


class Aim:
    """Integrates a soft task's error: 20 N move it by a centimetre.

    `axes`: factor (3,) of each axis; 0 for none. Attributes `ahead`: how far (3,) it aims beyond the target in m.
    """

    def __init__(self, axes: NDArray[np.float64]) -> None:
        self._axes = axes
        self.ahead = np.zeros(3)

    def at(self, target: NDArray[np.float64], reached: NDArray[np.float64], period: float) -> NDArray[np.float64]:
        """Returns the aim (3,) in m for `target` (3,) and `reached` (3,), a `period` in s after the last."""
        self.ahead += period / _CATCHING_UP * (target - reached) * self._axes
        self.ahead *= min(1.0, _MOST_AHEAD / max(float(np.linalg.norm(self.ahead)), _MOST_AHEAD))
        return target + self.ahead


class LeanController(Controller):
    """Settle, lower the forearm onto the table, lean, reach.

    Feet and forearm share the load within their friction cones, the forearm as its skin measures it, else at the
    table's expected place. Of the `experiment` only stance and first posture are used.

    `began`: begin of each phase in s by name; `areas`: measured supported part of each sole, about its middle.
    """

    def __init__(self, experiment: StandingExperiment, skin: BodySkin) -> None:
        self.settings = experiment.settings
        self.control = experiment.control
        self.skin = skin
        self.stance = experiment.stance
        self.began: dict[str, float] = {}
        self.areas: dict[str, Rectangle] = {}
        base = experiment.machine.base.link
        self._weight = experiment.weight
        self._feet = self.stance.support()
        self._all = self.stance.support()
        # Feet that push each other sideways would cost the hips what they need for the trunk.
        feet = DistributionWeights(ankle=0.1, pressure=1.0, friction=1.0)
        self._carried = ContactForces(self._feet, base, self._weight, weights=feet)
        self._carried.shares = {link: SHARES[link] for link in self.stance.feet}
        # The forearm should help by its share, not carry until each sole's centre of pressure is in its middle: it
        # would
        # relieve the foot on an edge, which then tilts.
        leaning = DistributionWeights(ankle=0.03, pressure=3.0, friction=1.0)
        self._planned = ContactForces(self._all, base, self._weight, weights=leaning)
        self._com = CenterOfMass(experiment.com, self.control.balance)
        # A forearm has five joints: its orientation must not ask the trunk for a sixth.
        self._arm = CartesianPose(_ARM, _UNDERSIDE, PoseGains(stiffness=80.0, damping=18.0), "position")
        self._trunk = CartesianPose(base, None, PoseGains(turn_stiffness=60.0, turn_damping=15.0), "orientation")
        self._turn = CartesianPose(_ARM, None, PoseGains(turn_stiffness=60.0, turn_damping=15.0), "orientation")
        self._hand = CartesianPose("left_hand", HAND, PoseGains(stiffness=40.0, damping=13.0), "position")
        self._measured = 0.0
        self.wanted = 0.0
        self._com_aim = Aim(np.array([1.0, 1.0, 0.0]))
        self._hand_aim = Aim(np.ones(3))
        # Accelerations, not torques: what a level above releases must not let springs of the posture loose.
        self._posture = Posture(experiment.first[7:], self.control.posture_rate)
        self._waist = list(experiment.machine.joints).index("waist_pitch")
        self._middle = np.mean(list(self.stance.places.values()), axis=0)
        self._paths: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}

    def step(self, robot: Any, reading: Reading) -> NDArray[np.float64]:
        self.stance.locate(robot)
        self._see_ground(reading)
        measured = float(np.nan_to_num(reading.force[self.skin.slices[PATCH]]).sum())
        self._move(robot, measured, robot.time)
        leaning = "lean" in self.began and self.control.skin
        tasks: list[Task] = [self._com, self._trunk, self._arm, self._hand, self._posture]
        if not leaning:
            tasks.insert(3, self._turn)
        demands = [[task.demand(robot, reading)] for task in tasks]
        self._measured += 0.1 * (measured - self._measured)
        split = self._split if leaning else self._carried
        return fuse(robot, demands, self._feet.demand(robot, reading), split=split).torque

    def _split(
        self, robot: RobotDynamics, force: NDArray[np.float64], support: Demand | None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
        torque, carried = self._planned(robot, force, self._all.demand(robot, None))
        assert self._planned.last is not None
        self.wanted = float(self._planned.last.wrenches[_ARM][2])
        missing = self.wanted - self._measured
        inward = robot.pose(_ARM)[1][:, 0]
        more = self.control.press_gain * missing * inward @ robot.jacobian(_ARM, _UNDERSIDE)[:3]
        return torque - more[robot.joints], carried

    def _move(self, robot: Any, measured: float, time: float) -> None:
        s = self.settings
        if "lean" not in self.began:
            self._posture.target[self._waist] = np.radians(self.control.pitch) * min(1.0, time / 3.0)
        if "lean" not in self.began and len(self.areas) == len(self.stance.feet):
            over = self._between_feet()
            self._paths.setdefault("over", (self._com.target, np.array([*over, self._com.target[2]])))
            self._com.target = _along(*self._paths["over"], time / 1.5)
        if "bring" not in self.began:
            if time < 1.0:
                return
            self.began["bring"] = time
            over = self._middle + np.array([s.table_edge + 0.08, -0.27, s.table_height + 0.10])
            self._paths["arm"] = (robot.place(_ARM, _UNDERSIDE), over)
        if "lean" in self.began:
            share = (time - self.began["lean"] - 0.5) / 3.0
            planned = _along(*self._paths["com"], share)
            self._com.target = self._com_aim.at(planned, robot.com()[0], self.control.period)
            planned = _along(*self._paths["hand"], share)
            reached = robot.place("left_hand", HAND)
            self._hand.target_position = self._hand_aim.at(planned, reached, self.control.period)
            return
        since = time - self.began["bring"]
        low = max(0.0, since - 2.2) * self.control.lowering
        self._arm.target_position = _along(*self._paths["arm"], since / 2.0) - [0.0, 0.0, low]
        if since > 1.0:
            self._turn.target_rotation = LEVEL
        if measured > self.control.touch * self._weight if self.control.skin else low >= 0.10:
            self.began["lean"] = time
            self._start_leaning(robot)

    def _start_leaning(self, robot: Any) -> None:
        s = self.settings
        self._posture.target = robot.joint_positions.copy()  # nothing turns back now that the forearm's angle is free
        self._arm.target_position = robot.place(_ARM, _UNDERSIDE)
        frame = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])  # z into the forearm: its own x
        self._all.contacts[_ARM] = Standing(_ARM, _UNDERSIDE, flat=False, rotation=frame, friction=0.02)
        self._planned.shares = SHARES
        # What the forearm takes over pulls the centre of pressure under the feet to the other side: they keep theirs.
        aside = (1.0 - SHARES[_ARM]) * self._between_feet()[1] + SHARES[_ARM] * self._arm.target_position[1]
        front = _foremost(self._ground_seen(), aside)
        com = robot.com()[0]
        self._paths["com"] = (com, np.array([front + s.beyond, aside, com[2]]))
        self._paths["hand"] = (robot.place("left_hand", HAND), self._middle + self.settings.hand_target)

    def _ground_seen(self) -> NDArray[np.float64]:
        corners = []
        for link, area in self.areas.items():
            x, y = self.stance.places[link][:2]
            corners += [[x + dx, y + dy] for dx in (area.x_min, area.x_max) for dy in (area.y_min, area.y_max)]
        return convex_hull(corners)

    def _between_feet(self) -> NDArray[np.float64]:
        places = np.zeros(2)
        total = 0.0
        for link, area in self.areas.items():
            places += SHARES[link] * (self.stance.places[link][:2] + area.center)
            total += SHARES[link]
        return places / total

    def _see_ground(self, reading: Reading) -> None:
        # Find each sole's supported part, and limit its load.
        for link, middle in self.stance.feet.items():
            own = self.skin.slices[f"{link}_sole"]
            places = self.skin.positions[own][reading.distance[own] < _NEAR] - middle
            if len(places) < 2:
                continue
            low = places.min(axis=0) + _MARGIN
            high = places.max(axis=0) - _MARGIN
            low, high = np.minimum(low, 0.5 * (low + high)), np.maximum(high, 0.5 * (low + high))
            area = Rectangle(float(low[0]), float(high[0]), float(low[1]), float(high[1]))
            if self.areas.get(link) != area:
                self.areas[link] = area
                for support in (self._feet, self._all):
                    support.contacts[link] = Standing(link, middle, area=area)


def _foremost(polygon: NDArray[np.float64], y: float) -> float:
    # Largest x of a convex polygon (m, 2) at some y, or overall.
    found = [
        float(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]))
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True)
        if min(a[1], b[1]) <= y <= max(a[1], b[1]) and a[1] != b[1]
    ]
    return max(found, default=float(polygon[:, 0].max()))


def _along(start: NDArray[np.float64], end: NDArray[np.float64], share: float) -> NDArray[np.float64]:
    return start + minimum_jerk(share)[0] * (end - start)
