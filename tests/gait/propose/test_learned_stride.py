from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.learned_stride import LearnedStride, LearnedStrideRules
from plantar.gait.propose.proposer import Tick

RULES = LearnedStrideRules()
NOWHERE = np.empty((0, 2))


def walk(plan, tick_at, learns, push, early=0.01):
    """Take each step of a plan: lift off, go along with a push by some metres forward, land some seconds early."""
    for step in range(plan.view.count):
        phase = next(p for p in plan.schedule.phases if p.swing is not None and p.step == step)
        assert learns.propose(_in_flight(tick_at(plan, phase.start + 0.01))) is None
        by = push(step)
        if by:
            there = plan.view.foothold(step)
            moved = PlanChange("pushed", step, foothold=replace(there, x=there.x + by), shift=(by, 0.0))
            plan.apply(moved, phase.start + 0.3, NOWHERE)
        tick = tick_at(plan, phase.end - early)
        tick = tick.changed(feet=tick.feet.changed(landed=early > 0.0, touchdown=True))
        change = learns.propose(tick)
        if change is not None:
            plan.apply(change, phase.end - early, NOWHERE)
        yield step, change


def _in_flight(tick: Tick) -> Tick:
    return tick.changed(feet=tick.feet.changed(landed=False))


def strides(plan: WalkPlan) -> list[float]:
    places = [plan.view.foothold(k).x for k in range(plan.view.count)]
    return [b - a for a, b in zip(places[:-2], places[2:], strict=True)]


@pytest.mark.parametrize("early", [0.01, 0.0, -0.01])
def test_strides_that_are_pushed_become_the_robots_own(plan_of, tick_at, early):
    plan, learns = plan_of(12), LearnedStride(RULES)
    usual = strides(plan)[3]
    changes = dict(walk(plan, tick_at, learns, lambda step: 0.1 if 2 <= step < 6 else 0.0, early))
    assert changes[2].reason == "strides learned"
    assert all(changes[k] is None for k in (0, 1, 7, 8, 9, 10, 11))
    kept = strides(plan)[-3:-1]  # the last one closes with half a stride
    assert learns._factor[0] == pytest.approx((1.0 + RULES.rate * 0.1 / usual * 4), rel=0.05)
    assert kept == pytest.approx([usual * learns._factor[0]] * 2, rel=0.02)
    assert learns._factor[1] == 1.0  # steps in place across the walk have no stride
    assert plan.view.count == 12


def test_what_nobody_pushes_stays_as_it_is_planned(plan_of, tick_at):
    plan, learns = plan_of(8), LearnedStride(RULES)
    before = [plan.view.foothold(k) for k in range(8)]
    assert all(change is None for _, change in walk(plan, tick_at, learns, lambda step: 0.0))
    assert [plan.view.foothold(k) for k in range(8)] == before


def test_strides_never_become_shorter_than_planned_nor_too_long(plan_of, tick_at):
    back, far = LearnedStride(RULES), LearnedStride(replace(RULES, rate=1.0, largest=1.2))
    for _ in walk(plan_of(8), tick_at, back, lambda step: -0.1):
        pass
    for _ in walk(plan_of(8), tick_at, far, lambda step: 0.3):
        pass
    assert back._factor.tolist() == [1.0, 1.0]
    assert far._factor.tolist() == [1.2, 1.0]
