"""What lies in the way does not bear the robot: it is refused, and walked around."""

from typing import ClassVar

from plantar.common.settings.schema import share
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason
from plantar.sim.judging.unmet import unmet


class NeverStoodOn(Criterion):
    """No piece of ground carries a quarter of the weight for long: a probe may press on it, a stand may not.

    Attributes:
        longest: Time for which one may, without a break: 0.2 s for H1.
    """

    longest: float = share(0.809, "beat", 0, 100)
    of_pieces: ClassVar[bool] = True

    def claim(self) -> str:
        return f"nothing in the way carries a quarter of the weight for more than {self.longest:.2g} s"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        pieces = run.judge.pieces
        assert pieces is not None
        longest = max((pieces.longest(piece) for piece in range(pieces.count)), default=0.0)
        limit = round(self.longest, 4)
        text = f"what lies in the way carried a quarter of the weight for {longest:.2f} s; allowed: {limit:.2g} s"
        return unmet((longest <= self.longest, "never_stood_on", longest, limit, text))
