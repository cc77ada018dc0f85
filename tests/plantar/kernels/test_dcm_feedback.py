"""The kernel of the DCM feedback in both forms against numpy, tick after tick."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.geometry.polygon import closest_point
from plantar.kernels import python_form
from plantar.kernels.gait import dcm_feedback

from ...examples import examples

FORMS = (dcm_feedback, python_form("dcm_feedback"))
OMEGA, GAIN, PERIOD, FILTER = 3.4, 2.0, 0.005, 0.02
ZMP_GAIN, COM_GAIN, LARGEST = 0.8, 1.2, 0.05
BOX = np.array([[-0.1, -0.06], [0.1, -0.06], [0.1, 0.06], [-0.1, 0.06]])
ANYWHERE = np.empty((0, 2))
HELD, PRESS = 0.06, 2.0


def feedback(module, after):
    offset = module.ComAdmittance(ZMP_GAIN, COM_GAIN, FILTER, PERIOD, LARGEST)
    return module.DcmFeedback(OMEGA, GAIN, PERIOD, offset, after, HELD, PRESS)


@pytest.mark.parametrize("after", [True, False])
@examples(25)
@given(seed=st.integers(0, 2**32 - 1))
def test_it_decides_what_numpy_would(after, seed):
    rng = np.random.default_rng(seed)
    kernels = [feedback(module, after) for module in FORMS]
    offset, error, away = np.zeros((3, 2))
    for tick in range(50):
        vrp, planned, com, velocity, dcm = rng.normal(0.0, 0.03, (5, 2))
        zmp = None if rng.random() < 0.2 else rng.normal(0.0, 0.1, 2)
        region = ANYWHERE if tick % 20 == 7 else BOX if tick < 25 else 0.5 * BOX
        free = vrp + (1.0 + GAIN / OMEGA) * (dcm - planned)
        wanted = free if region is ANYWHERE else closest_point(region, free)
        before = offset + away
        error = error + PERIOD / (FILTER + PERIOD) * ((0.0 if zmp is None else zmp - wanted) - error)
        rate = ZMP_GAIN * error - COM_GAIN * offset
        offset = offset + PERIOD * rate
        offset = offset * min(1.0, LARGEST / max(1e-9, float(np.hypot(*offset))))
        beyond = 1.0 - HELD / max(HELD, (1.0 + GAIN / OMEGA) * float(np.hypot(*(dcm - planned))))
        beyond = 0.0 if region is ANYWHERE or tick % 7 == 3 else beyond
        leaving = OMEGA * (beyond * (dcm - planned) - away) + PRESS * beyond * error
        away = away + PERIOD * leaving
        acceleration = OMEGA**2 * (com + (offset + away if after else before) - wanted)
        expected = (wanted, com + offset + away, velocity + rate + leaving, acceleration)
        found = [kernel.decide(vrp, planned, com, velocity, dcm, zmp, region, tick % 7 != 3) for kernel in kernels]
        for one, other, wished in zip(*found, expected, strict=True):
            np.testing.assert_array_equal(one, other)
            np.testing.assert_allclose(one, wished, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("module", FORMS)
def test_a_constant_error_of_the_zmp_moves_the_com_by_the_ratio_of_the_gains(module):
    admittance = module.ComAdmittance(zmp_gain=1.0, com_gain=4.0, zmp_filter=0.02, period=0.005)
    for _ in range(2000):
        admittance.update(np.array([0.02, -0.04]))
    np.testing.assert_allclose(admittance.offset, [0.005, -0.01])
    assert (admittance.x, admittance.y) == tuple(admittance.offset)


@pytest.mark.parametrize("module", FORMS)
def test_what_is_not_known_is_told_and_leaves_the_integral_alone(module):
    kernel, zero = feedback(module, False), np.zeros(2)
    lost = kernel.decide(zero, zero, zero, zero, np.array([np.nan, 0.0]), None, BOX, True)
    assert np.isnan(lost[0]).all()
    assert all(np.array_equal(found, zero) for found in kernel.decide(zero, zero, zero, zero, zero, None, BOX, True))
    with pytest.raises(ValueError, match="contiguous"):
        kernel.decide(zero, zero, zero, zero, np.zeros((2, 2))[:, 0], None, BOX, True)


@pytest.mark.parametrize("module", FORMS)
def test_beyond_the_ankles_the_com_falls_as_a_pendulum_does(module):
    """Over a foot that stays flat the CoM follows its DCM; where its reference lags, the body tips by the rest."""
    still = module.ComAdmittance(0.0, COM_GAIN, FILTER, PERIOD)
    kernel = module.DcmFeedback(OMEGA, GAIN, PERIOD, still, True, HELD, PRESS)
    edge, zero, com, dcm = np.array([0.1, 0.0]), np.zeros(2), np.zeros(2), np.array([0.15, 0.0])
    for _ in range(100):
        _, asked, *_ = kernel.decide(zero, zero, zero, zero, dcm, edge, BOX, True)
        com = com + PERIOD * OMEGA * (dcm - com)
        dcm = dcm + PERIOD * OMEGA * (dcm - edge)
    held = HELD / (1.0 + GAIN / OMEGA)  # of the DCM, which ankles hold back
    assert 0.0 < com[0] - asked[0] < held < 0.2 * com[0]
    assert com[0] - asked[0] == pytest.approx(held * (1.0 - np.exp(-OMEGA * 0.5)), rel=0.03)


MASS, GRAVITY = 60.0, 9.81


def foot_at(rng, y):
    rotation = np.ascontiguousarray(Rotation.from_rotvec(rng.normal(0.0, 0.3, 3)).as_matrix())
    return SimpleNamespace(
        position=np.array([0.0, y, 0.0]) + rng.normal(0.0, 0.02, 3), rotation=rotation, center=rng.normal(0.0, 0.02, 2)
    )


@pytest.mark.parametrize("stance", [0, 1, 2])
@given(seed=st.integers(0, 2**32 - 1))
def test_the_shares_are_those_of_the_projected_zmp(stance, seed):
    rng = np.random.default_rng(seed)
    feet = [foot_at(rng, 0.1), foot_at(rng, -0.1)]
    zmp, acceleration = rng.normal(0.0, 0.15, 2), rng.normal(size=2)
    found, other = (module.shared_load(zmp, acceleration, MASS, GRAVITY, *feet, stance) for module in FORMS)
    for one, two in zip(found, other, strict=True):
        np.testing.assert_array_equal(one, two)
    places = [foot.position[:2] + foot.rotation[:2, :2] @ foot.center for foot in feet]
    way = places[0] - places[1]
    share = (None, 1.0, 0.0)[stance]
    if share is None:
        share = float(np.clip((zmp - places[1]) @ way / (way @ way), 0.0, 1.0))
    force = MASS * np.array([*acceleration, GRAVITY])
    beside = zmp - (share * places[0] + (1.0 - share) * places[1])
    expected = (share * force, places[0] + beside, (1.0 - share) * force, places[1] + beside)
    for one, wished in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, wished, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("module", FORMS)
def test_feet_that_are_loaded_at_one_point_carry_half_each(module):
    foot = foot_at(np.random.default_rng(0), 0.0)
    left, _, right, _ = module.shared_load(np.ones(2), np.zeros(2), MASS, GRAVITY, foot, foot, 0)
    assert left.tolist() == right.tolist() == [0.0, 0.0, 0.5 * MASS * GRAVITY]
