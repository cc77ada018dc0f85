"""Whether joints stay within their true speed and torque limits."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.judging.joint_extremes import JointExtremes
from plantar.sim.model.world import World

AT_LIMIT = 0.999
"""Share of a torque limit from which a servo is at it: it asks for more than it gets."""


class JointLimits:
    """Follows the leg joints' speeds and torques in a `world`.

    `extremes`: takes speeds and torques each physics step.
    """

    def __init__(self, world: World) -> None:
        robot = world.robot
        model = world.model
        self.names: Sequence[str] = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self.limited = bool(robot.velocity_limits)
        self._period = world.period
        limits = np.array([*robot.velocity_limits] * 2) if self.limited else np.full(len(self.names), np.inf)
        self._per_speed = 1.0 / limits
        limited = model.actuator_forcelimited[world.servos] > 0
        torques = np.where(limited, model.actuator_forcerange[world.servos, 1], np.inf)
        self.extremes = JointExtremes(
            world.data.qvel,
            world.joint_qvel,
            self._per_speed,
            world.data.actuator_force,
            world.servos,
            1.0 / (AT_LIMIT * torques),
        )

    @property
    def fastest(self) -> NDArray[np.float64]:
        """Largest speed of each joint (k,) as a share of its limit; 0 without limits."""
        high = np.asarray(self.extremes.high)
        low = np.asarray(self.extremes.low)
        return np.asarray(np.maximum(high, -low) * self._per_speed)

    @property
    def longest(self) -> NDArray[np.float64]:
        """Longest time in s in a row for which each joint (k,) was too fast."""
        return np.asarray(self.extremes.longest) * self._period

    @property
    def share_at_limit(self) -> float:
        """Share of the time with a joint at its torque limit."""
        return float(self.extremes.any_held / max(1, self.extremes.steps))

    def summary(self) -> dict[str, Any]:
        """Fastest joint, and how often joints were at their torque limits."""
        fastest = self.fastest
        k = int(fastest.argmax())
        steps = max(1, self.extremes.steps)
        return {
            "joint_speed": {
                "joint": self.names[k],
                "share_of_limit": round(float(fastest[k]), 3),
                "longest_over_s": round(float(self.longest.max()), 4),
            }
            if self.limited
            else None,
            "torque_limit": {
                "share_of_time": round(self.share_at_limit, 4),
                "joints": {
                    name: round(float(count) / steps, 4)
                    for name, count in zip(self.names, self.extremes.held, strict=True)
                    if count
                },
            },
        }
