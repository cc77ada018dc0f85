"""Swing with changeable touchdown, smooth up to acceleration.

Horizontally and in heading a fifth-order polynomial goes to rest at the new place; vertically the trajectory's clock
changes rate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.gait.feet.swing import SwingTrajectory
from plantar.gait.feet.swing_kind import SwingKind, SwingStart, hurried
from plantar.mechanics.easing import minimum_jerk
from plantar.mechanics.same_time import SAME_TIME

# shares of a swing that only descends, blind or seeing the ground early
_END = 0.06  # chosen: of a blind one: 50 ms of 0.9 s
_EARLY_END = 0.25  # chosen: of one that sees the ground early: time to come down by sight
_SPARE = 0.12  # chosen: share left of a seeing one
# and spent rising
_LIFT = 0.45  # chosen: of a blind one
_EARLY_LIFT = 0.28  # chosen: of one that sees the ground early; bounded by the knee's speed
_LONG_LIFT = 0.42  # chosen: from which on a seeing swing arrives as late as a blind one, wholly from _LIFT on
# chosen: leg/beat at most of a rise, which the knee's speed bounds, unless it would last as long as others'
_QUICKEST = 0.26
_PEAK = 1.875  # nature: largest speed of a minimum-jerk motion over its mean; 15/8
_RAMP = 0.2  # chosen: share of the time left in which the clock comes to its new rate
# derived: s of the differences that velocity and acceleration are taken from; the fourth root of a rounding, best for
# second differences
_STEP = 1e-4
_LATE = 0.85  # chosen: of the time left in which a foot that is above its old place already goes to the new one


@dataclass(frozen=True)
class _Clock:
    """Trajectory time over flight time, with smooth rate."""

    since: float
    shown: float
    rate: float
    last: float
    until: float
    shows: float

    @classmethod
    def to(cls, since: float, shown: float, rate: float, until: float, shows: float) -> _Clock:
        """Clock through a time and rate at one moment, and a later time."""
        left = until - since
        last = (shows - shown - rate * left) / (left * (1.0 - 0.5 * _RAMP)) + rate
        return cls(since, shown, rate, last, until, shows)

    def at(self, time: float) -> float:
        if time >= self.until:
            return self.shows
        length = self.until - self.since
        s = max(0.0, time - self.since) / length
        # Integral of a rate that rises linearly and then stays: no jump in speed by any change of the plan.
        ramp = 0.5 * s * s / _RAMP if s < _RAMP else s - 0.5 * _RAMP
        return self.shown + length * (self.rate * s + (self.last - self.rate) * ramp)


@dataclass(frozen=True)
class _Course:
    """Horizontal position and heading (3,), fifth order, ending at rest."""

    since: float
    until: float
    coefficients: NDArray[np.float64]

    @classmethod
    def to(
        cls,
        since: float,
        until: float,
        start: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
        end: NDArray[np.float64],
    ) -> _Course:
        t = until - since
        p, v, a = start
        v = t * v
        a = t * t * a
        way = end - p
        # nature: The fifth-order polynomial in s = 0..1 with speed and acceleration given at its start and zero at its
        # end.
        third = 10.0 * way - 6.0 * v - 1.5 * a
        fourth = -15.0 * way + 8.0 * v + 1.5 * a  # nature: the same polynomial
        fifth = 6.0 * way - 3.0 * v - 0.5 * a  # nature: the same polynomial
        return cls(since, until, np.array([p, v, 0.5 * a, third, fourth, fifth]))

    def at(self, time: float) -> NDArray[np.float64]:
        s = min(1.0, max(0.0, (time - self.since) / (self.until - self.since)))
        value = np.zeros(3)
        # Horner's rule.
        for c in self.coefficients[::-1]:
            value = value * s + c
        return value


@dataclass(frozen=True)
class SwingFlight:
    """Motion of a swing foot.

    `duration` from lift-off to planned touchdown in s; `end`: planned sole (3,) at touchdown in m; `yaw_end`: heading
    in rad at touchdown; `period` of control in s; `least_time`: time in s to touchdown below which it is not aimed
    again.

    Example:
        >>> path = SwingTrajectory(np.zeros(3), np.array([0.2, 0.0, 0.0]), 0.0, 0.0, 0.05, 0.9)
        >>> flight = SwingFlight(path, path.duration, path.end, 0.0, 0.005, 0.1)
        >>> flight.aimed(0.4, np.array([0.3, 0.05]), 0.0, 1.2).at(1.2)[0].round(6).tolist()
        [0.3, 0.05, 0.0]
    """

    path: SwingTrajectory
    duration: float
    end: NDArray[np.float64]
    yaw_end: float
    period: float
    least_time: float
    _clock: _Clock | None = None
    _course: _Course | None = None

    def progress(self, time: float) -> float:
        """Time in s on the trajectory's clock, at a time in s since lift-off."""
        return time if self._clock is None else self._clock.at(time)

    def risen(self, time: float) -> float:
        """Share 0..1 of the rise done."""
        progress = time if self._clock is None else self._clock.at(time)
        lifted = self.path.kernel.lifted
        return minimum_jerk(progress / lifted)[0] if progress < lifted else 1.0

    def falling(self, time: float, height: float) -> float:
        """Returns the downward speed in m/s at a time and height in m."""
        return (height - self.along(time + self.period)[0].item(2)) / self.period

    def comes_down(self, time: float) -> bool:
        """Whether half of the swing is over at a time in s since lift-off."""
        progress = time if self._clock is None else self._clock.at(time)
        return progress > 0.5 * self.path.duration

    def along(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad at a time in s since lift-off; held outside."""
        position, yaw = self.path.kernel.at(time if self._clock is None else self._clock.at(time))
        if self._course is not None and time >= self._course.since:
            x, y, yaw = self._course.at(time).tolist()
            position[:2] = x, y
        return position, yaw

    at = along  # a swing that is fitted is elsewhere (`plantar.gait.feet.swing_fit`)

    def aimed(self, time: float, place: NDArray[np.float64], yaw: float, duration: float) -> SwingFlight:
        """Returns the flight with a new end from now; unchanged if too late.

        `time`: now in s since lift-off; `place`: sole (2,) at touchdown in m; `yaw` at touchdown in rad; `duration`
        from lift-off to touchdown in s.
        """
        old = self.duration - time
        new = duration - time
        if min(old, new) < self.least_time:
            return self
        shown = self.progress(time)
        rate = (self.progress(time + _STEP) - shown) / _STEP
        clock = self._clock
        if abs(duration - self.duration) > SAME_TIME:
            spare = self.path.spare if hurried(duration, self.path.duration) else 0.0
            clock = _Clock.to(time, shown, rate, duration, max(shown, (1.0 - spare) * self.path.duration))
        end = np.array([place[0], place[1], self.end[2]])
        flight = replace(self, duration=duration, end=end, _clock=clock)
        left = (self.path.arrived - shown) / (self.path.duration - shown)
        until = time + new * max(left, _LATE)
        before, now, after = (self._horizontal(time + k * _STEP) for k in (-1, 0, 1))
        start = (now, (after - before) / (2.0 * _STEP), (after - 2.0 * now + before) / _STEP**2)
        turn = now[2] + math.remainder(yaw - now[2], 2.0 * math.pi)
        course = _Course.to(time, until, start, np.array([place[0], place[1], turn]))
        return replace(flight, yaw_end=turn, _course=course)

    def _horizontal(self, time: float) -> NDArray[np.float64]:
        position, yaw = self.along(max(0.0, time))
        return np.array([position[0], position[1], yaw])


class PolynomialSwing(SwingKind):
    """Swings by time polynomials, which change only with the plan."""

    def begin(self, start: SwingStart) -> SwingFlight:
        """Flight at its begin."""
        rise = start.height + max(0.0, (start.end - start.position).item(2))
        lasts = _PEAK * rise / (_QUICKEST * self.body.in_si("leg/beat") * start.duration)
        # A rise that lasts as long as others' do by their share of time leaves none for an early arrival.
        late = max(start.haste, min(1.0, (lasts - _LONG_LIFT) / (_LIFT - _LONG_LIFT)))
        early = 1.0 - late if start.sees_ground else 0.0
        path = SwingTrajectory(
            start.position,
            start.end,
            start.yaw,
            start.yaw_end,
            start.height,
            start.duration,
            lift_share=min(_LIFT, max(_LIFT - early * (_LIFT - _EARLY_LIFT), lasts)),
            lateral_end=_END + early * (_EARLY_END - _END),
            spare=early * _SPARE,
            approach_height=start.approach_height,
            approach_speed=start.approach_speed,
            rises_first=start.rises_first,
        )
        return SwingFlight(path, path.duration, path.end, path.yaw_end, start.period, start.least_time)
