"""What a foot is found to stand on moves the plan; a strip moves the footsteps, and only along with the plan."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import SIDES, Side
from plantar.gait.contact.foot_contacts import FootholdFound, FootholdSeen
from plantar.gait.contact.support_strip import SupportStrip
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.foothold_found import FootholdCarries
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.foothold_seen import FootholdSeenAhead

RULES = FootholdRules()
NOWHERE = np.empty((0, 2))
MIDDLES = {side: np.array([0.02, 0.0]) for side in SIDES}
SQUARE = np.array([[-0.08, -0.08], [0.08, -0.08], [0.08, 0.08], [-0.08, 0.08]])
OUTLINES = {side: MIDDLES[side] + SQUARE for side in SIDES}


def found(plan: WalkPlan, step: int, off: tuple[float, float], whole: bool = False) -> FootholdFound:
    side = plan.view.foothold(step).side
    middle = plan.view.vrp(step) + off
    ground = middle + (SQUARE if whole else np.array([1.0, 0.5]) * SQUARE)
    return FootholdFound(step, side, ground, 1.0 if whole else 0.5, middle, middle, whole, whole)


def proposer() -> FootholdCarries:
    return FootholdCarries(RULES, MIDDLES, OUTLINES, SupportStrip(np.zeros(2), np.array([1.0, 0.0])))


def double_support(plan: WalkPlan, after: int) -> float:
    """A time in s in the double support after a step."""
    return next(p.start for p in plan.schedule.phases if p.step == after + 1 and p.swing is None) + 0.05


def test_a_partial_foothold_gets_the_vrp_over_it(plan_of, tick_at):
    plan = plan_of()
    here = found(plan, 2, (0.0, 0.03))
    change = proposer().propose(tick_at(plan, double_support(plan, 2), found=(here,)))
    assert (change.step, change.vrp) == (2, tuple(here.vrp))
    assert change.foothold is None
    assert change.shift == (0.0, 0.0)


@pytest.mark.parametrize(("off", "whole"), [((0.002, 0.0), False), ((0.0, 0.0), True)], ids=["hardly off", "whole"])
def test_a_foothold_as_planned_changes_nothing(off, whole, plan_of, tick_at):
    plan = plan_of()
    here = found(plan, 2, off, whole)
    assert proposer().propose(tick_at(plan, double_support(plan, 2), found=(here,))) is None


def test_one_foothold_moves_the_plan_only_every_now_and_then(plan_of, tick_at):
    plan, asked = plan_of(), proposer()
    time = double_support(plan, 2)
    change = asked.propose(tick_at(plan, time, found=(found(plan, 2, (0.0, 0.03)),)))
    assert change is not None
    plan.apply(change, time, NOWHERE)
    soon, later = time + 0.5 * RULES.replan_pause, time + 1.5 * RULES.replan_pause
    assert asked.propose(tick_at(plan, soon, found=(found(plan, 2, (0.0, 0.02)),))) is None
    assert asked.propose(tick_at(plan, later, found=(found(plan, 2, (0.0, 0.02)),))) is not None


def test_a_foothold_whose_change_was_not_chosen_is_proposed_again(plan_of, tick_at):
    plan, asked = plan_of(), proposer()
    time = double_support(plan, 2)
    first = asked.propose(tick_at(plan, time, found=(found(plan, 2, (0.0, 0.03)),)))
    plan.apply(PlanChange("something else", 4, vrp=(1.0, 0.0)), time, NOWHERE)
    second = asked.propose(tick_at(plan, time + 0.005))
    assert second.vrp == first.vrp
    plan.apply(second, time + 0.005, NOWHERE)
    assert asked.propose(tick_at(plan, time + 0.01)) is None


def test_two_partial_footholds_on_one_side_are_a_strip_that_the_steps_come_onto(plan_of, tick_at):
    plan, asked = plan_of(), proposer()
    for step in (1, 2):
        time = double_support(plan, step)
        lateral = 0.05 - float(plan.view.vrp(step)[1])  # the strip lies 5 cm to the left of the walk's line
        change = asked.propose(tick_at(plan, time, found=(found(plan, step, (0.0, lateral)),)))
        assert change is not None
        if step == 1:
            assert change.shift == (0.0, 0.0)
            plan.apply(change, time, NOWHERE)
    before = plan.view
    assert abs(change.shift[1]) == pytest.approx(RULES.largest_shift)
    plan.apply(change, time, NOWHERE)
    assert plan.view.vrp(3)[1] == pytest.approx(0.05, abs=1e-3)  # on the strip at once
    assert plan.view.foothold(3).y - before.foothold(3).y == pytest.approx(change.shift[1])
    moved = plan.record[-1].moved
    assert [m.step for m in moved] == [3, 4, 5]
    assert {m.reason for m in moved} == {"onto the strip that carries"}


def test_ground_that_ends_along_the_walk_is_no_strip(plan_of, tick_at):
    plan, asked = plan_of(), proposer()
    for step in (1, 2):
        time = double_support(plan, step)
        here = found(plan, step, (0.0, 0.05 - float(plan.view.vrp(step)[1])))
        ends = replace(here, polygon=here.middle + np.array([0.5, 1.0]) * SQUARE)
        change = asked.propose(tick_at(plan, time, found=(ends,)))
        assert change.shift == (0.0, 0.0)
        plan.apply(change, time, NOWHERE)


def test_ground_that_loads_alone_show_may_be_a_strip_however_wide_it_is_known_to_be(plan_of, tick_at):
    plan, asked, shifts = plan_of(), proposer(), []
    for step in (1, 2):
        time = double_support(plan, step)
        here = found(plan, step, (0.0, 0.05 - float(plan.view.vrp(step)[1])))
        wide = replace(here, polygon=here.middle + np.array([0.5, 1.0]) * SQUARE, seen=False)
        change = asked.propose(tick_at(plan, time, found=(wide,)))
        shifts.append(change.shift[1])
        plan.apply(change, time, NOWHERE)
    assert shifts[0] == 0.0
    assert shifts[1] == pytest.approx(RULES.largest_shift)


@pytest.mark.parametrize("ahead", [0.03, 0.055, 0.07])
def test_footsteps_move_once_a_foothold_until_the_ankle_is_over_what_carries(ahead, plan_of, tick_at):
    plan, time = plan_of(), 0.0
    asked = FootholdCarries(RULES, MIDDLES, OUTLINES, SupportStrip(np.zeros(2), np.array([0.0, 1.0])), 0.1)
    time = double_support(plan, 2)
    ankle = plan.view.foothold(2).position[:2]
    here = replace(found(plan, 2, (0.0, 0.0)), vrp=ankle + np.array([ahead, 0.0]))
    change = asked.propose(tick_at(plan, time, found=(here,)))
    far = ahead > 0.05  # half of what the ankle bears
    least = min(RULES.largest_shift, ahead - 0.02)
    assert change.shift == pytest.approx((least if far else 0.0, 0.0))
    plan.apply(change, time, NOWHERE)
    again = replace(here, vrp=here.vrp + np.array([0.01, 0.0]))
    change = asked.propose(tick_at(plan, time + 1.5 * RULES.replan_pause, found=(again,)))
    assert change.shift == (0.0, 0.0)


def test_where_nothing_is_to_be_done_no_footstep_creeps(plan_of, tick_at):
    """Refining a foothold on the strip again and again used to shift the steps to come by up to 2 cm each time."""
    plan, asked = plan_of(length=0.0, sideways=0.0), proposer()
    off = {"left": -0.085 + 0.002, "right": 0.085 + 0.002}  # every foothold lies 2 mm off the walk's line
    for step in (1, 2):
        time = double_support(plan, step)
        side: Side = plan.view.foothold(step).side
        change = asked.propose(tick_at(plan, time, found=(found(plan, step, (0.0, off[side])),)))
        if change is not None:
            plan.apply(change, time, NOWHERE)
    for k in range(1, 40):
        steps, changes = [p.foothold for p in plan.view.steps], len(plan.record)
        change = asked.propose(tick_at(plan, time + 0.005 * k, found=(found(plan, 2, (0.0, 0.0)),)))
        if change is not None:
            plan.apply(change, time + 0.005 * k, NOWHERE)
        assert ([p.foothold for p in plan.view.steps] != steps) <= (len(plan.record) > changes)


def test_a_foothold_that_is_seen_moves_the_vrp_of_the_step_in_the_air(plan_of, tick_at):
    plan, time = plan_of(), 2.2 + 0.7
    seen = FootholdSeen(0, "left", plan.view.vrp(0) + np.array([0.03, 0.0]))
    change = FootholdSeenAhead(RULES).propose(tick_at(plan, time, seen=seen))
    assert (change.step, change.vrp) == (0, tuple(seen.vrp))
    close = FootholdSeen(0, "left", plan.view.vrp(0) + np.array([0.002, 0.0]))
    assert FootholdSeenAhead(RULES).propose(tick_at(plan, time, seen=close)) is None
    assert FootholdSeenAhead(RULES).propose(tick_at(plan, time)) is None


def test_what_a_foothold_moves_can_be_switched_off(plan_of, tick_at):
    def change(**settings):
        plan = plan_of()
        rules = FootholdRules(**settings)
        asked = FootholdCarries(rules, MIDDLES, OUTLINES, SupportStrip(np.zeros(2), np.array([0.0, 1.0])), 0.1)
        here = replace(found(plan, 2, (0.0, 0.0)), vrp=plan.view.foothold(2).position[:2] + np.array([0.07, 0.0]))
        return asked.propose(tick_at(plan, double_support(plan, 2), found=(here,))), here

    both, _ = change()
    assert both.shift != (0.0, 0.0)
    stays, here = change(move_steps=False)
    assert (stays.shift, stays.vrp) == ((0.0, 0.0), tuple(here.vrp))
    assert change(move_vrp=False)[0] is None
