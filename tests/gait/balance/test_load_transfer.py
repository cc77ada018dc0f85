"""Load transfer by the plan: what the feet carry together is the pendulum's force at the desired ZMP."""

import numpy as np
import pytest

from plantar.common.sides import Side
from plantar.gait.balance.law import BalanceState, Feet, FootState
from plantar.gait.balance.load_transfer import OpenLoop, transferred
from plantar.gait.plan.vrp_plan import VrpPlan
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.rotation import level_rotation

MASS = 80.0


def feet(rng: np.random.Generator, stance: Side | None = None) -> Feet:
    anchor, offset = rng.normal(size=(2, 3))
    frame = CommandFrame(anchor, 0.005, 0.005)
    frame.update(anchor, anchor + offset, 0.3)
    states: dict[Side, FootState] = {}
    for side, y in (("left", 0.1), ("right", -0.1)):
        level = level_rotation(rng.normal(0.0, 0.3))
        position = np.array([0.0, y, 0.0]) + rng.normal(0.0, 0.02, 3)
        states[side] = FootState(position, level, level, rng.normal(0.0, 0.02, 2))
    return Feet(states, stance, frame)


@pytest.mark.parametrize("stance", [None, "left", "right"])
def test_the_feet_together_carry_the_pendulum_at_the_desired_zmp(stance):
    rng = np.random.default_rng(1)
    for _ in range(100):
        stand, wanted = feet(rng, stance), rng.normal(0.0, 0.2, 2)
        zmp, acceleration = rng.normal(0.0, 0.2, 2), rng.normal(size=2)
        actions = transferred(BalanceState(zmp, wanted, wanted, acceleration), MASS, stand)
        total = sum(a.force for a in actions.values())
        assert total == pytest.approx(MASS * np.array([*acceleration, GRAVITY]))
        moment = sum(a.force[2] * a.center_of_pressure for a in actions.values())
        assert moment / total[2] == pytest.approx(stand.frame.to_command(zmp))
        for side, action in actions.items():
            assert action.force[2] >= 0.0
            if stance is not None:
                assert (action.force[2] > 0.0) == (side == stance)
            assert (action.roll, action.pitch, action.shift) == (0.0, 0.0, 0.0)


def test_open_loop_is_the_plan_whatever_is_measured():
    plan = VrpPlan([0.0, 1.0], [[0.0, 0.0], [0.1, 0.0]], 3.5).at(0.4)
    law, stand = OpenLoop(MASS), feet(np.random.default_rng(2))
    state = law.update(plan, np.array([9.0, 9.0]), None, np.empty((0, 2)))
    assert state.zmp_desired is plan.vrp
    assert state.com is plan.com
    same = transferred(state, MASS, stand)
    for side, action in law.act(state, stand).items():
        assert np.array_equal(action.force, same[side].force)
        assert action.center_of_pressure == pytest.approx(same[side].center_of_pressure, abs=0.0)
