"""Estimated floating base with contacts."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record


class BaseState(Record, frozen=True):
    """Estimated state, world frame; contacts by name, a biped's feet "left" and "right".

    Attributes:
        rotation_base_to_world: Rotation (3, 3).
        position_base: Base position (3,) in m.
        com: CoM (3,) in m.
        com_velocity: CoM velocity (3,) in m/s.
        zmp: Composite ZMP (2,) in m of contacts, or None without load.
        loads: Vertical force on each contact in N, less its tare.
        positions_sole: Origin (3,) of each contact frame in m.
        rotations_sole: Rotation (3, 3) from each contact frame to world frame.
    """

    rotation_base_to_world: NDArray[np.float64]
    position_base: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    zmp: NDArray[np.float64] | None
    loads: Mapping[str, float]
    positions_sole: Mapping[str, NDArray[np.float64]]
    rotations_sole: Mapping[str, NDArray[np.float64]]
