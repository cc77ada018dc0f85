"""Step elsewhere, or sooner, if the ZMP alone cannot bring the DCM to the next step's start (K 4.1-4.2).

With the ZMP at p for a single support's rest T, the DCM xi comes to p + e^(w T) (xi - p). The wanted xi_s moves by (1 -
a) d with the footstep and later ones by d; a is the VRP's share in double support (K 23-24). A lasting push moves p by
-u_w (K 9).

- "search" scans the time; ZMP, then footstep, make up for the DCM.
- "ssp_opt" solves K 31 (`plantar.gait.propose.ssp_opt`), with the place reachable in the planned time.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import choice, fixed, number, share, switch
from plantar.common.sides import Side, other_side
from plantar.gait.balance.ankle_strategy import (
    AnkleRules,
    Saturation,
    shrunk_support,
    single_support_vrp,
    within_support,
)
from plantar.gait.estimate.push_estimate import NO_PUSH
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import PlanView
from plantar.gait.propose.proposer import Pendulum, Priority, Tick
from plantar.gait.propose.ssp_opt import SspProblem, StepRegionRules, StepWeights, footstep_region, solve_ssp
from plantar.gait.propose.step_timing import PEAK, StepTiming
from plantar.geometry.polygon import convex_hull, signed_margin
from plantar.kernels.gait.pendulum_miss import missed_by
from plantar.kernels.geometry import convex

# times that are tried first, and how often the best one's neighbourhood is halved
_COARSE = 10  # chosen: a time alone depends on it: the cost has one minimum
_FINE = 4  # chosen: 160 parts of a single support are about a tick


class StepAdjustmentRules(Part, table="step_adjustment", needs={"control.step_adjustment": (True,)}):
    """When footsteps move for balance, and how far.

    Attributes:
        method: "search" or "ssp_opt".
        confidence: c of K 2.5: 1 keeps nominal footsteps if balance allows, 0 follows pushes.
        yielding: Share of a push's DCM motion that steps without confidence follow, even if ankles could resist; 0
            steps for balance alone.
        double_support: Whether `double_support_timing` ends double supports, not `step_timing`.
        least_error: Final DCM error in m below which the plan stays.
        acceleration: Swing foot's largest in m/s^2.
        sideways: Its share sideways; all of it makes h1's hips sink.
        shortest: Largest shortening, share of a single support's rest.
        longest: Largest extension, share of a single support.
        pause: Between two changes in s.
        price_place: Cost of a metre of footstep in metres of DCM error, with confidence 1; a tenth without.
    """

    method: str = choice("search", "ssp_opt")
    confidence: float = number(0.0, "1", 0, 1)
    yielding: float = number(0.0, "1", 0, 2)
    double_support: bool = switch(False)
    least_error: float = share(0.04, "sole", 0, 0.2)  # chosen: 10 mm of 250
    acceleration: float = share(0.816, "leg/beat^2", 0.1, 100)  # chosen: 8 m/s^2 on h1
    sideways: float = number(0.5, "1", 0.01, 1)  # measured: with all of it h1's hips sink
    shortest: float = number(0.45, "1", 0, 0.9)  # chosen: bounded by the foot's way, which the acceleration bounds
    longest: float = number(0.3, "1", 0, 5)  # chosen: in 0.3 of a single support an error of the DCM grows 2.5 times
    # Time in s before touchdown from which a foot is not aimed; chosen: 0.1 s on h1
    least_left: float = fixed(0.404, "beat")
    # Single support in s from which a slower walk's is shortened, too; nature: T 4.4.5, 0.9 s
    quick: float = fixed(3.64, "beat")
    pause: float = share(0.081, "beat", 0, 5)  # chosen: 20 ms, four ticks
    lasting: float = fixed(0.202, "beat")  # Time in s for which a small push's miss has to last; chosen: 50 ms on h1
    # Cost of a second earlier in m/s of DCM error; chosen: 50 mm/s on h1, decides between equals
    price_time: float = fixed(0.0206, "leg/beat")
    # derived: The same in m/s of a second later, in which an error in the expected DCM of 20 to 35 mm grows on
    price_later: float = fixed(0.165, "leg/beat")
    price_place: float = number(0.5, "1", 0, 10)  # chosen: bounded by 0, where a millimetre of error moves a step
    # Distance in m from its place at which a foot that has landed stands elsewhere
    misplaced: float = fixed(0.0333, "leg")  # chosen: 20 mm on h1


class _Foot(NamedTuple):
    """Swing foot: step, place (x, y) in m, heading in rad, velocity (x, y) in m/s."""

    step: int
    place: tuple[float, float]
    yaw: float
    velocity: tuple[float, float]


class _Along(NamedTuple):
    """A step and its move (x, y) in m along a push."""

    step: int
    moved: tuple[float, float]


class _Nominal(NamedTuple):
    """VRP (2,) in m over a step before its adjustments, and after the last of them."""

    step: int
    vrp: NDArray[np.float64]
    adjusted: NDArray[np.float64]


class _Choice(NamedTuple):
    """A footstep: time in s until it, move (x, y) in m, cost in m."""

    left: float
    move: tuple[float, float]
    cost: float


class StepAdjustment:
    """Proposes another footstep or time.

    Args:
        rules: When, and how far.
        region: Where a foot can land beside the other.
        touching: Distance in m between sole origins with touching inner edges.
        weights: Of "ssp_opt".
        ankle: Polygon's part for planning a changed footstep.
        period: Of control in s, the unit of a time change.
        timing: Changes step times only, for ground that does not carry everywhere.
    """

    priority = Priority.TIMING

    def __init__(
        self,
        rules: StepAdjustmentRules,
        region: StepRegionRules,
        touching: float,
        weights: StepWeights,
        ankle: AnkleRules,
        period: float,
        timing: StepTiming | None = None,
    ) -> None:
        self._rules = rules
        self._timing = timing
        self._box = region
        self._touching = touching
        self._weights = weights
        c = rules.confidence if ankle.confident else 0.0
        forward = ankle.forward
        sideways = ankle.sideways
        self._ankle = replace(ankle, forward=forward + c * (1.0 - forward), sideways=sideways + c * (1.0 - sideways))
        self._period = period
        self._changed = -math.inf
        self._kept = -math.inf
        self._adjusted = -1
        self._stands = -1
        self._foot: _Foot | None = None
        self._along: _Along | None = None
        self._nominal: _Nominal | None = None
        self._absorbed: tuple[PlanView, Phase, NDArray[np.float64], float] | None = None  # of what, and in m

    def propose(self, tick: Tick) -> PlanChange | None:
        """Another footstep where that helps, or its place now."""
        pendulum = tick.pendulum
        swing = tick.phase.swing
        side = tick.feet.side
        timing = self._timing
        if pendulum is None:
            return None
        if tick.firm and tick.feet.landed and side is not None:
            change = self._landed(tick, side)
            if change is not None or swing is not None:
                return change
        if swing is None or not tick.firm:
            return None if timing is None or (swing is None and self._rules.double_support) else timing.propose(tick)
        if tick.phase.wait or side is None:
            return None
        foot = self._follow(tick, swing)
        if tick.time < self._changed + self._rules.pause or not len(pendulum.zmp_region):
            return None
        left = tick.phase.end - tick.time
        if self._ankle.law == "regulation":
            return self._beyond_ankles(tick, pendulum, foot, left, swing)
        # An error grows at most as without any feedback.
        off = math.dist(pendulum.dcm.tolist(), pendulum.reference.dcm.tolist())
        if pendulum.offset is not NO_PUSH or pendulum.pushed is not NO_PUSH:
            off += math.hypot(*(pendulum.offset + pendulum.pushed).tolist())
        if left < 2.0 * self._period or off * math.exp(pendulum.omega * left) < self._rules.least_error:
            return None
        missed = math.hypot(*_missed(pendulum, left))
        most = self._allowed(tick, pendulum)
        if missed < most:
            self._kept = tick.time
            return self._go_along(tick, pendulum, foot, left, swing)
        # What is expected of a small push is over soon: a step moves at once for a large miss only.
        small = pendulum.pushed.any() and missed < 2.0 * most and self._adjusted != tick.phase.step
        if small and tick.time < self._kept + self._rules.lasting:
            return None
        return self._step_elsewhere(tick, pendulum, foot, left, swing)

    def _allowed(self, tick: Tick, pendulum: Pendulum) -> float:
        """Final DCM error in m that moves no step: at first what a ZMP b off takes up in a double support."""
        phase = tick.phase
        if self._adjusted == phase.step:
            return self._rules.least_error
        known = self._absorbed
        # A phase has one region and one plan, mostly.
        if known is None or known[0] is not tick.plan or known[1] is not phase or known[2] is not pendulum.zmp_region:
            following = tick.plan.schedule.following(phase)
            taken = 1.0 - math.exp(-pendulum.omega * (following.end - following.start))
            most = taken * signed_margin(pendulum.zmp_region, tick.plan.stance_vrp(phase.step))
            known = (tick.plan, phase, pendulum.zmp_region, max(self._rules.least_error, most))
            self._absorbed = known
        return known[3]

    def _step_elsewhere(
        self, tick: Tick, pendulum: Pendulum, foot: _Foot, left: float, swing: Side
    ) -> PlanChange | None:
        """Another footstep for what the ankles' polygon share cannot make up for."""
        pendulum = pendulum.changed(zmp_region=self._relied_on(tick, pendulum.zmp_region))
        find = self._solved if self._rules.method == "ssp_opt" else self._searched
        return self._change(tick, find(tick, pendulum, foot, left, self._region(tick, swing)), left)

    def _beyond_ankles(
        self, tick: Tick, pendulum: Pendulum, foot: _Foot, left: float, swing: Side
    ) -> PlanChange | None:
        """Another footstep where u* lies outside the ankles' share f(c) S (K 25, 27)."""
        if left < 2.0 * self._period:
            return None
        wanted = single_support_vrp(pendulum.dcm, pendulum.goal, left, pendulum.offset, pendulum.omega)
        kept = within_support(wanted, self._relied_on(tick, pendulum.zmp_region))
        if kept.saturated != Saturation.SUPPORT:
            return None
        return self._step_elsewhere(tick, pendulum, foot, left, swing)

    def _go_along(self, tick: Tick, pendulum: Pendulum, foot: _Foot, left: float, swing: Side) -> PlanChange | None:
        """The step farther along a push, beyond its moves so far; it never returns by itself."""
        if pendulum.pushed is NO_PUSH or left < self._rules.least_left:
            return None
        px, py = pendulum.pushed.tolist()
        size = math.hypot(px, py)
        step = tick.phase.step
        if self._along is None or self._along.step != step:
            self._along = _Along(step, (0.0, 0.0))
        yields = self._rules.yielding * (1.0 - self._rules.confidence)
        mx, my = self._along.moved
        more = yields * px - mx, yields * py - my
        if size == 0.0 or more[0] * px + more[1] * py <= self._rules.least_error * size:
            return None
        planned = tick.plan.foothold(step)
        (x, y), _ = self._landing(foot, (planned.x + more[0], planned.y + more[1]), left, self._region(tick, swing))
        dx = x - planned.x
        dy = y - planned.y
        if dx * px + dy * py <= 0.5 * self._rules.least_error * size:
            return None
        self._along = _Along(step, (mx + dx, my + dy))
        self._changed = tick.time
        return _moved(planned, step, (dx, dy), "goes along with a push", 0.0)

    def _relied_on(self, tick: Tick, support: NDArray[np.float64]) -> NDArray[np.float64]:
        """Support polygon's part (k, 2) in m for planning a changed footstep: f(c) S (K 27)."""
        yaw = tick.place(tick.phase.stance or "left").yaw
        middle = tick.plan.stance_vrp(tick.phase.step) if self._ankle.law == "regulation" else support.mean(axis=0)
        return shrunk_support(support, self._ankle, middle, yaw)

    def _follow(self, tick: Tick, swing: Side) -> _Foot:
        position, yaw = tick.feet.footholds[swing]
        x, y, _ = tick.frame.to_world(position).tolist()
        before = self._foot
        velocity = (0.0, 0.0)
        if before is not None and before.step == tick.phase.step:
            was_x, was_y = before.place
            velocity = (x - was_x) / self._period, (y - was_y) / self._period
        self._foot = _Foot(tick.phase.step, (x, y), yaw + tick.frame.turn, velocity)
        return self._foot

    def _change(self, tick: Tick, found: _Choice | None, left: float) -> PlanChange | None:
        if found is None:
            return None
        # A whole number of ticks, so that phases begin at ticks.
        longer = round((found.left - left) / self._period) * self._period
        step = tick.phase.step
        move = found.move
        # derived: of whole ticks, more than one
        if abs(longer) < 1.5 * self._period and math.hypot(*move) < 0.5 * self._rules.least_error:
            return None
        self._changed = tick.time
        self._adjusted = step
        if self._nominal is not None:
            self._nominal = self._nominal._replace(adjusted=tick.plan.vrp(step) + move)
        return _moved(tick.plan.foothold(step), step, move, "step adjusted", longer)

    def _nominal_vrp(self, plan: PlanView, step: int) -> NDArray[np.float64]:
        """VRP (2,) in m over a step without its adjustments (K 30); where something else moved it, that is nominal."""
        vrp = plan.vrp(step)
        known = self._nominal
        # nature: floating point, far above a place's roundings
        if known is None or known.step != step or math.dist(known.adjusted, vrp) > 1e-9:
            known = _Nominal(step, vrp, vrp)
        self._nominal = known
        return known.vrp

    def _landed(self, tick: Tick, side: Side) -> PlanChange | None:
        """End the single support with an adjusted step's landing, and its place."""
        phase = tick.phase
        step = phase.step if phase.swing == side else phase.step - 1
        if step < tick.plan.first or step == self._stands or tick.plan.foothold(step).side != side:
            return None
        self._stands = step
        place = tick.place(side)
        planned = tick.plan.foothold(step)
        move = place.x - planned.x, place.y - planned.y
        if math.hypot(*move) < self._rules.misplaced:
            move = (0.0, 0.0)
            place = planned
        # Down to its last tick: a phase has to have a length.
        longer = min(0.0, tick.time + self._period - phase.end) if phase.swing and self._adjusted == step else 0.0
        if longer > -1.5 * self._period and not any(move):  # derived: of whole ticks, more than one
            return None
        reason = "landed beside its place" if any(move) else "landed early"
        return _moved(replace(planned, yaw=place.yaw), step, move, reason, longer)

    def _region(self, tick: Tick, swing: Side) -> NDArray[np.float64]:
        """Where the swing foot can land (k, 2), world frame, in m, its planned place included."""
        stance = tick.place(other_side(swing))
        planned = tick.plan.foothold(tick.phase.step).position[:2]
        region = footstep_region(self._box, swing, (stance.x, stance.y, stance.yaw), self._touching)
        # A walk may have longer steps than are allowed for balance; those it keeps.
        inside = len(region) and signed_margin(region, planned) >= 0.0
        return region if inside else convex_hull(np.vstack([region.reshape(-1, 2), planned]))

    def _bounds(self, tick: Tick, left: float) -> tuple[float, float]:
        """Soonest and latest single support end in s from now."""
        rules = self._rules
        usual = tick.plan.schedule.timing.single_support
        begun = tick.time - tick.phase.start
        rest = (1.0 - rules.shortest) * min(1.0, rules.quick / usual) * (usual - begun)
        return min(left, max(rules.least_left, rest)), max(left, (1.0 + rules.longest) * usual - begun)

    def _searched(
        self, tick: Tick, pendulum: Pendulum, foot: _Foot, left: float, region: NDArray[np.float64]
    ) -> _Choice | None:
        rules = self._rules
        soonest, latest = self._bounds(tick, left)
        planned = tick.plan.foothold(tick.phase.step)
        slope = _slope(tick, pendulum)
        # derived: a tenth without confidence (`price_place`)
        price = rules.price_place * (0.1 + 0.9 * rules.confidence)

        def tried(time: float) -> _Choice:
            missed = _missed(pendulum, time)
            wanted = planned.x + missed[0] / slope, planned.y + missed[1] / slope
            (x, y), beyond = self._landing(foot, wanted, time, region)
            dx = x - planned.x
            dy = y - planned.y
            when = max(rules.price_time * (left - time), rules.price_later * (time - left))
            cost = math.dist(missed, (slope * dx, slope * dy)) + beyond + when
            return _Choice(time, (dx, dy), cost + price * math.hypot(dx, dy))

        step = (latest - soonest) / _COARSE
        best = tried(left)
        for k in range(_COARSE + 1):
            best = min(best, tried(soonest + k * step), key=_cost)
        for _ in range(_FINE):
            step *= 0.5
            times = (max(soonest, best.left - step), min(latest, best.left + step))
            best = min(best, *map(tried, times), key=_cost)
        return best

    def _solved(
        self, tick: Tick, pendulum: Pendulum, foot: _Foot, left: float, region: NDArray[np.float64]
    ) -> _Choice | None:
        """Best footstep by K 31, in VRPs."""
        plan = tick.plan
        step = tick.phase.step
        rules = self._rules
        vrp = plan.vrp(step)
        target = plan.foothold(step).position[:2]
        following = plan.schedule.following(tick.phase)
        last = step + 1 >= plan.count
        begun = tick.time - tick.phase.start
        soonest, latest = self._bounds(tick, left)
        usual = plan.schedule.timing.single_support
        found = solve_ssp(
            SspProblem(
                omega=pendulum.omega,
                dcm=pendulum.dcm,
                vrp=pendulum.beyond_zmp(left)[2],
                offset=pendulum.offset,
                stance=plan.stance_vrp(step),
                elapsed=begun,
                target=(*vrp.tolist(), begun + left),
                nominal=(*self._nominal_vrp(plan, step).tolist(), usual),
                region=region + (vrp - target),
                shortest=begun + soonest,
                longest=begun + latest,
                next_stride=np.zeros(2) if last else plan.vrp(step + 1) - vrp,
                next_duration=usual,
                double_support=following.end - following.start,
                confidence=rules.confidence,
            ),
            self._weights,
        )
        if found is None:
            return None
        time = found.time - begun
        tx, ty = target.tolist()
        px, py = (found.place - vrp + target).tolist()
        (x, y), _ = self._landing(foot, (px, py), time, region)
        return _Choice(time, (x - tx, y - ty), 0.0)

    def _landing(
        self, foot: _Foot, wanted: tuple[float, float], time: float, region: NDArray[np.float64]
    ) -> tuple[tuple[float, float], float]:
        """Landing place in a region for a wanted one, and its distance outside."""
        x, y = self._reached(foot, convex.nearest(region, *wanted), time)
        inside = convex.nearest(region, x, y)
        return inside, math.dist(inside, (x, y))

    def _reached(self, foot: _Foot, wanted: tuple[float, float], time: float) -> tuple[float, float]:
        """Place (x, y) in m nearest to a wanted one, reachable at rest in a time in s."""
        most = self._rules.acceleration
        vx, vy = foot.velocity
        x, y = foot.place
        c = math.cos(foot.yaw)
        s = math.sin(foot.yaw)
        narrow = self._rules.sideways
        # In the foot's axes, those to the side stretched: what it reaches is a circle then.
        ahead = c * vx + s * vy
        aside = (c * vy - s * vx) / narrow
        reach = max(0.0, most * time * time - (ahead * ahead + aside * aside) / most) / PEAK
        wx = wanted[0] - x
        wy = wanted[1] - y
        dx = c * wx + s * wy - 0.5 * time * ahead
        dy = (c * wy - s * wx) / narrow - 0.5 * time * aside
        far = math.hypot(dx, dy)
        if far <= reach:
            return wanted
        dx = 0.5 * time * ahead + dx * (reach / far)
        dy = narrow * (0.5 * time * aside + dy * (reach / far))
        return x + c * dx - s * dy, y + s * dx + c * dy


def _cost(choice: _Choice) -> float:
    return choice.cost


def _moved(planned: Footstep, step: int, move: tuple[float, float], reason: str, longer: float) -> PlanChange:
    place = replace(planned, x=planned.x + move[0], y=planned.y + move[1])
    return PlanChange(reason, step, foothold=place, shift=move, longer=longer, resets=True)


def _missed(pendulum: Pendulum, left: float) -> tuple[float, float]:
    """DCM error (x, y) in m after a time in s with the best ZMP."""
    missed: tuple[float, float] = missed_by(pendulum, left)
    return missed


def _slope(tick: Tick, pendulum: Pendulum) -> float:
    """Wanted final DCM's change with the footstep."""
    following = tick.plan.schedule.following(tick.phase)
    growth = pendulum.omega * (following.end - following.start)
    return -math.expm1(-growth) / growth
