"""On slopes rising outwards beyond the ankle, stand farther inside."""

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, Tick, was_applied
from plantar.settings.part import Part
from plantar.settings.schema import number
from plantar.sides import Side


def inward_distance(side: Side, outward_rise: float, ankle_reach: float, com_height: float) -> float:
    """Returns how far in m along its y axis a foot on a slope should carry inwards.

    Args:
        side: Which foot.
        outward_rise: Slope in rad across it, positive with the outer edge higher.
        ankle_reach: Slope in rad that the ankle follows.
        com_height: CoM over the foot in m.

    Example:
        >>> round(inward_distance("left", 0.145, 0.095, 0.8), 3)
        -0.04
    """
    excess = outward_rise - ankle_reach
    return com_height * excess * (-1.0 if side == "left" else 1.0) if excess > 0.0 else 0.0


class SlopeRules(Part, table="slope", needs={"control.pfc": (True,)}):
    """Slopes that an ankle can follow.

    Attributes:
        ankle_reach: Slope across the foot, rising outwards, in rad that an ankle follows on one leg; on a steeper one
            the body stays inside.
    """

    ankle_reach: float = number(0.095, "rad", 0, 0.7)


class SlopeInside:
    """Proposes the VRP over a foot just landed on such a slope."""

    priority = Priority.FOOTHOLD

    def __init__(self) -> None:
        self._proposed: PlanChange | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """The VRP moved inwards, at touchdown."""
        if self._proposed is not None and was_applied(self._proposed, tick):
            self._proposed = None
        if tick.feet.touchdown:
            self._proposed = self._inside(tick)
        return self._proposed

    @staticmethod
    def _inside(tick: Tick) -> PlanChange | None:
        side, phase = tick.feet.side, tick.phase
        if side is None or tick.inward == 0.0:
            return None
        step = phase.step if phase.swing is not None else phase.step - 1
        across = tick.place(side).rotation_sole_to_world[:2, 1]
        x, y = (tick.plan.vrp(step) + across * tick.inward).tolist()
        return PlanChange("stands inside on a slope", step, vrp=(x, y))
