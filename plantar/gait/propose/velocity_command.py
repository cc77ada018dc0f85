"""Walk at a commanded velocity until a stop.

Each touchdown plans two steps by the command, and one that closes the feet. Of steps of duration T, with a velocity
(v_x, v_y, w_z),

    forward      each step leads the other foot by v_x T;
    sideways     the foot on that side opens by 2 v_y T, and the other one closes up to it;
    turning      each step turns its foot by w_z T against the other one, about the middle between the feet, and is so
                 much wider that heels, or toes where the feet turn in, keep their distance; what is beyond
                 `Stride.turn_in` the other foot turns.

The heading is the feet's mean, half a step behind a command.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from plantar.common.settings.schema import Settings, number
from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import InputError
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, Tick, was_applied

_AHEAD = 2  # chosen: steps that follow the command, before the one that closes


@dataclass(frozen=True)
class Velocity:
    """Commanded velocity, frame of the feet. `forward`: m/s; `left`: m/s; `turn`: rad/s, to the left."""

    forward: float = 0.0
    left: float = 0.0
    turn: float = 0.0

    def __post_init__(self) -> None:
        for name in ("forward", "left", "turn"):
            if not math.isfinite(getattr(self, name)):
                raise InputError(f"velocity '{name}' is {getattr(self, name)}; allowed: a finite number")


STOP: Velocity | None = None
"""The command to stand still; a velocity of zero takes steps in place."""


@dataclass(frozen=True)
class VelocityTable:
    """Commands over time, each until the next.

    `times`: their starts in s, increasing; `commands`: command from then on; None stops.

    Example:
        >>> table = VelocityTable((1.0, 5.0), (Velocity(forward=0.1), STOP))
        >>> [table.at(t) is STOP for t in (0.5, 1.0, 4.9, 5.0)]
        [True, False, False, True]
    """

    times: tuple[float, ...]
    commands: tuple[Velocity | None, ...]

    def __post_init__(self) -> None:
        if len(self.times) != len(self.commands):
            raise InputError(f"{len(self.times)} times for {len(self.commands)} commands; allowed: one for each")
        if not all(math.isfinite(t) for t in self.times) or sorted(set(self.times)) != list(self.times):
            raise InputError("the times of velocity commands have to be finite and to increase")

    def at(self, time: float) -> Velocity | None:
        """Command at a time in s; standing before the first."""
        k = bisect_right(self.times, time) - 1
        return self.commands[k] if k >= 0 else STOP


class Stride(Settings):
    """Largest step; larger commands are walked slower.

    Attributes:
        turn: Angle in rad of a foot outwards from the other, shared by both hips.
    """

    # Largest lead over the other foot, share of the CoM height; chosen: 0.2 m on h1, T 4.4.5's step
    lead: ClassVar[float] = 0.25
    opening: ClassVar[float] = 0.22  # Largest step sideways, share of the CoM height; chosen: 0.18 m on h1
    turn: float = number(0.5, "rad", 0.01, 1.2)  # chosen: 0.5 rad, half of a hip's turn
    turn_in: ClassVar[float] = 0.2  # Largest angle in rad of a foot inwards; chosen: bounded by the heels of both feet


@dataclass(frozen=True)
class Legs:
    """Step limits in m. `width`: between sole origins side by side; `heel`: sole behind its origin."""

    width: float
    com_height: float
    heel: float = 0.1  # chosen: of a common sole; callers give their robot's
    toe: float = 0.14  # chosen: of a common sole; callers give their robot's
    inner: float = 0.07  # chosen: of a common sole; callers give their robot's

    def room(self, out: float) -> float:
        """Extra width in m for a foot turned out or in by an angle in rad, so that heel or toe keep clear.

        Example:
            >>> legs = Legs(0.17, 0.8, heel=0.09, toe=0.13, inner=0.06)
            >>> legs.room(0.0), round(legs.room(0.3), 4), round(legs.room(-0.3), 4)
            (0.0, 0.029, 0.0414)
        """
        reach = self.heel if out > 0.0 else self.toe
        gap = 0.5 * self.width - self.inner
        return (gap + reach * math.sin(abs(out))) / math.cos(out) - gap


def next_step(
    stance: Footstep, other: Footstep, velocity: Velocity, legs: Legs, stride: Stride, duration: float
) -> Footstep:
    """Returns a foot's next step. `duration` from step to step in s.

    Example:
        >>> left, right = Footstep("left", 0.0, 0.085), Footstep("right", 0.0, -0.085)
        >>> step = next_step(right, left, Velocity(forward=0.1), Legs(0.17, 0.8), Stride(), 1.0)
        >>> step.side, round(step.x, 3), round(step.y, 3)
        ('left', 0.1, 0.085)
        >>> next_step(right, left, Velocity(left=-0.1), Legs(0.17, 0.8), Stride(), 1.0).y  # the other one opens
        0.085
    """
    outward = 1.0 if other.side == "left" else -1.0
    half = 0.5 * legs.width

    def within(value: float, most: float) -> float:
        return min(most, max(-most, value))

    def opening(value: float, most: float) -> float:
        return within(value, most) if value * outward > 0.0 else 0.0

    ahead = within(velocity.forward * duration, stride.lead * legs.com_height)
    across = opening(2.0 * velocity.left * duration, stride.opening * legs.com_height)
    turned_in = within(velocity.turn * duration, stride.turn_in)
    turn = turned_in
    if velocity.turn * outward > 0.0:
        turn = within(2.0 * velocity.turn * duration - turned_in, stride.turn)
    # The middle between the feet, as the stance foot has it, moves along the mean heading; the foot stands off it.
    before = math.remainder(other.yaw - stance.yaw, 2.0 * math.pi)
    x, y = _moved(stance.x, stance.y, stance.yaw, 0.0, outward * (half + legs.room(outward * before)))
    x, y = _moved(x, y, stance.yaw + 0.5 * turn, ahead, across)
    x, y = _moved(x, y, stance.yaw + turn, 0.0, outward * (half + legs.room(outward * turn)))
    return Footstep(other.side, x, y, stance.yaw + turn, stance.z)


def _moved(x: float, y: float, yaw: float, ahead: float, across: float) -> tuple[float, float]:
    c = math.cos(yaw)
    s = math.sin(yaw)
    return x + c * ahead - s * across, y + s * ahead + c * across


class VelocityCommand:
    """Proposes steps at a commanded velocity.

    `table`: commands over time; None leaves the plan alone until the first `set_velocity`.
    """

    priority = Priority.COMMAND

    def __init__(self, table: VelocityTable | None, legs: Legs, stride: Stride | None = None) -> None:
        self.table = table
        self.legs = legs
        self.stride = Stride() if stride is None else stride
        self._planned = -1
        self._proposed: PlanChange | None = None

    def set_velocity(self, velocity: Velocity | None) -> None:
        """Walk at a `velocity` from now on, instead of the table; None stops. From any thread."""
        self.table = VelocityTable((0.0,), (velocity,))  # one assignment: a tick reads the one or the other

    def propose(self, tick: Tick) -> PlanChange | None:
        """The next steps, at touchdown or from standing."""
        if self._proposed is not None and was_applied(self._proposed, tick):
            self._planned = self._proposed.step + 1
            self._proposed = None
        phase = tick.phase
        plan = tick.plan
        table = self.table
        if table is None or phase.kind == PhaseKind.SINGLE_SUPPORT:
            return None
        velocity = table.at(tick.time)
        timing = plan.schedule.timing
        if velocity is STOP and phase.step >= plan.count:
            return None  # at rest, or on the way to it
        # A stop counts until the foot lifts off: received a moment after the touchdown, it would take a step more.
        if phase.step == self._planned and not (velocity is STOP and plan.count > phase.step + 1):
            return None
        duration = timing.single_support + timing.double_support
        feet = {side: self._standing(side, tick) for side in SIDES}
        first = self._first(tick, velocity)
        steps = self._steps(feet[other_side(first)], feet[first], velocity, duration)
        self._proposed = PlanChange("velocity command", phase.step - 1, following=steps)
        return self._proposed

    def _first(self, tick: Tick, velocity: Velocity | None) -> Side:
        """Next foot: as planned, or from standing the commanded side's."""
        if tick.phase.step < tick.plan.count:
            return tick.plan.foothold(tick.phase.step).side
        if tick.phase.kind != PhaseKind.STANDING:
            return other_side(tick.plan.foothold(tick.phase.step - 1).side)
        sideways = 0.0 if velocity is None else velocity.left or velocity.turn
        return "right" if sideways < 0.0 else "left"

    @staticmethod
    def _standing(side: Side, tick: Tick) -> Footstep:
        """A foot's planned pose; the commanded one before its first step."""
        plan = tick.plan
        for k in range(tick.phase.step - 1, max(plan.first, tick.phase.step - 3) - 1, -1):
            if plan.foothold(k).side == side:
                return plan.foothold(k)
        return tick.place(side)

    def _steps(
        self, stance: Footstep, other: Footstep, velocity: Velocity | None, duration: float
    ) -> tuple[Footstep, ...]:
        """Steps at a velocity, the other foot first, and the closing one."""
        steps: list[Footstep] = []
        for command in [*([velocity] * _AHEAD if velocity is not None else []), Velocity()]:
            stance, other = next_step(stance, other, command, self.legs, self.stride, duration), stance
            steps.append(stance)
        return tuple(steps)


def table_of(rows: Sequence[Sequence[float | str]], begin: float) -> VelocityTable:
    """Returns commands from a scene's rows.

    `rows`: each [time, forward, left, turn] in s, m/s, m/s and rad/s, or [time, "stop"]; `begin`: time in s from which
    rows count.

    Example:
        >>> table_of([[0.0, 0.1, 0.0, 0.0], [10.0, "stop"]], 1.0).times
        (1.0, 11.0)
    """
    times: list[float] = []
    commands: list[Velocity | None] = []
    for row in rows:
        values = list(row) if isinstance(row, Sequence) and not isinstance(row, str) else [row]
        numbers = [v for v in values if isinstance(v, (int, float)) and not isinstance(v, bool)]
        if len(numbers) == 4 == len(values):
            commands.append(Velocity(*map(float, numbers[1:])))
        elif len(numbers) == 1 and values[1:] == ["stop"]:
            commands.append(STOP)
        else:
            raise InputError(f'a velocity command is {row!r}; allowed: [time, forward, left, turn] or [time, "stop"]')
        times.append(begin + float(numbers[0]))
    return VelocityTable(tuple(times), tuple(commands))
