"""Preemptive foot compliance: a sole's descent, and load after touchdown."""

from __future__ import annotations

from typing import ClassVar

from plantar.settings.part import Part
from plantar.settings.schema import choice, fixed, number, share

__all__ = ["ComplianceGains", "TouchdownGains"]


class ComplianceGains(Part, table="compliance", needs={"control.pfc": (True,)}):
    """How a swing foot descends to ground that its taxels see.

    Attributes:
        law: "plane" descends by the fitted plane's distance; "wrench" is damped by the virtual force, turned by the
            virtual moment and stopped where the force exceeds `stop` (T 4.30-4.31).
        stop: epsilon_stop of T 4.31, share of the virtual force with all taxels touching.
        damping: Least time constant in s: speed = touch_speed + distance / time constant.
        touch_speed: At touchdown in m/s.
        margin: Distance in m from the ground by which it has that speed.
        top_speed: Largest downwards in m/s.
        acceleration: Largest downwards in m/s^2.
        clearance: Largest kept distance in m from the ground during horizontal motion.
        reserve: The same of a late foot; it hurries from twice that.
        late_speed_ratio: Factor then on its touchdown speed.
        turning: Time constant in s of turning to the ground.
        turn_rate: Its largest rate in rad/s, less near the ground (`SwingCompliance.turn_rate`).
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
    """Load of touchdown, and carried until weight transfer.

    Attributes:
        contact_force: Of touchdown in N.
        touch_force: Carried at first in N.
        hold_force: Carried from then to double support in N.
        admittance: Yielding in m/s per newton of force error.
    """

    contact_force: float = share(0.0213, "weight", 0, 10000)
    touch_force: float = share(0.0237, "weight", 0, 10000)
    hold_force: float = share(0.0356, "weight", 0.1, 10000)
    load_time: float = fixed(0.607, "beat")  # Time in s from the one to the other
    admittance: float = share(0.0348, "leg/beat/weight", 0, 0.1)
    # Time constant in s with which it learns how fast the body above it moves up or down
    settling: float = fixed(0.404, "beat")
