"""What the sensors do to the truth, as a scene's `[sensing]` table says it."""

from __future__ import annotations

from plantar.settings.schema import Settings, number, switch, whole

__all__ = ["Sensing"]


class Sensing(Settings):
    """What the sensors do to the truth. Standard deviations (1 sigma) of white noise; SI.

    Attributes:
        skin_rate: Sampling rate of the soles in Hz.
        force_noise: Of each taxel in N (0.15 kg).
        delay_periods: Whole skin periods between sampling and delivery.
        proximity_range: Range of the taxels' proximity sensors in m.
        proximity_noise: Of each proximity reading in m.
        proximity_bias: What every proximity reading is too long by in m; negative: too short.
        dead_taxels: Share of each sole's taxels that are dead; the seed chooses which.
        encoder_noise: Of each joint encoder in rad.
        gyro_noise: Of each gyro axis in rad/s.
        accelerometer_noise: Of each accelerometer axis in m/s^2.
        force_torque: Whether the ankles have force-torque sensors that somebody reads.
        ankle_force_noise: Of each axis of their force in N.
        ankle_torque_noise: Of each axis of their torque in N m.
    """

    skin_rate: float = number(250.0, "Hz", 10, 1000)
    force_noise: float = number(1.4715, "N", 0, 1000)
    delay_periods: int = whole(0, "periods", 0, 250)
    proximity_range: float = number(0.05, "m", 0.005, 0.5)
    proximity_noise: float = number(0.002, "m", 0, 0.1)
    proximity_bias: float = number(0.0, "m", -0.05, 0.05)
    dead_taxels: float = number(0.0, "1", 0, 0.9)
    encoder_noise: float = number(5e-5, "rad", 0, 0.1)
    gyro_noise: float = number(2e-3, "rad/s", 0, 1)
    accelerometer_noise: float = number(0.05, "m/s^2", 0, 10)
    force_torque: bool = switch(False)
    ankle_force_noise: float = number(1.0, "N", 0, 1000)
    ankle_torque_noise: float = number(0.05, "N m", 0, 100)
