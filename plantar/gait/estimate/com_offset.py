"""CoM's horizontal offset from the model, by a standing robot's ground forces."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.estimate.estimator import Posture
from plantar.mechanics.rotation import level_rotation
from plantar.mechanics.zmp import zmp_of_feet


def com_offset(
    posture: Posture,
    rotation: NDArray[np.float64],
    feet: Mapping[Side, tuple[float, float, float, float]],
    wrenches: Mapping[Side, NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Returns CoM's horizontal offset (3,) in m, base frame, of a standing robot from its model, with the effects of
    encoder errors and unequal taxels; zero without load.

    By its `posture`, `rotation` base to world (3, 3), flat soles `feet` (x, y, z in m and heading in rad), and
    `wrenches` (6,) on each sole, own frame, in N and N m.
    """
    points: list[NDArray[np.float64] | None] = []
    bases: list[NDArray[np.float64]] = []
    for side in SIDES:
        x, y, z, yaw = feet[side]
        cop = SoleWrench(wrenches[side]).position_cop_in_sole
        points.append(None if cop is None else np.array([x, y]) + level_rotation(yaw)[:2, :2] @ cop)
        bases.append(np.array([x, y, z]) - rotation @ posture.positions[side])
    zmp = zmp_of_feet(points, [float(wrenches[side][2]) for side in SIDES])
    if zmp is None:
        return np.zeros(3)
    com = np.mean(bases, axis=0) + rotation @ posture.com
    beside = np.array([*(zmp - com[:2]).tolist(), 0.0])
    return np.asarray(rotation.T @ beside)
