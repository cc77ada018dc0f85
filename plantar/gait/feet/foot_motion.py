"""Commanded feet: footholds, swing and landing."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.sides import SIDES, Side, other_side
from plantar.gait.contact.ground_map import GroundView
from plantar.gait.feet.landing import Landing
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import Swing, SwingKind, SwingStart, hurried
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.kernels.base.vectors import close, vector, vector2
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.kernels.gait.sole_admittance import turned
from plantar.kernels.gait.swing_lag import SwingLag
from plantar.mechanics.rotation import level_rotation, rotation_from_vector, vector_from_rotation
from plantar.mechanics.same_time import SAME_TIME
from plantar.percepts.percept import Percept

# Distances as shares of the leg:
_RETAKE_HEIGHT = 1 / 15  # chosen: above what the foot met that a step taken once more rises at most
_CLOSE_BY = 0.1  # chosen: before its place from which a swing turns its sole to the ground
_NEARLY_THERE = 0.02  # chosen: before its place from which a swing judges the ground that it will land on
_TOUCHING = 1 / 60  # chosen: from the ground that it sees within which less than a blind foot's load counts as a touch
_AHEAD = 1 / 60  # chosen: below where it is estimated to be at which a foot that comes down is commanded at most
_ELSEWHERE = 1 / 150  # chosen: between ground and where it was expected from which the next steps come down slowly
_SAME_PLACE = 1 / 6000  # derived: between two places that are one; 0.1 mm
_AT_THE_GROUND = 1 / 300  # derived: from it within which the least load is; 2 mm, the noise of a reading

# chosen: beats before touchdown from which a foot would have to be thrown to reach another place; 0.1 s on h1
_LEAST_TIME = 0.404
# chosen: steps after ground that was elsewhere in which a swing that does not see it comes down slowly; three of each
# foot
_WARY = 6


class SoleSense(Record, frozen=True):
    """A sole's percept and its pose in the world, as estimated of what was measured at a `time` in s."""

    percept: Percept
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    time: float


class _Slope(NamedTuple):
    """Ground that slopes on.

    `rise`: from the standing foot to the swing's end in m; `share`: of the last step's rise that it explains; `tilt`:
    rotation vector (3,) in rad of a sole on it, less its heading.
    """

    rise: float
    share: float
    tilt: NDArray[np.float64]


_LEVEL = _Slope(0.0, 0.0, np.zeros(3))


class FootMotion:
    """Commanded footholds over time.

    Attributes `footholds`: sole's (3,) in m and heading in rad, command frame; `landed`: whether the last swing foot
    has touched; `comes_down`: whether it is past half of its swing; `surprise`: ground height seen or met, less the
    expected, in m; `last_side`: foot of the current or last swing; None before; `hurried`: whether that has to catch
    the body. `period` of control in s; `swing_height`: swing foot clearance in m; `compliance`: preemptive, of
    each foot; None lands blindly; `swing`: its kind; None takes time polynomials.
    """

    def __init__(
        self,
        feet: Mapping[Side, Footstep],
        period: float,
        swing_height: float,
        landing: Landing,
        compliance: Mapping[Side, SwingCompliance] | None = None,
        swing: SwingKind | None = None,
    ) -> None:
        self.footholds: dict[Side, tuple[NDArray[np.float64], float]] = {
            s: (feet[s].position.copy(), feet[s].yaw) for s in SIDES
        }
        self.landed = True
        self.comes_down = False
        self._period = period
        self._height = swing_height
        self._landing = landing
        self._leg = landing.body.leg
        self._compliance = compliance
        self._kind = PolynomialSwing() if swing is None else swing
        self._tilts: dict[Side, NDArray[np.float64]] = {s: np.eye(3) for s in SIDES}
        self._rotations: dict[Side, tuple[float, NDArray[np.float64], NDArray[np.float64]]] = {}
        self._lifted_tilt = np.zeros(3)
        self._slope = _LEVEL.tilt
        self._expected = float(np.mean([feet[s].z for s in SIDES]))
        self._planned = self._expected
        self._swing: Swing | None = None
        self.last_side: Side | None = None
        self.hurried = False
        self._side: Side = "left"
        self._target: Footstep | None = None
        self._start = 0.0
        self._unhurried = 0.0
        self._step = -1
        self.surprise = 0.0
        self._lift_off = False
        self._touchdown = False
        self._distance: NDArray[np.float64] | None = None
        self._below: NDArray[np.float64] | None = None
        self._lowered = 0.0
        self._lowering = 0.0
        self._touch = (0.0, 0.0)
        self._rises_first: set[Side] = set()
        self._wary = 0
        self._lag = SwingLag(period, landing.body.in_si("leg/beat"))

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Sides needing proximity: in the air, with preemptive compliance."""
        side = self.last_side
        return () if self._compliance is None or self.landed or side is None else (side,)

    @property
    def ahead(self) -> NDArray[np.float64]:
        """Horizontal distance (2,) in m to the swing target, command frame; zero before the first step."""
        if self._swing is None:
            return np.zeros(2)
        x, y, _ = self._swing.end.tolist()
        here_x, here_y, _ = self.footholds[self._side][0].tolist()
        return vector2(x - here_x, y - here_y)

    @property
    def end(self) -> tuple[float, float, float]:
        """Place in m and heading in rad that the last swing ends at, command frame; where the foot stands before."""
        if self._swing is None:
            position, yaw = self.footholds[self._side]
            return position.item(0), position.item(1), yaw
        x, y, _ = self._swing.end.tolist()
        return x, y, self._swing.yaw_end

    @property
    def comes_to(self) -> float:
        """Height in m of the last swing's end as now expected, command frame; infinite before."""
        if self._swing is None:
            return math.inf
        return self._expected + min(0.0, self.surprise)

    @property
    def view(self) -> FeetView:
        """Feet at this tick, as a value."""
        footholds = self.footholds
        left = footholds["left"]
        right = footholds["right"]
        close(left[0])
        close(right[0])
        return FeetView(
            {"left": left, "right": right},
            self.last_side,
            self.landed,
            self._lift_off,
            self._touchdown,
            self.ahead,
            self.surprise,
            self._distance,
            self._below,
        )

    def rotation(self, side: Side) -> NDArray[np.float64]:
        """Sole to command frame (3, 3): its heading, and the ground's slope."""
        yaw = self.footholds[side][1]
        tilt = self._tilts[side]
        known = self._rotations.get(side)
        if known is None or known[0] != yaw or known[1] is not tilt:
            level = level_rotation(yaw)
            rotation: NDArray[np.float64] = level if self._compliance is None else level.dot(tilt)
            close(rotation)  # shared until the foot moves
            known = (yaw, tilt, rotation)
            self._rotations[side] = known
        return known[2]

    def turn_standing(self, side: Side, turn: NDArray[np.float64], pivot: NDArray[np.float64]) -> None:
        """Turn a standing sole.

        `turn` (2,) about the sole's x and y axes in rad; `pivot`: point (2,), sole frame, in m that keeps its height.
        """
        before = self.rotation(side)
        self._tilts[side] = turned(self._tilts[side], turn.item(0), turn.item(1))
        now = self.rotation(side)
        rise_x = before.item(2, 0) - now.item(2, 0)
        rise_y = before.item(2, 1) - now.item(2, 1)
        rise = rise_x * pivot.item(0) + rise_y * pivot.item(1)
        position, yaw = self.footholds[side]
        self.footholds[side] = (position + vector(0.0, 0.0, rise), yaw)

    def update(
        self,
        phase: Phase,
        time: float,
        target: Footstep | None,
        loads: Mapping[str, float],
        frame: CommandFrame,
        senses: Mapping[Side, SoleSense] | None = None,
        press: float | None = None,
        heights: Mapping[Side, float] | None = None,
    ) -> None:
        """Advance the swing foot; stop at touchdown, lower it until ground.

        `time` in s; `target`: footstep being taken, in single support; `loads`: vertical on each foot in N; `frame`:
        command frame; `press`: force in N that a seeing foot holds in single support; None for its gains'; `heights`:
        soles' estimated, world frame, in m, for feet that relax.
        """
        if self._compliance is not None and senses is not None:
            for side, compliance in self._compliance.items():
                if loads[side] > compliance.touchdown.touch_force:
                    compliance.ground.stand(senses[side].position, senses[side].rotation)
        self._lift_off = phase.swing is not None and self._step != phase.step
        if self._lift_off and target is not None:
            self._begin(phase.step, (phase.start, phase.touchdown), target, frame)
        if self._swing is None:
            return
        before = self.landed
        self.comes_down = self._swing.comes_down(time - self._start)
        if self._compliance is not None and senses is not None:
            self._comply(phase, time, loads[self._side], senses[self._side], frame, press)
        else:
            self._advance(phase, time, loads[self._side])
        if heights is not None and phase.kind == PhaseKind.STANDING and self._landing.relax_time > 0.0:
            self._relax(heights)
        self._touchdown = self.landed and not before

    def _relax(self, heights: Mapping[Side, float]) -> None:
        """Command the landed foot as high above the other as estimated."""
        side = self._side
        other = other_side(self._side)
        position, yaw = self.footholds[side]
        stands = self.footholds[other][0].item(2) + heights[side] - heights[other]
        share = min(1.0, self._period / self._landing.relax_time)
        self.footholds[side] = (position + np.array([0.0, 0.0, share * (stands - position.item(2))]), yaw)

    def stand_at(self, side: Side, place: NDArray[np.float64], yaw: float) -> None:
        """Move a landed foot's place. `place`: its (3,), command frame, in m; `yaw`: its heading in rad."""
        self.footholds[side] = (place.copy(), yaw)

    def _advance(self, phase: Phase, time: float, load: float) -> None:
        assert self._swing is not None
        if phase.swing is not None:
            # On its way up a sole still carries what the ground that it leaves gives back.
            if self.comes_down and load > self._landing.contact_force:
                self.landed = True
                if abs(self.footholds[self._side][0].item(2) - self._expected) > _ELSEWHERE * self._leg:
                    self._wary = _WARY
            if not self.landed:
                self.footholds[self._side] = self._swing.at(time - self._start)
                return
        self.landed = True  # it touched, or the plan puts weight on it now
        self._press(self._side, load)

    def aim(self, phase: Phase, time: float, target: Footstep, frame: CommandFrame, lifts: bool = False) -> None:
        """Follow a plan changed in the swing; a landed foot lifts and steps again.

        `time` in s; `frame`: command frame; `lifts`: whether a foot in the air does so, too, off ground that it sees.
        """
        if self._swing is None or phase.swing is None or phase.step != self._step:
            return
        moves = target != self._target
        if not moves and (self.landed or abs(phase.touchdown - self._start - self._swing.duration) < SAME_TIME):
            return
        if self.landed or lifts:
            here = self.footholds[self._side][0][:2]
            if math.dist(frame.to_command(target.position[:2]), here) < _SAME_PLACE * self._leg:
                self._target = target  # the plan has only taken over where it stands
            else:
                self._retake(time, phase.touchdown, target, frame)
            return
        self._target = target
        place = frame.to_command(target.position[:2]) if moves else self._swing.end[:2]
        yaw = target.yaw - frame.turn if moves else self._swing.yaw_end
        self._swing = self._swing.aimed(time - self._start, place, yaw, phase.touchdown - self._start)
        self.hurried = hurried(self._swing.duration, self._unhurried)
        if self.hurried and self._compliance is not None:
            self._compliance[self._side].hasten()

    def _begin(
        self, index: int, times: tuple[float, float], target: Footstep, frame: CommandFrame, again: bool = False
    ) -> None:
        side = target.side
        stance = other_side(side)
        position, yaw = self.footholds[side]
        x, y = frame.to_command(target.position[:2]).tolist()
        yaw_end = target.yaw - frame.turn
        rise = target.z - self._planned
        slopes = _LEVEL if rise else self._slopes_on(stance, position, x - position[0], y - position[1], yaw_end)
        self._slope = slopes.tilt
        if self._swing is not None:
            # Where the other foot found the ground is the best guess of where this one will: the better, the more of
            # its step's rise a slope explains.
            landed = float(self.footholds[stance][0][2])
            self._expected += max(self._landing.ground_share, slopes.share) * (landed - self._expected)
        # By the plan it is as much higher or lower as that has its steps; by itself, if it slopes on.
        self._expected += rise or slopes.rise
        self._planned = target.z
        sees = self._compliance is not None
        start = SwingStart(
            position=position.copy(),
            yaw=yaw,
            end=np.array([x, y, self._expected - self._landing.depth]),
            yaw_end=yaw_end,
            height=self._height,
            duration=times[1] - times[0],
            period=self._period,
            least_time=_LEAST_TIME * self._landing.body.beat,
            sees_ground=sees and not again,
            approach_height=self._landing.approach_height if self._wary > 0 and (again or not sees) else 0.0,
            approach_speed=self._landing.approach_speed,
            rises_first=side in self._rises_first,
        )
        self._swing = self._kind.begin(start)
        self._unhurried = start.duration
        self.hurried = False
        self.last_side = side
        self._rises_first.discard(side)
        self._wary -= 1
        self._step = index
        self._side = side
        self._target = target
        self._start = times[0]
        self.surprise = 0.0
        self.landed = False
        self._distance = None
        self._below = None
        self._lowered = 0.0
        self._lowering = 0.0
        if self._compliance is not None:
            self._compliance[side].begin(start.haste)
            self._lag.begin()
            self._lifted_tilt = vector_from_rotation(self._tilts[side])

    def _slopes_on(self, stance: Side, lifted: NDArray[np.float64], way_x: float, way_y: float, yaw: float) -> _Slope:
        """Returns the slope that the standing sole and the last step share, to the swing's end."""
        way = math.hypot(way_x, way_y)
        if self._compliance is None or way < _NEARLY_THERE * self._leg:
            return _LEVEL
        x, y, z = (self.footholds[stance][0] - lifted).tolist()
        gone = float(way_x * x + way_y * y) / way
        normal_x, normal_y, normal_z = self.rotation(stance)[:, 2].tolist()
        slope = -(way_x * normal_x + way_y * normal_y) / (way * normal_z)
        if gone < _NEARLY_THERE * self._leg or slope * z <= 0.0:
            return _LEVEL
        last = float(z) / gone
        shared = math.copysign(min(abs(slope), abs(last)), slope)
        along = math.atan2(way_y, way_x) - yaw
        tilt = math.atan(shared) * vector(math.sin(along), -math.cos(along), 0.0)
        return _Slope(shared * (way - gone), shared / last, tilt)

    def _retake(self, time: float, touchdown: float, target: Footstep, frame: CommandFrame) -> None:
        """Lift a landed foot and repeat its step elsewhere."""
        expected = self._expected
        height = self._height
        self._wary = _WARY
        # It has to clear only what it has just met, in what is left of the step.
        self._height = min(height, _RETAKE_HEIGHT * self._leg)
        self._begin(self._step, (time, touchdown), target, frame, again=True)
        self._expected = expected
        self._height = height
        self._rises_first.add(self._side)  # what it has met is next to it then

    def _comply(
        self, phase: Phase, time: float, load: float, sense: SoleSense, frame: CommandFrame, press: float | None
    ) -> None:
        """Advance a seeing foot: soften its swing, turn it, hand over to real load."""
        assert self._swing is not None
        assert self._compliance is not None
        swing = self._swing
        period = self._period
        side = self._side
        compliance = self._compliance[side]
        position, yaw = self.footholds[side]
        elapsed = time - self._start
        self._below = None
        if not self.landed:
            above_frame = sense.position.item(2) - frame.z
            self._lag.update(position.item(2), above_frame)
            view = compliance.ground.update(sense.percept, sense.position, sense.rotation, sense.time)
            if self.comes_down and compliance.update_load(load) and self._may_touch(compliance, view, load):
                self.landed = True
                self._touch = (time, sense.position.item(2))
                self.surprise = max(self.surprise, above_frame - self._expected)
                compliance.ground.touched()
                self._distance = compliance.ground.distance
                self._distance.flags.writeable = False
        if not self.landed:
            risen = swing.risen(elapsed)
            planned, heading = swing.at(elapsed)
            if risen < 1.0:
                self.footholds[side] = (planned, heading)
                self._tilts[side] = rotation_from_vector(self._lifted_tilt + risen * (self._slope - self._lifted_tilt))
                return
            x, y, z = planned.tolist()
            falling = swing.falling(elapsed, z)
            down = phase.start if phase.swing is None else phase.end - phase.wait
            time_left = down - time - self._lag.time
            if time_left <= 0.0:
                falling = self._landing.speed
            end_x, end_y, _ = swing.end.tolist()
            remaining = math.hypot(end_x - x, end_y - y)
            # A sole that sees, and sees no ground at its place, is above ground that is lower than expected.
            sees = view is None and sense.percept.reading.proximity is not None
            if sees and remaining < _NEARLY_THERE * self._leg:
                falling = max(falling, self._landing.approach_speed)
            if compliance.by_wrench:
                drop = compliance.damped(falling, time_left, period)
                if compliance.stopped:
                    x, y, _ = position.tolist()
            else:
                # One that has to catch the body comes down wherever it is.
                away = 0.0 if self.hurried else remaining
                drop = compliance.descent(view, falling, away, time_left, period, self._lag.to_come)
            if view is not None and remaining < _NEARLY_THERE * self._leg:
                # A block under a rim is not under the middle: unless all is one plane, what would be met first counts.
                under = view.middle if view.even else min(view.middle, view.distance)
                self.surprise = above_frame - under - self._expected
                if self.surprise > 0.0 and not view.even:
                    self._below = compliance.ground.distance
                    self._below.flags.writeable = False
            near = view if remaining < _CLOSE_BY * self._leg else None
            turn = compliance.turn(self._tilts[side], near, period, self._slope)
            turn_x = turn.item(0)
            turn_y = turn.item(1)
            if turn_x != 0.0 or turn_y != 0.0:
                self._tilts[side] = turned(self._tilts[side], turn_x, turn_y)
            # A leg that is stretched leaves its foot behind; commanded further down, it would slam where it gets there.
            was = position.item(2)
            lowest = above_frame - _AHEAD * self._leg
            self.footholds[side] = (vector(x, y, max(was - drop, min(was, lowest))), heading)
            return
        touched_at, height = self._touch
        hold = compliance.holding(time - touched_at) if press is None else press
        above = max(0.0, sense.position.item(2) - height)
        if phase.swing is not None:
            drop = compliance.yielding(load, hold, above, period)
        else:
            share = min(1.0, 2.0 * (time - phase.start) / (phase.end - phase.start))
            target = hold + share * (self._landing.press_force - hold)
            drop = max(0.0, compliance.yielding(load, target, above, period))
        self.footholds[side] = (position - vector(0.0, 0.0, drop), yaw)

    def _may_touch(self, compliance: SwingCompliance, view: GroundView | None, load: float) -> bool:
        """Whether a load can be a touch: the farther the ground, the likelier noise."""
        blind = self._landing.contact_force
        if load > blind:
            return True
        touching = _TOUCHING * self._leg
        there = _AT_THE_GROUND * self._leg
        if view is None or view.distance >= touching:
            return False
        far = (view.distance - there) / (touching - there)
        least = compliance.touchdown.contact_force
        return far <= 0.0 or compliance.force > least + far * (blind - least)

    def _press(self, side: Side, load: float) -> None:
        """Press down less the more the foot carries, so that it does not tap."""
        landing = self._landing
        missing = 1.0 - load / landing.press_force
        wanted = landing.speed * missing if missing > 0.0 and self._lowered < landing.reach else 0.0
        self._lowering = min(wanted, self._lowering + landing.acceleration * self._period)
        if self._lowering > 0.0:
            drop = self._lowering * self._period
            self._lowered += drop
            position, yaw = self.footholds[side]
            self.footholds[side] = (position - vector(0.0, 0.0, drop), yaw)
