"""End double support sooner or later if no VRP brings the DCM to its goal (K 4.3, `dsp_opt`)."""

import math

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share
from plantar.gait.balance.ankle_strategy import (
    AnkleRules,
    Saturation,
    double_support_vrp,
    shrunk_support,
    within_support,
)
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.dsp_opt import DspProblem, DspWeights, solve_dsp
from plantar.gait.propose.proposer import Pendulum, Priority, Tick


class DoubleSupportTimingRules(
    Part,
    table="double_support_timing",
    needs={"control.step_adjustment": (True,), "step_adjustment.double_support": (True,)},
):
    """When a double support's end moves.

    Attributes:
        least_error: DCM error in m below which the timing stays.
        pause: Between two changes in s.
    """

    # derived: twice that of step adjustment: a timing moves less than a step
    least_error: float = share(0.08, "sole", 0, 0.2)
    # Time in s before its end from which it stays; none ends sooner; chosen: 50 ms, ten ticks
    least_left: float = fixed(0.202, "beat")
    pause: float = share(0.202, "beat", 0, 5)  # chosen: 50 ms, in which the last change acts


class DoubleSupportTiming:
    """Proposes another double support end.

    `confidence`: c of K 37; `period` of control in s, the unit of a change; `ankle`: VRP's share of the support polygon
    (K 27), with law "regulation"; else all of it.
    """

    priority = Priority.TIMING

    def __init__(
        self,
        rules: DoubleSupportTimingRules,
        weights: DspWeights,
        confidence: float,
        period: float,
        ankle: AnkleRules | None = None,
    ) -> None:
        self._rules = rules
        self._weights = weights
        self._confidence = confidence
        self._period = period
        self._ankle = ankle if ankle is not None and ankle.law == "regulation" else None
        self._changed = -math.inf

    def propose(self, tick: Tick) -> PlanChange | None:
        """Another double support end, where that helps."""
        phase = tick.phase
        pendulum = tick.pendulum
        rules = self._rules
        plan = tick.plan
        if pendulum is None or phase.kind != PhaseKind.DOUBLE_SUPPORT or not plan.first < phase.step < plan.count:
            return None
        left = phase.end - tick.time
        if left < rules.least_left or tick.time < self._changed + rules.pause or not len(pendulum.zmp_region):
            return None
        if math.dist(pendulum.dcm, pendulum.reference.dcm) < rules.least_error:
            return None
        found = self._best(tick, pendulum)
        if found is None:
            return None
        change = round((found - (phase.end - phase.start)) / self._period) * self._period
        change = max(change, rules.least_left - left)
        if abs(change) < 1.5 * self._period:  # derived: of whole ticks, more than one
            return None
        self._changed = tick.time
        # It is about the footstep that the double support ends with.
        return PlanChange("double support adjusted", phase.step - 1, longer=change, resets=True)

    def _best(self, tick: Tick, pendulum: Pendulum) -> float | None:
        """Best double support in s; None if the VRP suffices."""
        phase = tick.phase
        plan = tick.plan
        end = plan.stance_vrp(phase.step)
        begun = tick.time - phase.start
        length = phase.end - phase.start
        wanted = double_support_vrp(pendulum.dcm, pendulum.goal, end, length, begun, pendulum.offset, pendulum.omega)
        region = pendulum.zmp_region
        if self._ankle is not None:
            region = shrunk_support(region, self._ankle, region.mean(axis=0), tick.place("left").yaw)
        kept = within_support(wanted, region)
        if kept.saturated != Saturation.SUPPORT:
            return None
        problem = DspProblem(
            omega=pendulum.omega,
            dcm=pendulum.dcm,
            goal=pendulum.goal,
            vrp=kept.vrp,
            end=end,
            offset=pendulum.offset,
            elapsed=begun,
            target=length,
            nominal=plan.schedule.timing.double_support,
            confidence=self._confidence,
        )
        return solve_dsp(problem, self._weights).time
