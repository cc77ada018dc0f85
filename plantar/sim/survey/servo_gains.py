"""Gains of a leg's servos from inertia, weight and control period."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.gravity import GRAVITY
from plantar.sim.survey.joint_inertia import JointInertia

__all__ = ["LEAST_STIFFNESS", "SAMPLED", "STIFFNESS", "rotor_inertia", "servo_gains"]

STIFFNESS = 12.0
"""Stiffness of a joint over m g h, which is the least at which two ankles of half of it each hold the pendulum up."""

LEAST_STIFFNESS = 3.0
"""The same at which a robot on one foot still stands with a third of it to spare."""

SAMPLED = 1.5
"""Phase in rad by which a joint swings on its servo in a control period at most; h1's ankle does so by 1.46."""

_LEAD = 0.076  # damping over stiffness, in beats of the leg; h1 has 0.01875 s


def servo_gains(
    inertia: JointInertia, mass: float, com_height: float, beat: float, period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gains of the servos of a leg.

    Stiffness is 12 m g h, as of h1; for a light joint only so much that the foot's own swing, of frequency sqrt(k / I),
    moves by 1.5 rad in a control period. Damping is critical for the swing, or as of h1 where that is more, less the
    joint's own.

    Args:
        inertia: About each joint of a leg.
        mass: Of the robot in kg.
        com_height: Of its CoM in m.
        beat: Time scale sqrt(leg / g) in s.
        period: Control period in s.

    Returns:
        Stiffness in N m/rad and damping in N m s/rad of each joint of a leg, of two digits.
    """
    wanted = STIFFNESS * mass * GRAVITY * com_height
    least = LEAST_STIFFNESS * mass * GRAVITY * com_height
    stiffness = np.clip(inertia.swing * (SAMPLED / period) ** 2, least, wanted)
    damping = np.maximum(2.0 * np.sqrt(stiffness * inertia.swing), _LEAD * beat * stiffness)
    damping = np.maximum(damping - inertia.damping, 0.02 * damping)
    return _two_digits(stiffness), _two_digits(damping)


def rotor_inertia(inertia: JointInertia, mass: float, com_height: float, period: float) -> NDArray[np.float64]:
    """Rotor inertia to assume where a model states none and a joint would be too light for its servo.

    It keeps a bare foot's swing under the least stiffness that holds the robot to `SAMPLED` in a control period; more
    would chatter. For Unitree's G1, whose URDF states none, 0.0035 and 0.0066 kg m^2 about the ankle, which has 0.007.

    Args:
        inertia: About each joint of a leg.
        mass: Of the robot in kg.
        com_height: Of its CoM in m.
        period: Control period in s.

    Returns:
        Inertia in kg m^2 to add about each joint of a leg, of two digits; 0 where none is missing.
    """
    least = LEAST_STIFFNESS * mass * GRAVITY * com_height
    missing = least * (period / SAMPLED) ** 2 - inertia.swing
    return _two_digits(np.where(inertia.armature > 0.0, 0.0, np.maximum(missing, 0.0)))


def _two_digits(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([float(f"{v:.2g}") for v in values])
