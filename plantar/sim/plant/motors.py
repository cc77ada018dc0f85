"""True motors of the leg joints: a gain loop about targets, with delay, gear and a torque-speed curve."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.sim.plant.delay import Delay
from plantar.sim.plant.draw import TruePlant
from plantar.sim.plant.drives import RIPPLES

__all__ = ["TorqueCurve", "TrueMotors"]


class TorqueCurve:
    """Torque limits that fall with the speed at which a motor drives its joint; a brake keeps its full torque.

    Args:
        model: The MjModel of the world, whose force ranges are written.
        servos: Indices (k,) of the motors' actuators.
        speeds: Speed limits (k,) of the joints in rad/s; empty without.
        corner: Share of those up to which a motor has its full torque.
    """

    def __init__(self, model: Any, servos: NDArray[np.int64], speeds: NDArray[np.float64], corner: float) -> None:
        self._ranges, self._servos = model.actuator_forcerange, servos
        self._full = model.actuator_forcerange[servos].copy()
        self._speeds, self._corner = speeds, corner
        self.acts = corner < 1.0 and len(speeds) > 0 and bool(model.actuator_forcelimited[servos].all())

    def limit(self, speeds: NDArray[np.float64]) -> None:
        """Write the limits at joint speeds (k,) in rad/s."""
        drives = np.multiply.outer(speeds / self._speeds, (-1.0, 1.0))  # backwards, forwards
        share = np.clip((1.0 - drives) / max(1.0 - self._corner, 1e-9), 0.0, 1.0)
        self._ranges[self._servos] = share * self._full


class TrueMotors:
    """Turns targets into the torque offset of actuators that exert `ctrl - stiffness q - damping v`.

    The torque is tau = stiffness (q* - q) + damping (v* - v) + tau_ff with what the encoder reads as q; gears with
    play and torque ripple change it as in `TrueDrives`, and targets arrive late.

    Args:
        plant: The true plant; None for the nominal one.
        stiffness: Gains (k,) in N m/rad as the motors are set.
        damping: Gains (k,) in N m s/rad.
    """

    def __init__(self, plant: TruePlant | None, stiffness: NDArray[np.float64], damping: NDArray[np.float64]) -> None:
        self._stiffness, self._damping = stiffness, damping
        late = 0.0 if plant is None else plant.actuation_delay
        self._line: Delay[NDArray[np.float64]] | None = Delay(late) if late else None
        self._offsets = np.zeros(len(stiffness)) if plant is None else plant.encoder_offsets
        self._play = 0.0 if plant is None else 0.5 * plant.backlash
        self._ripple = 0.0 if plant is None else plant.torque_ripple

    def control(
        self, time: float, asked: NDArray[np.float64], joints: NDArray[np.float64], speeds: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Torque offset of the actuators.

        Args:
            time: Time in s, never decreasing.
            asked: stiffness q* + damping v* + tau_ff (k,) in N m.
            joints: True joint angles (k,) in rad.
            speeds: True joint speeds (k,) in rad/s.

        Returns:
            The offset (k,) in N m.
        """
        arrived = asked if self._line is None else self._line.passed(time, asked)
        offset = arrived - self._stiffness * self._offsets
        if self._play:
            sprung = offset - self._stiffness * joints
            offset = offset - np.clip(sprung, -self._stiffness * self._play, self._stiffness * self._play)
        if self._ripple:
            torque = offset - self._stiffness * joints - self._damping * speeds
            offset = offset + self._ripple * np.sin(RIPPLES * joints) * torque
        return np.asarray(offset)
