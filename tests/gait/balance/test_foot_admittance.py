import numpy as np
import pytest

from plantar.errors import InputError
from plantar.gait.balance.foot_admittance import AdmittanceGains, FootAdmittance

PERIOD = 0.005


def wrench(fz: float, tx: float = 0.0, ty: float = 0.0) -> np.ndarray:
    return np.array([0.0, 0.0, fz, tx, ty, 0.0])


def test_a_foot_settles_where_its_elastic_ankle_gives_the_wanted_moment():
    """An ankle of 2 kN m/rad on flat ground: a sole turned by (roll, pitch) against it feels less moment about both."""
    stiffness, offset = 2000.0, np.array([12.0, -7.0])
    feet = FootAdmittance(AdmittanceGains(foot_turn_gain=5e-3, foot_return=0.0), PERIOD)
    wanted = wrench(300.0, 5.0, 9.0)
    for _ in range(1000):
        foot = feet.corrections["left"]
        moment = offset - stiffness * np.array([foot.roll, foot.pitch])
        feet.update({"left": wanted}, {"left": wrench(300.0, *moment)})
    foot = feet.corrections["left"]
    assert offset - stiffness * np.array([foot.roll, foot.pitch]) == pytest.approx([5.0, 9.0], abs=0.01)


def test_the_foot_that_carries_too_much_goes_up_and_the_other_down():
    feet = FootAdmittance(AdmittanceGains(), PERIOD)
    for _ in range(50):
        feet.update({"left": wrench(300.0), "right": wrench(300.0)}, {"left": wrench(400.0), "right": wrench(200.0)})
    left, right = feet.corrections["left"], feet.corrections["right"]
    assert left.shift == pytest.approx(-right.shift)
    assert left.shift == pytest.approx(0.5 * 2e-5 * 200.0 * 50 * PERIOD, rel=0.15)
    # A common error is none of the difference's business.
    before = left.shift
    feet.update({"left": wrench(300.0), "right": wrench(300.0)}, {"left": wrench(310.0), "right": wrench(310.0)})
    assert abs(feet.corrections["left"].shift - before) < 2e-5


def test_a_foot_in_the_air_returns_to_its_place():
    feet = FootAdmittance(AdmittanceGains(), PERIOD)
    for _ in range(100):
        feet.update({"left": wrench(300.0)}, {"left": wrench(300.0, 20.0, -15.0)})
    assert feet.corrections["left"].roll > 1e-3
    for _ in range(1000):
        feet.update({}, {})
    foot = feet.corrections["left"]
    assert (foot.roll, foot.pitch, foot.shift) == (0.0, 0.0, 0.0)


def test_corrections_are_limited():
    gains = AdmittanceGains()
    feet = FootAdmittance(gains, PERIOD)
    for _ in range(5000):
        feet.update(
            {"left": wrench(300.0), "right": wrench(300.0)},
            {"left": wrench(9000.0, 500.0, -500.0), "right": wrench(0.0)},
        )
    foot = feet.corrections["left"]
    assert (foot.roll, foot.pitch, foot.shift) == (gains.largest_turn, -gains.largest_turn, gains.largest_lift)


def test_gains_come_from_a_table_and_are_checked():
    assert AdmittanceGains.from_table({"foot_return": 2.0}, "[balance]").foot_return == 2.0
    with pytest.raises(InputError, match="foot_return"):
        AdmittanceGains(foot_return=-1.0)
