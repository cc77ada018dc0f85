"""Wrench on the body in the dynamics of the divergent component of motion (K 6-12, corrected).

The pendulum of height g / w^2 has its ZMP at u_ref; a wrench pushes its CoM with a horizontal force F and a moment tau
that passes to the ground. Moments about the ZMP give

    x'' = w^2 (x - u_ref) + F / m + w^2 [tau_y, -tau_x] / (m g) = w^2 (x - u),    u = u_ref - (u_F + u_tau),

so both push the CoM away (printed: u_F - u_tau). The vertical force is left out.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import positive
from plantar.common.arrays import array
from plantar.common.gravity import GRAVITY


def vrp_offset(wrench: ArrayLike, mass: float, omega: float, virtual_mass: float = 1.0) -> NDArray[np.float64]:
    """Offset u_w = u_F + u_tau (..., 2) in m of the VRP by a wrench on the body: u = u_ref - u_w (K 9-11 corrected).

    `wrench`: wrench (..., 6) about CoM in axes with z up in N and N m, by world on robot; `mass`: mass of robot in kg,
    above 0; `omega`: pendulum frequency sqrt(g / z) in rad/s, above 0; `virtual_mass`: nu of K 10-11: share of mass
    that answers a push; a smaller one yields more. Returns ZMP at which wrench would not accelerate CoM.

    Example:
        >>> hip = vrp_offset([50.0, 0.0, 0.0, 0.0, 0.0, 0.0], 86.0, 3.44)
        >>> shoulder = vrp_offset([50.0, 0.0, 0.0, 0.0, 20.0, 0.0], 86.0, 3.44)
        >>> [round(float(u), 4) for u in (*hip, *shoulder)]
        [0.0491, 0.0, 0.0728, 0.0]
    """
    given = array(wrench, "wrench", (..., 6))
    rate = positive(omega, "pendulum frequency", "rad/s")
    carried = positive(mass, "mass", "kg") * positive(virtual_mass, "share of the mass", "1")
    if given.ndim == 1:
        fx, fy, _, tx, ty, _ = given.tolist()
        by_force = 1.0 / (carried * rate * rate)
        by_moment = 1.0 / (carried * GRAVITY)
        return np.array((fx * by_force + ty * by_moment, fy * by_force - tx * by_moment))
    out = np.empty((*given.shape[:-1], 2))
    with np.errstate(over="ignore", invalid="ignore"):  # of wrenches that are not finite
        out[..., 0] = given[..., 0] / (carried * rate * rate) + given[..., 4] / (carried * GRAVITY)
        out[..., 1] = given[..., 1] / (carried * rate * rate) - given[..., 3] / (carried * GRAVITY)
    return out


def external_acceleration(
    wrench: ArrayLike, mass: float, omega: float, virtual_mass: float = 1.0
) -> NDArray[np.float64]:
    """Horizontal acceleration w^2 u_w (..., 2) in m/s^2 of the CoM by a wrench, at a fixed ZMP (K 12)."""
    return np.asarray(vrp_offset(wrench, mass, omega, virtual_mass) * float(omega) ** 2)
