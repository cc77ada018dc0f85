"""Walking state machine: which foot carries, which one swings, and when (T 4.16). Pure: no clock, no sensors inside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from gait.footsteps import Footstep, other_side
from plantar.errors import InputError
from plantar.layout import Side

__all__ = ["Phase", "PhaseKind", "Timing", "WalkSchedule"]


class PhaseKind(IntEnum):
    """What the feet do."""

    STANDING = 0
    DOUBLE_SUPPORT = 1
    SINGLE_SUPPORT = 2


@dataclass(frozen=True)
class Timing:
    """Durations of a walk in s.

    Attributes:
        single_support: t_ss.
        double_support: t_ds.
        start: First double support, in which the weight shifts from both feet to the first stance foot.
        end: Last double support, in which the weight returns between the feet.
        settle: Standing time after the last step.
    """

    single_support: float = 0.9
    double_support: float = 0.3
    start: float = 1.2
    end: float = 1.0
    settle: float = 2.0

    def __post_init__(self) -> None:
        for name, low, high in (
            ("single_support", 0.2, 10.0),
            ("double_support", 0.02, 10.0),
            ("start", 0.2, 60.0),
            ("end", 0.2, 60.0),
            ("settle", 0.0, 600.0),
        ):
            value = getattr(self, name)
            if not low <= value <= high:
                raise InputError(f"timing '{name}' is {value} s; allowed: {low:g} to {high:g}")


@dataclass(frozen=True)
class Phase:
    """A phase of the walk.

    Attributes:
        kind: Standing, double support or single support.
        step: Index of the footstep that is being taken or comes next; the number of steps at the end.
        start: Time in s at which the phase begins.
        end: Time in s at which it ends (inf for the final standing).
        swing: The swing foot in single support, else None.
    """

    kind: PhaseKind
    step: int
    start: float
    end: float
    swing: Side | None = None

    @property
    def stance(self) -> Side | None:
        """The only carrying foot in single support, else None."""
        return None if self.swing is None else other_side(self.swing)


class WalkSchedule:
    """Phases of a walk over time.

    Args:
        steps: The footsteps in order.
        timing: The durations.
        begin: Time in s at which the first double support begins; before it the robot stands.

    Example:
        >>> from gait.footsteps import straight_plan
        >>> schedule = WalkSchedule(straight_plan(2)[1], Timing())
        >>> schedule.at(1.3).kind.name, schedule.at(1.3).swing, round(schedule.walking_end, 2)
        ('SINGLE_SUPPORT', 'left', 4.3)
    """

    def __init__(self, steps: Sequence[Footstep], timing: Timing, begin: float = 0.0) -> None:
        self.steps = tuple(steps)
        self.timing = timing
        phases = [Phase(PhaseKind.STANDING, 0, -float("inf"), begin)]
        time = begin
        for k, step in enumerate(self.steps):
            length = timing.start if k == 0 else timing.double_support
            phases.append(Phase(PhaseKind.DOUBLE_SUPPORT, k, time, time + length))
            time += length
            phases.append(Phase(PhaseKind.SINGLE_SUPPORT, k, time, time + timing.single_support, step.side))
            time += timing.single_support
        if self.steps:
            phases.append(Phase(PhaseKind.DOUBLE_SUPPORT, len(self.steps), time, time + timing.end))
            time += timing.end
        phases.append(Phase(PhaseKind.STANDING, len(self.steps), time, float("inf")))
        self.phases = tuple(phases)
        self.walking_end = time
        self._cursor = 0

    @property
    def end(self) -> float:
        """Time in s at which the robot has walked and settled."""
        return self.walking_end + self.timing.settle

    def shift_steps(self, first: int, shift: NDArray[np.float64]) -> None:
        """Move the footsteps from one on.

        Args:
            first: Index of the first step that moves.
            shift: By how much (2,) in m.
        """
        dx, dy = shift.tolist()
        moved = [replace(step, x=step.x + dx, y=step.y + dy) for step in self.steps[first:]]
        self.steps = (*self.steps[:first], *moved)

    def move_step(self, index: int, step: Footstep) -> None:
        """Put one footstep elsewhere.

        Args:
            index: Its index.
            step: The new footstep.
        """
        self.steps = (*self.steps[:index], step, *self.steps[index + 1 :])

    def stop_after(self, index: int) -> None:
        """Leave out all steps after one; the walk ends with it.

        Args:
            index: Index of the last step.
        """
        i = next(j for j, p in enumerate(self.phases) if p.step == index and p.kind == PhaseKind.SINGLE_SUPPORT)
        end = self.phases[i].end
        self.steps = self.steps[: index + 1]
        self.walking_end = end + self.timing.end
        self.phases = (
            *self.phases[: i + 1],
            Phase(PhaseKind.DOUBLE_SUPPORT, index + 1, end, self.walking_end),
            Phase(PhaseKind.STANDING, index + 1, self.walking_end, float("inf")),
        )

    def delay(self, phase: Phase, by: float) -> None:
        """Make a phase longer; all later ones come later.

        Args:
            phase: One of `phases`.
            by: How much longer in s.
        """
        i = self.phases.index(phase)
        later = [replace(p, start=p.start + by, end=p.end + by) for p in self.phases[i + 1 :]]
        self.phases = (*self.phases[:i], replace(phase, end=phase.end + by), *later)
        self.walking_end += by

    def at(self, time: float) -> Phase:
        """The phase at a time in s."""
        return self.phases[self.index(time)]

    def index(self, time: float) -> int:
        """Index in `phases` of the phase at a time in s."""
        i = self._cursor
        while time >= self.phases[i].end and i + 1 < len(self.phases):
            i += 1
        while time < self.phases[i].start:
            i -= 1
        self._cursor = i
        return i
