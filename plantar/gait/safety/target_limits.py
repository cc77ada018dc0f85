"""Limits how far targets move in a tick."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, FootTarget
from plantar.kernels.safety.plausible import TargetMoves

# leg/beat: fastest targets of a foot and of the CoM, between what walks need (0.62 and 0.27: drawn plants of level 3
# over uneven ground and stones, turning and pushed) and 2.5 times what the slowest robot's undisturbed walk does (0.79
# and 0.32)
_FOOT = 0.75  # measured: 1.8 m/s on h1
_COM = 0.32  # measured: 0.8 m/s on h1
_TURN = 2.4  # chosen: rad/beat of a sole or the torso; 9.7 rad/s
_FORCE = 4.5  # chosen: weight/beat of the force on a foot; a weight in 55 ms
_TILTED = 0.5  # derived: cosine of the trunk's tilt below which a robot has fallen: 60 degrees


class TargetLimits:
    """Limits targets' moves per tick.

    `period` of control in s; `leg`: leg length in m; `beat`: body's time unit in s, root of leg over gravity; `weight`
    in N.
    """

    def __init__(self, period: float, leg: float, beat: float, weight: float) -> None:
        share = period / beat
        self._foot = _FOOT * leg * share
        self._com = _COM * leg * share
        self._turn = _TURN * share
        self._force = _FORCE * weight * share
        self._moves = TargetMoves(self._com, self._foot, self._turn, self._force, _TILTED)
        self._taken: Command | None = None  # whose targets those are that the next ones are compared with

    @property
    def height(self) -> float:
        """Of the last command's estimated CoM in m over the lower sole; -inf where its trunk has fallen."""
        return float(self._moves.height)

    def limited(self, before: Command, now: Command) -> Command:
        """A command with targets within the limits from the last tick's.

        Returns `now` itself within limits; else with targets on the way.
        """
        if before is not self._taken:
            self._moves.within(before)
        self._taken = None
        near = self._moves.within(now)
        self._taken = now
        if near:
            return now
        feet: Mapping[Side, FootTarget] = {side: self._foot_of(before.feet[side], now.feet[side]) for side in SIDES}
        return now.changed(
            com=_moved(before.com, now.com, self._com),
            rotation_torso=_turned(before.rotation_torso, now.rotation_torso, self._turn),
            feet=feet,
        )

    def _foot_of(self, before: FootTarget, now: FootTarget) -> FootTarget:
        return FootTarget(
            _moved(before.position, now.position, self._foot),
            _turned(before.rotation, now.rotation, self._turn),
            _moved(before.force, now.force, self._force),
            now.center_of_pressure if np.isfinite(now.center_of_pressure).all() else before.center_of_pressure,
        )


def _moved(before: NDArray[np.float64], now: NDArray[np.float64], most: float) -> NDArray[np.float64]:
    """A vector moved towards another by a limit; never by NaN."""
    way = now - before
    largest = math.sqrt(float(way @ way))
    if not np.isfinite(largest):
        return before
    return now if largest <= most else before + (most / largest) * way


def _turned(before: NDArray[np.float64], now: NDArray[np.float64], most: float) -> NDArray[np.float64]:
    """Weighted sum of two rotations, made orthogonal."""
    largest = float(np.abs(now - before).max())
    if not np.isfinite(largest):
        return before
    if largest <= most:
        return now
    u, _, v = np.linalg.svd(before + (most / largest) * (now - before))
    turn = u @ v
    return turn if np.linalg.det(turn) > 0.0 else before
