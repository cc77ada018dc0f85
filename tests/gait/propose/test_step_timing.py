import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import shapely
import shapely.ops

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.proposer import Pendulum, Tick
from plantar.gait.propose.step_timing import StepTiming, StepTimingRules

PERIOD = 0.005
RULES = StepTimingRules()
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
NARROW, WIDE = 1e-4 * SQUARE, 0.1 * SQUARE  # m about the stance's VRP
NOW = 3.4 + 0.45  # s: half-way through the second single support of the plan


@pytest.fixture
def timed(plan_of, tick_at):
    """Makes a plan, and the tick at a time of it at which the DCM and the room of the ZMP are given."""

    def made(time: float, dcm: Any, room: np.ndarray = NARROW, **known: Any) -> tuple[WalkPlan, Tick]:
        plan = plan_of()
        reference = plan.at(time)
        goal = plan.dcm_after(plan.schedule.at(time))
        pendulum = Pendulum(3.5, np.asarray(dcm(plan)), reference, goal, reference.vrp + room)
        return plan, tick_at(plan, time, pendulum=pendulum, **known)

    return made


def proposed(tick: Tick, **rules: Any) -> PlanChange | None:
    return StepTiming(StepTimingRules(**rules), PERIOD).propose(tick)


def late_by(seconds: float) -> Callable[[WalkPlan], np.ndarray]:
    return lambda plan: plan.at(NOW - seconds).dcm


def missed(tick: Tick, left: float) -> float:
    """By how much the DCM misses the end of the stance, with the best constant ZMP: a distance in GEOS."""
    pendulum, growth = tick.pendulum, math.exp(3.5 * left) - 1.0
    wanted = pendulum.dcm + (pendulum.dcm - pendulum.goal) / growth
    return growth * float(shapely.Polygon(pendulum.zmp_region).distance(shapely.Point(wanted)))


@pytest.mark.parametrize("late", [0.04, 0.08, 0.12])
def test_a_dcm_that_is_behind_gets_the_time_that_it_needs(late, timed):
    plan, tick = timed(NOW, late_by(late))
    change = proposed(tick, price=0.0)
    assert change.reason == "DCM behind"
    assert change.longer == pytest.approx(late, abs=2.0 * PERIOD)
    plan.apply(change, NOW, tick.pendulum.zmp_region)
    # The plan goes on from where the body is, and its steps stay where they are.
    assert plan.at(NOW).dcm == pytest.approx(tick.pendulum.dcm, abs=0.005)
    assert plan.at(NOW).com == pytest.approx(tick.pendulum.reference.com, abs=1e-12)
    assert plan.schedule.at(NOW).end == pytest.approx(tick.phase.end + change.longer)
    assert [s.foothold for s in plan.view.steps] == [s.foothold for s in tick.plan.steps]


def test_one_that_is_ahead_is_followed_as_far_as_the_foot_can_be_hurried(timed):
    _, tick = timed(NOW, late_by(-0.06))
    change = proposed(tick, price=0.0)
    assert change.reason == "DCM ahead"
    assert change.longer == pytest.approx(-0.06, abs=2.0 * PERIOD)
    _, far = timed(NOW, late_by(-0.3))
    left = far.phase.end - NOW
    assert left + proposed(far, price=0.0).longer == pytest.approx(RULES.least_left, abs=PERIOD)
    way = np.array([0.1, 0.0])  # m, which takes a foot longer
    hurried = proposed(far.changed(feet=far.feet.changed(ahead=way)), price=0.0)
    assert left + hurried.longer == pytest.approx(math.sqrt(5.774 * 0.1 / RULES.acceleration), abs=PERIOD)


@pytest.mark.parametrize("off", [0.02, 0.1])
def test_a_foot_is_not_hurried_for_a_dcm_that_runs_the_other_way(off, timed):
    def beyond(plan: WalkPlan) -> np.ndarray:
        step = plan.schedule.at(NOW).step
        way = plan.view.vrp(step) - plan.view.stance_vrp(step)
        return plan.view.stance_vrp(step) - off * way / np.hypot(*way)

    change = proposed(timed(NOW, beyond)[1], price=0.0)
    assert change is None or change.longer > 0.0


def test_what_the_zmp_can_do_is_left_to_it(timed):
    for late in (0.0, 0.04, -0.04):
        assert proposed(timed(NOW, late_by(late), WIDE)[1]) is None
    assert proposed(timed(NOW, late_by(0.0))[1]) is None
    assert proposed(timed(NOW, late_by(0.003))[1]) is None  # 15 ms of walking: less than the least error


def towards_the_lifting_foot(time: float, off: float) -> Callable[[WalkPlan], np.ndarray]:
    def dcm(plan: WalkPlan) -> np.ndarray:
        step = plan.schedule.at(time).step
        way = plan.view.stance_vrp(step) - plan.view.vrp_before(step, plan.view.foothold(step).side)
        return plan.at(time).dcm - off * way / np.hypot(*way)

    return dcm


@pytest.mark.parametrize("left", [0.1, 0.05, 0.02])
@pytest.mark.parametrize("off", [0.07, 0.09])
def test_a_foot_does_not_lift_before_the_dcm_is_where_the_next_stance_can_hold_it(left, off, timed):
    time = timed(3.2, late_by(0.0))[1].phase.end - left
    # The sole's edge, 0.1 m out, holds it and brings it back.
    _, tick = timed(time, towards_the_lifting_foot(time, off), WIDE)
    change = proposed(tick, price=0.0)
    assert missed(tick, left) > missed(tick, left + change.longer) + RULES.least_error
    assert change.reason == "DCM behind"
    beyond = timed(time, towards_the_lifting_foot(time, 0.3), WIDE)[1]
    assert proposed(beyond) is None  # it only runs away: the next step has to come
    ahead = timed(time, towards_the_lifting_foot(time, -off), WIDE)[1]
    assert proposed(ahead) is None  # the next stance foot does alone what both can do


def test_standing_has_no_time_of_its_own_nor_has_a_foot_that_waits(timed):
    behind = late_by(0.1)
    standing, last = (timed(t, lambda plan: plan.at(0.0).dcm + 0.1)[1] for t in (-1.0, 1e3))
    assert proposed(standing) is None
    assert proposed(last) is None
    _, tick = timed(NOW, behind)
    assert proposed(tick.changed(pendulum=None)) is None  # without feedback
    waits = tick.phase.__class__(**{**vars(tick.phase), "wait": 0.2})
    assert proposed(tick.changed(phase=waits)) is None  # somebody else has the time in hand


def test_it_rests_between_two_changes(timed):
    _, tick = timed(NOW, late_by(0.08))
    timing = StepTiming(RULES, PERIOD)
    assert timing.propose(tick) is not None
    assert timing.propose(tick.changed(time=NOW + 0.5 * RULES.pause)) is None
    assert timing.propose(tick.changed(time=NOW + RULES.pause)) is not None


@pytest.mark.parametrize("seed", range(100))
def test_a_change_is_the_best_that_there_is_and_worth_its_price(timed, seed):
    rng = np.random.default_rng(seed)
    time = NOW + float(rng.uniform(-0.4, 0.4))
    off = rng.normal(0.0, 0.02, 2)
    _, tick = timed(time, lambda plan: plan.at(time).dcm + off, SQUARE * rng.uniform(0.002, 0.04, 2))
    change, left = proposed(tick), tick.phase.end - time
    before = missed(tick, left)
    begun = time - tick.phase.start
    longest = (1.0 + RULES.longest) * 0.9 - begun
    least = RULES.least_left  # the foot is at its place already
    later, sooner = np.arange(left, longest + 1e-9, PERIOD), np.arange(left, least - 1e-9, -PERIOD)
    # By GEOS, again: where the DCM would miss its goal to, of the way from the standing to the swinging foot.
    wanted = tick.pendulum.dcm + (tick.pendulum.dcm - tick.pendulum.goal) / (math.exp(3.5 * left) - 1.0)
    nearest = shapely.ops.nearest_points(shapely.Polygon(tick.pendulum.zmp_region), shapely.Point(wanted))[0]
    step = tick.phase.step
    runs_to_foot = (wanted - [nearest.x, nearest.y]) @ (tick.plan.vrp(step) - tick.plan.stance_vrp(step)) > 0.0
    allowed = later.tolist() + (sooner.tolist() if runs_to_foot else [])
    best = min([missed(tick, t) + RULES.price * abs(t - left) for t in allowed], default=before)
    if change is None:
        near = (left - PERIOD, left, left + PERIOD) if runs_to_foot else (left, left + PERIOD)
        soon = min(missed(tick, t) + RULES.price * abs(t - left) for t in near)
        assert before < RULES.least_error or best >= soon - 1e-12  # a change of one period is none
        return
    after = left + change.longer
    assert before >= RULES.least_error
    assert missed(tick, after) + RULES.price * abs(change.longer) == pytest.approx(best, abs=1e-9)
    assert min(left, least) - 1e-9 <= after <= max(left, longest) + 1e-9
