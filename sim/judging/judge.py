"""The judge: what really happened, from MuJoCo's state and contact forces. The controller never sees it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray

from gait.plan.plan_change import MovedStep
from plantar.kernels.few_points import small_hull
from plantar.kernels.step_watch import FAST, LEGS, StepWatch
from plantar.layouts.layout import Side
from plantar.sides import SIDES
from sim.judging.joint_limits import JointLimits
from sim.judging.leg_contact import LegContact
from sim.judging.step_count import StepCount
from sim.judging.walk_goal import WalkGoal
from sim.model.contact_truth import (
    ContactReader,
    FootContacts,
    GroundTruth,
    foot_contacts,
    ground_truth,
)
from sim.model.world import World

__all__ = ["Judge", "Landing"]

_TOUCH = 0.0237  # weight: less than this is no contact; 20 N for H1, the usual level of force plates in gait analysis
_LEAST = 0.0012  # weight on both feet below which there is no ZMP: 1 N for H1
_AIRBORNE = 0.607  # beats without contact before a touch counts as a landing: 0.15 s for H1
_IMPACT_WINDOW = 0.202  # beats after touchdown in which the impact is looked for: 50 ms
_SETTLED = 2.43  # beats after touchdown in which the contact area is looked for: 0.6 s
_FALLEN_TILT = 40.0  # degrees
_FALLEN_HEIGHT = 0.6  # of the standing CoM height
_FLAT_FACES = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_BOX))


@dataclass
class Landing:
    """One landing of one foot.

    Attributes:
        side: Which foot.
        time: Touchdown in s: the first physics step with ground force after 0.6 beats or more in the air.
        impact: Largest vertical ground force in N within 0.2 beats.
        area: Largest contact area in m^2 (hull of the contact points) in the 2.4 beats after touchdown.
        angle: Angle in degrees between the sole and the face that it touched first, at touchdown; None on round ground.
        margin: Smallest true ZMP margin in m from this landing to the next one.
    """

    side: Side
    time: float
    impact: float = 0.0
    area: float = 0.0
    angle: float | None = None
    margin: float = math.inf


@dataclass
class Judge:
    """Follows a run.

    Attributes:
        world: The world.
        standing_height: CoM height above the ground at the start in m.
        goal: Where the feet have to be put down.
    """

    world: World
    standing_height: float
    goal: WalkGoal
    fall: tuple[float, float, str] | None = None
    tilt_max: float = 0.0
    margin_min: float = math.inf
    landings: list[Landing] = field(default_factory=list)
    estimate_error_max: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    zmp_error: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._geoms = {s: frozenset(self.world.sole_geoms[s]) for s in SIDES}
        self._contacts = ContactReader(self.world.model, self.world.data, [self._geoms[s] for s in SIDES])
        data, torso = self.world.data, self.world.torso
        self._torso, self._center = data.xmat[torso], data.subtree_com[torso]
        self._touched = data.sensordata[self.world.touch["left"] : self.world.touch["right"] + 1]
        self._soles = [(data.site_xpos[i], data.site_xmat[i]) for i in (self.world.sole_sites[s] for s in SIDES)]
        self._fresh: list[Landing] = []  # whose impact is not over yet
        self._landing: dict[Side, Landing | None] = {"left": None, "right": None}
        body = self.world.body
        self._touch, self._least = _TOUCH * body.weight, _LEAST * body.weight
        self._settled, self._reach = _SETTLED * body.beat, self.world.reach
        self._lowest = _FALLEN_HEIGHT * self.standing_height
        self.steps = StepCount(self.goal, body.weight)
        self.legs = LegContact(self.world)
        self.joints = JointLimits(self.world)
        leg = self.world.leg_contact
        self._watch = StepWatch(
            self._touched,
            data.sensordata[leg : leg + 1],
            self.joints.speeds,
            self.joints.places,
            self.joints.per_speed,
            self._touch,
            round(_AIRBORNE * body.beat / self.world.period),
        )

    @property
    def fell(self) -> bool:
        """Whether the robot fell."""
        return self.fall is not None

    def update_physics(self) -> None:
        """After each physics step: landings and their impacts, legs that touch, joints that are too fast."""
        seen = self._watch.step()
        if seen or self._fresh or self.joints.was_fast:
            self._look(seen)

    def _look(self, seen: int) -> None:
        """After a physics step in which something happened, or lately did."""
        if seen & LEGS:
            self.legs.step()
        if seen & FAST or self.joints.was_fast:
            self.joints.step()
        for bit, side in enumerate(SIDES):
            if seen & 1 << bit:
                self._land(side)
        if self._fresh:
            self._follow_impacts(dict(zip(SIDES, self._touched.tolist(), strict=True)))

    def _land(self, side: Side) -> None:
        """A foot touches the ground after it was in the air."""
        landing = Landing(side, float(self.world.data.time), angle=self._angle(side))
        self.landings.append(landing)
        self._landing[side] = landing
        self._fresh.append(landing)
        self.steps.touch(side, landing.time)

    def _follow_impacts(self, forces: Mapping[Side, float]) -> None:
        """Look for the impact of landings that are not long ago."""
        begin = float(self.world.data.time) - _IMPACT_WINDOW * self.world.body.beat
        self._fresh = [landing for landing in self._fresh if landing.time >= begin]
        for landing in self._fresh:
            if forces[landing.side] >= self._touch:
                landing.impact = max(landing.impact, forces[landing.side])

    def _angle(self, side: Side) -> float | None:
        """Angle in degrees between a sole and the flat face that carries most of it."""
        model, data = self.world.model, self.world.data
        contacts = foot_contacts(model, data, self._geoms[side])
        if not contacts.size:
            return None
        ground = int(contacts.other_geoms[int(np.argmax(contacts.forces[:, 2]))])
        if ground < 0 or int(model.geom_type[ground]) not in _FLAT_FACES:
            return None
        up = data.geom_xmat[ground].reshape(3, 3)[:, 2]
        sole = data.site_xmat[self.world.sole_sites[side]].reshape(3, 3)[:, 2]
        return math.degrees(math.acos(min(1.0, abs(float(up @ sole)))))

    def update(
        self,
        com: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        feet: Sequence[FootContacts] | None = None,
        moved: Sequence[MovedStep] = (),
    ) -> GroundTruth:
        """At each control tick: tilt, ZMP margin, contact areas, places of the feet and the controller's errors.

        Args:
            com: The controller's estimate of the CoM (3,) in m.
            zmp: The controller's estimate of the ZMP (2,) in m, or None.
            feet: Contacts of both feet where they are known already.
            moved: Footsteps that the controller says it has just planned anew.

        Returns:
            Ground reaction, true ZMP and true support polygon.
        """
        data = self.world.data
        if feet is None:
            feet = self._contacts.read()
        truth = ground_truth(feet, minimum_force=self._least, reach=self._reach)
        _, true_zmp, ring, margin, points = truth
        if margin is not None:
            self.margin_min = min(self.margin_min, margin)
            if self.landings:
                self.landings[-1].margin = min(self.landings[-1].margin, margin)
        tilt = math.degrees(math.acos(min(1.0, self._torso.item(8))))
        self.tilt_max = max(self.tilt_max, tilt)
        for i, (told, true) in enumerate(zip(com.tolist(), self._center.tolist(), strict=True)):
            if not abs(told - true) <= self.estimate_error_max[i]:
                self.estimate_error_max[i] = abs(told - true)
        if zmp is not None and true_zmp is not None:
            self.zmp_error.append(math.dist(zmp.tolist(), true_zmp.tolist()))
        now = float(data.time)
        for side, own in zip(SIDES, points, strict=True):
            last = self._landing[side]
            if last is not None and len(own) > 2 and now - last.time <= self._settled:
                alone = sum(map(len, points)) == len(own)  # the ring is this foot's
                last.area = max(last.area, _area(ring if alone else small_hull(own)))
        if moved:
            self.goal.hear(now, moved)
        for side, force, (position, rotation) in zip(SIDES, self._touched.tolist(), self._soles, strict=True):
            if force >= self.steps.enough:
                x, y, _ = position.tolist()
                self.steps.carry(side, force, x, y, math.atan2(rotation.item(3), rotation.item(0)))
        self.joints.tick()
        if self.fall is None:
            least, height = self._lowest, self.height
            if tilt > _FALLEN_TILT:
                self.fall = (tilt, _FALLEN_TILT, f"the robot fell: the torso tilted by {tilt:.1f} deg")
            elif height < least:
                self.fall = (height, least, f"the robot fell: its CoM was {height:.2f} m above the lower sole")
        return truth

    @property
    def height(self) -> float:
        """Height in m of the CoM above the lower sole."""
        (left, _), (right, _) = self._soles
        return float(self._center.item(2) - min(left.item(2), right.item(2)))


def _area(ring: Sequence[tuple[float, float]]) -> float:
    """Area in m^2 of a few points' hull: `plantar.kernels.convex.area` on plain floats."""
    total = 0.0
    if len(ring) > 2:
        (x, y), (ax, ay) = ring[0], ring[1]
        ax, ay = ax - x, ay - y
        for bx, by in ring[2:]:
            total += ax * (by - y) - (bx - x) * ay
            ax, ay = bx - x, by - y
    return 0.5 * total
