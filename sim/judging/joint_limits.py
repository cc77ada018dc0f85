"""Do the joints stay within what they can: speeds and torques, by the simulator's state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.model.world import PHYSICS_PERIOD, World

__all__ = ["JointLimits"]

_AT_LIMIT = 0.999  # of a torque limit: a servo there asks for more than it gets


class JointLimits:
    """Follows the leg joints' speeds and torques.

    Args:
        world: The world.

    Attributes:
        longest: For how long in s without a break each joint (k,) was faster than its limit, at most.
        fastest: Largest speed of each joint (k,) as a share of its limit; 0 without limits.
    """

    def __init__(self, world: World) -> None:
        robot, model = world.robot, world.model
        self.names: Sequence[str] = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self.limited = bool(robot.velocity_limits)
        k = len(self.names)
        self.longest, self.fastest = np.zeros(k), np.zeros(k)
        self._over = np.zeros(k)
        speeds = np.array([*robot.velocity_limits] * 2) if self.limited else np.full(k, np.inf)
        self._per_limit = 1.0 / speeds
        self._velocity, self._dofs = world.data.qvel, world.joint_qvel
        first = int(self._dofs[0])
        in_order = np.array_equal(self._dofs, np.arange(first, first + k))
        self._view = self._velocity[first : first + k] if in_order else None  # without a copy at each step
        self._shares = np.empty(k)
        self._force, self._servos = world.data.actuator_force, world.servos
        limited = model.actuator_forcelimited[world.servos] > 0
        limits = np.where(limited, model.actuator_forcerange[world.servos, 1], np.inf)
        self._torques = _AT_LIMIT * limits
        self._at_limit = np.zeros(k)
        self._any_at_limit = self._ticks = 0
        self._fast = False

    def _speed_shares(self) -> NDArray[np.float64]:
        """Speed of each joint (k,) now as a share of its limit, with its sign; overwritten by the next call."""
        velocity = self._velocity.take(self._dofs) if self._view is None else self._view
        np.multiply(velocity, self._per_limit, out=self._shares)
        return self._shares

    def step(self) -> None:
        """After each physics step: speeds."""
        if not self.limited:
            return
        shares = self._speed_shares()
        if shares.dot(shares) > 1.0 and max(map(abs, shares.tolist())) > 1.0:  # no square is above the sum of them
            np.abs(shares, out=shares)
            self._over = np.where(shares > 1.0, self._over + PHYSICS_PERIOD, 0.0)
            np.maximum(self.longest, self._over, out=self.longest)
            np.maximum(self.fastest, shares, out=self.fastest)
            self._fast = True
        elif self._fast:
            self._over[:] = 0.0
            self._fast = False

    def tick(self) -> None:
        """At each control tick: torques."""
        self._ticks += 1
        if self.limited and not self._fast:
            np.maximum(self.fastest, np.abs(self._speed_shares()), out=self.fastest)
        held = np.abs(self._force[self._servos]) >= self._torques
        if held.any():
            self._any_at_limit += 1
            self._at_limit += held

    def summary(self) -> dict[str, Any]:
        """Fastest joint, and how often joints were at their torque limits, for a run's summary."""
        k = int(np.argmax(self.fastest))
        ticks = max(1, self._ticks)
        return {
            "joint_speed": {
                "joint": self.names[k],
                "share_of_limit": round(float(self.fastest[k]), 3),
                "longest_over_s": round(float(self.longest.max()), 4),
            }
            if self.limited
            else None,
            "torque_limit": {
                "share_of_ticks": round(self._any_at_limit / ticks, 4),
                "joints": {
                    name: round(float(count) / ticks, 4)
                    for name, count in zip(self.names, self._at_limit, strict=True)
                    if count
                },
            },
        }
