"""Preemptive foot compliance: a swing that sees the ground before it touches it (T 4.4.1, Fig. 49).

What the taxels measure on their way down is kept as one map of distances, carried along with the sole as it moves, so
that noise averages out though nothing stands still. A plane through the highest ground under the sole gives how far
the first contact is and which way the ground slopes.

- Damping: on level ground the virtual force of T 4.26 is f_p = n k_p (range - distance); slowing down in proportion to
  the distance that is left is slowing down by f_p. The swing ends at a crawl, where T 4.31 stops at f_p > epsilon_stop:
  so it meets what noise and bias leave of the distance.
- Orientation: the sole turns until the ground shows no slope, or until the virtual moment is zero.
- Hand-over: once the taxels carry load, T 4.30 (corrected) drops the virtual part.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gait.estimator import rotation_from_vector
from plantar.kernels.highest_ground import highest_plane
from plantar.layout import SoleLayout
from plantar.percept import Percept
from plantar.percept_virtual import PROXIMITY_GAIN
from plantar.virtual_wrench import SoleWrenchSwitch, virtual_ground_reaction_wrench

__all__ = ["ComplianceGains", "GroundView", "SwingCompliance", "turned_to_ground", "vector_from_rotation"]


_LARGEST_LESSON = 0.0015  # m that one touch changes the bias by: more is ground that moved
_DOUBT = 0.001  # m past the ground that it sees at which a sole that has not touched goes down twice as fast
_LARGEST_DRIFT = 0.005  # m/s that a body moves up or down above a foot that has touched
_EVEN = 0.9  # share of the taxels that see ground which lies on a plane where all of it is one
_LIFTED_OFF = 0.005  # m that a sole has risen when it is compared with the distance it sees
_LEAST_NOISE = 0.002  # m: standard deviation of a taxel's distance that is expected at least
_NOISE_SHARE = 0.02  # share of a reading in what is known of that
_SIGMA_OF_MEDIAN = 1.4826  # of the median of the absolute values of normal noise
_LEAST_BIAS = 0.75  # standard deviations of a taxel's distance that noise cannot make of that
_SLOPE_OF_NOISE = 0.015  # tangent of the slope that level ground may seem to have
_REMEMBERED = 12  # control ticks for which poses are kept, for readings that are late


@dataclass(frozen=True)
class ComplianceGains:
    """Settings of preemptive foot compliance.

    Attributes:
        orientation: "plane" turns the sole by the plane fitted to the distances, "moment" by the virtual moment.
        sensing_range: Range of the proximity sensors in m.
        damping: Smallest time constant in s with which the swing comes to the ground: speed = touch_speed + distance /
            time constant.
        touch_speed: Speed in m/s at which it touches.
        margin: Distance in m from the ground at which it is down to that speed.
        top_speed: Largest speed downwards in m/s.
        acceleration: Largest acceleration downwards in m/s^2.
        clearance: Distance in m from the ground that the foot keeps at most while it still moves horizontally.
        clearance_slope: The same, for each metre that it still has to go.
        correction: Time constant in s with which the foot follows the distance that it should have.
        steepness: Power of the time that is left with which a descent that has time to spare comes to the ground.
        crawl_time: Time in s before the plan puts weight on the foot at which it is there.
        reserve: The same at which a foot that has not touched hurries down; it begins at twice that.
        haste: How many times faster it touches then.
        turning: Time constant in s with which the sole turns to the ground.
        turn_rate: Largest rate of that in rad/s; close to the ground it is less (see `SwingCompliance.turn_rate`).
        largest_slope: Slope in rad beyond which the sole does not follow the ground.
        follow_taxels: Number of taxels that must lie on a slope for the sole to follow it.
        ankle_reach: Slope across the foot, rising outwards, in rad that an ankle can follow on one leg, which leans
            outwards itself; on a steeper one the body stays further inside.
        contact_force: Force in N that counts as touchdown.
        touch_force: Force in N that a foot carries at first.
        hold_force: Force in N that it carries from then on to the double support.
        firming: Time in s from the one to the other.
        pliancy: Speed in m/s with which a foot on the ground yields to each newton of force that it should not have.
        settling: Time constant in s with which it learns how fast the body above it moves up or down.
        readings: Number of readings that the map of distances averages over while the sole stands still.
        readings_moving: The same while it moves fast.
        still: Move in m a control tick that halves it.
        jump: Difference from the map, in standard deviations of the readings, by which one of them shows that the
            ground has moved.
        jump_of_all: The same for the mean of all taxels, which is less noisy.
    """

    orientation: str = "plane"
    sensing_range: float = 0.05
    damping: float = 0.04
    touch_speed: float = 0.002
    margin: float = 0.0002
    top_speed: float = 0.3
    acceleration: float = 4.0
    clearance: float = 0.012
    clearance_slope: float = 0.2
    correction: float = 0.03
    steepness: float = 3.0
    crawl_time: float = 0.3
    reserve: float = 0.08
    haste: float = 2.5
    turning: float = 0.04
    turn_rate: float = 1.5
    largest_slope: float = 0.25
    follow_taxels: int = 10
    ankle_reach: float = 0.095
    contact_force: float = 18.0
    touch_force: float = 20.0
    hold_force: float = 30.0
    firming: float = 0.15
    pliancy: float = 1e-4
    settling: float = 0.1
    readings: int = 60
    readings_moving: int = 5
    still: float = 0.0001
    jump: float = 6.0
    jump_of_all: float = 1.5


@dataclass(frozen=True)
class GroundView:
    """The ground under a swinging sole.

    Attributes:
        distance: How far down in m the first contact is.
        middle: How far down in m the ground is under the middle of the sole; the same where it is no plane.
        slope: Rise of the ground along the sole's x and y (tangents) that the sole has to turn by; None where there is
            too little of it to follow.
        even: Whether nearly all that is seen of the ground lies on one plane.
    """

    distance: float
    middle: float
    slope: tuple[float, float] | None
    even: bool = True


class SwingCompliance:
    """What one sole sees and feels from lift-off to the end of its landing.

    Args:
        layout: The sole.
        gains: Settings.
    """

    def __init__(self, layout: SoleLayout, gains: ComplianceGains) -> None:
        self.layout = layout
        self.gains = gains
        self.switch = SoleWrenchSwitch(gains.contact_force)
        self.bias = 0.0
        self.force = 0.0
        self._x, self._y = layout.positions[:, 0].copy(), layout.positions[:, 1].copy()
        self._corners = layout.outline
        self._centre = layout.positions.mean(axis=0)
        self._arm = 0.5 * float(np.linalg.norm(np.ptp(self._corners, axis=0)))  # m from the middle to an edge
        self._spread = ((layout.positions - self._centre) ** 2).mean(axis=0)[:2]
        self._distance = np.full(len(layout), np.inf)
        self._readings = np.zeros(len(layout))
        self._on_plane = np.zeros(len(layout), dtype=np.uint8)
        self._plane = np.zeros(3)
        self._read = -math.inf
        self._most = float(gains.readings_moving)
        self._noise = _LEAST_NOISE
        self._rising = False
        self._stood: float | None = None
        self._liftoff: float | None = None
        self._poses: deque[tuple[float, NDArray[np.float64], NDArray[np.float64]]] = deque(maxlen=_REMEMBERED)
        self._rise = np.zeros(len(layout))  # of each taxel from the last pose but one to the last
        self._speed = self._drift = 0.0
        self._aim: float | None = None

    @property
    def distance(self) -> NDArray[np.float64]:
        """Distance (n,) of each taxel from the ground in m, less the bias; inf or NaN where nothing is seen."""
        return self._distance - self.bias

    def begin(self) -> None:
        """A swing begins."""
        self._distance[:] = np.inf
        self._readings[:] = 0.0
        self._read = -math.inf
        self._poses.clear()
        self._rising = True
        self._liftoff, self._stood = self._stood, None
        self._speed = self._drift = 0.0
        self._aim = None
        self.switch.reset()
        self.force = 0.0

    def stand(self, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> None:
        """The sole carries load here: it lifts off from the last height at which it did.

        Args:
            position: Sole position (3,) in the world as estimated in m.
            rotation: Rotation (3, 3) from the sole to the world as estimated.
        """
        self._stood = self._height(position, rotation)

    def feel(self, load: float) -> bool:
        """Whether the foot has landed (T 4.30 corrected).

        Args:
            load: Vertical force in N on the sole, less its tare.
        """
        self.force += 0.5 * (load - self.force)
        up = np.array([0.0, 0.0, self.force, 0.0, 0.0, 0.0])
        self.switch.update(up, np.zeros(6))
        return self.switch.landed

    def look(
        self, percept: Percept, position: NDArray[np.float64], rotation: NDArray[np.float64], time: float
    ) -> GroundView | None:
        """What the sole sees now.

        Args:
            percept: What the sole senses.
            position: Sole position (3,) in the world as estimated in m.
            rotation: Rotation (3, 3) from the sole to the world as estimated.
            time: Now in s.

        Returns:
            The ground, or None where nothing is seen.
        """
        if self._poses:
            _, before, turned = self._poses[-1]
            g, moved = self.gains, math.dist(position, before)
            self._most = max(float(g.readings_moving), g.readings * g.still / (g.still + moved))
            self._rise = self._risen(before, turned, position, rotation)
            self._distance = self._distance + self._rise
        self._poses.append((time, position.copy(), rotation.copy()))
        reading = percept.reading.proximity
        if reading is not None and percept.reading.time > self._read:
            self._read = percept.reading.time
            self._mix(reading + self._risen_since(self._read))
        view = self._view()
        if not self._rising:
            return view
        return self._lifted_off(view, self._height(position, rotation))

    def _height(self, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> float:
        return float(position[2] + rotation[2, :2].dot(self._centre[:2]))

    def _lifted_off(self, view: GroundView | None, height: float) -> GroundView | None:
        """The ground that the sole has just left is as far away as its middle rose to a height in m, but for a bias."""
        if self._liftoff is None:
            self._liftoff = height
        risen = height - self._liftoff
        if risen < _LIFTED_OFF:
            return view
        self._rising = False
        if view is None or not view.even or abs(view.middle - risen) < _LEAST_BIAS * self._noise:
            return view
        self.bias += view.middle - risen
        return self._view()

    def descent(
        self, view: GroundView | None, planned: float, remaining: float, time_left: float, period: float
    ) -> float:
        """How far the foot goes down in one control tick, in m; negative: up.

        Args:
            view: What the sole sees.
            planned: Speed downwards in m/s of the swing's own plan, which holds while nothing is seen.
            remaining: Horizontal distance in m that the foot still has to go.
            time_left: Time in s until the plan puts weight on the foot; negative where it does already.
            period: Control period in s.

        Returns:
            The distance.
        """
        g = self.gains
        if view is None:
            self._aim = None
            self._speed = min(planned, self._speed + g.acceleration * period)
            return self._speed * period
        if self._aim is None:
            self._aim = view.distance
        above = remaining < 0.002
        left = self._aim - (g.margin if above else min(g.clearance, 0.004 + g.clearance_slope * remaining))
        hurry = min(1.0, max(0.0, 2.0 - time_left / g.reserve))
        doubt = max(0.0, -view.distance) / _DOUBT  # it should have touched already
        crawl = g.touch_speed * (1.0 + (g.haste - 1.0) * hurry + doubt)
        damping = max(g.damping, (time_left - g.crawl_time) / g.steepness)
        wanted = left / damping + crawl if left > 0.0 else max(-0.1, left / g.damping)
        if above:
            wanted = max(wanted, crawl)
        self._speed = min(wanted, g.top_speed, self._speed + g.acceleration * period)
        behind = view.distance - self._aim
        self._aim -= self._speed * period
        return period * min(g.top_speed, max(-0.1, self._speed + behind / g.correction))

    def turn_rate(self, distance: float, slope: tuple[float, float]) -> float:
        """Largest rate in rad/s at which the sole turns: its edge goes down no faster than the whole of it does, but
        where the slope that is left is more than what noise makes of the ground.

        Args:
            distance: How far down in m the first contact is.
            slope: Rise of the ground along the sole's x and y (tangents).

        Returns:
            The rate.
        """
        g = self.gains
        gentle = (g.touch_speed + max(0.0, distance) / g.damping) / self._arm
        return min(g.turn_rate, gentle + max(0.0, math.hypot(*slope) - _SLOPE_OF_NOISE) / g.turning)

    def holding(self, since: float) -> float:
        """Force in N that a foot shall carry some time after it touched, until weight is put on it.

        Args:
            since: Time in s since it touched.
        """
        g = self.gains
        return g.touch_force + min(1.0, since / g.firming) * (g.hold_force - g.touch_force)

    def yielding(self, load: float, target: float, above: float, period: float) -> float:
        """How far a foot on the ground goes down in one control tick, in m, for a force; negative: up.

        Args:
            load: Vertical force in N on the sole.
            target: Force in N that it should have.
            above: How far in m it is above where it touched; a foot that has lost the ground comes back from there.
            period: Control period in s.

        Returns:
            The distance.
        """
        g = self.gains
        missing = g.pliancy * (target - load)
        self._drift = min(_LARGEST_DRIFT, max(-_LARGEST_DRIFT, self._drift + missing * period / g.settling))
        wanted = missing + self._drift
        if load < 0.3 * g.hold_force:
            wanted = max(wanted, g.touch_speed + above / g.damping)
        self._speed = min(0.02, max(-0.02, wanted))
        return self._speed * period

    def touched(self) -> None:
        """The sole has met the ground: what the map still shows as distance is the sensors' bias."""
        view = self._view()
        if view is not None and abs(view.distance) < 0.015:
            self.bias += min(_LARGEST_LESSON, max(-_LARGEST_LESSON, 0.5 * view.distance))

    def _risen(
        self,
        before: NDArray[np.float64],
        turned: NDArray[np.float64],
        position: NDArray[np.float64],
        rotation: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """How far (n,) each taxel rose in m from one pose of the sole to another: its distance grows by that."""
        up = rotation.T.dot(position - before)
        turn = turned.T.dot(rotation)
        return np.asarray(up[2] + turn[2, 0] * self._x + turn[2, 1] * self._y)

    def _risen_since(self, time: float) -> NDArray[np.float64]:
        """How far (n,) each taxel rose in m since a time, for a reading that is as old as that."""
        _, position, rotation = self._poses[-1]
        later: tuple[float, NDArray[np.float64]] = (self._poses[-1][0], np.zeros(len(self._x)))
        for k, (then, before, turned) in enumerate(reversed(self._poses)):
            risen = self._rise if k == 1 else self._risen(before, turned, position, rotation)
            if then <= time:
                span = later[0] - then
                share = (time - then) / span if span > 0.0 else 1.0
                return risen + share * (later[1] - risen)
            later = (then, risen)
        return later[1]

    def _mix(self, reading: NDArray[np.float64]) -> None:
        """Take a reading (n,) in m into the map; where the ground has moved the map begins anew."""
        g = self.gains
        known = np.isfinite(reading) & np.isfinite(self._distance)
        news = np.subtract(reading, self._distance, out=np.zeros(len(known)), where=known)
        told = news[known]
        if len(told):
            if abs(float(told.sum()) / len(told)) > g.jump_of_all * self._noise:
                self._readings[:] = 0.0
            spread = _SIGMA_OF_MEDIAN * _median(np.abs(told))
            self._noise = max(_LEAST_NOISE, self._noise + _NOISE_SHARE * (spread - self._noise))
        self._readings[~known | (np.abs(news) > g.jump * self._noise)] = 0.0
        self._readings = np.minimum(self._readings + 1.0, self._most)
        self._distance = np.where(known, self._distance + news / self._readings, reading)

    def _view(self) -> GroundView | None:
        distance = self._distance - self.bias
        seen = int(np.count_nonzero(np.isfinite(distance)))
        if seen < 3:
            return None
        g = self.gains
        found = highest_plane(
            self._x, self._y, distance, self._readings, self._noise, g.follow_taxels, self._on_plane, self._plane
        )
        count = int(np.count_nonzero(self._on_plane))
        level, sx, sy = self._plane.tolist() if found else (0.0, 0.0, 0.0)
        slope: tuple[float, float] | None = (sx, sy)
        if count < g.follow_taxels or math.hypot(sx, sy) > g.largest_slope:
            slope = None  # too little to stand on, or too steep: the sole stays level
        if slope is None or not found:
            nearest = middle = float(np.sort(distance[self._on_plane != 0])[: max(1, count // 3)].mean())
        else:
            nearest = level - float((self._corners.dot(np.array([sx, sy]))).max())
            middle = level - sx * float(self._centre[0]) - sy * float(self._centre[1])
            if g.orientation == "moment":
                slope = self._slope_of_moment(seen)
        return GroundView(nearest, middle, slope, count > _EVEN * seen)

    def _slope_of_moment(self, count: int) -> tuple[float, float]:
        """Slope that a level sole would see for the virtual moment about its middle (T 4.26)."""
        distance = self._distance - self.bias
        wrench = virtual_ground_reaction_wrench(self.layout, distance, PROXIMITY_GAIN, self.gains.sensing_range)
        moment_x = wrench[3] - self._centre[1] * wrench[2]
        moment_y = wrench[4] + self._centre[0] * wrench[2]
        return (
            float(-moment_y / (PROXIMITY_GAIN * count * self._spread[0])),
            float(moment_x / (PROXIMITY_GAIN * count * self._spread[1])),
        )


def _median(values: NDArray[np.float64]) -> float:
    """Median of a few values (n,), all finite: `np.median` takes ten times as long."""
    ordered = np.sort(values)
    middle = len(ordered) // 2
    return float(ordered[middle] if len(ordered) % 2 else 0.5 * (ordered[middle - 1] + ordered[middle]))


def turned_to_ground(
    rotation: NDArray[np.float64], slope: tuple[float, float], share: float, largest: float
) -> NDArray[np.float64]:
    """Turn a sole a share of the way to the ground's slope.

    Args:
        rotation: Rotation (3, 3) of the sole.
        slope: Rise of the ground along the sole's x and y (tangents).
        share: Share of the way, 0..1.
        largest: Largest turn in rad.

    Returns:
        Rotation (3, 3) of the turned sole.
    """
    turn = np.array([share * slope[1], -share * slope[0], 0.0])
    size = math.hypot(float(turn[0]), float(turn[1]))
    if size > largest:
        turn *= largest / size
    return np.asarray(rotation.dot(rotation_from_vector(turn)))


def vector_from_rotation(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation vector of a rotation by less than half a turn.

    Args:
        rotation: Rotation (3, 3).

    Returns:
        Its axis times its angle (3,) in rad.
    """
    axis = 0.5 * np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine = math.sqrt(float(axis.dot(axis)))
    if sine < 1e-9:
        return axis
    return np.asarray(axis * (math.atan2(sine, 0.5 * (float(np.trace(rotation)) - 1.0)) / sine))
