"""A foothold is not what was planned: the VRP moves over it, and the steps to come onto the strip that it is part of.

T 4.4.2-4.4.3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from gait.contact.foot_contacts import FootholdFound
from gait.contact.support_strip import SupportStrip
from gait.plan.phases import PhaseKind
from gait.plan.plan_change import PlanChange, Point
from gait.plan.walk_plan import vrp_of_step
from gait.propose.foothold_rules import FootholdRules
from gait.propose.proposer import Priority, Tick, was_applied
from plantar.sides import Side

__all__ = ["FootholdCarries"]


class FootholdCarries:
    """Proposes the VRP over what a foot was found to stand on, and footsteps on the strip that the ground goes on as.

    Args:
        rules: How far a foothold has to lie off the plan, and how far one moves the footsteps to come.
        middles: Middle (2,) of each sole in its frame in m.
        strip: Where the ground goes on.
    """

    priority = Priority.FOOTHOLD

    def __init__(self, rules: FootholdRules, middles: Mapping[Side, NDArray[np.float64]], strip: SupportStrip) -> None:
        self._rules = rules
        self._middles = middles
        self._strip = strip
        self._moved, self._moved_step = -math.inf, -1
        self._waiting: FootholdFound | None = None
        self._proposed: PlanChange | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """The VRP over what was found last (see `gait.propose.proposer.Proposer`)."""
        if self._proposed is not None and was_applied(self._proposed, tick):
            self._waiting = None
        for found in tick.found:
            if self._is_news(found, tick.time):
                self._waiting = found
        self._proposed = None if self._waiting is None else self._over(self._waiting, tick)
        if self._proposed is None:
            self._waiting = None
        else:
            self._moved, self._moved_step = tick.time, self._proposed.step
        return self._proposed

    def _is_news(self, found: FootholdFound, time: float) -> bool:
        """Take a foothold into the strip; whether it may move the plan now."""
        if found.whole:
            self._strip.clear()
        else:
            self._strip.update(found.step, found.side, found.vrp)
        rested = time >= self._moved + self._rules.replan_pause or self._moved_step != found.step
        return rested and not found.as_planned

    def _over(self, found: FootholdFound, tick: Tick) -> PlanChange | None:
        if found.step < tick.plan.first:
            return None
        shift, vrp_shift = self._onto_strip(found.step, tick)
        x, y = found.vrp.tolist()
        away = math.dist(found.vrp, tick.plan.vrp(found.step))
        if max(away, math.hypot(*vrp_shift), math.hypot(*shift)) < self._rules.least_move:
            return None
        return PlanChange(
            "foothold found",
            found.step,
            vrp=(x, y),
            shift=shift,
            vrp_shift=vrp_shift,
            because="onto the strip that carries",
        )

    def _onto_strip(self, step: int, tick: Tick) -> tuple[Point, Point]:
        """By how much in m the footsteps to come move onto the strip, which one foothold moves only so far, and by how
        much the VRPs over them."""
        upcoming, phase, strip = step + 1, tick.phase, self._strip
        begun = phase.step == upcoming and phase.kind == PhaseKind.SINGLE_SUPPORT
        if not strip.known or begun or upcoming >= tick.plan.count:
            return (0.0, 0.0), (0.0, 0.0)
        foot = tick.plan.foothold(upcoming)
        center = vrp_of_step(foot, self._middles[foot.side])
        place, lateral = strip.coordinates(center)
        missing = strip.lateral(place) - lateral
        reach = self._rules.largest_shift
        dx, dy = (min(reach, max(-reach, missing)) * strip.across).tolist()
        vx, vy = (center + missing * strip.across - tick.plan.vrp(upcoming)).tolist()
        return (dx, dy), (vx, vy)
