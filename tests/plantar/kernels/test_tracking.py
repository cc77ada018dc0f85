"""Joints that miss their targets by more than they ever did are noticed; those that miss as they always do are not."""

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.safety import tracking

FORMS = [tracking, kernels.python_form("tracking")]
LIMITS = {"confirmed": 3, "most": 0.5, "share": 2.0, "leasts": (0.06, 0.35, 0.03), "far": 0.1, "settled": 50}


def check_of(form, joints=2, **changes):
    return form.TrackingCheck(joints, *{**LIMITS, **changes}.values())


def walked(check, ticks, miss, begin=0, joints=2):
    """Give moving targets, followed two and a half ticks late; ticks at which each joint is noticed, and one is off."""
    noticed = {}
    off = None
    for k in range(begin, begin + ticks):
        target = np.full(joints, 0.001 * k)
        measured = np.full(joints, 0.001 * (k - 2.5)) + np.array(miss(k)) + 1e-7 * (k % 2)
        check.update(measured, target)
        for i in np.flatnonzero(check.noticed):
            noticed.setdefault(int(i), k)
        if check.count and off is None:
            off = k
    return noticed, off


@pytest.mark.parametrize("form", FORMS)
def test_what_a_joint_of_either_leg_missed_by_before_is_usual(form):
    check = check_of(form)
    walked(check, 100, lambda k: (0.05, 0.01))
    check.begin_support()
    assert walked(check, 100, lambda k: (0.2, 0.01), 100) == ({}, None)
    check.end_support()
    assert walked(check, 100, lambda k: (0.2, 0.4), 200) == ({}, None)  # 2 x 0.2 + 0.03
    noticed, off = walked(check, 20, lambda k: (0.2, 0.45), 300)
    assert (noticed, off) == ({1: 302}, None)
    noticed, off = walked(check, 20, lambda k: (0.2, 0.52), 320)
    assert off == 322


@pytest.mark.parametrize("form", FORMS)
def test_a_stiff_robot_is_noticed_by_little(form):
    check = check_of(form)
    walked(check, 100, lambda k: (0.002, 0.002))
    check.begin_support()
    check.end_support()
    noticed, off = walked(check, 200, lambda k: (0.001 * max(0, k - 120), 0.0), 100)  # drifts by 0.2 rad/s
    assert 150 < noticed[0] < 160
    assert 220 < off < 240
    assert check.noticed_count == check.count == 1


@pytest.mark.parametrize("form", FORMS)
def test_a_joint_that_stands_still_while_its_target_moves_is_noticed(form):
    check = check_of(form)
    walked(check, 100, lambda k: (0.2, 0.0))
    check.begin_support()
    check.end_support()
    walked(check, 50, lambda k: (0.0, 0.0), 100)
    noticed, off = walked(check, 60, lambda k: (-0.001 * (k - 150), 0.0), 150)
    assert (noticed, off) == ({}, None)  # it moves, by the last bit alone
    check = check_of(form)
    walked(check, 100, lambda k: (0.2, 0.0))
    check.begin_support()
    check.end_support()
    for k in range(100, 160):
        check.update(np.array([0.12, 0.001 * (k - 2.5)]), np.full(2, 0.001 * k))
        assert bool(check.noticed[0]) == (k >= 118), k  # 0.015 rad, and three ticks
    assert check.count == 0


@pytest.mark.parametrize("form", FORMS)
def test_targets_that_never_move_are_not_compared(form):
    check = check_of(form)
    for k in range(50):
        assert check.update(np.array([0.1 * k, 0.0]), np.zeros(2)) == 0


@pytest.mark.parametrize("form", FORMS)
def test_a_joint_that_comes_back_to_its_target_is_used_again(form):
    check = check_of(form)
    _, off = walked(check, 30, lambda k: (0.0, 0.0))
    _, off = walked(check, 10, lambda k: (0.6, 0.0), 30)
    assert off == 32
    walked(check, 40, lambda k: (0.0, 0.0), 40)
    assert check.count == 0
    assert check.noticed_count == 0


def test_compiled_and_interpreted_check_agree():
    rng = np.random.default_rng(5)
    checks = [check_of(form, 4, settled=10) for form in FORMS]
    for k in range(400):
        target = np.cumsum(np.full(4, 0.002)) * k + rng.normal(0, 0.01, 4)
        measured = target + rng.normal(0, 0.02 if k % 90 < 70 else 0.2, 4)
        if rng.random() < 0.02:
            measured[rng.integers(4)] = np.nan
        for check in checks:
            check.update(measured, target)
            if k % 100 == 40:
                check.begin_support()
            if k % 100 == 80:
                check.end_support()
        assert np.array_equal(checks[0].noticed, checks[1].noticed)
        assert checks[0].count == checks[1].count
        assert checks[0].noticed_count == checks[1].noticed_count
