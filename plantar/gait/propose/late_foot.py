"""Lets no foot lift before the other one has landed.

Phases follow each other by plan. Where a sole that sees the ground is not down yet as its double support ends, the
next swing would leave the body without a foot, and it falls onto the one that is late.
"""

from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, Tick
from plantar.gait.propose.step_timing import LONGEST_DOUBLE

# chosen: beats by which the double support grows at a time: 50 ms on h1, in which a foot comes down by a centimetre.
# +-20 % fells neither robot in three turns with worn soles on poor ground, whose mean landing moves by -13 to +4 %
_WAITS = 0.202


class LateFoot:
    """Proposes a longer double support while the foot that is to carry is in the air.

    `beat` in s; `period` of control in s.
    """

    priority = Priority.SAFETY

    def __init__(self, beat: float, period: float) -> None:
        self._waits = round(_WAITS * beat / period) * period  # phases begin at ticks
        self._period = period

    def propose(self, tick: Tick) -> PlanChange | None:
        """Some time more before the next foot lifts, if the last one has not landed."""
        phase = tick.phase
        if tick.feet.landed or phase.kind != PhaseKind.DOUBLE_SUPPORT or phase.step >= tick.plan.count:
            return None
        # derived: within the next tick
        if phase.end - tick.time > 1.5 * self._period:
            return None
        if phase.end - phase.start > LONGEST_DOUBLE * tick.plan.schedule.timing.single_support:
            return None
        return PlanChange("foot not down yet", phase.step, longer=self._waits, resets=True)
