"""Counts the steps of a walk by side, order and true place."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby

from plantar.common.sides import SIDES
from plantar.kernels.judging.stance_force import StandWatch
from plantar.layouts.layout import Side
from plantar.sim.judging.walk_goal import NEAR_YAW, WalkGoal, Way

# Share of the weight that makes a touch a stand: probes, taps and bounces carry less, or are followed by one
_CARRIES = 0.25

# Share of the way by which steps may add up to another place than planned: feet slip and legs give way. 300 steps of
# H1 on the flat come to 0.002 of their 60 m.
_LOST = 0.02

# Heading in rad for each leg length of the way by which they may turn off their course: 0.5 degrees a metre for H1,
# which turns by 0.007
_TURNED = math.radians(0.3)


@dataclass(frozen=True)
class Stand:
    """A stand of the `side`'s foot from `touchdown` in s; its `place`, (x, y) in m and heading in rad, when last
    carrying a quarter of the weight.
    """

    side: Side
    touchdown: float
    place: tuple[float, float, float]


@dataclass(frozen=True)
class Count:
    """The steps of a walk that were taken.

    `missed`: why the first missing step failed, or empty; `drift`: summed differences in m (forward, left, in the
    plan's frame) from planned ways; `turned`: the same in rad.
    """

    stands: tuple[Stand, ...]
    missed: str
    drift: tuple[float, float]
    turned: float

    @property
    def taken(self) -> int:
        return len(self.stands)


class StepCount:
    """Follows both feet through a walk.

    A step is taken where its foot, last before the other touches down, stands at its place relative to the foothold
    before: taps and dead reckoning do not count, but the way limits summed differences.

    `weight` in N; `time_of`: time in s of a physics step; `justified`: whether ground or push justify a moved step, by
    stand, planned way, and true foothold before.
    """

    def __init__(
        self,
        goal: WalkGoal,
        weight: float,
        time_of: Callable[[int], float],
        justified: Callable[[Stand, Way, tuple[float, float, float]], bool],
    ) -> None:
        self.goal = goal
        self.watch = StandWatch(_CARRIES * weight)
        self._time_of = time_of
        self._justified = justified

    @property
    def slip(self) -> float:
        """Largest slip in m of a foot with a quarter of the weight."""
        return float(self.watch.slip)

    def last_stands(self) -> list[Stand]:
        """Each foot's last stands before the other touches down."""
        rows = [list(group)[-1] for _, group in groupby(self.watch.stands(), key=lambda row: row[1])]
        return [Stand(SIDES[foot], self._time_of(step), (x, y, yaw)) for step, foot, x, y, yaw in rows]

    def count(self) -> Count:
        """The steps taken in order."""
        steps = self.goal.steps
        start = self.goal.start() if self.goal.steps else None
        stands = self.last_stands()
        missed = ""
        taken: list[Stand] = []
        before = (0.0, 0.0, 0.0) if start is None else (start.x, start.y, start.yaw)
        course = before[2]  # heading that the plan had, were each step as planned from the one before
        drift = (0.0, 0.0)
        turned = 0.0
        for stand in stands:
            k = len(taken)
            if k == len(steps):
                break
            landed = taken[-1].touchdown if taken else -math.inf
            found = self._step(stand, k, before, landed, (drift, turned, course))
            if isinstance(found, str):
                missed = missed or found
                continue
            taken.append(stand)
            drift, turned, way = found
            before = stand.place
            course = course + way[2]
            missed = ""
        if len(taken) == len(steps):  # in the end both feet still have to stand there
            for side, k in {step.side: k for k, step in enumerate(steps)}.items():
                last = next(s for s in reversed(stands) if s.side == side)
                off, turn = _apart(taken[k].place, last.place) if k < len(taken) else (0.0, 0.0)
                if off > self.goal.near or turn > NEAR_YAW:
                    taken = taken[:k]
                    missed = _words(side, off, turn)
        if len(taken) < len(steps) and not missed:
            missed = f"the {steps[len(taken)].side} foot did not land for it"
        return Count(tuple(taken), missed, drift, turned)

    def _step(
        self,
        stand: Stand,
        k: int,
        before: tuple[float, float, float],
        landed: float,
        so_far: tuple[tuple[float, float], float, float],
    ) -> str | tuple[tuple[float, float], float, Way]:
        goal = self.goal
        side = self.goal.steps[k].side
        drift, turned, course = so_far
        if stand.side != side:
            return f"the {stand.side} foot landed in its stead"
        planned, moved = goal.ways(k, stand.touchdown, landed)
        ways = [planned]
        excuse = ""
        if moved is not None and self._justified(stand, planned, before):
            ways.append(moved)
        elif moved is not None:
            excuse = f"; its move, '{goal.reason(k, stand.touchdown)}', neither ground nor a push justifies"
        true = _from(before, stand.place)
        offs = [(math.hypot(true[0] - w[0], true[1] - w[1]), abs(_turn(true[2] - w[2])), w) for w in ways]
        fits = [(off, turn, way) for off, turn, way in offs if off <= goal.near and turn <= NEAR_YAW]
        if not fits:
            off, turn, _ = min(offs)
            return _words(side, off, turn) + excuse
        _, _, way = min(fits)
        c = math.cos(course)
        s = math.sin(course)
        ex = true[0] - way[0]
        ey = true[1] - way[1]
        drift = (drift[0] + c * ex - s * ey, drift[1] + s * ex + c * ey)
        turned += _turn(true[2] - way[2])
        lost = math.hypot(*drift)
        most = goal.near + _LOST * goal.way_to(k)
        if lost > most:
            return f"steps had added up to {lost:.3f} m from their ways; allowed: {most:.3f} m by then{excuse}"
        if abs(turned) > NEAR_YAW + _TURNED * goal.way_to(k) / goal.leg:
            return f"steps had added up to {math.degrees(abs(turned)):.1f} deg from their headings"
        return drift, turned, way


def _turn(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def _from(before: tuple[float, float, float], place: tuple[float, float, float]) -> Way:
    c = math.cos(before[2])
    s = math.sin(before[2])
    dx = place[0] - before[0]
    dy = place[1] - before[1]
    return c * dx + s * dy, c * dy - s * dx, _turn(place[2] - before[2])


def _apart(one: tuple[float, float, float], other: tuple[float, float, float]) -> tuple[float, float]:
    return math.hypot(one[0] - other[0], one[1] - other[1]), abs(_turn(one[2] - other[2]))


def _words(side: Side, off: float, turn: float) -> str:
    return f"the {side} foot stood {1e3 * off:.0f} mm and {math.degrees(turn):.1f} deg from its place"
