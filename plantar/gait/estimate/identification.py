"""Settings of what the controller identifies of its robot: the difference from the model."""

from __future__ import annotations

from plantar.settings.part import Part
from plantar.settings.schema import number, share, switch

__all__ = ["IdentificationRules"]


class IdentificationRules(Part, table="identification", needs={"control.identify": (True,)}):
    """What is identified while the robot stands and walks, and how fast.

    Attributes:
        gyro: Whether the gyro's bias is identified, by carrying feet.
        gyro_time: Time constant in s of the bias, after as much time has been averaged.
        gyro_largest: Largest accepted bias of an axis in rad/s.
        gyro_piece: Duration in s of the pieces in which gyro and legs are compared.
        gyro_slip: Angle in rad by which both may differ in a piece without a slip (noise leaves 1.6e-4).
        steady_share: Share of the total load from which a foot is compared with the gyro; others turn on edges.
        steady_time: Time constant in s of a foot's usual load; a foot at its usual load is compared too.
        steady_band: Largest deviation in N from the usual load.
        encoders: Whether the encoders' zeros are identified in the opening stand.
        encoder_error: Expected standard deviation of a joint's zero in rad (3e-3 are 0.17 degrees).
        encoder_least: Root mean square in rad of the offsets up to which they count as none; twice what noise of the
            accelerometer makes.
        encoder_largest: Largest accepted offset of a joint in rad.
        com: Whether the CoM's offset is identified, by the ZMP of the opening stand.
        com_least: Offset in m up to which it counts as none.
        com_largest: Largest accepted offset in m.
        lean: Roll of the torso in rad per metre between the CoM and the middle of the feet, for each tenth by which
            mass and CoM load the hips more than in the model, up to two tenths; 0 uses the walk's own lean.
        place_error: Standard deviation in m of the feet's known places at the start.
        turn_error: Standard deviation in rad of flat soles, and of the accelerometer's mean direction.
        fade: Time in s in which commands approach what was identified in the opening stand.
    """

    gyro: bool = switch(True)
    gyro_time: float = share(160.0, "beat", 1.0, 3600.0)
    gyro_largest: float = number(0.05, "rad/s", 0.0, 1.0)
    gyro_piece: float = share(1.0, "beat", 0.001, 100.0)
    gyro_slip: float = number(4e-4, "rad", 1e-6, 1.0)
    steady_share: float = number(0.8, "1", 0.0, 1.0)
    steady_time: float = share(2.0, "beat", 0.001, 10.0)
    steady_band: float = share(0.05, "weight", 0.0, 100000)
    encoders: bool = switch(True)
    encoder_error: float = number(3e-3, "rad", 1e-6, 0.1)
    encoder_least: float = number(1e-3, "rad", 0.0, 0.1)
    encoder_largest: float = number(0.03, "rad", 0.0, 0.2)
    com: bool = switch(True)
    com_least: float = share(0.005, "leg", 0.0, 0.1)
    com_largest: float = share(1 / 12, "leg", 0.0, 0.5)
    lean: float = share(0.48, "rad/leg", 0.0, 10.0)
    place_error: float = share(1e-3, "leg", 1e-6, 0.1)
    turn_error: float = number(1e-3, "rad", 1e-6, 0.1)
    fade: float = share(1.6, "beat", 0.01, 10.0)
