"""Do the joints stay within what they can: speeds and torques, by the simulator's state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.judging.joint_extremes import JointExtremes
from plantar.sim.model.world import World

__all__ = ["JointLimits"]

_AT_LIMIT = 0.999  # of a torque limit: a servo there asks for more than it gets

_most = np.maximum.reduce  # sooner than the method of an array


class JointLimits:
    """Follows the leg joints' speeds and torques.

    Args:
        world: The world.

    Attributes:
        longest: For how long in s without a break each joint (k,) was faster than its limit, at most.
        speeds: Speeds of the joints, and of others between them, where MuJoCo writes them.
        places: Where each joint's speed (k,) stands among them.
        per_speed: One over each joint's limit (k,) in s/rad; 0 without one.
    """

    def __init__(self, world: World) -> None:
        robot, model = world.robot, world.model
        self.names: Sequence[str] = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self.limited = bool(robot.velocity_limits)
        k = len(self.names)
        self.longest = np.zeros(k)
        self._period = world.period
        self._over = np.zeros(k)
        limits = np.array([*robot.velocity_limits] * 2) if self.limited else np.full(k, np.inf)
        self.per_speed = 1.0 / limits
        dofs = world.joint_qvel
        first, end = int(dofs.min()), int(dofs.max()) + 1
        self.speeds = world.data.qvel[first:end]  # a view, without a copy at each step; may hold other joints, too
        self.places = dofs - first
        self._fast = False
        limited = model.actuator_forcelimited[world.servos] > 0
        torques = np.where(limited, model.actuator_forcerange[world.servos, 1], np.inf)
        per_torque = 1.0 / (_AT_LIMIT * torques)
        self._extremes = JointExtremes(self.speeds, self.places, world.data.actuator_force, world.servos, per_torque)
        self._at_limit = np.zeros(k)
        self._held: list[tuple[int, NDArray[np.bool_]]] = []
        self._any_at_limit = self._ticks = 0

    @property
    def fastest(self) -> NDArray[np.float64]:
        """Largest speed of each joint (k,) as a share of its limit; 0 without limits."""
        high, low = np.asarray(self._extremes.high), np.asarray(self._extremes.low)
        return np.asarray(np.maximum(high, -low) * self.per_speed)

    @property
    def was_fast(self) -> bool:
        """Whether a joint was faster than its limit at the last step."""
        return self._fast

    def step(self) -> None:
        """After each physics step in which a joint is faster than its limit, and after the one that follows: speeds."""
        shares = np.abs(self.speeds[self.places]) * self.per_speed
        self._fast = float(_most(shares)) > 1.0
        if not self._fast:
            self._over[:] = 0.0
            return
        self._over = np.where(shares > 1.0, self._over + self._period, 0.0)
        np.maximum(self.longest, self._over, out=self.longest)
        self._extremes.extend()

    def tick(self) -> None:
        """At each control tick: torques."""
        self._ticks += 1
        if self._extremes.tick():
            held = np.abs(np.asarray(self._extremes.shares)) >= 1.0
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
