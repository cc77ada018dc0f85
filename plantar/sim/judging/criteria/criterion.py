"""The base of all criteria, and what they read of a finished run."""

import math
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from plantar.common.settings.body_scale import BodyScale
from plantar.common.settings.schema import Settings
from plantar.sim.judging.unmet import unmet

if TYPE_CHECKING:
    from plantar.sim.judging.judge import Judge
    from plantar.sim.terrain import Ground, PlannedFeet

Reason = dict[str, Any]
"""A failed criterion: "criterion", "value", "limit", "text"."""


class JudgedRun(Protocol):
    """Parts of a finished run that criteria read.

    Attributes:
        planned: Footprints as planned at the start.
        pusher: Pushes by force, `plantar.sim.run.pushing.Pusher`.
        touched: Hands, partner and guide, `plantar.sim.run.touched.Touched`, or None.
        zmps: ZMPs of skin and ankles, `plantar.sim.judging.zmp_comparison.ZmpComparison`, or None.
    """

    body: BodyScale
    scene: Any
    judge: "Judge"
    ground: "Ground"
    planned: "PlannedFeet"
    pusher: Any
    touched: Any
    zmps: Any


def not_measured(criterion: str, text: str) -> list[Reason]:
    """Returns the reason of a run that could not show it, for a `text` such as "no hand pushed"."""
    return unmet((False, criterion, math.nan, 0.0, f"{text}: there is nothing to show it by"))


class Criterion(Settings):
    """One thing that a scene's experiment shows: a table `[outcome.NAME]`, NAME being the name of its file.

    Attributes:
        of_pieces: Whether it reads `Judge.pieces`, which are followed for it.
    """

    of_pieces: ClassVar[bool] = False

    def claim(self) -> str:
        """What a run shows that meets it, in a sentence."""
        raise NotImplementedError(f"{type(self).__name__} needs a method `claim()`")

    def reasons(self, run: JudgedRun) -> list[Reason]:
        """Returns why a finished `run` does not show it, as `plantar.sim.judging.unmet`; empty where it does."""
        raise NotImplementedError(f"{type(self).__name__} needs a method `reasons(run)`")
