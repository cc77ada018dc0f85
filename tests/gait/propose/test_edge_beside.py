"""Steps that move off an edge which a landing sole saw beside it, and no others."""

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.contact.path_drift import PathDrift
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.edge_beside import EdgeBeside
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout

NOWHERE = np.empty((0, 2))
DROP, FIRST = 0.04, 2.2 + 0.85  # m; s, when the first foot touches down
RULES = FootholdRules()


@pytest.fixture(scope="module")
def sole():
    return hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])


@pytest.fixture
def proposer(sole):
    return EdgeBeside(dict.fromkeys(SIDES, sole), RULES, DROP)


def down(side: Side, distance: NDArray[np.float64]) -> FeetView:
    """A foot that touches down, and what it saw."""
    return FeetView(dict.fromkeys(SIDES, (np.zeros(3), 0.0)), side, touchdown=True, distance=distance)


def ground(sole: SoleLayout, edge: float) -> NDArray[np.float64]:
    """Distances of a sole that stands on ground which ends at y = edge, with nothing to its right."""
    return np.where(sole.positions[:, 1] < edge, np.inf, 0.001)


def test_steps_move_away_from_the_edge_by_half_of_what_it_cuts_off(proposer, sole, plan_of, tick_at):
    plan = plan_of()
    change = proposer.propose(tick_at(plan, FIRST, feet=down("left", ground(sole, -0.045))))
    assert change.step == 0
    assert change.shift == pytest.approx((0.0, 0.5 * 0.025), abs=0.004)
    places = [plan.view.foothold(k).y for k in range(6)]
    assert plan.apply(change, FIRST, NOWHERE).moved[0].reason == "off the edge beside"
    moved = [plan.view.foothold(k).y - y for k, y in enumerate(places)]
    assert moved == pytest.approx([0.0] + 5 * [change.shift[1]])


def test_one_landing_moves_them_only_so_far(proposer, sole, plan_of, tick_at):
    change = proposer.propose(tick_at(plan_of(), FIRST, feet=down("left", ground(sole, -0.01))))
    assert change.shift == pytest.approx((0.0, RULES.largest_shift))


@pytest.mark.parametrize("what", ["whole", "dead taxels", "two taxels", "toes", "all but nothing"])
def test_what_is_no_edge_beside_moves_nothing(what, proposer, sole, plan_of, tick_at):
    x, y = sole.positions[:, 0], sole.positions[:, 1]
    seen = {
        "whole": np.full(len(sole), 0.001),
        "dead taxels": np.where(y < -0.045, np.nan, 0.001),
        "two taxels": np.where(np.arange(len(sole)) < 2, np.inf, 0.001),
        "toes": np.where(x > 0.06, np.inf, 0.001),
        "all but nothing": np.where(y < 0.05, np.inf, 0.001),
    }[what]
    assert proposer.propose(tick_at(plan_of(), FIRST, feet=down("left", seen))) is None


def test_between_two_edges_there_is_no_way(proposer, sole, plan_of, tick_at):
    plan = plan_of()
    first = proposer.propose(tick_at(plan, FIRST, feet=down("left", ground(sole, -0.045))))
    assert first is not None
    plan.apply(first, FIRST, NOWHERE)
    later = next(p.end for p in plan.schedule.phases if p.step == 1 and p.swing is not None) - 0.01
    mirrored = np.where(sole.positions[:, 1] > 0.045, np.inf, 0.001)
    assert proposer.propose(tick_at(plan, later, feet=down("right", mirrored))) is None
    assert EdgeBeside(dict.fromkeys(SIDES, sole), RULES, DROP).propose(
        tick_at(plan, later, feet=down("right", mirrored))
    )


def test_it_asks_again_until_its_change_is_applied(proposer, sole, plan_of, tick_at):
    plan = plan_of()
    first = proposer.propose(tick_at(plan, FIRST, feet=down("left", ground(sole, -0.045))))
    plan.apply(PlanChange("somebody else's", 3, vrp=(0.8, 0.0)), FIRST, NOWHERE)
    second = proposer.propose(tick_at(plan, FIRST + 0.005))
    assert first is not None
    assert second == first
    plan.apply(second, FIRST + 0.005, NOWHERE)
    assert proposer.propose(tick_at(plan, FIRST + 0.01)) is None


def walk(plan, sole, tick_at, ends, steps):
    """Walks on ground that ends at `ends` (a left and a right sole's lateral place in m, by step) beside its plan.

    Returns the steps that change the plan, and how far in m each sole lands to the left of where the plan first had it.
    """
    proposer = EdgeBeside(dict.fromkeys(SIDES, sole), RULES, DROP, PathDrift(0.008, 40.0))
    planned = [plan.view.foothold(k).y for k in range(plan.view.count)]
    changed, beside = [], []
    for phase in [p for p in plan.schedule.phases if p.swing is not None][:steps]:
        foot = plan.view.foothold(phase.step)
        beside.append(foot.y - planned[phase.step])
        y = sole.positions[:, 1] + beside[-1]
        low, high = ends(phase.step, phase.swing)
        seen = np.where((y < low) | (y > high), np.inf, 0.001)
        feet = {side: (np.zeros(3), 0.0) for side in SIDES} | {phase.swing: (foot.position, foot.yaw)}
        touchdown = FeetView(feet, phase.swing, touchdown=True, distance=seen)
        change = proposer.propose(tick_at(plan, phase.end - 0.01, feet=touchdown))
        if change is not None:
            changed.append(phase.step)
            plan.apply(change, phase.end - 0.01, NOWHERE)
            assert proposer.propose(tick_at(plan, phase.end - 0.005)) is None
    return changed, np.array(beside)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_steps_follow_ground_that_turns_away(sign, sole, plan_of, tick_at):
    """By 4 mm a step after 60, 120 mm in all; soles keep on it to a row of taxels and what it turns in a stride."""

    def turned(step):
        return sign * 0.5 * 0.004 * step**2 / 60

    def ends(step, side):
        return (turned(step) - 0.07, 1.0) if side == "left" else (-1.0, turned(step) + 0.07)

    changed, beside = walk(plan_of(60), sole, tick_at, ends, 60)
    assert len(changed) > 5
    assert np.abs(beside - turned(np.arange(60))).max() < 0.03


def test_mirrored_ground_moves_steps_mirrored(sole, plan_of, tick_at):
    def ends(step, side):
        return (-1.0, 0.07) if side == "left" else (-1.0, 0.07 - 2e-5 * step**2)

    def mirrored(step, side):
        low, high = ends(step, "left" if side == "right" else "right")
        return -high, -low

    _, beside = walk(plan_of(40), sole, tick_at, ends, 40)
    _, other = walk(plan_of(40, first="right"), sole, tick_at, mirrored, 40)
    assert np.abs(beside).max() > 0.02
    assert other == pytest.approx(-beside, abs=0.004)  # the sole's rows are not quite mirrored


@pytest.mark.parametrize("cut", [0.03, 0.045, 0.06])
@pytest.mark.parametrize("step", range(6))
def test_one_partial_foothold_of_a_short_walk_moves_nothing(step, cut, sole, plan_of, tick_at):
    changed, _ = walk(plan_of(6), sole, tick_at, lambda k, side: (-0.07 + cut if k == step else -1.0, 1.0), 6)
    assert changed == []


def test_ground_that_ends_on_both_sides_is_stood_on_in_its_middle(sole, plan_of, tick_at):
    """Each foot sees an edge: steps do not leave the ground of either by more than a row of taxels."""

    def ends(step, side):
        return (-0.045, 1.0) if side == "left" else (-1.0, 0.045)

    _, beside = walk(plan_of(60), sole, tick_at, ends, 60)
    assert np.abs(beside).max() < 0.03
