"""Feet meet the ground softly, where it is not as expected, too."""

from plantar.common.settings.schema import number
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason
from plantar.sim.judging.unmet import unmet


class SoftLandings(Criterion):
    """No landing is harder than half the weight, which is what H1 of T met blindly: 430 N at most (T 4.4.1.2, Fig. 52).

    Attributes:
        largest: Largest ground force of a landing, in weights.
    """

    largest: float = number(0.5, "1", 0, 10)

    def claim(self) -> str:
        return f"no foot lands with more than {self.largest:g} of the weight"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        hardest = max((landing.impact for landing in run.judge.landings), default=0.0) / run.body.weight
        text = f"a foot landed with {hardest:.2f} of the weight; allowed: {self.largest:g}"
        return unmet((hardest <= self.largest, "soft_landings", hardest, self.largest, text))
