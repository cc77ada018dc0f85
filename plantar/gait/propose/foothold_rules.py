"""Limits of plan moves by unexpected footholds."""

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, switch


class FootholdRules(Part, table="foothold", needs={"control.footholds": ("force", "skin")}):
    """When unexpected footholds move the plan, and how far.

    Attributes:
        move_vrp: Whether the VRP moves to where a foothold carries (T 4.4.2); without, that only bounds the ZMP.
        move_steps: Whether later footsteps move onto the strip that carries, or so that ankles come over it.
    """

    move_vrp: bool = switch(True)
    move_steps: bool = switch(True)

    # Distance in m by which the centroid has to differ from the plan's VRP before the plan is moved
    least_move: float = fixed(0.016, "sole")  # chosen: 4 mm of 250
    largest_shift: float = fixed(0.08, "sole")  # Largest move of footsteps in m by one foothold; chosen: 20 mm of 250
    replan_pause: float = fixed(0.243, "beat")  # Time in s between two such moves; chosen: 60 ms
