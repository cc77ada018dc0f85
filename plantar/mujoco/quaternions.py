"""Rotations of MuJoCo's models, whose quaternions are (w, x, y, z)."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray


def rotation_of(quaternion: ArrayLike) -> NDArray[np.float64]:
    """Rotation (3, 3) of a `quaternion` (4,)."""
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, np.asarray(quaternion, dtype=np.float64))
    return matrix.reshape(3, 3)


def quaternion_of(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quaternion (4,) of a `rotation` (3, 3)."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
    return quaternion
