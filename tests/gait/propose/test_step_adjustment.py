import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import shapely

from plantar.common.sides import other_side
from plantar.gait.balance.ankle_strategy import AnkleRules
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import PhaseKind, Timing
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose import step_adjustment
from plantar.gait.propose.proposer import Pendulum, Tick
from plantar.gait.propose.ssp_opt import StepRegionRules, StepWeights
from plantar.gait.propose.step_adjustment import StepAdjustment, StepAdjustmentRules

PERIOD = 0.005
RULES = StepAdjustmentRules()
REGION = StepRegionRules()
TOUCHING = 0.14  # m
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
WHOLE = AnkleRules(forward=1.0, sideways=1.0)
ROOM = 0.03 * SQUARE  # m about the stance's VRP
NOW = 3.4 + 0.45  # s: half-way through the second single support of the plan
METHODS = ["search", "ssp_opt"]


@pytest.fixture
def pushed(plan_of, tick_at):
    """Makes a plan, and the tick at a time of it at which the DCM is pushed aside."""

    def made(by: Any, time: float = NOW, room: np.ndarray = ROOM, **known: Any) -> tuple[WalkPlan, Tick]:
        plan = plan_of()
        reference, goal = plan.at(time), plan.dcm_after(plan.schedule.at(time))
        pendulum = Pendulum(3.5, reference.dcm + np.asarray(by), reference, goal, reference.vrp + room, **known)
        tick = tick_at(plan, time, pendulum=pendulum)
        phase = plan.schedule.at(time)
        swing = phase.swing
        assert swing is not None
        step, stance = plan.view.foothold(phase.step), plan.view.foothold(phase.step - 1)
        # The stance foot stands at its place, the other one is on its way over the last 50 mm.
        feet = {
            swing: (np.array([step.x - 0.05, step.y, 0.03]), step.yaw),
            other_side(swing): (stance.position, stance.yaw),
        }
        return plan, tick.changed(feet=tick.feet.changed(footholds=feet, side=swing, landed=False))

    return made


def adjustment(**rules: Any) -> StepAdjustment:
    return StepAdjustment(replace(RULES, **rules), REGION, TOUCHING, StepWeights(), WHOLE, PERIOD)


def proposed(tick: Tick, **rules: Any) -> PlanChange | None:
    return adjustment(**rules).propose(tick)


def ends(tick: Tick, left: float) -> shapely.Polygon:
    """Every place of the DCM after some time that a constant ZMP of the region brings about."""
    pendulum, grown = tick.pendulum, math.exp(3.5 * left)
    return shapely.Polygon(grown * pendulum.dcm - (grown - 1.0) * (pendulum.zmp_region - pendulum.offset))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("by", [(0.1, 0.0), (-0.1, 0.0), (0.0, -0.08), (0.05, -0.05)])
def test_a_push_moves_the_step_its_way(method, by, pushed):
    plan, tick = pushed(by)
    sign = 1.0 if tick.phase.swing == "left" else -1.0
    by = (by[0], -sign * by[1])  # out to the side of the foot that swings
    plan, tick = pushed(by)
    change = proposed(tick, method=method)
    assert change.reason == "step adjusted"
    assert float(np.dot(change.shift, by)) > 0.0
    moved = plan.apply(change, NOW, tick.pendulum.zmp_region).moved
    before = tick.plan.foothold(tick.phase.step)
    assert math.dist((moved[0].x, moved[0].y), (before.x, before.y)) == pytest.approx(math.hypot(*change.shift))
    # What the ZMP has to leave is less than before.
    end = plan.schedule.at(NOW)
    missed = ends(tick, end.end - NOW).distance(shapely.Point(plan.dcm_after(end)))
    assert missed < 0.8 * ends(tick, tick.phase.end - NOW).distance(shapely.Point(tick.pendulum.goal))


@pytest.mark.parametrize("method", METHODS)
def test_what_the_zmp_can_do_is_left_to_it(method, pushed):
    for by in ((0.0, 0.0), (0.01, 0.0), (0.0, 0.015)):
        assert proposed(pushed(by)[1], method=method) is None
    assert proposed(pushed((0.0, 0.1), room=0.5 * SQUARE)[1], method=method) is None


def test_what_the_next_double_support_takes_up_moves_no_step(pushed):
    left, both = 0.45, 0.3
    growth = math.expm1(3.5 * left)
    taken_up = 0.03 * -math.expm1(-3.5 * both)  # by the room on each side of the VRP
    for missed, steps in ((0.8 * taken_up, False), (1.2 * taken_up, True)):
        assert missed > RULES.least_error
        by = (0.03 + missed / growth) / (1.0 + 1.0 / growth)
        assert (proposed(pushed((by, 0.0))[1]) is not None) == steps


def test_a_small_pushs_miss_has_to_last_and_a_large_one_does_not(pushed):
    growth = math.expm1(3.5 * 0.45)

    def by(missed):
        return (0.03 + missed / growth) / (1.0 + 1.0 / growth), 0.0

    push = np.array([0.02, 0.0])
    for missed, late, steps in ((0.03, 0.0, False), (0.03, 1.1 * RULES.lasting, True), (0.1, 0.0, True)):
        stepper = adjustment()
        assert stepper.propose(pushed((0.015, 0.0), NOW - max(PERIOD, late))[1]) is None
        assert (stepper.propose(pushed(by(missed), pushed=push)[1]) is not None) == steps
    assert proposed(pushed(by(0.03), pushed=push)[1]) is not None  # as a step begins, or lastingly


@pytest.mark.parametrize("seed", range(60))
def test_the_footstep_stays_in_its_region_and_where_the_foot_gets_to(pushed, seed):
    rng = np.random.default_rng(seed)
    time = NOW + float(rng.uniform(-0.4, 0.35))
    method = METHODS[seed % 2]
    _, tick = pushed(rng.normal(0.0, 0.08, 2), time)
    change = proposed(tick, method=method)
    if change is None:
        return
    swing = tick.phase.swing
    assert swing is not None
    left = tick.phase.end + (change.longer or 0.0) - time
    place = np.array([change.foothold.x, change.foothold.y])
    planned = tick.plan.foothold(tick.phase.step).position[:2]
    here = tick.place(swing).position[:2]
    assert math.dist(place, here) <= RULES.acceleration * (left + PERIOD) ** 2 / 5.77 + 1e-9
    stance = tick.place("right" if swing == "left" else "left")
    near, far = sorted((1.0 if swing == "left" else -1.0) * d for d in (TOUCHING + REGION.clearance, REGION.outside))
    box = shapely.box(stance.x - REGION.backward, stance.y + near, stance.x + REGION.forward, stance.y + far)
    # Towards its place the foot may still be on its way into the box, from where it is.
    allowed = box.union(shapely.Point(planned)).union(shapely.Point(here)).convex_hull
    assert allowed.distance(shapely.Point(place)) < 1e-9


@pytest.mark.parametrize("seed", range(40))
def test_the_search_is_as_good_as_trying_everything(pushed, seed):
    """Over all times in periods, with distances of GEOS."""
    rng = np.random.default_rng(seed)
    _, tick = pushed(rng.normal(0.0, 0.06, 2))
    rules = replace(RULES, acceleration=100.0)  # the foot gets everywhere
    change = StepAdjustment(rules, REGION, TOUCHING, StepWeights(), WHOLE, PERIOD).propose(tick)
    left, usual, begun = tick.phase.end - NOW, 0.9, NOW - tick.phase.start
    slope = (1.0 - math.exp(-3.5 * 0.3)) / (3.5 * 0.3)  # the plan's double support lasts 0.3 s
    price = 0.1 * rules.price_place

    def cost(time: float, move: np.ndarray) -> float:
        goal = tick.pendulum.goal + slope * move
        missed = ends(tick, time).distance(shapely.Point(goal))
        when = rules.price_time * (left - time) if time < left else rules.price_later * (time - left)
        return missed + when + price * float(np.hypot(*move))

    least = max(rules.least_left, (1.0 - rules.shortest) * (usual - begun))
    times = np.arange(least, (1.0 + rules.longest) * usual - begun, PERIOD)
    # Without a footstep's change; moves only ever help where that misses.
    still = min(cost(float(t), np.zeros(2)) for t in times)
    if change is None:  # the ankles do it, or nothing helps
        stays = cost(left, np.zeros(2))
        assert stays < rules.least_error or stays < still + 2e-3
        return
    found = cost(left + change.longer, np.array(change.shift))
    assert found <= still + 2e-3
    assert found < cost(left, np.zeros(2))


def test_a_slow_walk_steps_as_fast_as_another(tick_at):
    """The DCM does not wait for it: the time to land follows from the leg, not from the walk's tempo."""
    soonest = []
    for single in (0.9, 1.4, 2.0):
        feet, steps = straight_plan(6)
        plan = WalkPlan(feet, steps, Timing(single_support=single), dict.fromkeys(feet, np.zeros(2)), 3.5, 1.0)
        phase = next(p for p in plan.schedule.phases if p.step == 1 and p.swing is not None)
        time = phase.start + 0.4 * single
        pushed = plan.at(time).dcm + np.array([0.3, 0.0])  # more than any step makes up for
        pendulum = Pendulum(3.5, pushed, plan.at(time), plan.dcm_after(phase), plan.at(time).vrp + ROOM)
        tick = tick_at(plan, time, pendulum=pendulum)
        change = proposed(tick.changed(feet=tick.feet.changed(side=phase.swing, landed=False)))
        soonest.append(phase.end - time + change.longer)
    assert soonest == pytest.approx([0.6 * 0.55 * 0.9] * 3, abs=2 * PERIOD)


def test_a_push_that_goes_on_is_reckoned_with(pushed):
    assert proposed(pushed((0.0, 0.0))[1]) is None
    change = proposed(pushed((0.0, 0.0), offset=np.array([0.08, 0.0]))[1])
    assert change.shift[0] > 0.0


def test_a_confident_robot_moves_its_steps_less(pushed):
    tick = pushed((0.045, 0.0))[1]
    moves = [proposed(tick, confidence=c, price_place=2.0) for c in (0.0, 1.0)]
    sizes = [0.0 if change is None else math.hypot(*change.shift) for change in moves]
    assert sizes[1] < sizes[0]


def test_the_nominal_place_is_that_before_the_steps_own_adjustments(pushed, monkeypatch):
    """K 30: u_n stays where the walk had it, u_s is the last tick's; what something else moves is nominal."""
    seen = []
    solve = step_adjustment.solve_ssp
    monkeypatch.setattr(step_adjustment, "solve_ssp", lambda problem, w: seen.append(problem) or solve(problem, w))
    steps = adjustment(method="ssp_opt", confidence=0.5)
    plan, tick = pushed((0.1, 0.0))
    step = tick.phase.step
    first = plan.view.vrp(step)
    plan.apply(steps.propose(tick), NOW, tick.pendulum.zmp_region)
    moved = plan.view.vrp(step)
    assert math.dist(first, moved) > 0.02
    steps.propose(tick.changed(time=NOW + 0.1, plan=plan.view, phase=plan.schedule.at(NOW + 0.1)))
    place = plan.view.foothold(step)
    plan.apply(PlanChange("refused", step, replace(place, y=place.y + 0.1)), NOW, tick.pendulum.zmp_region)
    steps.propose(tick.changed(time=NOW + 0.2, plan=plan.view, phase=plan.schedule.at(NOW + 0.2)))
    assert [p.nominal[:2] for p in seen] == [
        pytest.approx(first),
        pytest.approx(first),
        pytest.approx(plan.view.vrp(step)),
    ]
    assert seen[1].target[:2] == pytest.approx(moved)


def test_a_foot_in_flight_gets_farther_its_way(pushed):
    _, tick = pushed((0.15, 0.0))
    still, moving = adjustment(), adjustment()
    swing = tick.phase.swing
    position, yaw = tick.feet.footholds[swing]
    back = dict(tick.feet.footholds) | {swing: (position - np.array([0.005, 0.0, 0.0]), yaw)}  # 1 m/s
    calm = tick.pendulum.changed(dcm=tick.pendulum.reference.dcm)
    earlier = tick.changed(time=NOW - PERIOD, feet=tick.feet.changed(footholds=back), pendulum=calm)
    assert moving.propose(earlier) is None
    first, second = still.propose(tick), moving.propose(tick)
    assert second.foothold.x > first.foothold.x + 0.01


def test_a_foot_that_lands_early_ends_the_single_support(pushed):
    plan, tick = pushed((0.1, 0.0))
    steps = adjustment()
    change = steps.propose(tick)
    assert change is not None
    plan.apply(change, NOW, tick.pendulum.zmp_region)
    down = tick.changed(time=NOW + 0.05, plan=plan.view, phase=plan.schedule.at(NOW + 0.05))
    place = plan.view.foothold(tick.phase.step)
    standing = {s: (np.array([f[0][0], f[0][1], 0.0]), f[1]) for s, f in tick.feet.footholds.items()}
    standing[tick.phase.swing] = (np.array([place.x - 0.05, place.y, 0.0]), 0.1)
    down = down.changed(feet=tick.feet.changed(footholds=standing, landed=True))
    landed = steps.propose(down)
    assert landed.reason == "landed beside its place"
    assert landed.shift == pytest.approx((-0.05, 0.0), abs=1e-12)
    assert landed.foothold.yaw == pytest.approx(0.1)
    assert down.phase.end + landed.longer == pytest.approx(NOW + 0.05 + PERIOD)
    assert steps.propose(down) is None  # told once


@pytest.mark.parametrize("other_rule", [False, True])
def test_a_double_support_has_one_rule_that_ends_it(other_rule, plan_of, tick_at):
    plan, change = plan_of(), PlanChange("DCM behind", 1, longer=0.1)
    time, timing = 3.2, SimpleNamespace(propose=lambda tick: change)
    reference, goal = plan.at(time), plan.dcm_after(plan.schedule.at(time))
    tick = tick_at(plan, time, pendulum=Pendulum(3.5, reference.dcm, reference, goal, reference.vrp + ROOM))
    assert tick.phase.kind == PhaseKind.DOUBLE_SUPPORT
    rules = replace(RULES, double_support=other_rule)
    steps = StepAdjustment(rules, REGION, TOUCHING, StepWeights(), WHOLE, PERIOD, timing)
    assert steps.propose(tick) is (None if other_rule else change)


def test_a_step_that_nobody_adjusted_keeps_its_time(pushed):
    _, tick = pushed((0.0, 0.0), NOW + 0.3)
    place = tick.plan.foothold(tick.phase.step)
    standing = dict(tick.feet.footholds) | {tick.phase.swing: (np.array([place.x, place.y, 0.0]), place.yaw)}
    assert proposed(tick.changed(feet=tick.feet.changed(footholds=standing, landed=True))) is None


def test_it_rests_between_two_changes_and_needs_feedback(pushed):
    _, tick = pushed((0.1, 0.0))
    steps = adjustment()
    assert steps.propose(tick.changed(pendulum=None)) is None
    assert steps.propose(tick) is not None
    assert steps.propose(tick.changed(time=NOW + 0.5 * RULES.pause)) is None
    assert steps.propose(tick.changed(time=NOW + 1.01 * RULES.pause)) is not None


def test_steps_are_planned_with_a_part_of_the_support_and_with_confidence_all_of_it(pushed):
    _, tick = pushed((0.045, 0.0))

    def moved(forward: float, confidence: float) -> float:
        # At its planned time, and wherever it gets to: nothing else is left to choose.
        rules = replace(RULES, confidence=confidence, price_place=0.0, acceleration=100.0, shortest=0.0, longest=0.0)
        anywhere, part = replace(REGION, forward=1.0), AnkleRules(forward=forward, sideways=1.0)
        steps = StepAdjustment(rules, anywhere, TOUCHING, StepWeights(), part, PERIOD)
        change = steps.propose(tick)
        return 0.0 if change is None else math.hypot(*change.shift)

    assert moved(0.5, 0.0) > moved(1.0, 0.0) + 0.005
    assert moved(0.5, 1.0) == pytest.approx(moved(1.0, 0.0), abs=1e-9)


def test_a_step_goes_along_with_a_push_as_far_as_it_is_not_confident(pushed):
    pushing = np.array([0.05, 0.0])

    def moved(confidence: float, by: np.ndarray = pushing) -> np.ndarray:
        change = proposed(pushed((0.0, 0.0), pushed=by)[1], confidence=confidence, yielding=1.0)
        return np.zeros(2) if change is None else np.array(change.shift)

    sizes = [float(moved(c)[0]) for c in (0.0, 0.3, 0.6, 1.0)]
    assert sizes == pytest.approx([0.05, 0.035, 0.02, 0.0], abs=1e-9)
    assert proposed(pushed((0.0, 0.0), pushed=pushing)[1]) is None  # one that does not yield
    assert not moved(0.0, 0.1 * pushing).any()  # too little to change a step for


def test_it_goes_along_once_and_farther_only_with_a_push_that_grows(pushed):
    steps = adjustment(confidence=0.5, yielding=1.0)
    plan, tick = pushed((0.0, 0.0), pushed=np.array([0.06, 0.0]))
    change = steps.propose(tick)
    assert change.reason == "goes along with a push"
    assert change.shift == pytest.approx((0.03, 0.0), abs=1e-9)
    plan.apply(change, NOW, tick.pendulum.zmp_region)
    pendulum = tick.pendulum.changed(reference=plan.at(NOW), goal=plan.dcm_after(tick.phase), dcm=plan.at(NOW).dcm)
    again = tick.changed(time=NOW + 0.1, plan=plan.view, pendulum=pendulum)
    assert steps.propose(again) is None
    fading = again.changed(pendulum=pendulum.changed(pushed=np.array([0.01, 0.0])))
    assert steps.propose(fading) is None
    more = again.changed(pendulum=pendulum.changed(pushed=np.array([0.1, 0.0])))
    change = steps.propose(more)
    assert change.shift == pytest.approx((0.02, 0.0), abs=1e-9)


def test_an_undisturbed_robot_on_a_sole_that_ends_near_its_vrp_keeps_its_steps(pushed):
    ankle = AnkleRules(law="regulation", confident=False)  # half of the sole along, about the VRP
    adjust = StepAdjustment(RULES, REGION, TOUCHING, StepWeights(), ankle, PERIOD)
    cut = np.array([[-0.1, -0.05], [0.02, -0.05], [0.02, 0.05], [-0.1, 0.05]])  # its middle is 40 mm behind
    assert adjust.propose(pushed((0.0, 0.0), room=cut)[1]) is None
    assert adjust.propose(pushed((0.06, 0.0), room=cut)[1]) is not None
