"""Walking state machine: carrying foot, swing foot, times (T 4.16)."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cached_property

from plantar.common.settings.schema import Settings, number
from plantar.common.sides import Side, other_side
from plantar.errors import InputError

UP = (0.2, 0.5)
"""Of a single support, between which its foot is up by plan. Chosen: after it has been unloaded, before it descends."""


class PhaseKind(IntEnum):
    """What the feet do."""

    STANDING = 0
    DOUBLE_SUPPORT = 1
    SINGLE_SUPPORT = 2


class Timing(Settings):
    """Durations in s.

    Attributes:
        single_support: t_ss.
        double_support: t_ds.
        start: First double support, shifting weight to the first stance foot.
        end: Last double support, returning weight between the feet.
        settle: Standing after the last step.
        transfer: Share of a double support over which the VRP moves from foot to foot, about its middle; 0 lets it jump
            there, so that it is constant over a step (T 4.14).
    """

    single_support: float = number(0.9, "s", 0.2, 10)  # nature: T 4.4.5
    double_support: float = number(0.3, "s", 0.02, 10)  # nature: T 4.4.5
    start: float = number(1.2, "s", 0.2, 60)  # chosen: four pendulum times of 0.28 s
    end: float = number(1.0, "s", 0.2, 60)  # chosen: 3.5 pendulum times
    settle: float = number(2.0, "s", 0, 600)  # chosen: seven pendulum times
    transfer: float = number(1.0, "1", 0, 1)  # derived: all of it, the slowest motion of the VRP


@dataclass(frozen=True)
class Phase:
    """Phase of the walk.

    `kind`: standing, double or single support; `step`: index of the current or next footstep; their number at the end;
    `start` in s; `end` in s; inf for final standing; `swing`: foot in single support, else None; `wait`: time in s
    before a single support's end by which the foot is down.
    """

    kind: PhaseKind
    step: int
    start: float
    end: float
    swing: Side | None = None
    wait: float = 0.0

    @cached_property
    def stance(self) -> Side | None:
        """Carrying foot of single support, else None."""
        return None if self.swing is None else other_side(self.swing)

    @property
    def touchdown(self) -> float:
        """Planned touchdown in s of a single support."""
        return self.end - self.wait if self.wait else self.end


@dataclass(frozen=True)
class WalkSchedule:
    """A walk's phases without gaps, as a value. `phases` in order, ending with standing.

    Example:
        >>> schedule = WalkSchedule.of(("left", "right"), Timing())
        >>> schedule.at(1.3).kind.name, schedule.at(1.3).swing, round(schedule.walking_end, 2)
        ('SINGLE_SUPPORT', 'left', 4.3)
    """

    phases: tuple[Phase, ...]
    timing: Timing

    @classmethod
    def of(cls, sides: Sequence[Side], timing: Timing, begin: float = 0.0) -> WalkSchedule:
        """Schedule of a walk from standing. `begin`: first double support's start in s, after standing."""
        phases = [Phase(PhaseKind.STANDING, 0, -math.inf, begin)]
        return cls((*phases, *_walked(sides, 0, begin, timing, timing.start)), timing)

    @property
    def walking_end(self) -> float:
        """End in s of the last double support."""
        return self.phases[-1].start

    @cached_property
    def end(self) -> float:
        """Time in s at which the robot is settled."""
        return self.walking_end + self.timing.settle

    @property
    def steps(self) -> int:
        """Number of steps of the whole walk."""
        return self.phases[-1].step

    @cached_property
    def _starts(self) -> list[float]:
        return [phase.start for phase in self.phases]

    def at(self, time: float) -> Phase:
        """The phase at a time in s."""
        return self.phases[self.index(time)]

    def index(self, time: float) -> int:
        """Index in `phases` at a time in s; the first kept one before."""
        return max(0, bisect_right(self._starts, time) - 1)

    def following(self, phase: Phase) -> Phase:
        """The phase after one of `phases`; the last for itself."""
        i = self.index(phase.start)
        if self.phases[i] is not phase:  # an equal one is looked for among all: 1 us each
            i = self.phases.index(phase)
        return self.phases[min(i + 1, len(self.phases) - 1)]

    def before(self, phase: Phase) -> Phase:
        """The phase before one of `phases`; the first for itself."""
        return self.phases[max(self.phases.index(phase) - 1, 0)]

    def delayed(self, phase: Phase, by: float, wait: float | None = None) -> WalkSchedule:
        """The schedule with a phase's end, and all after, moved.

        `by`: delay in s; negative: sooner; `wait`: time in s before its end by which the foot is down; None for
        unchanged.
        """
        i = self.phases.index(phase)
        longer = replace(phase, end=phase.end + by, wait=phase.wait if wait is None else wait)
        if longer.end <= longer.start:
            raise InputError(f"a phase of {phase.end - phase.start:g} s cannot end {-by:g} s sooner")
        later = [replace(p, start=p.start + by, end=p.end + by) for p in self.phases[i + 1 :]]
        return replace(self, phases=(*self.phases[:i], longer, *later))

    def followed_by(self, step: int, sides: Sequence[Side], time: float) -> WalkSchedule:
        """The schedule with other steps after one; none ends the walk.

        A begun double support keeps its length, unless it ended the walk or begins the end; a standing robot shifts
        weight first.

        `step`: last kept step's index; -1 for none; `time`: now in s.
        """
        i = next(j for j, p in enumerate(self.phases) if p.step == step + 1 and p.swing is None)
        phase = self.phases[i]
        timing = self.timing
        first = step + 1
        if not sides:
            start = phase.start if phase.kind == PhaseKind.DOUBLE_SUPPORT else math.inf
            if first == self.steps:
                return self
            if first == 0:  # nothing was walked yet: the robot goes on standing
                return replace(self, phases=(Phase(PhaseKind.STANDING, 0, self.phases[0].start, math.inf),))
            return replace(self, phases=(*self.phases[:i], *_ending(first, start, timing)))
        if phase.kind == PhaseKind.STANDING:
            start = max(time, phase.start if math.isinf(phase.end) else phase.end)
            walk = _walked(sides, first, start, timing, timing.start)
            return replace(self, phases=(*self.phases[:i], replace(phase, end=start), *walk))
        length = phase.end - phase.start
        if first == self.steps:  # it ended the walk
            begun = time - phase.start
            length = timing.double_support if begun <= 0.0 else max(timing.double_support, begun + timing.start)
        return replace(self, phases=(*self.phases[:i], *_walked(sides, first, phase.start, timing, length)))

    def since(self, time: float) -> WalkSchedule:
        """The schedule without phases ended before a time in s."""
        return replace(self, phases=self.phases[self.index(time) :])


def _walked(sides: Sequence[Side], step: int, time: float, timing: Timing, first: float) -> list[Phase]:
    """Phases of steps, with the double support before and standing after."""
    phases = []
    for k, side in enumerate(sides, step):
        length = first if k == step else timing.double_support
        phases.append(Phase(PhaseKind.DOUBLE_SUPPORT, k, time, time + length))
        time += length
        phases.append(Phase(PhaseKind.SINGLE_SUPPORT, k, time, time + timing.single_support, side))
        time += timing.single_support
    return phases + _ending(step + len(sides), time, timing)


def _ending(steps: int, time: float, timing: Timing) -> list[Phase]:
    """Last phases: weight returns between the feet, then standing."""
    phases = []
    if steps:
        phases.append(Phase(PhaseKind.DOUBLE_SUPPORT, steps, time, time + timing.end))
        time += timing.end
    phases.append(Phase(PhaseKind.STANDING, steps, time, math.inf))
    return phases
