"""CoM and DCM of a pushed pendulum: stationary Kalman filter with the measured push (after K 7-12).

Each axis, sampled exactly, with d the offset by a push on parts without skin:

    x' = w (xi - x),    xi' = w (xi - p + u_w + d),    d' = 0 + noise.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share


class DcmFilterRules(Part, table="dcm_filter", needs={"control.dcm_estimate": ("kalman",)}):
    """Standard deviations at a tick.

    Attributes:
        unfelt_rate: Change in m/s of an unmeasured push's offset; 0 counts it as ZMP noise.
    """

    com_noise: float = fixed(0.00333, "leg")  # Of the kinematic CoM in m; chosen: 2 mm on h1
    # Of the ZMP, less the measured offset, in m; measured: 10 mm on h1, as a run's `zmp_error_rms_m` (10.5 mm in
    # `partial-rear`)
    zmp_noise: float = fixed(0.04, "sole")
    unfelt_rate: float = share(0.495, "sole/beat", 0, 100)  # chosen: 0.5 m/s on h1


class PushedPendulum(NamedTuple):
    """State of a `DcmFilter`.

    `com`: CoM (2,) in m; `dcm`: DCM (2,) in m; `unfelt`: VRP offset (2,) in m by a push that no skin measures.
    """

    com: NDArray[np.float64]
    dcm: NDArray[np.float64]
    unfelt: NDArray[np.float64]


class DcmFilter:
    """CoM and DCM from kinematic CoM, ZMP and measured push. `omega`: pendulum's in rad/s; `period` of control in s."""

    def __init__(self, rules: DcmFilterRules, omega: float, period: float) -> None:
        c = math.cosh(omega * period)
        s = math.sinh(omega * period)
        self._input = np.array([1.0 - c, 1.0 - c - s])  # of the VRP, on x and xi
        own = np.array([[c - s, s], [0.0, c + s]])
        count = 3 if rules.unfelt_rate > 0.0 else 2  # nature: position, DCM and offset
        self._step = np.eye(count)
        self._step[:2, :2] = own
        noise = np.zeros((count, count))
        noise[:2, :2] = rules.zmp_noise**2 * np.outer(self._input, self._input)
        noise += 1e-18 * np.eye(count)  # nature: m^2: keeps the covariance regular
        if count == 3:  # nature: position, DCM and offset
            self._step[:2, 2] = -self._input
            noise[2, 2] = (rules.unfelt_rate * period) ** 2
        self._gain = _stationary_gain(self._step, noise, np.eye(1, count), np.array([[rules.com_noise**2]]))
        self._state: NDArray[np.float64] | None = None

    def reset(self) -> None:
        """Restart at the next update."""
        self._state = None

    def update(self, com: ArrayLike, zmp: ArrayLike | None, offset: ArrayLike) -> PushedPendulum:
        """Returns CoM and DCM after a tick; at first as measured, at rest.

        By the kinematic `com` (2,) in m, the `zmp` (2,) since the last tick in m, None without load, and the VRP's
        `offset` u_w (2,) by the measured push in m (`plantar.mechanics.external_wrench.vrp_offset`).
        """
        place = np.asarray(com, dtype=float)
        felt = np.asarray(offset, dtype=float)
        if self._state is None:
            self._state = np.zeros((len(self._step), 2))
            self._state[:2] = place
            return self._told()
        # Without ground the only acceleration is that of the push: as with the ZMP under the CoM.
        ground = self._state[0] if zmp is None else np.asarray(zmp, dtype=float)
        state = self._step @ self._state
        state[:2] += np.outer(self._input, ground - felt)
        state += self._gain * (place - state[0])
        self._state = state
        return self._told()

    def _told(self) -> PushedPendulum:
        state = self._state
        assert state is not None
        return PushedPendulum(state[0].copy(), state[1].copy(), state[2].copy() if len(state) == 3 else np.zeros(2))


def _stationary_gain(
    step: NDArray[np.float64], noise: NDArray[np.float64], measured: NDArray[np.float64], error: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Kalman gain (n, m) from the discrete Riccati equation, by doubling (Chu, Fan, Lin, Wang, Int. J. Control 77,
    2004).
    """
    one = np.eye(len(step))
    a = step.T
    g = measured.T @ np.linalg.solve(error, measured)
    p = noise
    for _ in range(60):
        w = np.linalg.solve(one + g @ p, np.hstack([a, g]))
        wa = w[:, : len(one)]
        wg = w[:, len(one) :]
        more = a.T @ p @ wa
        g = g + a @ wg @ a.T
        a = a @ wa
        p = p + more
        if np.abs(more).max() <= 1e-15 * np.abs(p).max():  # nature: floating point, five roundings
            break
    p = 0.5 * (p + p.T)
    return np.asarray(np.linalg.solve(measured @ p @ measured.T + error, measured @ p).T)
