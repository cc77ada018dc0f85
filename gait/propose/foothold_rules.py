"""When a foothold that is not what was planned moves the plan, and how far."""

from __future__ import annotations

from plantar.settings.schema import Settings, number

__all__ = ["FootholdRules"]


class FootholdRules(Settings):
    """When a foothold that is not what was planned moves the plan, and how far.

    Attributes:
        least_move: Distance in m by which the centroid has to differ from the plan's VRP before the plan is moved.
        largest_shift: Distance in m by which one foothold moves the footsteps to come.
        replan_pause: Time in s between two moves of the plan by one foothold.
    """

    least_move: float = number(0.004, "m", 0, 0.1)
    largest_shift: float = number(0.02, "m", 0, 0.2)
    replan_pause: float = number(0.06, "s", 0, 5)
