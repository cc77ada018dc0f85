"""True effects of pushes: changed steps and accelerated CoM.

Steps count from stance foot to landed foot, without dead reckoning.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import Side, other_side
from plantar.gait.plan.footsteps import Footstep
from plantar.sim.judging.step_count import Stand

CHANGED = 1 / 20
"""Distance in leg lengths by which a step has to be off its plan to count as changed: 30 mm for H1. A swing foot that
is not aimed again lands up to 25 mm off while a push that the ankles hold shakes the body."""

AGREEMENT = 0.1
"""Largest difference, as a share, of the CoM's measured acceleration from the predicted one."""

_AFTER = 3  # steps after the one that a push falls into that it may still change


class Pushed(NamedTuple):
    """A push: its `step`, `start` and `end` in s, true `impulse` (2,) in N s, whether too `small` to change steps."""

    step: int
    start: float
    end: float
    impulse: NDArray[np.float64]
    small: bool


class Stride(NamedTuple):
    """The way (x, y) in m between a foot's stands, `true` and as `planned` at the start."""

    true: tuple[float, float]
    planned: tuple[float, float]


@dataclass(frozen=True)
class _Sample:
    time: float
    com: NDArray[np.float64]
    zmp: NDArray[np.float64]
    force: NDArray[np.float64]
    leverage: NDArray[np.float64]


def step_changes(stands: Sequence[Stand], feet: Mapping[Side, Footstep], steps: Sequence[Footstep]) -> list[float]:
    """Returns each taken step's distance in m from its plan while feet take turns.

    By the `stands`, and the `feet` and planned `steps` at the start.
    """
    return [math.dist(*way) for way in _ways(stands, feet, steps, other_side)]


def strides(stands: Sequence[Stand], feet: Mapping[Side, Footstep], steps: Sequence[Footstep]) -> list[Stride]:
    """Returns the way of each foot with its step; arguments `stands`, `feet` and `steps` as of `step_changes`."""
    return list(_ways(stands, feet, steps, lambda side: side))


def _ways(
    stands: Sequence[Stand],
    feet: Mapping[Side, Footstep],
    steps: Sequence[Footstep],
    start: Callable[[Side], Side],
) -> Iterator[Stride]:
    planned = dict(feet)
    true = {side: (foot.x, foot.y) for side, foot in feet.items()}
    for stand, step in zip(stands, steps, strict=False):
        if stand.side != step.side:
            return
        x, y = true[start(step.side)]
        before = planned[start(step.side)]
        yield Stride((stand.place[0] - x, stand.place[1] - y), (step.x - before.x, step.y - before.y))
        planned[step.side] = step
        true[step.side] = stand.place[:2]


class PushTruth:
    """Follows pushes on a robot of a `mass` in kg and `leg` in m; `stride` in s is of a foot, 0 for standing."""

    def __init__(self, mass: float, leg: float, stride: float = 0.0) -> None:
        self._mass = mass
        self._leg = leg
        self._stride = stride
        self._samples: list[_Sample] = []

    def update(
        self, time: float, com: NDArray[np.float64], zmp: NDArray[np.float64] | None, wrench: NDArray[np.float64]
    ) -> None:
        """Take true `com` (3,) and `zmp` (2,) in m or None, and pushes' `wrench` (6,) about the world's origin, at
        `time` in s.
        """
        if zmp is None:
            return
        # A horizontal force F that acts d above the CoM has the moment d (-F_y, F_x) about it.
        moment = wrench[3:] - np.cross(com, wrench[:3])
        leverage = np.array([moment[1], -moment[0]])
        self._samples.append(_Sample(time, com.copy(), np.array(zmp), wrench[:2].copy(), leverage))

    def accelerations(self, pushes: Sequence[Pushed]) -> list[dict[str, float]]:
        """What the `pushes` gave the CoM without the ground, against K's model.

        For an upright body, m h com'' = m g (com - zmp) + F (h + d) for a horizontal force F that acts d above a CoM at
        height h (K 9-11, corrected): m dv less the ground's share is the integral of F (1 + d / h), by the printed
        signs of F (1 - d / h). The angular momentum of legs and trunk one stride before is subtracted.

        Returns for each "measured_Ns", "predicted_Ns", "printed_Ns" along it, "above_com_m", and "ratio" of the first
        two.
        """
        return [self._acceleration(push) for push in pushes]

    def _acceleration(self, push: Pushed) -> dict[str, float]:
        chosen = self._around(push.start, push.end)
        unknown = dict.fromkeys(("measured_Ns", "predicted_Ns", "printed_Ns", "above_com_m", "ratio"), math.nan)
        length = float(np.hypot(*push.impulse))
        if len(chosen) < 4 or length == 0.0:
            return unknown
        way = push.impulse / length
        before = self._around(push.start - self._stride, push.end - self._stride) if self._stride else []
        walks = len(before) >= 4 and not any(s.force.any() for s in before)
        measured = self._unexplained(chosen, way) - (self._unexplained(before, way) if walks else 0.0)
        times = np.array([s.time for s in chosen])
        height = np.array([s.com[2] for s in chosen])
        force = np.array([s.force for s in chosen]) @ way
        leverage = np.array([s.leverage for s in chosen]) @ way
        predicted = float(np.trapezoid(force + leverage / height, times))
        printed = float(np.trapezoid(force - leverage / height, times))
        given = float(np.trapezoid(force, times))
        return {
            "measured_Ns": measured,
            "predicted_Ns": predicted,
            "printed_Ns": printed,
            "above_com_m": float(np.trapezoid(leverage, times)) / given if given else math.nan,
            "ratio": measured / predicted if predicted else math.nan,
        }

    def _around(self, start: float, end: float) -> list[_Sample]:
        return [s for s in self._samples if start - 0.02 <= s.time <= end + 0.02]

    def _unexplained(self, chosen: Sequence[_Sample], way: NDArray[np.float64]) -> float:
        """Momentum in N s along a way beyond what the ground gives a pendulum."""
        times = np.array([s.time for s in chosen])
        com = np.array([s.com for s in chosen])
        along = com[:, :2] @ way
        zmp = np.array([s.zmp for s in chosen]) @ way
        speed = np.gradient(along, times)
        ground = self._mass * GRAVITY * (along - zmp) / com[:, 2]
        return float(self._mass * (speed[-2] - speed[1]) - np.trapezoid(ground[1:-1], times[1:-1]))

    def steps_reasons(self, pushes: Sequence[Pushed], changes: Sequence[float]) -> list[dict[str, Any]]:
        """Returns failed criteria where only large `pushes` must change steps, by `changes` in m."""
        limit = CHANGED * self._leg
        found = []
        for i, push in enumerate(pushes):
            until = pushes[i + 1].step if i + 1 < len(pushes) else push.step + _AFTER + 1
            after = changes[push.step : min(until, push.step + _AFTER + 1)]
            most = max(after, default=0.0)
            impulse = float(np.hypot(*push.impulse))
            sizes = {"value": round(most, 4), "limit": round(limit, 4)}
            if push.small and most > limit:
                text = f"{impulse:.1f} N s changed a step by {most:.3f} m; allowed: {limit:.3f} m at a small push"
                found.append({"criterion": "steps_kept", **sizes, "text": text})
            elif not push.small and most <= limit:
                text = f"{impulse:.1f} N s changed no step by more than {most:.3f} m; a large push needs {limit:.3f} m"
                found.append({"criterion": "stepped", **sizes, "text": text})
        return found

    def stride_reasons(self, pushes: Sequence[Pushed], ways: Sequence[Stride]) -> list[dict[str, Any]]:
        """Returns failed criteria where each of the `pushes` must lengthen its step, by strides `ways`."""
        limit = CHANGED * self._leg
        reacted = 0
        for push in pushes:
            if push.step < len(ways):
                true, planned = (np.array(way) for way in ways[push.step])
                along = push.impulse / max(float(np.hypot(*push.impulse)), 1e-9)
                reacted += bool((true - planned) @ along > limit)
        if reacted == len(pushes):
            return []
        text = f"{reacted} of {len(pushes)} pushed steps became longer along their push by {limit:.3f} m or more"
        return [{"criterion": "strides", "value": reacted, "limit": len(pushes), "text": text}]

    def acceleration_reasons(self, pushes: Sequence[Pushed]) -> list[dict[str, Any]]:
        """Failed criteria where `pushes` must move the CoM as K's model."""
        found = []
        for row in self.accelerations(pushes):
            off = abs(row["ratio"] - 1.0)
            if not off <= AGREEMENT:
                text = (
                    f"a push {row['above_com_m']:+.3f} m above the CoM gave it {row['measured_Ns']:.1f} N s more "
                    f"than the ground, {row['predicted_Ns']:.1f} N s were predicted; allowed: {AGREEMENT:.0%} off"
                )
                found.append({"criterion": "com_acceleration", "value": off, "limit": AGREEMENT, "text": text})
        return found
