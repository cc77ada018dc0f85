import numpy as np
import pytest

from plantar.gait.plan.phases import PhaseKind
from plantar.gait.propose.late_foot import LateFoot

PERIOD = 0.005
BEAT = 0.247  # s, of h1


def double_supports(plan):
    return [p for p in plan.schedule.phases if p.kind == PhaseKind.DOUBLE_SUPPORT]


@pytest.mark.parametrize("late", [0.0, 0.02, 0.12, 0.3])
def test_no_foot_lifts_before_the_other_one_has_landed(late, plan_of, tick_at):
    plan, waits = plan_of(), LateFoot(BEAT, PERIOD)
    both = double_supports(plan)[2]
    touches = both.end + late
    time = both.start
    while True:
        tick = tick_at(plan, time)
        if tick.phase.step == both.step and tick.phase.swing is not None:
            break
        landed = time >= touches
        change = waits.propose(tick.changed(feet=tick.feet.changed(landed=landed)))
        if change is not None:
            assert not landed
            plan.apply(change, time, np.empty((0, 2)))
        time += PERIOD
    assert time >= touches - 1e-9
    assert time <= max(both.end, touches) + 0.06  # and soon after
    assert [s.foothold for s in plan.view.steps] == [s.foothold for s in plan_of().view.steps]


def test_it_has_no_say_where_no_foot_lifts(plan_of, tick_at):
    plan, waits = plan_of(), LateFoot(BEAT, PERIOD)
    last = double_supports(plan)[-1]
    for phase, before in ((last, 0.001), (double_supports(plan)[2], 0.1)):
        tick = tick_at(plan, phase.end - before)
        assert waits.propose(tick.changed(feet=tick.feet.changed(landed=False))) is None


def test_a_foot_that_finds_no_ground_is_not_waited_for_for_ever(plan_of, tick_at):
    plan, waits = plan_of(), LateFoot(BEAT, PERIOD)
    both = double_supports(plan)[2]
    time = both.start
    while plan.schedule.at(time).swing is None:
        tick = tick_at(plan, time)
        change = waits.propose(tick.changed(feet=tick.feet.changed(landed=False)))
        if change is not None:
            plan.apply(change, time, np.empty((0, 2)))
        time += PERIOD
        assert time < both.start + 5.0
