"""A foot lands over an edge: later steps move away from it."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, Tick, was_applied
from plantar.layouts.layout import SoleLayout

# derived: Share of the taxels that see nothing, of an edge: half of the row along a side. Fewer are a hole, or have
# failed.
_LEAST_OVER = 0.08

_MOST_OVER = 0.5  # chosen: Share beyond which it is no foothold with an edge any more

# chosen: Landings in a row of one foot, alike, by which a walk that bears partial footholds has drifted off its way:
# one such foothold is a stone's shape.
_DRIFT = 3

_ALIKE = 0.08  # derived: Of a sole's width, by which the moves for them differ at most: half a row of taxels, and noise


class EdgeBeside:
    """Moves footsteps onto ground that a landed foot saw.

    An edge cutting a share f off a sole of width w moves steps by f w / 2, since the ground may end at its other side,
    too. In a drift it does not: steps move by f w, onto it.

    `drop`: distance in m from the sole of absent ground; `largest`: largest move in m by one landing; `drift`: whether
    steps move only for a drift: alike edges at a foot's last landings, none at the other's. A heading that is off
    drifts on, so that each later landing at that edge moves steps again.
    """

    priority = Priority.FOOTHOLD

    def __init__(self, layouts: Mapping[Side, SoleLayout], drop: float, largest: float, *, drift: bool = False) -> None:
        self._places = {side: layout.positions[:, :2] for side, layout in layouts.items()}
        self._drop = drop
        self._largest = largest
        self._proposed: PlanChange | None = None
        self._moved = (-1, 0.0)
        self._seen: list[float] | None = [] if drift else None  # moves for the last landings, of both feet in turn
        self._alike = _ALIKE * max(float(np.ptp(places[:, 1])) for places in self._places.values())

    def propose(self, tick: Tick) -> PlanChange | None:
        """Later steps, moved at touchdown."""
        if self._proposed is not None and (was_applied(self._proposed, tick) or self._begun(self._proposed.step, tick)):
            self._proposed = None
        if tick.feet.touchdown:
            self._proposed = self._off_the_edge(tick)
        return self._proposed

    @staticmethod
    def _begun(step: int, tick: Tick) -> bool:
        """Whether the next step has begun."""
        return tick.phase.step > step and tick.phase.kind == PhaseKind.SINGLE_SUPPORT

    def _off_the_edge(self, tick: Tick) -> PlanChange | None:
        side = tick.feet.side
        distance = tick.feet.distance
        phase = tick.phase
        if side is None or distance is None:
            return None
        step = phase.step if phase.swing is not None else phase.step - 1
        across = self._across(side, distance)
        if self._seen is not None:
            across = self._drifted(self._seen, across)
        across = min(self._largest, max(-self._largest, across))
        if not across or step + 1 >= tick.plan.count or self._begun(step, tick):
            return None
        last, way = self._moved
        self._moved = step, across
        if step == last + 1 and across * way < 0.0:
            return None  # the ground of the other foot ends on its other side: there is no way between both
        dx, dy = (across * tick.place(side).rotation_sole_to_world[:2, 1]).tolist()
        return PlanChange("an edge beside", step, shift=(dx, dy), because="off the edge beside")

    def _drifted(self, seen: list[float], across: float) -> float:
        """Move onto the ground by the least of a foot's last landings where they mean a drift."""
        seen.append(across)
        del seen[: -(2 * _DRIFT - 1)]
        own = seen[::-2]
        other = seen[-2::-2]
        alike = len(own) == _DRIFT and min(own) * max(own) > 0.0 and max(own) - min(own) <= self._alike
        if not alike or any(other):
            return 0.0
        return 2.0 * min(own, key=abs)

    def _across(self, side: Side, distance: NDArray[np.float64]) -> float:
        """Middle of its ground in m to the sole's left; 0 without an edge along a side."""
        places = self._places[side]
        known = ~np.isnan(distance)
        over = known & (distance > self._drop)
        count = int(known.sum())
        share = int(over.sum()) / count if count else 0.0
        if not _LEAST_OVER <= share <= _MOST_OVER:
            return 0.0
        ahead, across = (places[known & ~over].mean(axis=0) - places[known].mean(axis=0)).tolist()
        if abs(across) <= abs(ahead):
            return 0.0
        return float(across)
