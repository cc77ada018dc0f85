"""Settings of preemptive foot compliance: how a sole comes down, and what it carries after touchdown."""

from __future__ import annotations

from typing import ClassVar

from plantar.settings.part import Part
from plantar.settings.schema import choice, fixed, number, share

__all__ = ["ComplianceGains", "TouchdownGains"]


class ComplianceGains(Part, table="compliance", needs={"control.pfc": (True,)}):
    """How a swing foot comes down on the ground that its taxels see.

    Attributes:
        law: "plane" comes down by the distance of the plane fitted to what is seen; "wrench" is damped by the virtual
            force, turned by the virtual moment and stopped where that force exceeds `stop` (T 4.30-4.31).
        stop: epsilon_stop of T 4.31, as a share of the virtual force of a sole that touches with all its taxels.
        damping: Smallest time constant in s of the approach: speed = touch_speed + distance / time constant.
        touch_speed: Speed in m/s at touchdown.
        margin: Distance in m from the ground at which it is down to that speed.
        top_speed: Largest speed downwards in m/s.
        acceleration: Largest acceleration downwards in m/s^2.
        clearance: Largest distance in m kept from the ground while the foot still moves horizontally.
        reserve: Largest such distance of a foot that is late; it begins to hurry at twice that.
        late_speed_ratio: Factor on its touchdown speed then.
        turning: Time constant in s with which the sole turns to the ground.
        turn_rate: Largest rate of that in rad/s, less close to the ground (`SwingCompliance.turn_rate`).
    """

    law: str = choice("plane", "wrench")
    stop: float = number(0.95, "1", 0.05, 1)
    damping: float = share(0.243, "beat", 0.001, 1)
    touch_speed: float = share(0.000824, "leg/beat", 0.0001, 0.1)
    margin: float = share(1 / 3000, "leg", 0, 0.01)
    top_speed: float = share(0.124, "leg/beat", 0.01, 2)
    acceleration: float = share(0.408, "leg/beat^2", 0.1, 100)
    clearance: float = share(0.02, "leg", 0, 0.1)
    clearance_slope: ClassVar[float] = 0.2  # The same, for each metre that it still has to go
    # Time constant in s with which the foot follows the distance that it should have
    correction: float = fixed(0.121, "beat")
    # Power of the time that is left with which a descent that has time to spare comes to the ground
    steepness: ClassVar[float] = 3.0
    crawl_time: float = fixed(1.21, "beat")  # Time in s before the plan puts weight on the foot at which it is there
    reserve: float = share(0.485, "beat", 0, 1)
    late_speed_ratio: float = number(4.0, "1", 1, 20)
    turning: float = share(0.162, "beat", 0.005, 1)
    turn_rate: float = share(0.371, "rad/beat", 0.01, 20)


class TouchdownGains(Part, table="touchdown", needs={"control.pfc": (True,)}):
    """From which load a foot counts as down, and which load it carries until weight is put on it.

    Attributes:
        contact_force: Force in N that counts as touchdown.
        touch_force: Force in N that a foot carries at first.
        hold_force: Force in N that it carries from then on to the double support.
        admittance: Speed in m/s with which a foot on the ground yields to each newton of force error.
    """

    contact_force: float = share(0.0213, "weight", 0, 10000)
    touch_force: float = share(0.0237, "weight", 0, 10000)
    hold_force: float = share(0.0356, "weight", 0.1, 10000)
    load_time: float = fixed(0.607, "beat")  # Time in s from the one to the other
    admittance: float = share(0.0348, "leg/beat/weight", 0, 0.1)
    # Time constant in s with which it learns how fast the body above it moves up or down
    settling: float = fixed(0.404, "beat")
