"""Settings of what the controller finds out of the robot that it walks: by how much that differs from its model."""

from __future__ import annotations

from plantar.settings.part import Part
from plantar.settings.schema import number, share, switch

__all__ = ["IdentificationRules"]


class IdentificationRules(Part, table="identification", needs={"control.identify": (True,)}):
    """What is identified while the robot stands and walks, and how fast.

    Attributes:
        gyro: Whether the gyro's bias is identified, by feet that carry: they do not turn.
        gyro_time: Time constant in s with which it is followed once as much time has been averaged.
        gyro_largest: Largest bias in rad/s of an axis that is believed.
        gyro_piece: Duration in s of the pieces in which gyro and legs are compared.
        gyro_slip: Angle in rad by which both differ in a piece where no sole slips: noise of encoders and gyro leaves
            1.6e-4 rad.
        steady_share: Share of what both feet carry from which one is held against the gyro; others turn on edges.
        steady_time: Time constant in s of a foot's usual load: one that carries as usual stands, and counts, too.
        steady_band: How far in N a foot's load may be from that.
        encoders: Whether the encoders' zeros are identified, by the feet of the opening stand.
        encoder_error: Standard deviation of a joint's zero that is expected, in rad: 3e-3 are 0.17 degrees.
        encoder_least: Root mean square in rad of the joints' offsets up to which they count as none: noise of the
            accelerometer alone makes half of that.
        encoder_largest: Largest offset of a joint in rad that is believed.
        com: Whether the CoM's offset is identified, by the ZMP of the opening stand.
        com_least: Offset in m up to which it counts as none.
        com_largest: Largest offset in m that is believed.
        lean: Roll of the torso in rad per metre of the CoM's distance from the middle between the feet for each tenth
            that mass and CoM load the hips more than in the model, up to two tenths; 0 leans as the walk says.
        place_error: How well it is known where the feet stand at the start, as a standard deviation in m.
        turn_error: How well soles are known to lie flat, and the accelerometer to show gravity on average, in rad.
        fade: Time in s in which what is commanded follows what was found in the opening stand.
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
