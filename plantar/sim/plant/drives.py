"""True leg drives: encoder zeros, delay, play, ripple, torque-speed curves."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.sim.plant.delay import Delay
from plantar.sim.plant.draw import TruePlant

RIPPLES = 200.0
"""Swings of the torque in a turn of a joint: two in a turn of the wave generator of a harmonic drive of 100 : 1."""


class TorqueCurve:
    """Torque limits that fall with driving speed; a brake keeps full torque.

    `model`: the world's, whose force ranges are written; `servos`: actuator indices (k,); `speeds`: limits (k,) in
    rad/s; empty without.
    """

    def __init__(self, model: Any, servos: NDArray[np.int64], speeds: NDArray[np.float64], corner: float) -> None:
        self._ranges = model.actuator_forcerange
        self._servos = servos
        self._full = model.actuator_forcerange[servos].copy()
        self._speeds = speeds
        self._corner = corner
        self.acts = corner < 1.0 and len(speeds) > 0 and bool(model.actuator_forcelimited[servos].all())

    def limit(self, speeds: NDArray[np.float64]) -> None:
        """Write the limits at joint speeds (k,) in rad/s."""
        drives = np.multiply.outer(speeds / self._speeds, (-1.0, 1.0))  # backwards, forwards
        share = np.clip((1.0 - drives) / max(1.0 - self._corner, 1e-9), 0.0, 1.0)
        self._ranges[self._servos] = share * self._full


class TrueDrives:
    """Torque offset with which ideal actuators behave as the true drives.

    A drive exerts stiffness (q* - q) + damping (v* - v) + tau_ff = offset - stiffness q - damping v; of a position
    servo with the set-point u the offset is stiffness u. A gear with play b passes the spring torque of the excess over
    b / 2, one with ripple (1 + r sin(n q)) times the torque.

    `plant`: None for the nominal one; `stiffness`: True position gains (k,) in N m/rad; `damping`: velocity gains (k,)
    in N m s/rad.
    """

    def __init__(self, plant: TruePlant | None, stiffness: NDArray[np.float64], damping: NDArray[np.float64]) -> None:
        self._stiffness = stiffness
        self._damping = damping
        late = 0.0 if plant is None else plant.actuation_delay
        self._line: Delay[NDArray[np.float64]] | None = Delay(late) if late else None
        self._zero = 0.0 if plant is None else stiffness * plant.encoder_offsets
        self._play = 0.0 if plant is None else 0.5 * plant.backlash * stiffness
        self._ripple = 0.0 if plant is None else plant.torque_ripple

    def offset(
        self, time: float, asked: NDArray[np.float64], joints: NDArray[np.float64], speeds: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Returns the actuators' torque offset (k,) in N m at a `time` in s, never decreasing.

        `asked` is stiffness q* + damping v* + tau_ff (k,) in N m, delayed; true angles `joints` (k,) are in rad,
        `speeds` (k,) in rad/s.
        """
        arrived = asked if self._line is None else self._line.passed(time, asked)
        offset = arrived - self._zero
        if np.any(self._play):
            offset = offset - np.clip(offset - self._stiffness * joints, -self._play, self._play)
        if self._ripple:
            torque = offset - self._stiffness * joints - self._damping * speeds
            offset = offset + self._ripple * np.sin(RIPPLES * joints) * torque
        return np.asarray(offset)
