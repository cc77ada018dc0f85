"""What the sensors do to the truth, as a scene's `[sensing]` table gives it."""

from __future__ import annotations

from plantar.settings.schema import Settings, choice, number, share, switch, whole

__all__ = ["Sensing"]


class Sensing(Settings):
    """What the sensors do to the truth. Standard deviations (1 sigma) of white noise; SI.

    Skin and ankle sensors are made for the robot that wears them: their noise and range go with its weight and leg. An
    IMU and an encoder are what can be bought, for every robot.

    Attributes:
        taxels: How the ground's load comes to lie on the taxels: on springs side by side ("winkler", the fast default),
            or through an elastic layer whose parts move each other ("elastic"), which no fit of the controller knows.
        layer: Thickness of that layer in m: the H1's shoe is 12 mm thick.
        skin_rate: Sampling rate of the soles in Hz.
        force_noise: Of each taxel in N: 0.15 kg on a robot of 86 kg.
        delay_periods: Whole skin periods between sampling and delivery.
        proximity_range: Range of the taxels' proximity sensors in m.
        proximity_noise: Of each proximity reading in m.
        proximity_bias: What every proximity reading is too long by in m; negative: too short.
        dead_taxels: Share of each sole's taxels that are dead; the seed chooses which.
        encoder_noise: Of each joint encoder in rad.
        gyro_noise: Of each gyro axis in rad/s.
        accelerometer_noise: Of each accelerometer axis in m/s^2.
        body_skin: Whether the skin of the upper body is read, in a scene where somebody touches it.
        force_torque: Whether the ankles have force-torque sensors that somebody reads.
        ankle_force_noise: Of each axis of their force in N.
        ankle_torque_noise: Of each axis of their torque in N m.
    """

    taxels: str = choice("winkler", "elastic")
    layer: float = share(0.052, "sole", 1e-3, 10)
    skin_rate: float = number(250.0, "Hz", 10, 1000)
    force_noise: float = share(0.00174, "weight", 0, 1000)
    delay_periods: int = whole(0, "periods", 0, 250)
    proximity_range: float = share(1 / 12, "leg", 0.005, 0.5)
    proximity_noise: float = share(1 / 300, "leg", 0, 0.1)
    proximity_bias: float = number(0.0, "m", -0.05, 0.05)
    dead_taxels: float = number(0.0, "1", 0, 0.9)
    encoder_noise: float = number(5e-5, "rad", 0, 0.1)
    gyro_noise: float = number(2e-3, "rad/s", 0, 1)
    accelerometer_noise: float = number(0.05, "m/s^2", 0, 10)
    body_skin: bool = switch(True)
    force_torque: bool = switch(False)
    ankle_force_noise: float = share(0.00119, "weight", 0, 1000)
    ankle_torque_noise: float = share(0.000257, "weight sole", 0, 100)
