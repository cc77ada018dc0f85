"""Settings of the arm that a walking robot moves: a scene's table `[arm]`."""

from __future__ import annotations

from plantar.settings.schema import Settings, choice, number, share, tables

__all__ = ["ArmSettings"]


class ArmSettings(Settings):
    """An arm whose joints move under the companion's tasks (A 13-14, 18): springs to a posture, and yielding skin.

    Attributes:
        side: Which arm moves; with "none" both are part of the chest.
        posture: Angle in degrees of each joint from shoulder to wrist; empty: those of the machine's file.
        spring: Torque of the springs, as a share of a joint's largest per rad.
        damper: Torque against a joint's speed, likewise, in s/rad. Above 0.3 the wrist of h1 shakes at 200 Hz.
        gain: Factor on the measured force; 1 yields as without friction and gears, 0 holds against it.
        filter: Time constant in s of the low pass on each taxel's force.
        speed_noise: Standard deviation in rad/s of the joints' speeds; their angles have the noise of the legs'.
    """

    side: str = choice("none", "left", "right")
    posture: tuple[float, ...] = tables("a list of angles in degrees, one a joint")
    spring: float = number(0.6, "1/rad", 0.0, 1000.0)
    damper: float = number(0.08, "s/rad", 0.0, 100.0)
    gain: float = number(1.5, "1", 0.0, 100.0)
    filter: float = share(0.162, "beat", 0.0, 10.0)
    speed_noise: float = number(1e-3, "rad/s", 0.0, 1.0)
