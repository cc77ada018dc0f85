"""Settings of preemptive foot compliance: how a sole comes down, and what it carries once it has touched."""

from __future__ import annotations

from plantar.settings.schema import Settings, number

__all__ = ["ComplianceGains", "TouchdownGains"]


class ComplianceGains(Settings):
    """How a swing foot comes down on the ground that its taxels see.

    Attributes:
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
        late_speed_ratio: How many times faster it touches then.
        turning: Time constant in s with which the sole turns to the ground.
        turn_rate: Largest rate of that in rad/s; close to the ground it is less (see `SwingCompliance.turn_rate`).
    """

    damping: float = number(0.04, "s", 0.001, 1)
    touch_speed: float = number(0.002, "m/s", 0.0001, 0.1)
    margin: float = number(0.0002, "m", 0, 0.01)
    top_speed: float = number(0.3, "m/s", 0.01, 2)
    acceleration: float = number(4.0, "m/s^2", 0.1, 100)
    clearance: float = number(0.012, "m", 0, 0.1)
    clearance_slope: float = number(0.2, "1", 0, 2)
    correction: float = number(0.03, "s", 0.005, 1)
    steepness: float = number(3.0, "1", 1, 10)
    crawl_time: float = number(0.3, "s", 0, 2)
    reserve: float = number(0.08, "s", 0, 1)
    late_speed_ratio: float = number(2.5, "1", 1, 20)
    turning: float = number(0.04, "s", 0.005, 1)
    turn_rate: float = number(1.5, "rad/s", 0.01, 20)


class TouchdownGains(Settings):
    """From which load a foot counts as down, and which load it carries until weight is put on it.

    Attributes:
        contact_force: Force in N that counts as touchdown.
        touch_force: Force in N that a foot carries at first.
        hold_force: Force in N that it carries from then on to the double support.
        load_time: Time in s from the one to the other.
        admittance: Speed in m/s with which a foot on the ground yields to each newton of force that it should not have.
        settling: Time constant in s with which it learns how fast the body above it moves up or down.
    """

    contact_force: float = number(18.0, "N", 0, 10000)
    touch_force: float = number(20.0, "N", 0, 10000)
    hold_force: float = number(30.0, "N", 0.1, 10000)
    load_time: float = number(0.15, "s", 0.001, 5)
    admittance: float = number(1e-4, "m/s/N", 0, 0.1)
    settling: float = number(0.1, "s", 0.005, 10)
