"""End a support as the DCM reaches the next one's start, if the ZMP alone cannot.

A wanted DCM xi_e takes the ZMP p(T) = xi + (xi - xi_e) / (e^(w T) - 1) for the rest T. At d outside the support polygon
the DCM is off by (e^(w T) - 1) d, which another T reduces (T 4.9-4.14). A foot lifts later, too: with both feet down a
DCM between them comes back, while a swing of the foot that it lies over leaves it no ground.

A DCM that runs away towards the foot that swings is caught by it, as soon as that gets to its place: from rest to rest
by minimum jerk in sqrt(5.774 way / acceleration). One that runs the other way has no ground there either: the foot is
not hurried for it.
"""

import math
from collections.abc import Callable

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, number, share
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Pendulum, Priority, Tick

PEAK = 5.774
"""Largest acceleration of a minimum-jerk motion over its way and time. Nature: 10 / sqrt(3) way / time^2."""

LONGEST_DOUBLE = 2.5
"""Longest double support, as a share of a single one. Chosen: a foot that found no ground by then finds none."""


class StepTimingRules(Part, table="step_timing", needs={"control.step_timing": (True,)}):
    """When a support's end moves.

    Attributes:
        least_error: Final DCM error in m below which the timing stays.
        price: Of a second in m/s of DCM error.
        longest: Largest extension, share of a single support; with half, h1 withstands less.
        pause: Between two changes in s.
    """

    least_error: float = share(0.04, "sole", 0, 0.2)  # derived: as of step adjustment
    price: float = share(0.0206, "leg/beat", 0, 10)  # derived: as of step adjustment
    longest: float = number(0.15, "1", 0, 5)  # measured: with half of a single support h1 withstands less
    # Time in s before touchdown from which a foot is not hurried; chosen: 0.2 s on h1, in which a foot comes down
    least_left: float = fixed(0.809, "beat")
    # Largest of a foot that is hurried in m/s^2; derived: as of step adjustment
    acceleration: float = fixed(0.816, "leg/beat^2")
    longest_double: float = fixed(LONGEST_DOUBLE, "1")  # none ends sooner, for feet have to take over
    pause: float = share(0.162, "beat", 0, 5)  # chosen: 40 ms, eight ticks


class StepTiming:
    """Proposes another end of a support. `period` of control in s, the unit of a change."""

    priority = Priority.TIMING

    def __init__(self, rules: StepTimingRules, period: float) -> None:
        self._rules = rules
        self._period = period
        self._changed = -math.inf

    def propose(self, tick: Tick) -> PlanChange | None:
        """Another end of the support, where that helps."""
        phase = tick.phase
        rules = self._rules
        pendulum = tick.pendulum
        stands = phase.kind == PhaseKind.STANDING or phase.step == tick.plan.count
        if pendulum is None or stands or phase.wait or tick.time < self._changed + rules.pause:
            return None
        left = phase.end - tick.time
        if left < 2.0 * self._period or not len(pendulum.zmp_region):
            return None
        # An error grows at most as without any feedback.
        off = math.dist(pendulum.dcm.tolist(), pendulum.reference.dcm.tolist())
        if off * math.exp(pendulum.omega * left) < rules.least_error:
            return None
        missed = _misses(tick, pendulum)
        if missed(left) < rules.least_error:
            return None
        change = self._best_change(tick, missed, left)
        if abs(change) < 1.5 * self._period:  # derived: of whole ticks, more than one
            return None
        self._changed = tick.time
        reason = "DCM behind" if change > 0.0 else "DCM ahead"
        return PlanChange(reason, phase.step, longer=change, resets=True)

    def _best_change(self, tick: Tick, missed: Callable[[float], float], left: float) -> float:
        """Delay in s of the phase's end with least miss and price."""
        rules = self._rules
        usual = tick.plan.schedule.timing.single_support
        begun = tick.time - tick.phase.start
        later = rules.longest_double * usual - begun - left
        sooner = 0.0
        if tick.phase.swing is not None:
            later = (1.0 + rules.longest) * usual - begun - left
            if _runs_to_foot(tick, left):
                way = math.hypot(*tick.feet.ahead.tolist())
                sooner = left - max(rules.least_left, math.sqrt(PEAK * way / rules.acceleration))
        best = 0.0
        least = missed(left)
        for sign, most in ((1.0, later), (-1.0, sooner)):
            # nature: floating point: a quotient of decimals is whole to 1e-12
            for k in range(1, int(most / self._period + 1e-6) + 1):
                price = rules.price * k * self._period
                if price >= least:
                    break
                cost = price + missed(left + sign * k * self._period)
                if cost < least:
                    best = sign * k * self._period
                    least = cost
        return best


def _runs_to_foot(tick: Tick, left: float) -> bool:
    """Whether the DCM misses its goal, `left` seconds from now, towards the place of the swinging foot."""
    assert tick.pendulum is not None
    plan = tick.plan
    step = tick.phase.step
    x, y = (plan.vrp(step) - plan.stance_vrp(step)).tolist()
    _, wanted, best = tick.pendulum.beyond_zmp(left)
    return bool(x * (wanted[0] - best[0]) + y * (wanted[1] - best[1]) > 0.0)


def _misses(tick: Tick, pendulum: Pendulum) -> Callable[[float], float]:
    """DCM error in m after a time in s.

    In double support only towards the foot that lifts: elsewhere its stance foot does alone what both can do.
    """
    plan = tick.plan
    step = tick.phase.step
    way = plan.vrp_before(step, plan.foothold(step).side) - plan.stance_vrp(step)
    ux, uy = (way / math.hypot(*way)).tolist()

    def missed(left: float) -> float:
        growth, (wx, wy), (x, y) = pendulum.beyond_zmp(left)
        wx = growth * (wx - x)
        wy = growth * (wy - y)
        return math.hypot(wx, wy) if tick.phase.swing is not None else max(0.0, ux * wx + uy * wy)

    return missed
