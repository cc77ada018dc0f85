"""DCM regulation: the VRP that it applies brings a pendulum to the goal, which is one that a walk can rest from."""

import numpy as np
import pytest

from plantar.gait.balance.dcm_regulation import phase_goal, regulated_vrp
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import PhaseKind, Timing
from plantar.gait.plan.walk_plan import WalkPlan

OMEGA = 3.5
FEET = {"left": Footstep("left", 0.0, 0.085, 0.0), "right": Footstep("right", 0.0, -0.085, 0.0)}
STEPS = tuple(Footstep(s, 0.1 * (k + 1), y, 0.0) for k, (s, y) in enumerate([("left", 0.085), ("right", -0.085)] * 2))
MIDDLE = {"left": np.zeros(2), "right": np.zeros(2)}
PLAN = WalkPlan(FEET, STEPS, Timing(single_support=0.8, double_support=0.4), MIDDLE, OMEGA).view
PUSH = np.array([0.01, -0.02])


def phase_of(kind: PhaseKind, step: int):
    return next(p for p in PLAN.schedule.phases if p.kind == kind and p.step == step)


def test_after_the_goal_of_a_double_support_the_walk_comes_to_rest_over_its_next_step():
    phase = phase_of(PhaseKind.DOUBLE_SUPPORT, 2)
    goal = phase_goal(PLAN, phase, PUSH, OMEGA)
    stance = PLAN.stance_vrp(2)
    # xi' = w (xi - u + u_w) for the single support after it, with the VRP at rest over the stance foot.
    after = stance - PUSH + np.exp(OMEGA * 0.8) * (goal - stance + PUSH)
    assert after == pytest.approx(PLAN.vrp(2) - PUSH)


@pytest.mark.parametrize(("kind", "step"), [(PhaseKind.SINGLE_SUPPORT, 1), (PhaseKind.DOUBLE_SUPPORT, 2)])
def test_a_pendulum_that_follows_the_vrp_reaches_the_goal(kind, step):
    phase, tick = phase_of(kind, step), 1e-4
    goal = phase_goal(PLAN, phase, PUSH, OMEGA)
    time, dcm = phase.start, goal + np.array([-0.03, 0.02])
    while time < phase.end - 1.5 * tick:
        found = regulated_vrp(PLAN, phase, time, dcm, goal, PUSH, OMEGA)
        dcm = dcm + tick * OMEGA * (dcm - found.vrp + PUSH)
        time += tick
    assert dcm == pytest.approx(goal, abs=1e-4)


def test_the_ends_of_a_walk_keep_the_plan():
    for phase in (PLAN.schedule.phases[0], PLAN.schedule.phases[1], PLAN.schedule.phases[-1]):
        assert phase_goal(PLAN, phase, PUSH, OMEGA) is None
        assert regulated_vrp(PLAN, phase, phase.start, PUSH, PUSH, PUSH, OMEGA) is None
    last = phase_of(PhaseKind.SINGLE_SUPPORT, 3)
    assert phase_goal(PLAN, last, PUSH, OMEGA) is None
