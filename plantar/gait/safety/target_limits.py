"""Limits how far targets move in a tick."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, FootTarget
from plantar.kernels.safety.plausible import farthest

# leg/beat: fastest targets of a foot and of the CoM
_FOOT = 1.1
_COM = 0.44
_TURN = 2.4  # rad/beat of a sole or the torso
_FORCE = 4.5  # weight/beat of the force on a foot


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

    def limited(self, before: Command, now: Command) -> Command:
        """A command with targets within the limits from the last tick's.

        Returns `now` itself within limits; else with targets on the way.
        """
        left = now.feet["left"]
        right = now.feet["right"]
        was_left = before.feet["left"]
        was_right = before.feet["right"]
        if (
            farthest(before.com, now.com, 3) <= self._com
            and farthest(was_left.position, left.position, 3) <= self._foot
            and farthest(was_right.position, right.position, 3) <= self._foot
            and farthest(was_left.rotation, left.rotation, 9) <= self._turn
            and farthest(was_right.rotation, right.rotation, 9) <= self._turn
            and farthest(before.rotation_torso, now.rotation_torso, 9) <= self._turn
            and farthest(was_left.force, left.force, 3) <= self._force
            and farthest(was_right.force, right.force, 3) <= self._force
        ):
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
    """A vector moved towards another by a limit per coordinate; never by NaN."""
    way = now - before
    largest = float(np.abs(way).max())
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
