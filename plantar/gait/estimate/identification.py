"""Settings of the robot's identified differences from its model."""

from typing import ClassVar

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share, switch


class IdentificationRules(Part, table="identification", needs={"control.identify": (True,)}):
    """What is identified standing and walking, and how fast.

    Attributes:
        gyro: Whether gyro bias is, by carrying feet.
        encoders: Whether encoder zeros are, in the opening stand.
        com: Whether the CoM offset is, by the ZMP of the opening stand, and of standing still later.
        lean: Torso roll in rad per metre between CoM and feet's middle, for each tenth that mass and CoM load the hips
            more than in the model, up to two tenths; 0 uses the walk's lean. While one leg carries for longer than a
            step, both.
    """

    gyro: bool = switch(True)
    # Time constant in s with which it is followed once as much time has been averaged
    gyro_time: float = fixed(160.0, "beat")  # chosen: 40 s on h1, in which a bias drifts by less than it is known
    # Largest bias in rad/s of an axis that is believed; chosen: 2.9 degrees a second
    gyro_largest: ClassVar[float] = 0.05
    # Duration in s of the pieces in which gyro and legs are compared; chosen: a quarter of a second on h1
    gyro_piece: float = fixed(1.0, "beat")
    # derived: Angle in rad by which both differ in a piece where no sole slips: noise of encoders and gyro leaves
    # 1.6e-4 rad; 2.5 of them
    gyro_slip: ClassVar[float] = 0.0004
    # Share of what both feet carry from which one is held against the gyro; others turn on edges
    steady_share: ClassVar[float] = 0.8  # chosen: a foot that carries less is about to be lifted, or has just landed
    # Time constant in s of a foot's usual load: one that carries as usual stands, and counts, too
    steady_time: float = fixed(2.0, "beat")  # chosen: half a second
    # How far in N a foot's load may be from that; chosen: 42 N on h1, four times the noise of a sole's sum
    steady_band: float = fixed(0.05, "weight")
    encoders: bool = switch(True)
    # derived: Standard deviation of a joint's zero that is expected, in rad: 3e-3 are 0.17 degrees; a uniform draw of
    # 0.3 degrees either way (level 2)
    encoder_error: ClassVar[float] = 0.003
    # derived: Root mean square in rad of the joints' offsets up to which they count as none: noise of the accelerometer
    # alone makes half of that
    encoder_least: ClassVar[float] = 0.001
    encoder_largest: ClassVar[float] = 0.03  # Largest accepted joint offset in rad; derived: ten of `encoder_error`
    com: bool = switch(True)
    com_least: float = fixed(0.005, "leg")  # Offset in m up to which it counts as none; chosen: 3 mm on h1
    com_largest: float = fixed(1 / 12, "leg")  # Largest accepted offset in m; chosen: 50 mm on h1
    # Time constant in s with which it is followed while the robot stands still; measured: `balance` of h1, one seed,
    # recovers from all pushes at 20 % less and more
    com_time: float = fixed(4.0, "beat")
    # Speed of the CoM in m/s up to which it stands still; derived: the DCM is then no farther off than `com_least`
    com_still: float = fixed(0.005, "leg/beat")
    # Time in s of that before it is followed; chosen: half a second, a body that is pushed moves sooner
    com_rest: float = fixed(2.02, "beat")
    # chosen: bounded by the hip's torque below, by the trunk's way above
    lean: float = share(0.48, "rad/leg", 0.0, 10.0)
    # How well it is known where the feet stand at the start, as a standard deviation in m
    place_error: float = fixed(0.001, "leg")  # chosen: 0.6 mm
    # How well soles are known to lie flat, and the accelerometer to show gravity on average, in rad
    turn_error: ClassVar[float] = 0.001  # chosen: 1 mrad
    # Time in s in which commands approach the identified values; chosen: 0.4 s, in which the CoM moves by its offset
    # without a jerk
    fade: float = fixed(1.6, "beat")
