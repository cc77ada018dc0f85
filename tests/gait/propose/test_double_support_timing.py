from typing import Any

import numpy as np
import pytest

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.double_support_timing import DoubleSupportTiming, DoubleSupportTimingRules
from plantar.gait.propose.dsp_opt import DspWeights
from plantar.gait.propose.proposer import Pendulum, Tick

PERIOD = 0.005
RULES = DoubleSupportTimingRules()
WEIGHTS = DspWeights()
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
NOW = 4.3 + 0.05  # s: a sixth into the double support after the second step


@pytest.fixture
def pushed(plan_of, tick_at):
    """Makes a plan, and a tick at which the DCM is elsewhere and the ZMP has some room about the reference VRP."""

    def made(by: Any, time: float = NOW, room: float = 0.02) -> tuple[WalkPlan, Tick]:
        plan = plan_of()
        reference, goal = plan.at(time), plan.dcm_after(plan.schedule.at(time))
        pendulum = Pendulum(3.5, reference.dcm + np.asarray(by), reference, goal, reference.vrp + room * SQUARE)
        return plan, tick_at(plan, time, pendulum=pendulum)

    return made


def proposed(tick: Tick) -> PlanChange | None:
    return DoubleSupportTiming(RULES, WEIGHTS, 1.0, PERIOD).propose(tick)


def test_a_dcm_that_lags_gets_a_longer_double_support_and_one_that_leads_a_shorter_one(pushed):
    plan, tick = pushed((0.0, 0.0))
    way = tick.pendulum.goal - tick.pendulum.reference.dcm
    way = way / np.hypot(*way)
    longer, shorter = (proposed(pushed(by * way)[1]) for by in (-0.05, 0.05))
    assert longer.longer > 0.0
    assert shorter.longer < 0.0
    usual = tick.phase.end - tick.phase.start
    assert WEIGHTS.least * usual - 1e-9 <= usual + shorter.longer
    plan.apply(longer, NOW, tick.pendulum.zmp_region)
    assert plan.schedule.at(NOW).end == pytest.approx(tick.phase.end + longer.longer)
    assert plan.view.count == tick.plan.count


def test_what_the_vrp_can_do_is_left_to_it(pushed):
    assert proposed(pushed((0.0, 0.0))[1]) is None
    assert proposed(pushed((0.05, 0.0), room=1.0)[1]) is None


def test_single_supports_and_the_last_moment_are_not_its_business(pushed):
    plan, tick = pushed((0.05, 0.0))
    assert proposed(tick.changed(phase=plan.schedule.at(4.0))) is None
    assert proposed(tick.changed(time=tick.phase.end - 0.5 * RULES.least_left)) is None
    assert proposed(tick.changed(pendulum=None)) is None


def test_it_rests_between_two_changes(pushed):
    _, tick = pushed((0.06, 0.0))
    timing = DoubleSupportTiming(RULES, WEIGHTS, 1.0, PERIOD)
    assert timing.propose(tick) is not None
    assert timing.propose(tick.changed(time=NOW + 0.5 * RULES.pause)) is None
