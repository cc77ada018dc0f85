"""A walk's plan and its owner: footsteps, timing, VRPs (T 4.1.3, steps 2 and 3; T 4.4.2).

Only `WalkPlan.apply` changes and records it. DCM jumps are bridged, or double support extended
(`plantar.gait.plan.bridge`).
"""

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.sides import Side, other_side
from plantar.errors import InputError
from plantar.gait.plan.bridge import bridged
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, PhaseKind, Timing, WalkSchedule
from plantar.gait.plan.plan_change import AppliedChange, MovedStep, PlanChange
from plantar.gait.plan.vrp_plan import LipReference, VrpPlan
from plantar.mechanics.same_time import SAME_TIME

_DELAY = 0.202  # chosen: beats by which a double support that is too short grows at a time; 50 ms
_MOST_DELAY = 1.21  # derived: beats in all; a double support once more
_SHORT = 0.02  # chosen: leg of the DCM that the feedback is left to deal with; 12 mm on h1
# chosen: beats in which a change that comes in single support is bridged; 0.8 s on h1, most of a single support
_STANCE_BRIDGE = 3.24
# chosen: beats before touchdown from which a foothold that is seen coming is bridged on the stance foot; 60 ms
_FORESIGHT = 0.243
_LEAST_BRIDGE = 0.202  # chosen: beats: with less time left nothing is bridged; 50 ms
# derived: beats of standing before the first weight shift, and after the last, that the VRP rests in; 1 s on h1: e^-3.5
# is left of what was before
_AT_REST = 4.04
# derived: stances that a replan builds again; later ones keep what they have; the fourth moves the DCM by e^(-4 w T) of
# its way, 5e-8
_REBUILT = 4
_REMEMBERED = 4  # chosen: steps behind the current one that a plan without an end keeps; a time alone depends on it
_RECORDED = 1000  # chosen: changes that the record keeps; no motion depends on it
_JUMP = 1e-3  # chosen: s: what a VRP that jumps takes, since knots follow each other in time; a fifth of a tick


def vrp_of_step(step: Footstep, vrp_in_sole: ArrayLike) -> NDArray[np.float64]:
    """Footstep's VRP (2,) in m, world frame (T 4.13). `vrp_in_sole`: its place (2,), sole frame, in m."""
    return np.asarray(step.position[:2] + step.rotation_sole_to_world[:2, :2] @ np.asarray(vrp_in_sole, dtype=float))


@dataclass(frozen=True)
class PlannedStep:
    """Footstep with its VRP. `foothold`: planned sole pose; `vrp`: over it (2,), world frame, in m, read-only."""

    foothold: Footstep
    vrp: NDArray[np.float64]

    def __post_init__(self) -> None:
        self.vrp.flags.writeable = False


@dataclass(frozen=True)
class PlanView:
    """The plan now, as a value.

    `first`: first kept step's index; above 0 only in endless walks; `standing`: VRP (2,) over each foot in m before the
    first kept step.
    """

    first: int
    steps: tuple[PlannedStep, ...]
    schedule: WalkSchedule
    standing: Mapping[Side, NDArray[np.float64]]
    last: AppliedChange | None = None

    @property
    def count(self) -> int:
        """Steps of the whole walk."""
        return self.first + len(self.steps)

    def foothold(self, step: int) -> Footstep:
        """A step's planned pose."""
        return self.steps[step - self.first].foothold

    def vrp(self, step: int) -> NDArray[np.float64]:
        """VRP (2,) in m over a step's foothold."""
        return self.steps[step - self.first].vrp

    def vrp_before(self, step: int, side: Side) -> NDArray[np.float64]:
        """VRP (2,), world frame, in m over a foot before a step. `step`: its index."""
        for planned in reversed(self.steps[: step - self.first]):
            if planned.foothold.side == side:
                return planned.vrp
        return self.standing[side]

    def stance_vrp(self, step: int) -> NDArray[np.float64]:
        """VRP (2,) in m over a step's carrying foot."""
        return self.vrp_before(step, other_side(self.foothold(step).side))

    def middle(self, step: int) -> NDArray[np.float64]:
        """Midpoint (2,) in m of both VRPs before a step."""
        return np.asarray(0.5 * (self.vrp_before(step, "left") + self.vrp_before(step, "right")))

    def knots(self, time: float, last: int) -> tuple[list[float], list[NDArray[np.float64]]]:
        """Times in s and VRPs (2,) in m after a time, up to a step's stance; and the final standing's.

        `time` in s; `last`: that step's index. Returns both knot sequences.
        """
        times: list[float] = []
        points: list[NDArray[np.float64]] = []
        rest = _AT_REST * self.schedule.timing.body.beat
        phases = self.schedule.phases
        begin = self.schedule.index(time)
        if self._kept(phases[begin]) > 0.0 and begin > 0:
            begin -= 1  # the foot before carries on into this double support
        for i in range(begin, len(phases)):
            phase = phases[i]
            begun = self._kept(phases[i - 1]) if i > 0 else 0.0
            more = self._kept(phases[i + 1]) if i + 1 < len(phases) else 0.0
            if phase.kind == PhaseKind.SINGLE_SUPPORT:
                if phase.step >= last:
                    return times, points
                vrp = self.stance_vrp(phase.step)
                knots = [phase.start - begun, phase.end + more]
            elif phase.kind == PhaseKind.STANDING and math.isfinite(phase.start):
                vrp = self.middle(phase.step)
                knots = [phase.start - begun, min(phase.end, phase.start + rest) + more]
            elif phase.kind == PhaseKind.STANDING and more > 0.0:
                vrp = self.middle(phase.step)
                knots = [phase.end + more]
            else:
                continue
            times += knots
            points += [vrp] * len(knots)
        return times, points

    def _kept(self, phase: Phase) -> float:
        """Time in s at either end of a double support for which the VRP stays over the feet before and after."""
        share = self.schedule.timing.transfer
        if share == 1.0 or phase.kind != PhaseKind.DOUBLE_SUPPORT:
            return 0.0
        length = phase.end - phase.start
        return 0.5 * (length - max(share * length, min(_JUMP, length)))


class WalkPlan:
    """A walk's footsteps, timing and VRPs.

    `vrp_in_sole` (2,) in each sole's frame in m, usually its centroid; `omega`: pendulum's in rad/s; `begin`: first
    double support's start in s, after standing. Attributes `view`: the plan now, as a value; only `apply` changes it.
    """

    def __init__(
        self,
        feet: Mapping[Side, Footstep],
        steps: Sequence[Footstep],
        timing: Timing,
        vrp_in_sole: Mapping[Side, NDArray[np.float64]],
        omega: float,
        begin: float = 0.0,
    ) -> None:
        self._vrp_in_sole = dict(vrp_in_sole)
        self._omega = omega
        self._body = timing.body
        self._record: deque[AppliedChange] = deque(maxlen=_RECORDED)
        schedule = WalkSchedule.of([step.side for step in steps], timing, begin)
        standing = {s: vrp_of_step(feet[s], vrp_in_sole[s]) for s in feet}
        for vrp in standing.values():
            vrp.flags.writeable = False
        self.view = PlanView(0, tuple(map(self._planned, steps)), schedule, standing)
        first = schedule.phases[0].end
        start = self.view.middle(0)
        times, points = self.view.knots(-math.inf, len(steps))
        if times and times[0] <= first:  # no step at all
            del times[0], points[0]
        self._vrps = VrpPlan([first - _AT_REST * timing.body.beat, first, *times], [start, start, *points], omega)
        self._asked = (-math.inf, self._vrps, self._vrps.at(-math.inf))
        self._next = (-math.inf, self._vrps, self._vrps.at(-math.inf).dcm)

    @property
    def schedule(self) -> WalkSchedule:
        """The phases."""
        return self.view.schedule

    @property
    def vrps(self) -> VrpPlan:
        """VRP, DCM and CoM over time."""
        return self._vrps

    @property
    def record(self) -> tuple[AppliedChange, ...]:
        """The last thousand applied changes."""
        return tuple(self._record)

    def at(self, time: float) -> LipReference:
        """The plan at a time in s (`VrpPlan.at`)."""
        last, vrps, reference = self._asked
        if last != time or vrps is not self._vrps:  # a tick asks more than once, and seldom changes the plan in between
            reference = self._vrps.at(time)
            self._asked = (time, self._vrps, reference)
        return reference

    def dcm_after(self, phase: Phase) -> NDArray[np.float64]:
        """Planned DCM (2,) in m at a phase's end."""
        end, vrps, dcm = self._next
        if end != phase.end or vrps is not self._vrps:  # asked at each tick of the phase
            dcm = self._vrps.at(phase.end).dcm
            self._next = (phase.end, self._vrps, dcm)
        return dcm

    @property
    def end(self) -> NDArray[np.float64]:
        """Final CoM (2,) in m."""
        return np.asarray(self._vrps.vrps[-1])

    def apply(self, change: PlanChange, time: float, region: NDArray[np.float64]) -> AppliedChange:
        """Change the plan from now; returns the record.

        `time`: now in s; `region`: convex (k, 2), world, in m, counter-clockwise, for a bridge's VRP; empty for no
        limit.
        """
        before = self.view
        if not before.first <= change.step < max(before.count, 1) and change.following is None:
            raise InputError(f"step {change.step} is not in the plan; allowed: {before.first} to {before.count - 1}")
        self.view = self._changed(change, time)
        now = self._vrps.at(time)
        shift = np.asarray(change.shift if change.vrp_shift is None else change.vrp_shift)
        gap, delay = self._bridge(change, time, now, region, shift)
        moved = _moved(before, self.view, change)
        applied = AppliedChange(time, change, moved, (float(gap[0]), float(gap[1])), delay)
        self.view = replace(self.view, last=applied)
        if change.following is not None:
            self._forget(time)
        self._record.append(applied)
        return applied

    def _planned(self, step: Footstep) -> PlannedStep:
        return PlannedStep(step, vrp_of_step(step, self._vrp_in_sole[step.side]))

    def _changed(self, change: PlanChange, time: float) -> PlanView:
        view = self.view
        steps = list(view.steps)
        schedule = view.schedule
        k = change.step - view.first
        if change.following is not None:
            steps = steps[: k + 1] + [self._planned(step) for step in change.following]
            schedule = schedule.followed_by(change.step, [step.side for step in change.following], time)
        if change.foothold is not None:
            steps[k] = self._planned(replace(change.foothold, z=steps[k].foothold.z))
        if change.vrp is not None:
            steps[k] = PlannedStep(steps[k].foothold, np.array(change.vrp))
        vrp_shift = change.shift if change.vrp_shift is None else change.vrp_shift
        if any(change.shift) or any(vrp_shift):
            dx, dy = change.shift
            later = np.asarray(vrp_shift)
            for i in range(k + 1, len(steps)):
                foothold = steps[i].foothold
                moved = replace(foothold, x=foothold.x + dx, y=foothold.y + dy)
                steps[i] = PlannedStep(moved, steps[i].vrp + later)
        if change.longer is not None:
            now = schedule.at(time)
            schedule = schedule.delayed(schedule.before(now) if change.again else now, change.longer, change.wait)
        return replace(view, steps=tuple(steps), schedule=schedule)

    def _bridge(
        self,
        change: PlanChange,
        time: float,
        now: LipReference,
        region: NDArray[np.float64],
        shift: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], float]:
        """Solve bridged VRPs; unbridged DCM (2,) in m, and a double support's extension in s."""
        step = change.step
        phase = self.schedule.at(time)
        beat = self._body.beat
        anew = change.following is not None
        if change.longer is not None or anew:
            window = (time, time if change.resets else min(phase.end, time + _STANCE_BRIDGE * beat))
            return self._solved(time, now, window, region, shift, late=change.longer or 0.0, anew=anew), 0.0
        takes_over = phase.step == step + 1 and phase.kind == PhaseKind.DOUBLE_SUPPORT
        if phase.step == step and phase.kind == PhaseKind.SINGLE_SUPPORT and phase.end - time >= _FORESIGHT * beat:
            return self._solved(time, now, (time, phase.end), region, shift), 0.0
        if takes_over or phase.step == step:
            following = phase if takes_over else self.schedule.following(phase)
            return self._bridged_in_double_support(following, time, now, region, shift)
        window = (time, min(phase.end, time + _STANCE_BRIDGE * beat))
        return self._solved(time, now, window, region, shift), 0.0

    def _bridged_in_double_support(
        self,
        phase: Phase,
        time: float,
        now: LipReference,
        region: NDArray[np.float64],
        shift: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], float]:
        window = (max(time, phase.start), phase.end)
        delay = 0.0
        old = self._vrps
        while True:
            self._vrps = old
            gap = self._solved(time, now, window, region, shift, delay)
            if float(np.hypot(*gap)) <= _SHORT * self._body.leg or delay > _MOST_DELAY * self._body.beat:
                break
            delay += _DELAY * self._body.beat
            window = (window[0], phase.end + delay)
        if delay > 0.0:
            self.view = replace(self.view, schedule=self.schedule.delayed(phase, delay))
        return gap, delay

    def _solved(
        self,
        time: float,
        now: LipReference,
        window: tuple[float, float],
        region: NDArray[np.float64],
        shift: NDArray[np.float64],
        delay: float = 0.0,
        late: float = 0.0,
        anew: bool = False,
    ) -> NDArray[np.float64]:
        """Solve VRPs bridged in a time window; unbridged DCM (2,) in m."""
        n = self.view.count
        last = n if anew else min(self.schedule.at(time).step + _REBUILT, n)
        if last >= n - 1:
            last = n
        times, points = self.view.knots(time, last)
        if delay:
            times = [t + delay if t >= window[1] - delay - SAME_TIME else t for t in times]
        kept = len(self._vrps.times) - (0 if last == n else 2 * (n - last) + 2)
        self._vrps, gap = bridged(
            self._vrps,
            (times, points),
            (time, now),
            window if window[1] - window[0] >= _LEAST_BRIDGE * self._body.beat else None,
            region,
            (kept, shift, delay + late),
        )
        return gap

    def _forget(self, time: float) -> None:
        """Drop what lies far behind in an endless walk."""
        view = self.view
        first = max(view.first, min(view.schedule.at(time).step - _REMEMBERED, view.count))
        gone = view.steps[: first - view.first]
        standing = dict(view.standing) | {p.foothold.side: p.vrp for p in gone}
        schedule = view.schedule.since(time - 1.0)
        self.view = replace(view, first=first, steps=view.steps[len(gone) :], standing=standing, schedule=schedule)


def _moved(before: PlanView, after: PlanView, change: PlanChange) -> tuple[MovedStep, ...]:
    moved = []
    for k in range(max(change.step, after.first), after.count):
        old = before.foothold(k) if before.first <= k < before.count else None
        new = after.foothold(k)
        if new != old:
            reason = change.reason if k == change.step or not change.because else change.because
            moved.append(MovedStep(k, new.x, new.y, new.yaw, reason, old))
    return tuple(moved)
