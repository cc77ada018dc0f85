"""Preemptive foot compliance: a sole's descent, and load after touchdown."""

from typing import ClassVar

from plantar.common.settings.part import Part
from plantar.common.settings.schema import choice, fixed, number, share


class ComplianceGains(Part, table="compliance", needs={"control.pfc": (True,)}):
    """How a swing foot descends to ground that its taxels see.

    Attributes:
        law: "plane" descends by the fitted plane's distance; "wrench" is damped by the virtual force, turned by the
            virtual moment and stopped where the force exceeds `stop` (T 4.30-4.31).
        stop: epsilon_stop of T 4.31, share of the virtual force with all taxels touching.
        damping: Least time constant in s: speed = touch_speed + distance / time constant.
        margin: Distance in m from the ground by which it has that speed.
        acceleration: Largest downwards in m/s^2.
        clearance: Largest kept distance in m from the ground during horizontal motion.
    """

    law: str = choice("plane", "wrench")
    stop: float = number(0.95, "1", 0.05, 1)  # chosen: just below the force of all taxels at the ground, 1
    damping: float = share(0.243, "beat", 0.001, 1)  # chosen: 60 ms on h1, beyond the lag of drives
    touch_speed: float = fixed(0.000824, "leg/beat")  # Speed at touchdown in m/s; chosen: 2 mm/s on h1
    # derived: 0.2 mm on h1, about the error of a mean of sixty readings
    margin: float = share(1 / 3000, "leg", 0, 0.01)
    # Largest speed downwards in m/s; measured: 0.3 m/s on h1, at which a lag of 35 ms leaves 10 mm
    top_speed: float = fixed(0.124, "leg/beat")
    # The same to ground that is not one plane: which part is met first is seen by few taxels, and changes
    rough_speed: float = fixed(0.0247, "leg/beat")  # chosen: 60 mm/s, as a blind foot's `approach_speed`
    acceleration: float = share(0.408, "leg/beat^2", 0.1, 100)  # chosen: 4 m/s^2 on h1
    clearance: float = share(0.02, "leg", 0, 0.1)  # chosen: 12 mm on h1, six times the noise of a reading
    # The same, for each metre that it still has to go; chosen: 11 degrees: ground that rises faster is seen as a step
    clearance_slope: ClassVar[float] = 0.2
    # Time constant in s with which the foot follows the distance that it should have
    correction: float = fixed(0.121, "beat")  # chosen: 30 ms, six ticks
    # Power of the time that is left with which a descent that has time to spare comes to the ground
    steepness: ClassVar[float] = 3.0  # derived: three: speed and acceleration are 0 at the ground
    # Time in s before the plan puts weight on the foot at which it is there; derived: as long as a double support, 0.3
    # s on h1
    crawl_time: float = fixed(1.21, "beat")
    # Time in s before that of a late foot; it hurries from twice that; chosen: 0.12 s on h1. Shorter, and the foot
    # quicker, by as much as the double support that follows is shorter than `crawl_time`
    reserve: float = fixed(0.485, "beat")
    # Factor on a late foot's touchdown speed; chosen: 8 mm/s on h1, still far below a blind touch
    late_speed_ratio: ClassVar[float] = 4.0
    turning: float = fixed(0.162, "beat")  # Time constant in s of turning to the ground; chosen: 40 ms, eight ticks
    # Largest such rate in rad/s, less near the ground (`SwingCompliance.turn_rate`)
    turn_rate: float = fixed(0.371, "rad/beat")  # chosen: 1.5 rad/s on h1, whose ankles turn by 4 at most


class TouchdownGains(Part, table="touchdown", needs={"control.pfc": (True,)}):
    """Load of touchdown, and carried until weight transfer.

    Attributes:
        contact_force: Of touchdown in N.
        touch_force: Carried at first in N.
    """

    contact_force: float = share(0.0213, "weight", 0, 10000)  # chosen: 18 N on h1, twice the noise of a sole's sum
    touch_force: float = share(0.0237, "weight", 0, 10000)  # chosen: 20 N on h1, just above `contact_force`
    # Force in N carried up to double support; chosen: 30 N on h1: a foot that carries less may lift again
    hold_force: float = fixed(0.0356, "weight")
    # Time in s from the one to the other; chosen: 0.15 s on h1, half a double support
    load_time: float = fixed(0.607, "beat")
    # Yielding in m/s per newton of force error; chosen: bounded by the delay of 20 ms, with which a softer foot swings
    admittance: float = fixed(0.0348, "leg/beat/weight")
    # Time constant in s with which it learns how fast the body above it moves up or down
    settling: float = fixed(0.404, "beat")  # chosen: 0.1 s
