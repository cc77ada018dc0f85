"""Piecewise linear virtual repellent points, with DCM and CoM (T 4.9-4.16).

On a segment of duration T, x'' = w^2 (x - p) and xi' = w (xi - p) have the solutions

    xi(t) = p(t) + p'/w + A e^(w t)              x(t) = p(t) + A/2 e^(w t) + B e^(-w t)

DCM waypoints go backward from the last knot (T 4.14 corrected: xi_i = r + e^(-w T) (xi_(i+1) - r) for a constant VRP),
the CoM forward; segments are evaluated from their end, so no exponential grows. Later knots moved together keep A e^(w
T), so `replanned` solves only new knots.
"""

import math
from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.record import Record
from plantar.errors import InputError
from plantar.kernels.mechanics.pendulum import PendulumCourse, sums


class LipReference(Record, frozen=True):
    """The plan at a time, horizontal, world frame.

    `vrp`: and ZMP on the ground (2,) in m; `dcm` (2,) in m; `dcm_velocity`: its rate (2,) in m/s; `com` (2,) in m;
    `com_velocity`: its rate (2,) in m/s; `com_acceleration` (2,) in m/s^2.
    """

    vrp: NDArray[np.float64]
    dcm: NDArray[np.float64]
    dcm_velocity: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]

    def plus(self, shift: Self) -> Self:
        """This plan plus the DCM and CoM of another VRP."""
        return type(self)(self.vrp, *sums(self, shift))


class VrpPlan:
    """DCM and CoM over a piecewise linear VRP.

    `times`: knots' (k,) in s, strictly increasing, k >= 2; `vrps` at knots (k, 2) in m; `omega`: pendulum's in rad/s;
    `com` at the first knot (2,) in m; None for the first VRP.
    """

    def __init__(self, times: Sequence[float], vrps: ArrayLike, omega: float, com: ArrayLike | None = None) -> None:
        knots = np.ascontiguousarray(times, dtype=float)
        points = np.ascontiguousarray(vrps, dtype=float)
        if knots.ndim != 1 or len(knots) < 2 or points.shape != (len(knots), 2):
            raise InputError(f"a VRP plan needs k >= 2 times and (k, 2) points; got {knots.shape} and {points.shape}")
        if not (np.isfinite(knots).all() and np.isfinite(points).all() and (np.diff(knots) > 0.0).all()):
            raise InputError("a VRP plan needs finite points at strictly increasing finite times")
        segments = len(knots) - 1
        self._keep(knots, points, np.empty((segments, 2)), np.empty((segments, 2)), np.empty((segments + 1, 2)), omega)
        self.dcm_waypoints[-1] = points[-1]  # the plan ends at rest on its last VRP
        self._solve(segments)
        self._start_com(points[0] if com is None else np.asarray(com, dtype=float))

    def _keep(
        self,
        times: NDArray[np.float64],
        vrps: NDArray[np.float64],
        rate: NDArray[np.float64],
        end_offset: NDArray[np.float64],
        waypoints: NDArray[np.float64],
        omega: float,
    ) -> None:
        self.times: tuple[float, ...] = tuple(times.tolist())
        self._times = times
        self.vrps = vrps
        self.omega = omega
        self.dcm_waypoints = waypoints
        self._rate = rate
        self._end_offset = end_offset  # A e^(w T) of each segment

    def _solve(self, segments: int) -> None:
        """Backward pass: first segments' rates, offsets and DCM waypoints from their end's."""
        omega = self.omega
        times = self.times
        x, y = self.dcm_waypoints[segments].tolist()
        points = self.vrps[: segments + 1].tolist()
        for i in range(segments - 1, -1, -1):
            ax, ay = points[i]
            bx, by = points[i + 1]
            length = times[i + 1] - times[i]
            rx = (bx - ax) / length
            ry = (by - ay) / length
            ox = x - bx - rx / omega
            oy = y - by - ry / omega
            decay = math.exp(-omega * length)
            x = ax + rx / omega + decay * ox
            y = ay + ry / omega + decay * oy
            self._rate[i] = rx, ry
            self._end_offset[i] = ox, oy
            self.dcm_waypoints[i] = x, y

        for array in (self._times, self.vrps, self.dcm_waypoints):
            array.flags.writeable = False  # handed out: a plan is changed by making another one

    def _start_com(self, com: NDArray[np.float64]) -> None:
        self._course = PendulumCourse(
            self.omega, self._times, self.vrps, self._rate, self._end_offset, (float(com[0]), float(com[1]))
        )

    def replanned(
        self,
        times: Sequence[float],
        vrps: ArrayLike,
        first: int,
        *,
        shift: ArrayLike = (0.0, 0.0),
        delay: float = 0.0,
    ) -> "VrpPlan":
        """The plan over other knots, without solving kept ones again.

        `times`: new knots' (m,) in s, strictly increasing, from now; `vrps`: theirs (m, 2) in m; `first`: first kept
        knot's index; the number of knots keeps none; `shift`: kept knots' (2,) in m; `delay`: theirs in s. Returns the
        plan, from the CoM now.
        """
        head = np.asarray(times, float)
        points = np.asarray(vrps, float).reshape(-1, 2)
        move = np.asarray(shift, float)
        m = len(head)
        knots = np.concatenate([head, self._times[first:] + delay])
        every = np.concatenate([points, self.vrps[first:] + move])
        finite = np.isfinite(knots).all() and np.isfinite(every).all()
        if (
            not m
            or head.ndim != 1
            or len(points) != m
            or len(knots) < 2
            or not finite
            or not (np.diff(knots) > 0).all()
        ):
            raise InputError("a plan goes on over finite points (m, 2) at strictly increasing finite times (m,)")
        kept = len(knots) - m
        unsolved = m if kept else m - 1
        new = object.__new__(VrpPlan)
        waypoints = np.empty_like(every)
        if kept:
            waypoints[m:] = self.dcm_waypoints[first:] + move
        else:
            waypoints[-1] = every[-1]
        gap = np.empty((unsolved, 2))
        new._keep(
            knots,
            every,
            np.concatenate([gap, self._rate[first:]]),
            np.concatenate([gap, self._end_offset[first:]]),
            waypoints,
            self.omega,
        )
        new._solve(unsolved)
        new._start_com(self.at(float(head[0])).com)
        return new

    def at(self, time: float) -> LipReference:
        """VRP, DCM and CoM with rates at a `time` in s; first knot before, last VRP after."""
        if time < self.times[-1]:
            return LipReference(*self._course.at(time))
        omega = self.omega
        vrp = self.vrps[-1]
        offset = math.exp(-omega * (time - self.times[-1])) * (self._course.end() - vrp)
        zero = np.zeros(2)
        return LipReference(vrp, vrp, zero, vrp + offset, -omega * offset, omega * omega * offset)
