"""Settings of what the controller finds out of the robot that it walks: by how much that differs from its model."""

from __future__ import annotations

from plantar.settings.schema import Settings, number, share, switch

__all__ = ["IdentificationRules"]


class IdentificationRules(Settings):
    """What is identified while the robot stands and walks, and how fast.

    Attributes:
        gyro: Whether the gyro's bias is identified, by feet that carry: they do not turn.
        gyro_time: Time constant in s with which it is followed once as much time has been averaged.
        gyro_largest: Largest bias in rad/s of an axis that is believed.
    """

    gyro: bool = switch(True)
    gyro_time: float = share(80.0, "beat", 1.0, 3600.0)
    gyro_largest: float = number(0.05, "rad/s", 0.0, 1.0)
