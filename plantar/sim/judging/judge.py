"""The judge: what really happened, by MuJoCo's state and contact forces.

After a physics step MuJoCo's contacts, forces and poses belong to its beginning.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, other_side
from plantar.gait.plan.plan_change import MovedStep
from plantar.kernels.contacts.foot_contacts import FootContacts
from plantar.kernels.contacts.ground_reaction import GroundReaction
from plantar.kernels.joints.setpoints import Setpoints
from plantar.kernels.judging.estimate_error import EstimateError
from plantar.kernels.judging.physics_steps import PhysicsSteps
from plantar.kernels.judging.step_watch import FALLING, LEGS, OTHERS, OUTSIDE, StepWatch
from plantar.layouts.layout import Side
from plantar.sim.judging.ground_pieces import GroundPieces
from plantar.sim.judging.joint_limits import JointLimits
from plantar.sim.judging.leg_contact import LegContact
from plantar.sim.judging.other_contact import OtherContact
from plantar.sim.judging.outside_force import Actor, OutsideForce
from plantar.sim.judging.stance_ripple import StanceRipple
from plantar.sim.judging.step_count import Stand, StepCount
from plantar.sim.judging.walk_goal import WalkGoal, Way
from plantar.sim.model.contact_truth import ContactReader, GroundTruth, foot_contacts
from plantar.sim.model.world import DIVERGED, World
from plantar.sim.terrain import CORNERS, Ground

_LEVEL = 0.9999  # cosine of the tilt up to which a face is level


class PlainGround:
    """A `ground` under soles with `outlines` (k, 2) in m and `around` them, in m."""

    def __init__(self, ground: Ground, outlines: Mapping[Side, NDArray[np.float64]], around: float) -> None:
        import shapely

        self._outlines = outlines
        self._around = around
        self._faces = []
        for solid, ring in zip(ground.solids, ground.seen_from_above(), strict=True):
            # Where a piece goes the ground is not plain, from where it begins to where it ends.
            ways = [m.position[:2] - solid.position[:2] for m in solid.motions]
            swept = shapely.MultiPoint(np.vstack([np.array(ring) + way for way in (np.zeros(2), *ways)])).convex_hull
            level = solid.shape == "box" and solid.rotation[2, 2] > _LEVEL and not solid.motions
            self._faces.append((swept, level))

    def under(self, side: Side, x: float, y: float, yaw: float) -> bool:
        """Returns whether the `side`'s sole at `x`, `y` in m and `yaw` in rad is on one level face."""
        import shapely

        c = math.cos(yaw)
        s = math.sin(yaw)
        ring = self._outlines[side] @ np.array([[c, s], [-s, c]]) + (x, y)
        area = shapely.Polygon(ring).buffer(self._around)
        near = [(face, level) for face, level in self._faces if face.intersects(area)]
        return not near or (len(near) == 1 and near[0][1] and near[0][0].contains(area))


_TOUCH = 0.0237  # weight: less than this is no contact; 20 N for H1, the usual level of force plates in gait analysis
_LEAST = 0.0012  # weight on both feet below which there is no ZMP: 1 N for H1
_AIRBORNE = 0.607  # beats without contact before a touch counts as a landing: 0.15 s for H1
_IMPACT_WINDOW = 0.202  # beats after touchdown in which the impact is looked for: 50 ms
_SETTLED = 2.43  # beats after touchdown in which the contact area is looked for: 0.6 s
_PUSH_LASTS = 15.0  # beats in which a push may move steps: three of H1's, and what lies between
_FALLEN_TILT = 40.0  # degrees
_FALLEN_HEIGHT = 0.6  # of the standing CoM height
_FLAT_FACES = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_BOX))


@dataclass(frozen=True)
class Landing:
    """One landing of one foot.

    `time`: first ground force in s after 0.6 beats or more in the air; `impact`: largest vertical ground force in N
    within 0.2 beats; `area`: largest contact hull in m^2 within 2.4 beats; `angle` in degrees between sole and first
    touched face; None on round ground; `margin`: smallest true ZMP margin in m until the next landing, or None.
    """

    side: Side
    time: float
    impact: float
    area: float
    angle: float | None
    margin: float | None


@dataclass
class Judge:
    """Follows a run.

    `standing_height`: CoM above the ground at the start in m; `ground`: None where all is plain; `learns`: whether
    pushes change all later steps; `actors`: those that push in the scene; `pieces`: of the ground, after
    `follow_pieces`; `fall`: the fall as (criterion's value, limit, text), or None; `feet`: contacts
    of both soles after the last physics step, None before the first.
    """

    world: World
    standing_height: float
    goal: WalkGoal
    ground: PlainGround | None = None
    learns: bool = False
    actors: Sequence[Actor] = ()
    pieces: GroundPieces | None = None
    fall: tuple[float, float, str] | None = None
    feet: tuple[FootContacts, ...] | None = None

    def __post_init__(self) -> None:
        world = self.world
        data = self.world.data
        torso = self.world.torso
        body = self.world.body
        self._geoms = {s: frozenset(world.sole_geoms[s]) for s in SIDES}
        self._contacts = ContactReader(world.model, data, [self._geoms[s] for s in SIDES])
        self._torso = data.xmat[torso]
        self._center = data.subtree_com[torso]
        self._places = [data.site_xpos[world.sole_sites[s]] for s in SIDES]
        self._angles: list[float | None] = []
        self._lowest = _FALLEN_HEIGHT * self.standing_height
        self._start = float(data.time)
        self.steps = StepCount(self.goal, body.weight, self._time_of, self._justified)
        self._pushed: list[float] = []
        self.legs = LegContact(world)
        self.outside = OutsideForce(world.model, data, int(world.model.body_rootid[torso]), self.actors)
        self.others = OtherContact(world)
        self.joints = JointLimits(world)
        ground = is_ground(world).astype(np.uint8)
        self._reaction = GroundReaction(math.nan, _LEAST * body.weight, world.reach, ground)
        self.ripple = StanceRipple(world, self._reaction, _TOUCH * body.weight)
        self._estimates = EstimateError(self._center, self._reaction)
        windows = [round(beats * body.beat / world.period) for beats in (_AIRBORNE, _IMPACT_WINDOW, _SETTLED)]
        self._watch = StepWatch(
            self._reaction,
            self.steps.watch,
            self.joints.extremes,
            self.ripple.watch,
            self.outside.forces,
            self._torso,
            self._center,
            self._places,
            [data.site_xmat[world.sole_sites[s]] for s in SIDES],
            data.sensordata[world.leg_contact : world.leg_contact + 1],
            data.warning.number,
            np.array(DIVERGED, dtype=np.intp),
            _TOUCH * body.weight,
            windows,
            (math.cos(math.radians(_FALLEN_TILT)), self._lowest),
        )

    def follow_pieces(self, ground: Ground) -> None:
        """From now on, follow what the pieces of the `ground` carry."""
        self.pieces = GroundPieces(self.world, ground, self.steps.watch.enough)

    def _time_of(self, step: int) -> float:
        return self._start + (step - 1) * self.world.period

    @property
    def landings(self) -> list[Landing]:
        return [
            Landing(SIDES[foot], self._time_of(step), impact, area, angle, margin if math.isfinite(margin) else None)
            for (step, foot, impact, area, margin), angle in zip(self._watch.landings(), self._angles, strict=True)
        ]

    @property
    def tilt_max(self) -> float:
        """Largest tilt of the torso in degrees."""
        return _tilt(self._watch.up)

    @property
    def margin_min(self) -> float | None:
        """Smallest true ZMP margin in m; None without ZMP."""
        return float(self._watch.margin) if math.isfinite(self._watch.margin) else None

    @property
    def loads(self) -> tuple[float, float]:
        """Vertical ground force in N on the left and right foot."""
        return self._reaction.loads[0], self._reaction.loads[1]

    @property
    def estimate_error_max(self) -> list[float]:
        """Largest CoM errors (3,) in m of the controller."""
        return [float(off) for off in self._estimates.com]

    @property
    def zmp_error(self) -> float | None:
        """RMS error in m of the controller's ZMP, or None."""
        compared = self._estimates.compared
        return math.sqrt(self._estimates.squares / compared) if compared else None

    @property
    def fell(self) -> bool:
        return self.fall is not None

    def step(self) -> int:
        """Take in a physics step; returns what `StepWatch.step` reports."""
        feet = self._contacts.read()
        self.feet = feet
        if self.actors:
            self.outside.expect()
        seen: int = self._watch.step(feet, self._contacts.kernel.count)
        if self.pieces is not None:
            self.pieces.loads.step(feet)
        if seen:
            self.look(seen)
        return seen

    def physics_steps(self, drives: Setpoints, step: Callable[[], None]) -> PhysicsSteps | None:
        """Physics steps with their judge in one kernel, by what writes set-points and makes a step.

        `look` takes in what it reports. For steps in which none of `actors` applies a force. None where the soles'
        contacts need more than reading.
        """
        if self._contacts.sticks:
            return None
        self.feet = self._contacts.read()  # the same objects after each step
        pieces = None if self.pieces is None else self.pieces.loads
        return PhysicsSteps(drives, step, self._contacts.kernel, self._watch, pieces)

    def look(self, seen: int) -> None:
        """Look closer at what `StepWatch.step` reported after a physics step."""
        if seen & OUTSIDE:
            self.outside.look()
        if seen & OTHERS:
            self.others.step()
        if seen & LEGS:
            self.legs.step()
        for bit, side in enumerate(SIDES):
            if seen & 1 << bit:
                self._angles.append(self._angle(side))
        if seen & FALLING and self.fall is None:
            self._look_for_fall()

    def _angle(self, side: Side) -> float | None:
        """Angle in degrees between a sole and its most loaded flat face."""
        model = self.world.model
        data = self.world.data
        contacts = foot_contacts(model, data, self._geoms[side])
        if not contacts.size:
            return None
        ground = int(contacts.other_geoms[int(np.argmax(contacts.forces[:, 2]))])
        if ground < 0:
            return None
        ground = int(model.geom(model.geom(ground).name.removesuffix(CORNERS)).id)
        if int(model.geom_type[ground]) not in _FLAT_FACES:
            return None
        up = data.geom_xmat[ground].reshape(3, 3)[:, 2]
        sole = data.site_xmat[self.world.sole_sites[side]].reshape(3, 3)[:, 2]
        return math.degrees(math.acos(min(1.0, abs(float(up @ sole)))))

    def update(
        self,
        time: float,
        com: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        moved: Sequence[MovedStep] = (),
        pushed: bool = False,
    ) -> None:
        """Take estimated `com` (3,) and `zmp` (2,) in m or None at `time` in s, footsteps `moved`, and whether truly
        `pushed`.
        """
        if pushed:
            self._pushed.append(time)
        self._estimates.update(com.tolist(), None if zmp is None else zmp.tolist())
        if self.outside.forces.sprung():
            self.outside.look_at_springs()
        if moved:
            self.goal.move(time, moved)

    def _justified(self, stand: Stand, way: Way, before: tuple[float, float, float]) -> bool:
        """Whether a push in the last three steps or uneven ground justify a move."""
        since = -math.inf if self.learns else stand.touchdown - _PUSH_LASTS * self.world.body.beat
        if any(since <= time <= stand.touchdown for time in self._pushed):
            return True
        if self.ground is None:
            return False
        x, y, yaw = before
        c = math.cos(yaw)
        s = math.sin(yaw)
        place = (x + c * way[0] - s * way[1], y + s * way[0] + c * way[1], yaw + way[2])
        return not (self.ground.under(stand.side, *place) and self.ground.under(other_side(stand.side), *before))

    def truth(self) -> GroundTruth:
        """Ground reaction, true ZMP and support polygon at the last physics step."""
        return GroundTruth(*self._reaction.found_now())

    def _look_for_fall(self) -> None:
        tilt = _tilt(self._torso.item(8))
        height = self.height
        if tilt > _FALLEN_TILT:
            self.fall = (tilt, _FALLEN_TILT, f"the robot fell: the torso tilted by {tilt:.1f} deg")
        elif height < self._lowest:
            self.fall = (height, self._lowest, f"the robot fell: its CoM was {height:.2f} m above the lower sole")

    @property
    def height(self) -> float:
        left, right = self._places
        return float(self._center.item(2) - min(left.item(2), right.item(2)))


def is_ground(world: World) -> NDArray[np.bool_]:
    """Mask (geoms,) of the ground's geoms in a `world`, moving pieces too."""
    model = world.model
    moving = [model.body_mocapid.tolist().index(i) for i, _ in world.moving_ground]
    fixed = model.body_weldid == 0
    fixed[moving] = True
    return np.asarray(fixed[model.geom_bodyid])


def _tilt(up: float) -> float:
    return math.degrees(math.acos(max(-1.0, min(1.0, up))))
