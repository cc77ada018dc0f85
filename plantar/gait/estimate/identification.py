"""Settings of the robot's identified differences from its model."""

from typing import ClassVar

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share, switch


class IdentificationRules(Part, table="identification", needs={"control.identify": (True,)}):
    """What is identified standing and walking, and how fast.

    Attributes:
        gyro: Whether gyro bias is, by carrying feet.
        encoders: Whether encoder zeros are, in the opening stand.
        com: Whether the CoM offset is, by the opening stand's ZMP.
        lean: Torso roll in rad per metre between CoM and feet's middle, for each tenth that mass and CoM load the hips
            more than in the model, up to two tenths; 0 uses the walk's lean. While one leg carries for longer than a
            step, both.
    """

    gyro: bool = switch(True)
    # Time constant in s with which it is followed once as much time has been averaged
    gyro_time: float = fixed(160.0, "beat")
    gyro_largest: ClassVar[float] = 0.05  # Largest bias in rad/s of an axis that is believed
    gyro_piece: float = fixed(1.0, "beat")  # Duration in s of the pieces in which gyro and legs are compared
    # Angle in rad by which both differ in a piece where no sole slips: noise of encoders and gyro leaves 1.6e-4 rad
    gyro_slip: ClassVar[float] = 0.0004
    # Share of what both feet carry from which one is held against the gyro; others turn on edges
    steady_share: ClassVar[float] = 0.8
    # Time constant in s of a foot's usual load: one that carries as usual stands, and counts, too
    steady_time: float = fixed(2.0, "beat")
    steady_band: float = fixed(0.05, "weight")  # How far in N a foot's load may be from that
    encoders: bool = switch(True)
    # Standard deviation of a joint's zero that is expected, in rad: 3e-3 are 0.17 degrees
    encoder_error: ClassVar[float] = 0.003
    # Root mean square in rad of the joints' offsets up to which they count as none: noise of the accelerometer alone
    # makes half of that
    encoder_least: ClassVar[float] = 0.001
    encoder_largest: ClassVar[float] = 0.03  # Largest accepted joint offset in rad
    com: bool = switch(True)
    com_least: float = fixed(0.005, "leg")  # Offset in m up to which it counts as none
    com_largest: float = fixed(1 / 12, "leg")  # Largest accepted offset in m
    lean: float = share(0.48, "rad/leg", 0.0, 10.0)
    # How well it is known where the feet stand at the start, as a standard deviation in m
    place_error: float = fixed(0.001, "leg")
    # How well soles are known to lie flat, and the accelerometer to show gravity on average, in rad
    turn_error: ClassVar[float] = 0.001
    fade: float = fixed(1.6, "beat")  # Time in s in which commands approach the identified values
