import math
from itertools import pairwise

import pytest

from gait.footsteps import straight_plan
from gait.phases import PhaseKind, Timing, WalkSchedule
from plantar.errors import InputError

STEPS = straight_plan(5)[1]


def test_phases_tile_time_and_swing_every_step_once() -> None:
    schedule = WalkSchedule(STEPS, Timing(), begin=1.0)
    for a, b in zip(schedule.phases, schedule.phases[1:], strict=False):
        assert a.end == b.start
    swings = [p for p in schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT]
    assert [p.step for p in swings] == list(range(5))
    assert [p.swing for p in swings] == [s.side for s in STEPS]
    assert all(p.stance not in (None, p.swing) for p in swings)
    assert schedule.walking_end == pytest.approx(1.0 + 1.2 + 5 * 0.9 + 4 * 0.3 + 1.0)
    assert schedule.end == pytest.approx(schedule.walking_end + 2.0)


def test_any_time_has_its_phase_in_any_order() -> None:
    schedule = WalkSchedule(STEPS, Timing(), begin=1.0)
    for time in (-5.0, 50.0, 0.0, 2.5, 1.0, 3.1, 2.2, schedule.walking_end, 2.19999):
        phase = schedule.at(time)
        assert phase.start <= time < phase.end
    assert schedule.at(math.inf) is schedule.phases[-1]


def test_no_steps_is_standing() -> None:
    schedule = WalkSchedule((), Timing(), begin=1.0)
    assert {p.kind for p in schedule.phases} == {PhaseKind.STANDING}


@pytest.mark.parametrize("name", ["single_support", "double_support", "start", "end", "settle"])
@pytest.mark.parametrize("value", [-1.0, math.nan, 1e9])
def test_bad_timing_is_named(name: str, value: float) -> None:
    with pytest.raises(InputError, match=name):
        Timing(**{name: value})


def test_a_single_support_that_is_made_longer_delays_all_that_follows() -> None:
    schedule = WalkSchedule(STEPS, Timing(), begin=1.0)
    before = schedule.phases
    swing = next(p for p in before if p.step == 2 and p.swing is not None)
    schedule.delay(swing, 0.7)
    after = schedule.phases
    i = before.index(swing)
    assert after[:i] == before[:i]
    assert after[i].end == pytest.approx(swing.end + 0.7)
    assert [p.start for p in after[i + 1 :]] == pytest.approx([p.start + 0.7 for p in before[i + 1 :]])
    assert all(a.end == b.start for a, b in pairwise(after))


def test_a_walk_that_stops_ends_with_the_step_that_is_being_taken() -> None:
    schedule = WalkSchedule(STEPS, Timing(), begin=1.0)
    schedule.move_step(2, STEPS[0])
    schedule.stop_after(2)
    assert schedule.steps == (STEPS[0], STEPS[1], STEPS[0])
    assert all(a.end == b.start for a, b in pairwise(schedule.phases))
    assert [p.kind for p in schedule.phases[-2:]] == [PhaseKind.DOUBLE_SUPPORT, PhaseKind.STANDING]
    assert schedule.phases[-1].step == 3
    assert schedule.walking_end == schedule.phases[-1].start
    assert sum(p.swing is not None for p in schedule.phases) == 3
