import math
from collections.abc import Mapping

import numpy as np
import pytest
from msgspec.structs import astuple

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.gait.balance.balance_laws import balance_gains
from plantar.gait.balance.dcm_balance import BalanceGains, DcmBalance
from plantar.gait.balance.law import Feet, FootAction, FootState
from plantar.gait.balance.wrench_balance import WrenchBalance, WrenchBalanceGains, _share
from plantar.gait.plan.vrp_plan import LipReference
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.contact import Contact
from plantar.mechanics.wrench_cone import Rectangle, wrench_cone
from plantar.mechanics.wrench_distribution import DistributionState

PERIOD, OMEGA, MASS = 0.005, 3.36, 65.0
SOLE = Rectangle(-0.1, 0.13, -0.07, 0.07)
BOX = np.array([[-0.09, -0.17], [0.12, -0.17], [0.12, 0.17], [-0.09, 0.17]])
MIDDLE = np.array([0.015, 0.0])
STILL = LipReference(MIDDLE, MIDDLE, np.zeros(2), MIDDLE, np.zeros(2), np.zeros(2))


def standing(*sides: Side, fz: float = 300.0, moment: float = -0.015 * 300.0, height: float = 0.0) -> Feet:
    """Both feet beside each other, of which some stand."""
    states: dict[Side, FootState] = {}
    for side in SIDES:
        place = np.array([0.0, 0.105 if side == "left" else -0.105, height])
        foot = FootState(place, np.eye(3), np.eye(3), np.zeros(2))
        if side in sides:
            measured = np.array([0.0, 0.0, fz, 0.0, moment, 0.0])
            foot = foot.changed(contact=Contact(place, np.eye(3), SOLE), wrench=measured)
        states[side] = foot
    return Feet(states, None, CommandFrame(np.zeros(3), PERIOD, 0.3))


def tick(balance, dcm, zmp, region, feet):
    """What a law decides and wants of the feet."""
    state = balance.update(STILL, dcm, zmp, region)
    return state, balance.act(state, feet)


def law(**gains: float) -> WrenchBalance:
    return WrenchBalance(WrenchBalanceGains(**gains), OMEGA, MASS, PERIOD)


def zmp_of(actions: Mapping[Side, FootAction]) -> np.ndarray:
    """ZMP (2,) of what the feet shall carry, by moments on the ground."""
    total = sum(action.force[2] for action in actions.values())
    return sum(action.force[2] * action.center_of_pressure for action in actions.values()) / total


def test_the_feet_shall_carry_the_desired_zmp_of_t_4_18():
    feet = standing("left", "right")
    dcm = MIDDLE + np.array([0.01, -0.02])
    state, actions = tick(law(dcm_gain=3.0), dcm, MIDDLE, BOX, feet)
    wanted = MIDDLE + (1.0 + 3.0 / OMEGA) * np.array([0.01, -0.02])
    assert state.zmp_desired == pytest.approx(wanted)
    assert zmp_of(actions) == pytest.approx(wanted, abs=2e-4)
    assert sum(action.force[2] for action in actions.values()) == pytest.approx(MASS * 9.81, rel=1e-3)
    raised = law(dcm_gain=3.0).act(state, standing("left", "right", height=0.3))
    for side, action in actions.items():
        assert raised[side].force == pytest.approx(action.force, abs=1e-3)
    # The pendulum's horizontal force goes with it.
    assert sum(a.force[0] for a in actions.values()) == pytest.approx(MASS * OMEGA**2 * (MIDDLE - wanted)[0], rel=0.02)


def test_wanted_wrenches_stay_in_the_cones_whatever_the_dcm():
    balance = law()
    rng = np.random.default_rng(0)
    for _ in range(200):
        sides: tuple[Side, ...] = ("left", "right") if rng.random() < 0.5 else ("left",)
        feet = standing(*sides)
        state, actions = tick(balance, rng.normal(0.0, 1.0, 2), rng.normal(0.0, 0.1, 2), BOX, feet)
        wrenches = balance.distributed(state, feet)
        assert set(wrenches) == set(sides)
        for side in sides:
            assert (wrench_cone(SOLE, 0.6) @ wrenches[side]).max() < 1e-6
        assert set(actions) == {"left", "right"}


def test_a_foot_in_the_air_shall_carry_nothing_and_no_foot_is_no_error():
    balance = law()
    _, actions = tick(balance, MIDDLE, None, BOX, standing("left"))
    assert not actions["right"].force.any()
    state, actions = tick(balance, MIDDLE, None, np.empty((0, 2)), standing())
    assert balance.states[DistributionState.AIRBORNE] == 1
    assert not any(a.force.any() for a in actions.values())
    assert np.isfinite(state.com).all()


def test_numbers_that_are_not_finite_end_in_a_named_state():
    balance = law()
    feet = standing("left", "right")
    _, actions = tick(balance, np.array([math.nan, 0.0]), MIDDLE, np.empty((0, 2)), feet)
    assert balance.states == {"invalid": 1}
    for action in actions.values():
        assert np.isfinite(np.hstack(astuple(action))).all()


def test_soles_that_feel_too_much_pressure_in_front_turn_their_toes_up():
    balance = law()
    feet = standing("left", "right", fz=319.0, moment=-0.06 * 319.0)
    for _ in range(20):
        _, actions = tick(balance, MIDDLE, MIDDLE, BOX, feet)
    # A turn about y by a positive angle puts the toes down.
    assert actions["left"].pitch < 0.0
    assert actions["right"].pitch < 0.0
    assert abs(actions["left"].roll) < 1e-4


def test_the_robot_file_names_the_law():
    assert isinstance(balance_gains({}), BalanceGains)
    gains = balance_gains({"law": "wrench_distribution", "dcm_gain": 2.0, "foot_return": 0.5})
    assert isinstance(gains, WrenchBalanceGains)
    assert (gains.dcm_gain, gains.feet.foot_return) == (2.0, 0.5)
    assert isinstance(gains.law(OMEGA, MASS, PERIOD), WrenchBalance)
    assert isinstance(BalanceGains().law(OMEGA, MASS, PERIOD), DcmBalance)
    with pytest.raises(InputError, match="com_admittance, wrench_distribution"):
        balance_gains({"law": "hope"})
    with pytest.raises(InputError, match="dcm_gain"):
        balance_gains({"law": "wrench_distribution", "dcm_gain": -1.0})


@pytest.mark.parametrize("aside", [-0.06, 0.0, 0.09])
def test_the_foot_that_is_nearer_to_the_zmp_carries_more(aside):
    """Its share is that of a lever on two supports, at 0.105 m to either side."""
    balance, feet = law(dcm_gain=0.0), standing("left", "right")
    state = tick(balance, MIDDLE, MIDDLE, BOX, feet)[0].changed(zmp_desired=MIDDLE + np.array([0.0, aside]))
    wrenches = balance.distributed(state, feet)
    share = wrenches["left"][2] / (wrenches["left"][2] + wrenches["right"][2])
    assert share == pytest.approx(0.5 + aside / 0.21, abs=1e-3)
    for wrench in wrenches.values():  # so that no foot has to be turned
        assert abs(wrench[3]) < 2e-4 * wrench[2]


@pytest.mark.parametrize(("x", "share"), [(-0.2, 0.0), (0.1, 0.25), (0.4, 1.0), (0.6, 1.0)])
def test_no_foot_carries_more_than_all_where_the_zmp_is_beyond_it(x, share):
    # Along a line that is turned and away from the origin, with a ZMP aside of it.
    c, s = 0.6, 0.8
    first, second, zmp = ((1.0 + c * v - s * w, 2.0 + s * v + c * w) for v, w in ((0.4, 0.0), (0.0, 0.0), (x, 0.3)))
    assert _share(*zmp, first, second) == pytest.approx(share)
