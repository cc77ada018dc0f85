import numpy as np
import pytest

from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.slope_inside import SlopeInside, inward_distance
from plantar.sides import Side

NOWHERE = np.empty((0, 2))


def touchdown(side: Side) -> FeetView:
    return FeetView({side: (np.zeros(3), 0.0)}, side, landed=True, touchdown=True)


@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_inside_is_towards_the_other_foot(side, sign):
    assert inward_distance(side, 0.12, 0.1, 0.8) == pytest.approx(sign * 0.016)
    assert inward_distance(side, 0.1, 0.1, 0.8) == 0.0
    assert inward_distance(side, -0.3, 0.1, 0.8) == 0.0  # the inner edge is the higher one


def test_a_foot_on_a_slope_is_stood_on_further_inside(plan_of, tick_at):
    plan, time = plan_of(), 2.2 + 0.85
    change = SlopeInside().propose(tick_at(plan, time, feet=touchdown("left"), inward=-0.02))
    assert change.step == 0
    assert change.vrp == pytest.approx(tuple(plan.view.vrp(0) + np.array([0.0, -0.02])))


def test_it_asks_again_until_its_change_is_applied(plan_of, tick_at):
    plan, time, proposer = plan_of(), 2.2 + 0.85, SlopeInside()
    first = proposer.propose(tick_at(plan, time, feet=touchdown("left"), inward=-0.02))
    plan.apply(PlanChange("somebody else's", 3, vrp=(0.8, 0.0)), time, NOWHERE)
    second = proposer.propose(tick_at(plan, time + 0.005))
    assert first is not None
    assert second == first
    plan.apply(second, time + 0.005, NOWHERE)
    assert proposer.propose(tick_at(plan, time + 0.01)) is None


def test_level_ground_is_stood_on_as_planned(plan_of, tick_at):
    assert SlopeInside().propose(tick_at(plan_of(), 3.0, feet=touchdown("left"))) is None
