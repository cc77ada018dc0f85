import math

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
