"""Limits of plan moves by unexpected footholds."""

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed


class FootholdRules(Part, table="foothold", needs={"control.footholds": ("force", "skin")}):
    """When unexpected footholds move the plan, and how far."""

    # Distance in m by which the centroid has to differ from the plan's VRP before the plan is moved
    least_move: float = fixed(0.016, "sole")
    largest_shift: float = fixed(0.08, "sole")  # Largest move of footsteps in m by one foothold
    replan_pause: float = fixed(0.243, "beat")  # Time in s between two such moves
