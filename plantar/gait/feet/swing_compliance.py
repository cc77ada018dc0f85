"""Preemptive foot compliance: a swing that sees the ground before it touches it (T 4.4.1, Fig. 49).

Law "wrench" damps the swing by the force of w_sole (T 4.30, corrected), turns the sole by its moment and stops at
epsilon_stop (T 4.31). Law "plane" slows down with the distance of a fitted plane and ends at a crawl.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plantar.gait.contact.ground_map import GroundMap, GroundMapSettings, GroundView
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.rotation import rotation_from_vector
from plantar.percepts.percept_options import PROXIMITY_GAIN
from plantar.sensing.virtual_wrench import SoleWrenchSwitch, early_stop, virtual_ground_reaction_wrench

__all__ = ["SwingCompliance", "turned_to_ground"]


_DOUBT = 1 / 600  # leg past the ground that it sees at which a sole that has not touched goes down twice as fast
_THERE = 1 / 300  # leg before its place from which a sole is above it
_KEPT = 1 / 150  # leg from the ground that a sole keeps until then, and more the further it has to go
_LARGEST_RISE = 0.0412  # leg/beat at which a sole goes up that is too near to the ground
_LARGEST_DRIFT = 0.00206  # leg/beat that a body moves up or down above a foot that has touched
_LARGEST_YIELD = 0.00824  # leg/beat at which a foot that has touched gives way
_SLOPE_OF_NOISE = 0.015  # tangent of the slope that level ground may seem to have


class SwingCompliance:
    """How one sole comes down, and the load on it, from lift-off to the end of its landing.

    Attributes:
        ground: What the sole sees of the ground.
        force: Vertical force in N on the sole, filtered.
        by_wrench: Whether its law is "wrench".
        stopped: Whether the virtual force has stopped the swing (T 4.31).

    Args:
        layout: The sole.
        gains: How it comes down.
        touchdown: Loads of and after touchdown.
        ground: How the map of the ground is kept.
    """

    def __init__(
        self, layout: SoleLayout, gains: ComplianceGains, touchdown: TouchdownGains, ground: GroundMapSettings
    ) -> None:
        self.layout = layout
        self.gains = gains
        self.touchdown = touchdown
        self.ground = GroundMap(layout, ground)
        self.switch = SoleWrenchSwitch(touchdown.contact_force)
        self.force = 0.0
        self._leg, self._speed_unit = gains.body.in_si("leg"), gains.body.in_si("leg/beat")
        self._arm = 0.5 * float(np.linalg.norm(np.ptp(layout.outline, axis=0)))  # m from the middle to an edge
        self._speed = self._drift = 0.0
        self._aim: float | None = None
        self.by_wrench = gains.law == "wrench"
        self.stopped = False
        self._whole = len(layout) * PROXIMITY_GAIN * ground.sensing_range  # N of a sole that touches everywhere
        self._wrench = np.zeros(6)

    def begin(self) -> None:
        """A swing begins."""
        self.ground.begin()
        self._speed = self._drift = 0.0
        self._aim = None
        self.switch.reset()
        self.force = 0.0
        self._wrench, self.stopped = np.zeros(6), False

    def update_load(self, load: float) -> bool:
        """Touchdown detection: whether the foot has landed (T 4.30 corrected), by `load` in N, less its tare."""
        self.force += 0.5 * (load - self.force)
        up = np.array([0.0, 0.0, self.force, 0.0, 0.0, 0.0])
        if self.by_wrench:
            reach = self.ground.settings.sensing_range
            virtual = virtual_ground_reaction_wrench(self.layout, self.ground.distance, PROXIMITY_GAIN, reach)
            self._wrench = self.switch.update(up, virtual)
        else:
            self.switch.update(up, np.zeros(6))
        return self.switch.landed

    def damped(self, planned: float, time_left: float, period: float) -> float:
        """Distance in m that the foot goes down in one control tick: its plan, damped by the virtual force (T 4.4.1).

        Once that force has stopped the swing (T 4.31), the foot goes down by what it lacks of a sole that touches.

        Args:
            planned: Speed downwards in m/s of the swing's own plan.
            time_left: Time in s until the plan puts weight on the foot.
            period: Control period in s.

        Returns:
            The distance.
        """
        g, force = self.gains, float(self._wrench[2])
        self.stopped = self.stopped or bool(early_stop(self._wrench, g.stop * self._whole))
        gap = max(0.0, 1.0 - force / self._whole) * self.ground.settings.sensing_range
        late = time_left < g.crawl_time
        wanted = max(0.0, 1.0 - force / (g.stop * self._whole)) * planned
        if self.stopped or late:
            wanted = max(wanted, gap / g.damping)
        wanted += g.touch_speed * (g.late_speed_ratio if late else 1.0)
        self._speed = min(wanted, g.top_speed, self._speed + g.acceleration * period)
        return self._speed * period

    def descent(
        self, view: GroundView | None, planned: float, remaining: float, time_left: float, period: float
    ) -> float:
        """Distance in m that the foot goes down in one control tick; negative: up.

        Args:
            view: What the sole sees.
            planned: Speed downwards in m/s of the swing's own plan, used while no ground is seen.
            remaining: Remaining horizontal distance in m.
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
        above = remaining < _THERE * self._leg
        left = self._aim - (g.margin if above else min(g.clearance, _KEPT * self._leg + g.clearance_slope * remaining))
        hurry = min(1.0, max(0.0, 2.0 - time_left / g.reserve)) if g.reserve > 0.0 else float(time_left <= 0.0)
        doubt = max(0.0, -view.distance) / (_DOUBT * self._leg)  # it should have touched already
        crawl = g.touch_speed * (1.0 + (g.late_speed_ratio - 1.0) * hurry + doubt)
        damping = max(g.damping, (time_left - g.crawl_time) / g.steepness)
        rise = -_LARGEST_RISE * self._speed_unit
        wanted = left / damping + crawl if left > 0.0 else max(rise, left / g.damping)
        if above:
            wanted = max(wanted, crawl)
        self._speed = min(wanted, g.top_speed, self._speed + g.acceleration * period)
        behind = view.distance - self._aim
        self._aim -= self._speed * period
        return period * min(g.top_speed, max(rise, self._speed + behind / g.correction))

    def turn_rate(self, distance: float, slope: tuple[float, float]) -> float:
        """Largest turning rate in rad/s: the edge goes down no faster than the sole, unless the slope exceeds its
        noise.

        Args:
            distance: Distance down in m to the first contact.
            slope: Rise of the ground along the sole's x and y (tangents).

        Returns:
            The rate.
        """
        g = self.gains
        gentle = (g.touch_speed + max(0.0, distance) / g.damping) / self._arm
        return min(g.turn_rate, gentle + max(0.0, math.hypot(*slope) - _SLOPE_OF_NOISE) / g.turning)

    def holding(self, since: float) -> float:
        """Force in N that a foot should carry `since` seconds after it touched, until weight is put on it."""
        t = self.touchdown
        return t.touch_force + min(1.0, since / t.load_time) * (t.hold_force - t.touch_force)

    def yielding(self, load: float, target: float, above: float, period: float) -> float:
        """Distance in m that a foot on the ground goes down in one control tick, for a force; negative: up.

        Args:
            load: Vertical force in N on the sole.
            target: Desired force in N.
            above: Height in m above where it touched; a foot that has lost the ground comes back from there.
            period: Control period in s.

        Returns:
            The distance.
        """
        g, t = self.gains, self.touchdown
        missing = t.admittance * (target - load)
        drift = _LARGEST_DRIFT * self._speed_unit
        self._drift = min(drift, max(-drift, self._drift + missing * period / t.settling))
        wanted = missing + self._drift
        if load < 0.3 * t.hold_force:
            wanted = max(wanted, g.touch_speed + above / g.damping)
        fastest = _LARGEST_YIELD * self._speed_unit
        self._speed = min(fastest, max(-fastest, wanted))
        return self._speed * period


def turned_to_ground(
    rotation: NDArray[np.float64], slope: tuple[float, float], share: float, largest: float
) -> NDArray[np.float64]:
    """Rotation (3, 3) of a sole that is turned a share of the way to the ground's slope.

    Args:
        rotation: Rotation (3, 3) of the sole.
        slope: Rise of the ground along the sole's x and y (tangents).
        share: Share of the way, 0..1.
        largest: Largest turn in rad.

    Returns:
        The turned sole.
    """
    turn = np.array([share * slope[1], -share * slope[0], 0.0])
    size = math.hypot(float(turn[0]), float(turn[1]))
    if size > largest:
        turn *= largest / size
    return np.asarray(rotation.dot(rotation_from_vector(turn)))
