import math
from itertools import pairwise

import pytest

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import PhaseKind, Timing, WalkSchedule

STEPS = straight_plan(5)[1]
FEET = [step.side for step in STEPS]


def test_phases_tile_time_and_swing_every_step_once():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    for a, b in zip(schedule.phases, schedule.phases[1:], strict=False):
        assert a.end == b.start
    swings = [p for p in schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT]
    assert [p.step for p in swings] == list(range(5))
    assert [p.swing for p in swings] == [s.side for s in STEPS]
    assert all(p.stance not in (None, p.swing) for p in swings)
    assert schedule.walking_end == pytest.approx(1.0 + 1.2 + 5 * 0.9 + 4 * 0.3 + 1.0)
    assert schedule.end == pytest.approx(schedule.walking_end + 2.0)


def test_any_time_has_its_phase_in_any_order():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    for time in (-5.0, 50.0, 0.0, 2.5, 1.0, 3.1, 2.2, schedule.walking_end, 2.19999):
        phase = schedule.at(time)
        assert phase.start <= time < phase.end
    assert schedule.at(math.inf) is schedule.phases[-1]


def test_no_steps_is_standing():
    schedule = WalkSchedule.of((), Timing(), begin=1.0)
    assert {p.kind for p in schedule.phases} == {PhaseKind.STANDING}


@pytest.mark.parametrize("name", ["single_support", "double_support", "start", "end", "settle"])
@pytest.mark.parametrize("value", [-1.0, math.nan, 1e9])
def test_bad_timing_is_named(name, value):
    with pytest.raises(InputError, match=name):
        Timing(**{name: value})


def test_a_single_support_that_is_made_longer_delays_all_that_follows():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    before = schedule.phases
    swing = next(p for p in before if p.step == 2 and p.swing is not None)
    after = schedule.delayed(swing, 0.7).phases
    assert schedule.phases == before
    i = before.index(swing)
    assert after[:i] == before[:i]
    assert after[i].end == pytest.approx(swing.end + 0.7)
    assert [p.start for p in after[i + 1 :]] == pytest.approx([p.start + 0.7 for p in before[i + 1 :]])
    assert all(a.end == b.start for a, b in pairwise(after))


def test_a_walk_that_stops_ends_with_the_step_that_is_being_taken():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0).followed_by(2, (), 4.0)
    assert all(a.end == b.start for a, b in pairwise(schedule.phases))
    assert [p.kind for p in schedule.phases[-2:]] == [PhaseKind.DOUBLE_SUPPORT, PhaseKind.STANDING]
    assert schedule.steps == schedule.phases[-1].step == 3
    assert schedule.walking_end == schedule.phases[-1].start
    assert sum(p.swing is not None for p in schedule.phases) == 3


@pytest.mark.parametrize("time", [0.5, 1.7, 3.0, 5.2, 7.5, 60.0])
def test_a_walk_goes_on_with_other_steps_at_any_time(time):
    """Before it begins, in the first double support, in mid walk, in the last double support, and at rest again."""
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    phase = schedule.at(time)
    last = phase.step - 1 if phase.swing is None else phase.step
    other: tuple[Side, ...] = ("right", "left", "right", "left")
    longer = schedule.followed_by(last, other, time)
    assert all(a.end == b.start for a, b in pairwise(longer.phases))
    assert [p.swing for p in longer.phases if p.swing is not None] == FEET[: last + 1] + list(other)
    assert longer.steps == last + 5
    assert longer.at(time).kind == (PhaseKind.DOUBLE_SUPPORT if time == 60.0 else phase.kind)
    following = next(p for p in longer.phases if p.step == last + 1 and p.swing is not None)
    assert following.start >= time
    if time == 60.0:  # the weight has to shift first
        assert following.start == pytest.approx(60.0 + Timing().start)


def test_a_phase_can_be_shortened_in_flight_but_not_below_nothing():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    swing = next(p for p in schedule.phases if p.step == 2 and p.swing is not None)
    sooner = schedule.delayed(swing, -0.3)
    assert sooner.walking_end == pytest.approx(schedule.walking_end - 0.3)
    with pytest.raises(InputError, match="sooner"):
        schedule.delayed(swing, -1.0)


def test_a_foot_that_waits_touches_down_before_its_phase_ends():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    swing = next(p for p in schedule.phases if p.step == 2 and p.swing is not None)
    held = schedule.delayed(swing, 0.7, wait=0.7).at(swing.start)
    assert held.touchdown == pytest.approx(swing.touchdown)
    assert held.end == pytest.approx(swing.end + 0.7)


def test_what_lies_behind_is_forgotten():
    schedule = WalkSchedule.of(FEET, Timing(), begin=1.0)
    late = schedule.since(5.0)
    assert late.phases == schedule.phases[schedule.index(5.0) :]
    assert late.at(6.1) == schedule.at(6.1)
    assert late.steps == 5
