"""Limits of plan moves by unexpected footholds."""

from __future__ import annotations

from plantar.settings.part import Part
from plantar.settings.schema import fixed, share

__all__ = ["FootholdRules"]


class FootholdRules(Part, table="foothold", needs={"control.footholds": ("force", "skin")}):
    """When unexpected footholds move the plan, and how far.

    Attributes:
        largest_shift: Footsteps' move in m by one foothold.
        replan_pause: Between two such moves in s.
    """

    # Distance in m by which the centroid has to differ from the plan's VRP before the plan is moved
    least_move: float = fixed(0.0173, "sole")
    largest_shift: float = share(0.0867, "sole", 0, 0.2)
    replan_pause: float = share(0.243, "beat", 0, 5)
