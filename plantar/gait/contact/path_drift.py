"""Drift of the walked ground relative to the planned steps, by edges that landed soles see."""

import math

import numpy as np
from numpy.typing import NDArray

# measured: rad/s by which headings turn on drawn plants (level 2), root mean square: 2.5e-4 in 11 walks of hrp2kai,
# 1.3e-4 in 6 of h1. At 20 % less and more hrp2kai completes `uneven` on the plant that turns most, 4 degrees, as well
_BIAS = 2.7e-4

# derived: rad/sqrt(s) by which a heading turns by chance: a foot turns by 0.3 mrad in a second of single support
_TURN = 3e-4

_PLAUSIBLE = 3.0  # chosen: standard deviations beyond which no drift has brought an edge: the ground has that shape

_SHAPE = 6.0  # chosen: landings for which such ground is expected to go on; three of each foot


class PathDrift:
    """Kalman filter of the ground's offset y and heading p to the left of the steps to come.

    Dead reckoning turns by the bias b that identification leaves of the gyro's. In a time t with a way d ahead

        y += d (p + t b / 2),  p += t b,  b *= exp(-t / T)

    with b of standard deviation `_BIAS` at any time. A walk begins on ground that it stands on: y = p = 0. An edge
    measures y. One that no drift can have brought there shows the shape of the ground: for some landings, edges measure
    y with as large an error.

    `spread`: standard deviation in m of an edge; `time_constant`: T in s, in which a bias is identified again.
    Attribute `seen`: whether there was an edge; before, offset and heading are 0.
    """

    def __init__(self, spread: float, time_constant: float) -> None:
        self.seen = False
        self._variance = spread**2
        self._shape = 0.0
        self._time_constant = time_constant
        self._time = math.nan
        self._state = np.zeros(3)
        self._covariance = np.diag([0.0, 0.0, _BIAS**2])

    def offset(self, way: float) -> float:
        """Offset in m of the ground to the left of the steps, a `way` in m ahead of the last landing."""
        y, heading, _ = self._state.tolist()
        return float(y + way * heading)

    def moved(self, left: float) -> None:
        """The steps to come have moved to their left, by as much in m."""
        self._state[0] -= left

    def landed(self, time: float, way: float, edge: float | None) -> None:
        """Update by a landing.

        `time` in s; `way` in m ahead of the last one; `edge`: left shift in m that puts the whole sole on the ground;
        None without an edge.
        """
        if not math.isnan(self._time):
            self._predict(time - self._time, way)
        self._time = time
        if edge is not None:
            self._update(edge)

    def _predict(self, duration: float, way: float) -> None:
        kept = math.exp(-duration / self._time_constant)
        change = np.array([[1.0, way, 0.5 * way * duration], [0.0, 1.0, duration], [0.0, 0.0, kept]])
        noise = np.diag([0.0, _TURN**2 * duration, _BIAS**2 * (1.0 - kept**2)])
        self._state = change @ self._state
        self._covariance = change @ self._covariance @ change.T + noise
        self._shape *= math.exp(-1.0 / _SHAPE)

    def _update(self, edge: float) -> None:
        self.seen = True
        missed = edge - float(self._state[0])
        along: NDArray[np.float64] = self._covariance[0]
        variance = float(along[0]) + self._variance
        if missed**2 > _PLAUSIBLE**2 * variance:
            self._shape = max(self._shape, missed**2)
        gain = along / (variance + self._shape)
        self._state = self._state + missed * gain
        self._covariance = self._covariance - np.outer(gain, along)
