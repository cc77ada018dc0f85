"""Torques of a whole body on its soles: inverse dynamics as one quadratic program.

Unknown are the acceleration a (6 + k) and the wrench w_i (6) of each standing sole in its frame, in body weights. The
program minimizes

    sum_j d_j (a_j - a*_j)^2 + c |J_c a + drift_c - c*|^2 + sum_i |w_i - w*_i|^2_W

subject to
- dynamics of the base, M_b a + h_b = sum J_b,i^T w_i;
- soles that stay: J_i a + drift_i = their wanted acceleration;
- wrench cones: friction pyramid, centre of pressure in the sole, yaw moment limits;
- torque limits, |M_k a + h_k - sum J_k,i^T w_i| <= tau, and soft bounds of joint accelerations, for limits of speed and
  position.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import daqp
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.mechanics.wrench_cone import Rectangle, cone_rows
from plantar.robots.motors.body_dynamics import BodyDynamics

Array = NDArray[np.float64]

_BASE = 6
# daqp's words for an equality and for a limit that may give way
_EQUAL = 5
_SOFT = 8
_ROWS = 17  # of a sole: the facets of its wrench cone, and its largest normal force


@dataclass(frozen=True)
class Standing:
    """A sole that stands.

    `rotation`: rotation (3, 3) from sole to world; `rectangle`: part of sole that may carry; `acceleration`: wanted
    (6,) of its site, world frame; `wrench`: preferred (6,) in its frame about its origin in N and N m; `most`: largest
    normal force in N, small while it still finds the ground.
    """

    rotation: Array
    rectangle: Rectangle
    friction: float
    acceleration: Array
    wrench: Array
    most: float


@dataclass(frozen=True)
class Wish:
    """What the body should do.

    `acceleration`: a* (6 + k,) of base and joints; `weights`: d (6 + k,); `com`: CoM acceleration (3,) in m/s^2;
    `torque`: limits (k,) in N m; inf without; `slowest`: least joint accelerations (k,) in rad/s^2; `fastest`: largest
    (k,).
    """

    acceleration: Array
    weights: Array
    com: Array
    com_weight: float
    torque: Array
    slowest: Array
    fastest: Array
    standing: Mapping[Side, Standing] = field(default_factory=dict)


@dataclass(frozen=True)
class Torques:
    """Torques with their motion and wrenches.

    `torques` (k,) in N m; `acceleration` (6 + k,); `wrenches` (6,) of each standing sole in its frame in N and N m.
    """

    torques: Array
    acceleration: Array
    wrenches: Mapping[Side, Array]


_WRENCH = np.array([0.1, 0.1, 0.1, 1.0, 1.0, 0.1])  # weights W of forces in body weights, moments in those times 0.1 m
_RIDGE = 1e-6
_TOLERANCE = 1e-10  # of rows in N, N m, m/s^2 and rad/s^2, of cones in body weights


def torques_of(dynamics: BodyDynamics, wish: Wish, gravity: float) -> Torques | None:
    """Torques for a wish. `gravity` in m/s^2. Returns the torques; None without a feasible, finite solution."""
    mass = dynamics.mass
    bias = dynamics.bias
    size = len(dynamics.bias)
    count = 6 * len(wish.standing)
    total = float(mass[0, 0])
    weight = total * gravity
    unit = np.tile(weight * np.array([1.0, 1.0, 1.0, 0.1, 0.1, 0.1]), len(wish.standing))
    jacobian = np.zeros((count, size))
    wanted = np.zeros(count)
    preferred = np.zeros(count)
    cones = np.zeros((_ROWS * len(wish.standing), size + count))
    most = np.zeros(_ROWS * len(wish.standing))
    for i, (side, sole) in enumerate(wish.standing.items()):
        at = slice(6 * i, 6 * i + 6)
        turn = sole.rotation.T
        rows = dynamics.soles[side]
        jacobian[6 * i : 6 * i + 3] = turn @ rows[:3]
        jacobian[6 * i + 3 : 6 * i + 6] = turn @ rows[3:]
        lacking = sole.acceleration - dynamics.drifts[side]
        wanted[6 * i : 6 * i + 3] = turn @ lacking[:3]
        wanted[6 * i + 3 : 6 * i + 6] = turn @ lacking[3:]
        preferred[at] = sole.wrench
        cones[_ROWS * i : _ROWS * i + 16, size + 6 * i : size + 6 * i + 6] = cone_rows(
            sole.rectangle, sole.friction
        ) * (unit[at] / weight)
        cones[_ROWS * i + 16, size + 6 * i + 2] = 1.0
        most[_ROWS * i + 16] = sole.most / weight
    preferred /= unit
    pushed = jacobian.T * unit
    moves = np.hstack([mass, -pushed])
    com = mass[:3] / total
    diagonal = np.concatenate([wish.weights, np.tile(_WRENCH, len(wish.standing))]) + _RIDGE
    aim = np.concatenate([wish.acceleration, preferred])
    hessian = np.diag(diagonal)
    gradient = -diagonal * aim
    hessian[:size, :size] += wish.com_weight * com.T @ com
    drift = bias[:3] / total - np.array([0.0, 0.0, gravity])
    gradient[:size] -= wish.com_weight * (wish.com - drift) @ com
    fixed = np.hstack([jacobian, np.zeros((count, count))])
    bounded = np.zeros((size - _BASE, size + count))
    bounded[:, _BASE:size] = np.eye(size - _BASE)
    rows = np.vstack([moves[:_BASE], fixed, cones, moves[_BASE:], bounded])
    none = np.full(len(cones), -1e30)
    torque = np.minimum(wish.torque, 1e6)
    held = np.concatenate([-bias[:_BASE], wanted])
    upper = np.concatenate([held, most, torque - bias[_BASE:], wish.fastest])
    lower = np.concatenate([held, none, -torque - bias[_BASE:], wish.slowest])
    sense = np.zeros(len(rows), dtype=np.int32)
    sense[: _BASE + count] = _EQUAL
    sense[-len(bounded) :] = _SOFT
    if not (np.isfinite(gradient).all() and np.isfinite(rows).all() and np.isfinite(held).all()):
        return None
    found, _, flag, _ = daqp.solve(hessian, gradient, rows, upper, lower, sense, primal_tol=_TOLERANCE)
    if flag < 1:
        return None
    found = np.asarray(found)
    forces = unit * found[size:]
    return Torques(
        (moves @ found + bias)[_BASE:],
        found[:size],
        {side: forces[6 * i : 6 * i + 6] for i, side in enumerate(wish.standing)},
    )
