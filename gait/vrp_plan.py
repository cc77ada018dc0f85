"""VRP plan: piecewise linear virtual repellent points, and the DCM and CoM that follow from them (T 4.9-4.16).

Between two knots the VRP p moves linearly (it stays during single support and moves to the next foot during double
support). On such a segment of duration T the pendulum x'' = w^2 (x - p) and the DCM xi' = w (xi - p) have the closed
solutions

    xi(t) = p(t) + p'/w + A e^(w t)              x(t) = p(t) + A/2 e^(w t) + B e^(-w t)

The DCM is unstable forward in time, so its waypoints run backward from the last knot (T 4.14 corrected:
xi_i = r + e^(-w T) (xi_(i+1) - r) for a constant VRP), and each segment is evaluated from its END: A e^(w (t - T))
never grows, whatever the length of the plan. The CoM is stable forward in time and runs forward.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError

__all__ = ["LipReference", "VrpPlan"]


@dataclass(frozen=True)
class LipReference:
    """The plan at one time, in the horizontal plane of the world frame.

    Attributes:
        vrp: Reference VRP, which is the reference ZMP on the ground, (2,) in m.
        dcm: Reference DCM (2,) in m.
        dcm_velocity: Its rate (2,) in m/s.
        com: Reference CoM (2,) in m.
        com_velocity: Its rate (2,) in m/s.
        com_acceleration: Its second rate (2,) in m/s^2.
    """

    vrp: NDArray[np.float64]
    dcm: NDArray[np.float64]
    dcm_velocity: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]


class VrpPlan:
    """DCM and CoM trajectories over a piecewise linear VRP.

    Args:
        times: Knot times (k,) in s, strictly increasing, k >= 2.
        vrps: VRP (k, 2) at each knot in m.
        omega: Pendulum frequency in rad/s.
        com: CoM (2,) at the first knot in m; the first VRP where None.

    Raises:
        InputError: If the knots are not finite, not increasing, or of other shapes.

    Example:
        >>> plan = VrpPlan([0.0, 1.0, 1.3, 3.0], [[0, 0], [0, 0], [0, 0.1], [0, 0.1]], omega=3.5)
        >>> plan.at(3.0).dcm.tolist()
        [0.0, 0.1]
    """

    def __init__(self, times: Sequence[float], vrps: ArrayLike, omega: float, com: ArrayLike | None = None) -> None:
        knots = np.asarray(times, dtype=float)
        points = np.asarray(vrps, dtype=float)
        if knots.ndim != 1 or len(knots) < 2 or points.shape != (len(knots), 2):
            raise InputError(f"a VRP plan needs k >= 2 times and (k, 2) points; got {knots.shape} and {points.shape}")
        if not (np.isfinite(knots).all() and np.isfinite(points).all() and (np.diff(knots) > 0.0).all()):
            raise InputError("a VRP plan needs finite points at strictly increasing finite times")
        if not (math.isfinite(omega) and omega > 0.0):
            raise InputError(f"pendulum frequency is {omega} rad/s; allowed: above 0")
        self.times: list[float] = knots.tolist()
        self.vrps = points
        self.omega = omega
        duration = np.diff(knots)
        self._rate = np.diff(points, axis=0) / duration[:, None]
        # Backward: DCM waypoints, with the plan ending at rest on its last VRP.
        waypoints = np.empty_like(points)
        waypoints[-1] = points[-1]
        self._end_offset = np.empty_like(self._rate)  # A e^(w T) of each segment
        for i in range(len(duration) - 1, -1, -1):
            self._end_offset[i] = waypoints[i + 1] - points[i + 1] - self._rate[i] / omega
            waypoints[i] = points[i] + self._rate[i] / omega + math.exp(-omega * duration[i]) * self._end_offset[i]
        self.dcm_waypoints = waypoints
        # Forward: CoM at the knots.
        start = points[0] if com is None else np.asarray(com, dtype=float)
        self._com_offset = np.empty_like(self._rate)  # B of each segment
        for i, length in enumerate(duration):
            growing = 0.5 * math.exp(-omega * length) * self._end_offset[i]
            self._com_offset[i] = start - points[i] - growing
            start = points[i + 1] + 0.5 * self._end_offset[i] + math.exp(-omega * length) * self._com_offset[i]
        self._last_com = start

    @property
    def duration(self) -> float:
        """Time in s from the first to the last knot."""
        return self.times[-1] - self.times[0]

    def at(self, time: float) -> LipReference:
        """The plan at one time; before its start the first knot holds, after its end the CoM settles on the last VRP.

        Args:
            time: Time in s.

        Returns:
            VRP, DCM and CoM with their rates.
        """
        omega = self.omega
        if time >= self.times[-1]:
            vrp = self.vrps[-1]
            offset = math.exp(-omega * (time - self.times[-1])) * (self._last_com - vrp)
            zero = np.zeros(2)
            return LipReference(vrp, vrp, zero, vrp + offset, -omega * offset, omega * omega * offset)
        time = max(time, self.times[0])
        i = bisect_right(self.times, time) - 1
        since, until = time - self.times[i], self.times[i + 1] - time
        rate = self._rate[i]
        vrp = self.vrps[i] + since * rate
        growing = math.exp(-omega * until) * self._end_offset[i]
        shrinking = math.exp(-omega * since) * self._com_offset[i]
        return LipReference(
            vrp=vrp,
            dcm=vrp + rate / omega + growing,
            dcm_velocity=rate + omega * growing,
            com=vrp + 0.5 * growing + shrinking,
            com_velocity=rate + omega * (0.5 * growing - shrinking),
            com_acceleration=omega * omega * (0.5 * growing + shrinking),
        )
