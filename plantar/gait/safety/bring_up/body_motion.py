"""How a robot's body moves over its soles, by its encoders, and what soles and IMU have to measure of it.

A soft robot sways by several times what it is commanded. What sensors report of one motion agrees all the same.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.estimate.estimator import Posture
from plantar.mechanics.lip import GRAVITY

# chosen: s: second differences of positions are over it, and what they are compared with is smoothed likewise. +-20 %
# refuses none of 183 drawn plants of ten robots, and passes none of their 549 reversed orders
SPAN = 0.1


class BodyMotion(NamedTuple):
    """Motion over n rows, x forward and y to the left.

    Attributes:
        turn: Torso's rotation vector (n, 3) since the first row, its frame, in rad.
        zmp: ZMP (m, 2) in m from the middle of both soles, of each `smoothed` row; that of the model's CoM, and exact
            while the torso does not turn about the other axis.
        force: Specific force (m, 2) in m/s^2 at the IMU, but for a constant, likewise.
        height: CoM's in m over the soles.
    """

    turn: NDArray[np.float64]
    zmp: NDArray[np.float64]
    force: NDArray[np.float64]
    height: float


def body_motion(
    joints: NDArray[np.float64],
    posture: Callable[[NDArray[np.float64]], Posture],
    imu: NDArray[np.float64],
    period: float,
) -> BodyMotion:
    """Motion by `joints` (n, k) in rad, each `period` in s, of soles that stay; `imu`: its place (3,), base frame."""
    postures = [posture(row) for row in joints]
    # Of each row and side: sole to base
    turns = np.array([[posed.rotations[side] for side in SIDES] for posed in postures])
    soles = np.array([[posed.positions[side] for side in SIDES] for posed in postures])
    coms = np.array([posed.com for posed in postures])

    def over_soles(points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Mean of both soles' frames."""
        return np.asarray(np.einsum("nsji,nsj->nsi", turns, points[:, None] - soles).mean(axis=1))

    turned = np.einsum("sij,nskj->nsik", turns[0], turns).mean(axis=1)
    turn = 0.5 * np.stack([turned[:, i - 1, i - 2] - turned[:, i - 2, i - 1] for i in range(3)], axis=1)
    com = over_soles(coms)
    height = float(com[:, 2].mean())
    zmp = smoothed(com, period) - height / GRAVITY * _accelerated(com, period)
    tilt = GRAVITY * np.column_stack([-turn[:, 1], turn[:, 0]])
    place = over_soles(np.broadcast_to(imu, coms.shape))
    return BodyMotion(turn, zmp[:, :2], _accelerated(place, period)[:, :2] + smoothed(tilt, period), height)


def smoothed(values: NDArray[np.float64], period: float) -> NDArray[np.float64]:
    """Mean (m, ...) of values (n, ...) by the weights of accelerations in a second difference: a triangle."""
    rows = _rows(period)
    found = values[1:-1]
    for _ in range(2):
        summed = np.cumsum(np.concatenate([np.zeros_like(found[:1]), found]), axis=0)
        found = (summed[rows:] - summed[:-rows]) / rows
    return found


def _accelerated(places: NDArray[np.float64], period: float) -> NDArray[np.float64]:
    """Second differences (m, k) in m/s^2 of places (n, k) in m."""
    rows = _rows(period)
    ends = places[2 * rows :] + places[: -2 * rows]
    return np.asarray((ends - 2.0 * places[rows:-rows]) / (rows * period) ** 2)


def _rows(period: float) -> int:
    return max(1, round(SPAN / period))
