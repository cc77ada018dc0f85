"""Doubt, probe, step on or walk around, stop: from ticks alone."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plantar import Reading, hex_layout
from plantar.common.sides import SIDES
from plantar.gait.contact.foot_contacts import REMEMBERED
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.feasibility import FeasibilityRules
from plantar.gait.propose.foothold_refused import StepGuard
from plantar.gait.propose.proposer import Pendulum, Tick

PERIOD = 0.005
LAYOUT = hex_layout([[-0.1, -0.07], [0.12, -0.07], [0.12, 0.07], [-0.1, 0.07]])
RULES = FeasibilityRules()
FRONT = LAYOUT.positions[:, 0] > 0.07


def ticks(plan, step, touch, carries, guard, tick_at, sees=False):
    """The ticks of a step that meets something high at a time in s after lift-off, which carries on some taxels, and
    which the foot sees before.
    """
    side = plan.view.foothold(step).side
    start = next(p.start for p in plan.schedule.phases if p.step == step and p.swing is not None)
    force = np.where(carries, 130.0 / carries.sum(), 0.0)
    for k in range(1000):
        time = start + k * PERIOD
        landed = k * PERIOD >= touch
        surprise = 0.03 if k * PERIOD > touch - 0.05 else 0.0
        tick = tick_at(plan, time)
        if tick.phase.step != step or tick.phase.swing is None:
            return
        readings = {s: Reading(time=time, force=force if landed and s == side else 0.0 * force) for s in SIDES}
        pressed = guard.press or 0.0
        feet = FeetView(tick.feet.footholds, side, landed, surprise=surprise, distance=np.where(carries, 0.0, 0.03))
        if sees and surprise and not landed:
            feet = feet.changed(below=np.where(carries, 0.01, 0.04))
        loads = {side: pressed, **{s: 800.0 for s in SIDES if s != side}}
        yield tick.changed(feet=feet, readings=readings, loads=loads)


def walked(guard: StepGuard, plan: WalkPlan, carries: np.ndarray, tick_at: Callable[..., Tick]) -> list[PlanChange]:
    """What it proposes in a step, each change applied."""
    changes = []
    for tick in ticks(plan, 2, 0.8, carries, guard, tick_at):
        change = guard.propose(tick)
        if change is not None:
            plan.apply(change, tick.time, np.empty((0, 2)))
            changes.append(change)
            if change.foothold is not None:
                break
    return changes


def guarding(rules: FeasibilityRules = RULES) -> StepGuard:
    return StepGuard(rules, dict.fromkeys(SIDES, LAYOUT), 0.005)


def test_expected_ground_is_stepped_on_without_a_word(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    for tick in ticks(plan, 2, 0.8, np.ones(len(LAYOUT), dtype=bool), guard, tick_at):
        level = tick.changed(feet=tick.feet.changed(surprise=0.002))
        assert guard.propose(level) is None
    assert guard.press is None
    assert guard.checked == []


def test_a_high_foothold_that_carries_the_sole_is_probed_and_trusted(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    swing = next(p for p in plan.schedule.phases if p.step == 2 and p.swing is not None)
    changes = walked(guard, plan, np.ones(len(LAYOUT), dtype=bool), tick_at)
    assert {c.reason for c in changes} == {"ground higher than expected"}
    held = plan.schedule.at(swing.start)
    assert held.end > swing.end + RULES.hold
    assert held.touchdown == pytest.approx(swing.touchdown)  # the foot comes down when it was going to
    assert [c.foothold.feasible for c in guard.checked] == [True]
    assert not guard.stopped


def test_a_foothold_under_the_toes_alone_is_walked_around(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    planned = plan.view
    changes = walked(guard, plan, FRONT, tick_at)
    assert changes[-1].reason == "foothold refused"
    assert guard.press is None
    assert [c.foothold.feasible for c in guard.checked] == [False]
    toes = plan.view.foothold(2).x + LAYOUT.outline[:, 0].max()
    edge = planned.foothold(2).x + LAYOUT.positions[FRONT, 0].min()
    assert toes < edge
    assert {m.reason for m in plan.record[-1].moved} == {"foothold refused", "foothold before it refused"}
    swing = plan.schedule.at(plan.record[-1].time)
    assert swing.touchdown == pytest.approx(plan.record[-1].time + RULES.swing_time)


@pytest.mark.parametrize(("at", "touches"), [("sight", False), ("probe", True), ("impact", True)])
def test_what_is_seen_under_the_toes_alone_is_walked_around_without_a_touch(at, touches, plan_of, tick_at):
    guard, plan = guarding(replace(RULES, at=at)), plan_of()
    for tick in ticks(plan, 2, 0.8, FRONT, guard, tick_at, sees=True):
        change = guard.propose(tick)
        if change is not None and change.foothold is not None:
            break
        assert not guard.lifts
        if change is not None:
            plan.apply(change, tick.time, np.empty((0, 2)))
    assert change.reason == "foothold refused"
    assert tick.feet.landed == touches
    assert guard.lifts != touches
    assert len(guard.checked) == 1
    guard.propose(tick)
    assert not guard.lifts


def test_what_is_seen_under_the_whole_sole_is_touched_before_it_is_trusted(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    for tick in ticks(plan, 2, 0.8, np.ones(len(LAYOUT), dtype=bool), guard, tick_at, sees=True):
        change = guard.propose(tick)
        if change is not None:
            plan.apply(change, tick.time, np.empty((0, 2)))
        assert tick.feet.landed or not guard.checked
    assert [c.foothold.feasible for c in guard.checked] == [True]


def test_without_a_way_around_the_foot_goes_back_and_the_walk_ends(plan_of, tick_at):
    guard, plan = guarding(replace(RULES, attempts=0)), plan_of()
    changes = walked(guard, plan, FRONT, tick_at)
    assert guard.stopped
    assert changes[-1].following == ()
    assert plan.view.count == 3
    back, stance = plan.view.foothold(2), plan.view.foothold(1)
    assert back.x == pytest.approx(stance.x)
    assert guard.propose(tick_at(plan, plan.schedule.end)) is None


def test_a_probe_presses_as_the_rule_says_from_touchdown_to_verdict(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    pressed = []
    for tick in ticks(plan, 2, 0.8, np.ones(len(LAYOUT), dtype=bool), guard, tick_at):
        change = guard.propose(tick)
        if change is not None:
            plan.apply(change, tick.time, np.empty((0, 2)))
        pressed.append(guard.press)
    assert set(pressed) == {None, RULES.probe_force}
    assert pressed[-1] is None


def test_at_the_impact_a_foothold_is_judged_by_the_touch_alone(plan_of, tick_at):
    rules = replace(RULES, at="impact", sideways_cost=0.01)
    guard, plan = guarding(rules), plan_of()
    start = next(p.start for p in plan.schedule.phases if p.step == 2 and p.swing is not None)
    changes = walked(guard, plan, FRONT, tick_at)
    assert changes[-1].reason == "foothold refused"
    # Touched at 0.8 s: no probe, and the cheapest way around is a sidestep (T Fig. 45).
    assert plan.record[-1].time <= start + 0.8 + RULES.impact_time + 4 * PERIOD
    shift = guard.checked[0].shift
    assert shift is not None
    assert shift[0] == 0.0
    assert abs(shift[1]) > 0.05
    # Later steps go along: the next foot keeps its distance, and no step lands on what was met.
    moved = {m.step: (m.x - m.before.x, m.y - m.before.y) for m in plan.record[-1].moved if m.before is not None}
    assert all(move[1] == pytest.approx(shift[1]) for move in moved.values())
    met = guard.checked[0].foothold.polygon_in_sole[:, 0] + plan.view.foothold(2).x
    for step in moved:
        heel, toe = (plan.view.foothold(step).x + e for e in (LAYOUT.outline[:, 0].min(), LAYOUT.outline[:, 0].max()))
        assert step == 2 or heel > met.max() or toe < met.min()


def test_noise_of_a_single_reading_is_not_support(plan_of, tick_at):
    rules = replace(RULES, at="impact", active_force=1.5)
    guard, plan, rng = guarding(rules), plan_of(), np.random.default_rng(0)
    for tick in ticks(plan, 2, 0.8, FRONT, guard, tick_at):
        noisy = {
            s: Reading(time=r.time, force=r.force + 1.5 * rng.standard_normal(len(LAYOUT)))
            for s, r in tick.readings.items()
        }
        change = guard.propose(tick.changed(readings=noisy))
        if change is not None:
            plan.apply(change, tick.time, np.empty((0, 2)))
        if guard.checked:
            break
    assert guard.checked[0].foothold.polygon_in_sole[:, 0].min() > 0.03


def held(plan: WalkPlan, guard: StepGuard, aside: float, carries: np.ndarray, tick_at, until: float = 2.0):
    """Changes of a step that meets something high at 0.8 s, each applied, with the DCM `aside` m beyond the middle of
    the standing foot towards the other one; time in s is from lift-off."""
    step = 2
    side = plan.view.foothold(step).side
    start = next(p.start for p in plan.schedule.phases if p.step == step and p.swing is not None)
    middle = plan.view.stance_vrp(step)
    region = middle + np.array([[-0.09, -0.05], [0.09, -0.05], [0.09, 0.05], [-0.09, 0.05]])
    way = plan.view.vrp(step) - middle
    dcm = middle + np.array([0.0, np.copysign(aside, way[1])])
    force = np.where(carries, 130.0 / carries.sum(), 0.0)
    changes = []
    for k in range(round(until / PERIOD)):
        time = start + k * PERIOD
        landed = k * PERIOD >= 0.8
        tick = tick_at(plan, time)
        if guard.stopped or (tick.phase.step > step and tick.phase.swing is not None):
            break
        reference = plan.at(time)
        pendulum = Pendulum(3.5, dcm, reference, plan.dcm_after(tick.phase), region)
        feet = FeetView(
            tick.feet.footholds,
            side,
            landed,
            surprise=0.03 if k * PERIOD > 0.75 else 0.0,
            distance=np.full(len(LAYOUT), 0.03),
        )
        readings = {s: Reading(time=time, force=force if landed and s == side else 0.0 * force) for s in SIDES}
        loads = {s: 130.0 if landed and s == side else 700.0 for s in SIDES}
        change = guard.propose(tick.changed(feet=feet, readings=readings, loads=loads, pendulum=pendulum))
        if change is not None:
            plan.apply(change, time, region)
            changes.append((time, change))
            if change.foothold is not None:
                break
    return changes


WHOLE = np.ones(len(LAYOUT), dtype=bool)


def test_a_leg_holds_while_the_dcm_is_over_its_sole(plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    changes = held(plan, guard, 0.02, WHOLE, tick_at)
    assert changes[0][1].longer == pytest.approx(RULES.hold)
    assert [c.foothold.feasible for c in guard.checked] == [True]


@pytest.mark.parametrize("aside", [0.06, 0.08, 0.12])
def test_a_leg_holds_no_longer_than_its_sole_and_the_next_double_support_capture(aside, plan_of, tick_at):
    guard, plan = guarding(), plan_of()
    region_edge, omega = 0.05, 3.5
    end = next(p.end for p in plan.schedule.phases if p.step == 2 and p.swing is not None)
    goal = plan.at(end).dcm
    middle = plan.view.stance_vrp(2)
    toward = np.sign(plan.view.vrp(2)[1] - middle[1])
    changes = held(plan, guard, aside, WHOLE, tick_at)
    allowed = -np.expm1(-omega * plan.schedule.timing.double_support) * region_edge
    late = end
    for time, change in changes:
        late += change.longer
        # xi(T) = p + e^(w T) (xi - p), from the ZMP at the sole's inner edge.
        comes_to = region_edge + np.exp(omega * (late - time)) * (aside - region_edge)
        assert comes_to - toward * (goal[1] - middle[1]) <= allowed + 1e-9
    assert late - end < RULES.hold
    # What the leg could not wait for is judged with both feet down, before the next step begins.
    assert [c.foothold.feasible for c in guard.checked] == [True]


@pytest.mark.parametrize(("aside", "again"), [(0.0, True), (0.12, False)])
def test_a_foothold_refused_with_both_feet_down_is_left_only_by_a_body_that_can_be_held(aside, again, plan_of, tick_at):
    guard, plan = guarding(replace(RULES, hold=0.01)), plan_of()
    held(plan, guard, aside, FRONT, tick_at)
    assert [c.foothold.feasible for c in guard.checked] == [False]
    assert (guard.checked[0].shift is not None) == again
    left = [a.change for a in plan.record if a.change.foothold is not None]
    assert bool(left) == again


def test_after_a_refused_foothold_no_step_may_go_anywhere_for_a_while(plan_of, tick_at):
    guard, plan = guarding(), plan_of(12)
    assert guard.firm(2)
    walked(guard, plan, FRONT, tick_at)
    assert [guard.firm(step) for step in range(2, 9)] == [step > 2 + REMEMBERED for step in range(2, 9)]


def test_a_step_that_has_landed_is_taken_once_more(plan_of):
    plan = plan_of()
    swing, both = (
        p
        for p in plan.schedule.phases
        if (p.step, p.kind) in ((2, PhaseKind.SINGLE_SUPPORT), (3, PhaseKind.DOUBLE_SUPPORT))
    )
    time = both.start + 0.1
    plan.apply(PlanChange("foothold refused", 2, longer=1.5, wait=0.0, again=True), time, np.empty((0, 2)))
    now = plan.schedule.at(time)
    assert (now.step, now.kind) == (2, PhaseKind.SINGLE_SUPPORT)
    assert now.end == pytest.approx(swing.end + 1.5)
    assert plan.schedule.following(now).start == now.end
