"""The judge: what really happened, from MuJoCo's state and contact forces. The controller never sees it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.gait.plan.plan_change import MovedStep
from plantar.kernels.contacts.ground_reaction import GroundReaction
from plantar.kernels.judging.step_watch import FAST, LEGS, StepWatch
from plantar.kernels.judging.tick_watch import TickWatch
from plantar.layouts.layout import Side
from plantar.sides import SIDES
from plantar.sim.judging.joint_limits import JointLimits
from plantar.sim.judging.leg_contact import LegContact
from plantar.sim.judging.step_count import StepCount
from plantar.sim.judging.walk_goal import WalkGoal
from plantar.sim.model.contact_truth import (
    ContactReader,
    FootContacts,
    GroundTruth,
    foot_contacts,
)
from plantar.sim.model.world import DIVERGED, World

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
        watch: Looks after each physics step whether there is something for `look`.
    """

    world: World
    standing_height: float
    goal: WalkGoal
    fall: tuple[float, float, str] | None = None

    def __post_init__(self) -> None:
        self._geoms = {s: frozenset(self.world.sole_geoms[s]) for s in SIDES}
        self._contacts = ContactReader(self.world.model, self.world.data, [self._geoms[s] for s in SIDES])
        data, torso = self.world.data, self.world.torso
        self._torso, self._center = data.xmat[torso], data.subtree_com[torso]
        self._landings: list[Landing] = []
        self._touched = data.sensordata[self.world.touch["left"] : self.world.touch["right"] + 1]
        self._soles = [(data.site_xpos[i], data.site_xmat[i]) for i in (self.world.sole_sites[s] for s in SIDES)]
        self._fresh: list[Landing] = []  # whose impact is not over yet
        self._landing: dict[Side, Landing | None] = {"left": None, "right": None}
        body = self.world.body
        self._touch, self._settled = _TOUCH * body.weight, _SETTLED * body.beat
        self._lowest = _FALLEN_HEIGHT * self.standing_height
        self.steps = StepCount(self.goal, body.weight)
        self.legs = LegContact(self.world)
        self.joints = JointLimits(self.world)
        leg = self.world.leg_contact
        self.watch = StepWatch(
            self._touched,
            data.sensordata[leg : leg + 1],
            self.joints.speeds,
            self.joints.places,
            self.joints.per_speed,
            self._touch,
            round(_AIRBORNE * body.beat / self.world.period),
            data.warning.number,
            np.array(DIVERGED, dtype=np.intp),
        )
        self._reaction = GroundReaction(math.nan, _LEAST * body.weight, self.world.reach)
        self._tick_watch = TickWatch(
            self._reaction,
            self.steps.watch,
            self._torso,
            self._center,
            [place for place, _ in self._soles],
            [turn for _, turn in self._soles],
            self._touched,
            math.cos(math.radians(_FALLEN_TILT)),
            self._lowest,
        )

    @property
    def landings(self) -> list[Landing]:
        """The landings so far, one after the other."""
        self._hand_over()
        return self._landings

    @property
    def tilt_max(self) -> float:
        """Largest tilt of the torso in degrees."""
        return _tilt(self._tick_watch.up)

    @property
    def margin_min(self) -> float:
        """Smallest true ZMP margin in m; inf where there was no ZMP."""
        return float(self._tick_watch.margin)

    @property
    def estimate_error_max(self) -> list[float]:
        """Largest errors (3,) in m of the controller's CoM."""
        return [float(off) for off in self._tick_watch.errors]

    @property
    def zmp_error(self) -> float | None:
        """Root mean square error in m of the controller's ZMP; None where it never told one while there was one."""
        compared = self._tick_watch.compared
        return math.sqrt(self._tick_watch.squares / compared) if compared else None

    @property
    def fell(self) -> bool:
        """Whether the robot fell."""
        return self.fall is not None

    def look(self, seen: int) -> None:
        """After a physics step in which something happened, or lately did: landings and their impacts, legs that touch,
        joints that are too fast.

        Args:
            seen: What `watch.step`, which is called after each physics step, gave: above 0.
        """
        if seen & LEGS:
            self.legs.step()
        if seen & FAST or self.joints.was_fast:
            self.joints.step()
        for bit, side in enumerate(SIDES):
            if seen & 1 << bit:
                self._land(side)
        if self._fresh:
            self._follow_impacts(dict(zip(SIDES, self._touched.tolist(), strict=True)))
        self.watch.awake = bool(self._fresh) or self.joints.was_fast

    def _land(self, side: Side) -> None:
        """A foot touches the ground after it was in the air."""
        self._hand_over()
        landing = Landing(side, float(self.world.data.time), angle=self._angle(side))
        self._landings.append(landing)
        self._landing[side] = landing
        foot, watch = SIDES.index(side), self._tick_watch
        watch.margin_since = math.inf
        watch.area[foot], watch.until[foot] = 0.0, landing.time + self._settled
        self._fresh.append(landing)
        self.steps.touch(side, landing.time)

    def _hand_over(self) -> None:
        """Let the landings know what was found since."""
        watch = self._tick_watch
        if self._landings:
            self._landings[-1].margin = watch.margin_since
        for landing, area in zip(self._landing.values(), watch.area, strict=True):
            if landing is not None:
                landing.area = float(area)

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
    ) -> None:
        """At each control tick: tilt, ZMP margin, contact areas, places of the feet and the controller's errors.

        Args:
            com: The controller's estimate of the CoM (3,) in m.
            zmp: The controller's estimate of the ZMP (2,) in m, or None.
            feet: Contacts of both feet where they are known already.
            moved: Footsteps that the controller says it has just planned anew.
        """
        if feet is None:
            feet = self._contacts.read()
        now = float(self.world.data.time)
        told = None if zmp is None else zmp.tolist()
        may_have_fallen = self._tick_watch.update(feet, now, com.tolist(), told)
        if moved:
            self.goal.hear(now, moved)
        self.joints.tick()
        if may_have_fallen and self.fall is None:
            self._look_for_fall()

    def truth(self) -> GroundTruth:
        """Ground reaction, true ZMP and true support polygon at the last control tick."""
        return GroundTruth(*self._reaction.told())

    def _look_for_fall(self) -> None:
        """Whether the robot lies, or leans too far to stay up."""
        tilt, height = _tilt(self._torso.item(8)), self.height
        if tilt > _FALLEN_TILT:
            self.fall = (tilt, _FALLEN_TILT, f"the robot fell: the torso tilted by {tilt:.1f} deg")
        elif height < self._lowest:
            self.fall = (height, self._lowest, f"the robot fell: its CoM was {height:.2f} m above the lower sole")

    @property
    def height(self) -> float:
        """Height in m of the CoM above the lower sole."""
        (left, _), (right, _) = self._soles
        return float(self._center.item(2) - min(left.item(2), right.item(2)))


def _tilt(up: float) -> float:
    """Tilt in degrees by its cosine."""
    return math.degrees(math.acos(max(-1.0, min(1.0, up))))
