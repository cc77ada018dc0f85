"""Settings of the arm that a walking robot moves: a scene's table `[arm]`."""

from __future__ import annotations

from plantar.settings.schema import Settings, choice, number, share, tables

__all__ = ["ArmSettings"]


class ArmSettings(Settings):
    """An arm whose joints move under the companion's tasks (A 13-14, 18): springs to a posture, and yielding skin.

    Attributes:
        side: Which arm moves; with "none" both are part of the chest, as in every other scene.
        posture: Angle in degrees of each joint from shoulder to wrist; without, those of the machine's file.
        spring: Torque of the springs to the posture, as a share of a joint's largest a rad.
        damper: Torque against a joint's speed, likewise, in s/rad. Torques are held for a control period: above 0.3 the
            light wrist of h1 shakes at 200 Hz.
        gain: Factor on the force that the skin of the arm measures, with which the arm gives way to it; 1 as if it had
            neither friction nor gears, 0 holds against it.
        filter: Time constant in s of the low pass on each taxel's force, against oscillation on the skin's stiffness.
        speed_noise: Noise (1 sigma) in rad/s of the joints' speeds; their angles have the noise of the legs'.
    """

    side: str = choice("none", "left", "right")
    posture: tuple[float, ...] = tables("a list of angles in degrees, one a joint")
    spring: float = number(0.6, "1/rad", 0.0, 1000.0)
    damper: float = number(0.08, "s/rad", 0.0, 100.0)
    gain: float = number(1.5, "1", 0.0, 100.0)
    filter: float = share(0.162, "beat", 0.0, 10.0)
    speed_noise: float = number(1e-3, "rad/s", 0.0, 1.0)
