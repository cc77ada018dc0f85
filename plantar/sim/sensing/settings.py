"""What sensors do to the truth: a scene's `[sensing]` table."""

from plantar.common.settings.schema import Settings, choice, number, share, switch, whole


class Sensing(Settings):
    """White noise (1 sigma), rates and delays, SI.

    Skin and ankle sensors scale with the robot; IMU and encoder do not.

    Attributes:
        taxels: Springs ("winkler") or an elastic layer ("elastic").
        layer: Thickness in m of an elastic layer; H1's shoe has 12 mm.
        skin_rate: Of the soles in Hz.
        force_noise: Of each taxel in N.
        delay_periods: Skin periods from sampling to delivery.
        proximity_range: In m.
        proximity_noise: Of each reading in m.
        proximity_bias: Of every reading in m.
        dead_taxels: Share of each sole's taxels; the seed chooses which.
        encoder_noise: Of each joint in rad.
        gyro_noise: Of each axis in rad/s.
        accelerometer_noise: Of each axis in m/s^2.
        body_skin: Whether upper body skin is read, with touch.
        force_torque: Whether the ankles have force-torque sensors.
        ankle_force_noise: Of each axis in N.
        ankle_torque_noise: Of each axis in N m.
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
