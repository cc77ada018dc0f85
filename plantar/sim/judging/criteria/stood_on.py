"""The ground under the planned steps was stood on: no foothold was skipped."""

from typing import ClassVar

from plantar.common.settings.schema import number
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason
from plantar.sim.judging.unmet import unmet


class StoodOn(Criterion):
    """Every piece of ground that lies under a planned footprint carries a quarter of the weight at some time.

    Attributes:
        covers: Share of a footprint from which a piece lies under it.
    """

    covers: float = number(0.2, "1", 0.01, 1)
    of_pieces: ClassVar[bool] = True

    def claim(self) -> str:
        return "every piece of ground under a planned step carries a quarter of the weight at some time"

    def reasons(self, run: JudgedRun) -> list[Reason]:
        pieces = run.judge.pieces
        assert pieces is not None
        wanted = pieces.under(run.planned, self.covers)
        skipped = [piece for piece in wanted if not pieces.carried(piece)]
        stood = len(wanted) - len(skipped)
        first = f"; the first one skipped is piece {skipped[0]} of the ground (from 0)" if skipped else ""
        text = f"{stood} of {len(wanted)} pieces of ground under planned steps were stood on{first}"
        return unmet((not skipped, "stood_on", stood, len(wanted), text))
