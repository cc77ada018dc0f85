"""Steps that move off an edge which a landing sole saw beside it, and no others."""

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.edge_beside import EdgeBeside
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout

NOWHERE = np.empty((0, 2))
DROP, LARGEST, FIRST = 0.04, 0.02, 2.2 + 0.85  # s, when the first foot touches down


@pytest.fixture(scope="module")
def sole():
    return hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])


@pytest.fixture
def proposer(sole):
    return EdgeBeside(dict.fromkeys(SIDES, sole), DROP, LARGEST)


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
    assert change.shift == pytest.approx((0.0, LARGEST))


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
    assert EdgeBeside(dict.fromkeys(SIDES, sole), DROP, LARGEST).propose(
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


@pytest.mark.parametrize(
    ("left", "right", "moves"),
    [
        ((-0.045, -0.045, -0.045), (None, None), True),
        ((-0.045, -0.04, -0.045), (None, None), True),  # a row of taxels more
        ((-0.045, -0.045, None), (None, None), False),
        ((-0.045, 0.0, -0.045), (None, None), False),  # stones of three shapes
        ((-0.045, -0.045, -0.045), (None, -0.045), False),
    ],
)
def test_a_walk_that_bears_partial_footholds_moves_onto_the_ground_whose_edge_it_drifts_to(
    left, right, moves, sole, plan_of, tick_at
):
    proposer, plan = EdgeBeside(dict.fromkeys(SIDES, sole), DROP, 0.05, drift=True), plan_of()
    edges = [left[0], right[0], left[1], right[1], left[2]]
    changes = landings(proposer, plan, edges, sole, tick_at)
    assert changes[:4] == [None] * 4
    assert (changes[4] is not None) is moves
    if moves:
        assert changes[4].shift == pytest.approx((0.0, 0.025), abs=0.006)


def test_a_drift_that_goes_on_is_followed_at_each_landing(sole, plan_of, tick_at):
    proposer, plan = EdgeBeside(dict.fromkeys(SIDES, sole), DROP, 0.05, drift=True), plan_of(10)
    edges = [-0.045, None] * 5
    changes = landings(proposer, plan, edges[:-1], sole, tick_at)
    assert [change is not None for change in changes] == [False] * 4 + [True, False, True, False, True]


def landings(proposer, plan, edges, sole, tick_at):
    """Changes proposed at the landings of a walk whose soles see ground that ends at each of some edges."""
    swings = [p for p in plan.schedule.phases if p.swing is not None][: len(edges)]
    changes = []
    for edge, phase in zip(edges, swings, strict=True):
        seen = np.full(len(sole), 0.001) if edge is None else ground(sole, edge)
        change = proposer.propose(tick_at(plan, phase.end - 0.01, feet=down(phase.swing, seen)))
        changes.append(change)
        if change is not None:
            plan.apply(change, phase.end - 0.01, NOWHERE)
            assert proposer.propose(tick_at(plan, phase.end - 0.005)) is None
    return changes
