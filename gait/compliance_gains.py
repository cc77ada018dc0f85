"""Settings of preemptive foot compliance."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ComplianceGains"]


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
