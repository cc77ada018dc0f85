"""Do the joints stay within what they can: speeds and torques, by the simulator's state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.model.world import World

__all__ = ["JointLimits"]

_AT_LIMIT = 0.999  # of a torque limit: a servo there asks for more than it gets

_most = np.maximum.reduce  # sooner than the method of an array


class JointLimits:
    """Follows the leg joints' speeds and torques.

    Args:
        world: The world.

    Attributes:
        longest: For how long in s without a break each joint (k,) was faster than its limit, at most.
    """

    def __init__(self, world: World) -> None:
        robot, model = world.robot, world.model
        self.names: Sequence[str] = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self.limited = bool(robot.velocity_limits)
        k = len(self.names)
        self.longest = np.zeros(k)
        self._period = world.period
        self._over, self._high, self._low = np.zeros(k), np.zeros(k), np.zeros(k)
        limits = np.array([*robot.velocity_limits] * 2) if self.limited else np.full(k, np.inf)
        self._per_speed = 1.0 / limits
        self._least_limit = float(limits.min()) ** 2  # squared
        dofs = world.joint_qvel
        first, end = int(dofs.min()), int(dofs.max()) + 1
        self._span = world.data.qvel[first:end]  # a view, without a copy at each step; may hold other joints, too
        self._places = None if np.array_equal(dofs, np.arange(first, end)) else dofs - first
        self._fast = False
        self._force, self._servos = world.data.actuator_force, world.servos
        limited = model.actuator_forcelimited[world.servos] > 0
        torques = np.where(limited, model.actuator_forcerange[world.servos, 1], np.inf)
        self._per_torque = 1.0 / (_AT_LIMIT * torques)
        self._at_limit = np.zeros(k)
        self._held: list[tuple[int, NDArray[np.bool_]]] = []
        self._any_at_limit = self._ticks = 0

    @property
    def fastest(self) -> NDArray[np.float64]:
        """Largest speed of each joint (k,) as a share of its limit; 0 without limits."""
        return np.asarray(np.maximum(self._high, -self._low) * self._per_speed)

    def _velocity(self) -> NDArray[np.float64]:
        return self._span if self._places is None else np.asarray(self._span.take(self._places))

    def step(self) -> None:
        """After each physics step: speeds."""
        if float(self._span.dot(self._span)) <= self._least_limit:  # no square is above the sum of them
            if self._fast:
                self._over[:] = 0.0
                self._fast = False
            return
        velocity = self._velocity()
        shares = np.abs(velocity) * self._per_speed
        if float(_most(shares)) <= 1.0:
            if self._fast:
                self._over[:] = 0.0
                self._fast = False
            return
        self._over = np.where(shares > 1.0, self._over + self._period, 0.0)
        self._fast = True
        np.maximum(self.longest, self._over, out=self.longest)
        self._extend(velocity)

    def _extend(self, velocity: NDArray[np.float64]) -> None:
        np.maximum(self._high, velocity, out=self._high)
        np.minimum(self._low, velocity, out=self._low)

    def tick(self) -> None:
        """At each control tick: torques."""
        self._ticks += 1
        self._extend(self._velocity())
        shares = self._force.take(self._servos)
        shares *= self._per_torque
        if float(shares.dot(shares)) < 1.0:
            return
        held = np.abs(shares) >= 1.0
        if held.any():
            self._any_at_limit += 1
            self._at_limit += held
            self._held.append((self._ticks, held))

    def first_held(self, since: int, ticks: int = 3) -> str | None:
        """The joint that came to its torque limit first, and stayed there.

        Args:
            since: Number of the control tick, counted from 1, from which on it counts.
            ticks: For so many ticks in a row it has to be there.

        Returns:
            Its name; None where none was.
        """
        runs, last = np.zeros(len(self.names), dtype=int), since
        for tick, held in self._held:
            if tick >= since:
                runs = np.where(held, runs + 1 if tick == last + 1 else 1, 0)
                last = tick
                if int(runs.max()) >= ticks:
                    return self.names[int(runs.argmax())]
        return None

    def summary(self) -> dict[str, Any]:
        """Fastest joint, and how often joints were at their torque limits, for a run's summary."""
        fastest = self.fastest
        k = int(fastest.argmax())
        ticks = max(1, self._ticks)
        return {
            "joint_speed": {
                "joint": self.names[k],
                "share_of_limit": round(float(fastest[k]), 3),
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
