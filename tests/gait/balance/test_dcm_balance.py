import math

import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.gait.balance.dcm_balance import BalanceGains, DcmBalance
from plantar.gait.balance.law import Feet, FootState
from plantar.gait.plan.vrp_plan import VrpPlan
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.contact import Contact
from plantar.mechanics.rotation import level_rotation
from plantar.mechanics.wrench_cone import Rectangle

OMEGA, MASS, PERIOD = 3.5, 95.0, 0.005
BOX = np.array([[-0.1, -0.06], [0.1, -0.06], [0.1, 0.06], [-0.1, 0.06]])
STILL = VrpPlan([0.0, 1.0], [[0.0, 0.0], [0.0, 0.0]], OMEGA).at(0.5)


def test_desired_zmp_is_equation_4_28_inside_and_its_nearest_point_outside():
    balance = DcmBalance(BalanceGains(dcm_gain=3.0), OMEGA, MASS, PERIOD)
    xi = np.array([0.01, -0.02])
    assert np.allclose(balance.update(STILL, xi, None, BOX).zmp_desired, (1 + 3.0 / OMEGA) * xi)
    assert np.allclose(balance.update(STILL, np.array([1.0, 0.0]), None, BOX).zmp_desired, [0.1, 0.0])
    free = balance.update(STILL, np.array([1.0, 0.0]), None, np.empty((0, 2))).zmp_desired
    assert np.allclose(free, [1 + 3.0 / OMEGA, 0.0])


def test_a_pendulum_under_the_desired_zmp_recovers_as_equation_4_17_says():
    gain = 3.0
    balance = DcmBalance(BalanceGains(dcm_gain=gain), OMEGA, MASS, PERIOD)
    xi, dt = np.array([0.03, 0.0]), 1e-4
    for _ in range(5000):
        xi = xi + dt * OMEGA * (xi - balance.update(STILL, xi, None, np.empty((0, 2))).zmp_desired)
    assert xi[0] == pytest.approx(0.03 * math.exp(-gain * 0.5), rel=1e-3)


def test_the_com_yields_to_a_push_and_returns():
    balance = DcmBalance(BalanceGains(), OMEGA, MASS, PERIOD)
    pushed = balance.update(STILL, np.zeros(2), np.array([0.05, 0.0]), BOX)
    for _ in range(40):
        pushed = balance.update(STILL, np.zeros(2), np.array([0.05, 0.0]), BOX)
    assert pushed.com[0] > 0.002  # moves with a push that drives the ZMP forward
    back = pushed
    for _ in range(2000):
        back = balance.update(STILL, np.zeros(2), np.zeros(2), BOX)
    assert abs(back.com[0]) < 1e-4


def test_no_zmp_is_no_error():
    state = DcmBalance(BalanceGains(), OMEGA, MASS, PERIOD).update(STILL, np.zeros(2), None, BOX)
    assert np.array_equal(state.com, STILL.com)


@pytest.mark.parametrize("off", [0.0, 0.02])
def test_feet_at_rest_give_way_to_what_they_press_against_each_other_alone(off):
    """Away from the origin, and turned: each foot carries what the load transfer asks for, but for an opposite roll."""
    turn = level_rotation(0.4)
    balance, states = DcmBalance(BalanceGains(), OMEGA, MASS, PERIOD), {}
    middle = np.array([2.0, -1.0])
    places = {side: np.append(middle + turn[:2, 1] * y, 0.0) for side, y in (("left", 0.1), ("right", -0.1))}
    for side, place in places.items():
        moment = 0.5 * MASS * GRAVITY * (off if side == "left" else -off)
        wrench = np.array([0.0, 0.0, 0.5 * MASS * GRAVITY, moment, 0.0, 0.0])
        foot = FootState(place, turn, turn, np.zeros(2))
        states[side] = foot.changed(contact=Contact(place, turn, Rectangle(-0.1, 0.1, -0.05, 0.05)), wrench=wrench)
    feet = Feet(states, None, CommandFrame(np.zeros(3), PERIOD, 0.3)).changed(rests=True)
    still = VrpPlan([0.0, 1.0], [middle, middle], OMEGA).at(0.5)
    for _ in range(50):
        balanced = balance.update(still, middle, middle, np.empty((0, 2)))
        actions = balance.act(balanced, feet)
    rolls = [actions[side].roll for side in ("left", "right")]
    if off:
        assert rolls[0] == pytest.approx(-rolls[1])
        assert abs(rolls[0]) > 1e-4
    else:
        assert rolls == pytest.approx([0.0, 0.0], abs=1e-9)
        assert [actions[side].pitch for side in ("left", "right")] == pytest.approx([0.0, 0.0], abs=1e-9)
    for zmp, rests in ((None, True), (middle, False)):
        other = DcmBalance(BalanceGains(), OMEGA, MASS, PERIOD)
        balanced = other.update(still, middle, zmp, np.empty((0, 2)))
        assert [foot.roll for foot in other.act(balanced, feet.changed(rests=rests)).values()] == [0.0, 0.0]


def test_gains_are_checked():
    assert BalanceGains.from_table({"dcm_gain": 2.0}, "[balance]").dcm_gain == 2.0
    for value in (-1.0, math.nan, "3"):
        with pytest.raises(InputError, match=r"\[balance\] 'dcm_gain' is"):
            BalanceGains.from_table({"dcm_gain": value}, "[balance]")
    with pytest.raises(InputError, match="nearest: dcm_gain"):
        BalanceGains.from_table({"dcm_gian": 2.0}, "[balance]")
