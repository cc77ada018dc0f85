"""A foot lands over an edge: later steps move away from it."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.contact.path_drift import PathDrift
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.proposer import Priority, Tick, was_applied
from plantar.layouts.layout import SoleLayout

# derived: Share of the taxels that see nothing, of an edge: half of the row along a side. Fewer are a hole, or have
# failed.
_LEAST_OVER = 0.08

_MOST_OVER = 0.5  # chosen: Share beyond which it is no foothold with an edge any more


class EdgeBeside:
    """Moves footsteps onto ground that a landed foot saw.

    An edge cutting a share f off a sole of width w moves steps by f w / 2, since the ground may end at its other side,
    too. In a drift it does not: it measures that by f w, and steps follow the ground.

    `rules`: largest move by one landing, and least in a drift; `drop`: distance in m from the sole of absent ground;
    `drift` of the ground; None on ground that soles are expected to stand on whole.
    """

    priority = Priority.FOOTHOLD

    def __init__(
        self,
        layouts: Mapping[Side, SoleLayout],
        rules: FootholdRules,
        drop: float,
        drift: PathDrift | None = None,
    ) -> None:
        self._places = {side: layout.positions[:, :2] for side, layout in layouts.items()}
        self._rules = rules
        self._drop = drop
        self._drift = drift
        self._proposed: PlanChange | None = None
        self._moved = (-1, 0.0)
        self._landed: NDArray[np.float64] | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """Later steps, moved at touchdown."""
        if self._proposed is not None:
            applied = was_applied(self._proposed, tick)
            if applied and self._drift is not None:
                self._drift.moved(self._moved[1])
            if applied or self._begun(self._proposed.step, tick):
                self._proposed = None
        if tick.feet.touchdown and tick.feet.side is not None:
            self._proposed = self._off_the_edge(tick, tick.feet.side)
        return self._proposed

    @staticmethod
    def _begun(step: int, tick: Tick) -> bool:
        """Whether the next step has begun."""
        return tick.phase.step > step and tick.phase.kind == PhaseKind.SINGLE_SUPPORT

    def _off_the_edge(self, tick: Tick, side: Side) -> PlanChange | None:
        phase = tick.phase
        step = phase.step if phase.swing is not None else phase.step - 1
        foot = tick.place(side)
        across = 0.0 if tick.feet.distance is None else self._across(side, tick.feet.distance)
        if self._drift is not None:
            across = self._followed(self._drift, tick, step, foot, across)
        most = self._rules.largest_shift
        across = min(most, max(-most, across))
        if not across or step + 1 >= tick.plan.count or self._begun(step, tick):
            return None
        last, way = self._moved
        self._moved = step, across
        if self._drift is None and step == last + 1 and across * way < 0.0:
            return None  # the ground of the other foot ends on its other side: there is no way between both
        dx, dy = (across * foot.rotation_sole_to_world[:2, 1]).tolist()
        return PlanChange("an edge beside", step, shift=(dx, dy), because="off the edge beside")

    def _followed(self, drift: PathDrift, tick: Tick, step: int, foot: Footstep, across: float) -> float:
        """Move in m to the left by which the next step lies on ground that drifts."""
        here = foot.position[:2]
        ahead = foot.rotation_sole_to_world[:2, 0]
        way = 0.0 if self._landed is None else float((here - self._landed) @ ahead)
        self._landed = here
        drift.landed(tick.time, way, 2.0 * across if across else None)
        if not drift.seen or step + 1 >= tick.plan.count:
            return 0.0
        move = drift.offset(float((tick.plan.foothold(step + 1).position[:2] - here) @ ahead))
        return move if abs(move) >= self._rules.least_move else 0.0

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
