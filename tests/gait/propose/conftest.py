"""Ticks to propose at, without a walk."""

from typing import Any

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Timing
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.proposer import Tick
from plantar.kernels.gait.command_frame import CommandFrame

OMEGA = 3.5
MIDDLES = {side: np.array([0.02, 0.0]) for side in SIDES}


def _plan_of(count: int = 6, **walk: float) -> WalkPlan:
    """The plan of a straight walk."""
    feet, steps = straight_plan(count, **walk)
    return WalkPlan(feet, steps, Timing(), MIDDLES, OMEGA, 1.0)


def _tick_at(plan: WalkPlan, time: float, **known: Any) -> Tick:
    """The tick at a time in s, with the feet where the plan has them."""
    phase, view = plan.schedule.at(time), plan.view
    feet = straight_plan(0)[0]
    for k in range(view.first, phase.step):
        feet[view.foothold(k).side] = view.foothold(k)
    commanded = {side: (feet[side].position, feet[side].yaw) for side in SIDES}
    in_world = CommandFrame(np.zeros(3), 0.005, 0.3)
    tick = Tick(time, phase, view, FeetView(commanded, phase.swing, landed=phase.swing is None), in_world)
    return tick.changed(**known)


@pytest.fixture
def plan_of():
    """Makes the plan of a straight walk of some steps."""
    return _plan_of


@pytest.fixture
def tick_at():
    """Makes the tick at a time of a plan, with what else is known."""
    return _tick_at
