"""Where to put the swing foot when the DCM runs away faster than the stance foot can hold it.

With a DCM error e and the ZMP held at an offset u from its reference along e, the error obeys e' = w (e - u) (T 4.12),
so after the time T that is left of the step it is

    e_T = u + (e - u) e^(w T)        (0 where u >= e: the stance foot brings it back by itself)

The next foothold moves by e_T, so that the next step begins with the DCM error that its plan expects: none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gait.footsteps import Footstep

__all__ = ["AdjustmentLimits", "adjusted_step", "remaining_error"]


@dataclass(frozen=True)
class AdjustmentLimits:
    """How far a footstep may be moved.

    Attributes:
        deadband: Predicted error in m up to which the footstep stays where it is planned.
        forward: Largest move along the foot's heading in m.
        outward: Largest move away from the stance foot in m.
        separation: Smallest lateral distance of the two soles' origins in m.
        latest: Share of the swing after which the foothold is fixed.
        speed: Largest speed in m/s at which the foothold moves.
    """

    deadband: float = 0.02
    forward: float = 0.15
    outward: float = 0.15
    separation: float = 0.165
    latest: float = 0.85
    speed: float = 0.8


def remaining_error(
    error: NDArray[np.float64], zmp_offset: NDArray[np.float64], omega: float, time_left: float
) -> NDArray[np.float64]:
    """DCM error that is left at the end of the step, with the ZMP held where it is now.

    Args:
        error: DCM error (2,) now in m.
        zmp_offset: Offset (2,) in m of the desired ZMP from its reference.
        omega: Pendulum frequency in rad/s.
        time_left: Time to the end of the step in s, 0 or more.

    Returns:
        Error (2,) in m along the present one.

    Example:
        >>> remaining_error(np.array([0.05, 0.0]), np.array([0.05, 0.0]), 3.5, 0.4).tolist()
        [0.0, 0.0]
    """
    size = math.hypot(*error.tolist())
    if size < 1e-9:
        return np.zeros(2)
    direction = error / size
    held = float(zmp_offset @ direction)
    if held >= size:
        return np.zeros(2)
    return max(0.0, held + (size - held) * math.exp(omega * time_left)) * direction


def adjusted_step(step: Footstep, stance: Footstep, error: NDArray[np.float64], limits: AdjustmentLimits) -> Footstep:
    """The footstep moved by a predicted DCM error, within limits.

    Args:
        step: The planned footstep.
        stance: Pose of the standing foot.
        error: Predicted DCM error (2,) at the end of the step in the world frame in m.
        limits: How far it may move.

    Returns:
        The moved footstep; the same one within the deadband.
    """
    size = math.hypot(*error.tolist())
    if size <= limits.deadband:
        return step
    c, s = math.cos(step.yaw), math.sin(step.yaw)
    shrunk = error * (1.0 - limits.deadband / size)  # continuous at the deadband's edge
    forward = float(c * shrunk[0] + s * shrunk[1])
    left = float(-s * shrunk[0] + c * shrunk[1])
    outward = 1.0 if step.side == "left" else -1.0
    forward = min(limits.forward, max(-limits.forward, forward))
    planned = outward * (-s * (step.x - stance.x) + c * (step.y - stance.y))
    inward_room = min(0.0, limits.separation - planned)
    side = min(limits.outward, max(inward_room, outward * left)) * outward
    return replace(step, x=step.x + c * forward - s * side, y=step.y + s * forward + c * side)
