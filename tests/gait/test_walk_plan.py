import numpy as np
import pytest

from gait.footsteps import straight_plan
from gait.phases import PhaseKind, Timing, WalkSchedule
from gait.walk_plan import WalkPlan, vrp_of_step

OMEGA = 3.5
CENTER = {"left": np.array([0.025, 0.01]), "right": np.array([0.025, -0.01])}


def test_vrp_stands_over_the_stance_foot_and_the_plan_ends_between_the_feet() -> None:
    feet, steps = straight_plan(6, length=0.2)
    schedule = WalkSchedule(steps, Timing(), begin=1.0)
    plan = WalkPlan(feet, schedule, CENTER, OMEGA)
    standing = dict(feet)
    for phase in schedule.phases:
        if phase.kind == PhaseKind.SINGLE_SUPPORT:
            assert phase.stance is not None
            wanted = vrp_of_step(standing[phase.stance], CENTER[phase.stance])
            for time in (phase.start, 0.5 * (phase.start + phase.end), phase.end):
                assert np.allclose(plan.at(time).vrp, wanted, atol=1e-12)
            standing[steps[phase.step].side] = steps[phase.step]
    assert np.allclose(plan.end, [1.0 + 0.025, 0.0], atol=1e-12)
    assert np.allclose(plan.at(0.0).com, [0.025, 0.0], atol=1e-2)


def test_the_planned_com_stays_near_the_feet_for_any_number_of_steps() -> None:
    for count in (0, 1, 2, 300):
        feet, steps = straight_plan(count, length=0.2)
        plan = WalkPlan(feet, WalkSchedule(steps, Timing()), CENTER, OMEGA).vrps
        times = np.arange(plan.times[0], plan.times[-1], 0.05)
        lateral = np.array([plan.at(t).com[1] for t in times])
        assert np.abs(lateral).max() < 0.1


def test_turned_footsteps_turn_their_vrps() -> None:
    feet, _ = straight_plan(0, start=(1.0, 2.0, np.pi / 2))
    assert vrp_of_step(feet["left"], CENTER["left"]) == pytest.approx([1.0 - 0.085 - 0.01, 2.0 + 0.025])
