"""A foothold off the plan: the VRP moves over it, later steps onto its strip (T 4.4.2-4.4.3)."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.gait.contact.support_strip import SupportStrip
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange, Point
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.proposer import Priority, Tick, was_applied
from plantar.mechanics.rotation import level_rotation

# derived: Share of the sole across the walk below which the ground is narrow. The widest that counts as a strip, half a
# sole, is seen with an error of a taxel at either edge, a fourteenth of a sole of 42 taxels.
_NARROW = 0.75

# chosen: Share of what an ankle bears up to which the load may lie from it without the footsteps being moved
_NEAR = 0.5

# chosen: Share of what an ankle bears on which a foot is loaded that is still to come; the rest is to balance with
_BORNE = 0.75


class FootholdCarries:
    """Proposes the VRP over a found foothold, and footsteps on the continuing strip.

    `rules`: least and largest moves; `middles`: loaded point (2,) of each whole sole, own frame, in m; `outlines`: each
    sole's (k, 2), own frame, in m; `reach`: distance in m along the sole, from its origin, at which an ankle bears the
    robot.
    """

    priority = Priority.FOOTHOLD

    def __init__(
        self,
        rules: FootholdRules,
        middles: Mapping[Side, NDArray[np.float64]],
        outlines: Mapping[Side, NDArray[np.float64]],
        strip: SupportStrip,
        reach: float = math.inf,
    ) -> None:
        self._rules = rules
        self._strip = strip
        self._reach = reach
        self._middles = middles
        self._outlines = outlines
        self._moved = -math.inf
        self._moved_step = -1
        self._waiting: FootholdFound | None = None
        self._proposed: PlanChange | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """VRP over the last found."""
        if self._proposed is not None and was_applied(self._proposed, tick):
            self._waiting = None
        for found in tick.found:
            if self._is_news(found, tick):
                self._waiting = found
        self._proposed = None if self._waiting is None else self._over(self._waiting, tick)
        if self._proposed is None:
            self._waiting = None
        else:
            self._moved = tick.time
            self._moved_step = self._proposed.step
        return self._proposed

    def _is_news(self, found: FootholdFound, tick: Tick) -> bool:
        """Add a foothold to the strip; whether it can move the plan now."""
        if found.whole:
            self._strip.clear()
        elif not found.seen or self._is_narrow(found, tick):
            self._strip.update(found.step, found.side, found.middle)
        rested = tick.time >= self._moved + self._rules.replan_pause or self._moved_step != found.step
        return rested and not found.as_planned

    def _is_narrow(self, found: FootholdFound, tick: Tick) -> bool:
        """Whether a foothold can belong to a strip along the walk."""
        turn = level_rotation(tick.plan.foothold(max(found.step, tick.plan.first)).yaw)[:2, :2]
        sole = self._outlines[found.side] @ turn.T @ self._strip.across
        ground = found.polygon @ self._strip.across
        return float(np.ptp(ground)) < _NARROW * float(np.ptp(sole))

    def _over(self, found: FootholdFound, tick: Tick) -> PlanChange | None:
        if found.step < tick.plan.first or not self._rules.move_vrp:
            return None
        shift, vrp_shift = self._moved_steps(found, tick)
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

    def _moved_steps(self, found: FootholdFound, tick: Tick) -> tuple[Point, Point]:
        """Moves in m of later footsteps, limited for one foothold, and of their VRPs."""
        upcoming = found.step + 1
        phase = tick.phase
        begun = phase.step == upcoming and phase.kind == PhaseKind.SINGLE_SUPPORT
        if begun or upcoming >= tick.plan.count or not self._rules.move_steps:
            return (0.0, 0.0), (0.0, 0.0)
        if not self._strip.known:
            shift = self._into_reach(found, tick)
            return shift, shift
        return self._onto_strip(upcoming, tick)

    def _into_reach(self, found: FootholdFound, tick: Tick) -> Point:
        """Footsteps' move along the sole to bring the ankle over their ground."""
        foot = tick.plan.foothold(found.step)
        forward = foot.rotation_sole_to_world[:2, 0]
        near = abs(float((found.vrp - foot.position[:2]) @ forward)) <= _NEAR * self._reach
        if near or self._moved_step == found.step:
            return 0.0, 0.0
        off = float((found.vrp - vrp_of_step(foot, self._middles[found.side])) @ forward)
        most = self._rules.largest_shift
        x, y = (min(most, max(-most, off)) * forward).tolist()
        return x, y

    def _onto_strip(self, upcoming: int, tick: Tick) -> tuple[Point, Point]:
        """Moves in m onto the strip, of later footsteps and their VRPs."""
        strip = self._strip
        foot = tick.plan.foothold(upcoming)
        center = vrp_of_step(foot, self._middles[foot.side])
        place, lateral = strip.coordinates(center)
        missing = strip.lateral(place) - lateral
        reach = self._rules.largest_shift
        shift = min(reach, max(-reach, missing)) * strip.across
        beside = center + missing * strip.across - foot.position[:2] - shift
        forward = foot.rotation_sole_to_world[:2, 0]
        along = float(beside @ forward)
        most = _BORNE * self._reach
        vrp = foot.position[:2] + shift + beside
        if abs(along) > most:
            vrp += (math.copysign(most, along) - along) * forward
        dx, dy = shift.tolist()
        vx, vy = (vrp - tick.plan.vrp(upcoming)).tolist()
        return (dx, dy), (vx, vy)
