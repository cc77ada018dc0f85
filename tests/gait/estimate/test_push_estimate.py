import math

import numpy as np
import pytest

from plantar.gait.estimate.push_estimate import PushEstimate, PushRules

PERIOD = 0.005
RULES = PushRules()


def test_a_push_is_found_within_three_time_constants():
    push = PushEstimate(RULES, PERIOD)
    walking = np.array([0.4, -0.3])
    for _ in range(100):
        assert not push.update(walking, walking).any()
    by = np.array([3.0, -2.0])
    ticks = math.ceil(3.0 * RULES.time_constant / PERIOD)
    found = [push.update(walking + by, walking) for _ in range(ticks)][-1]
    assert push.acts
    assert found == pytest.approx(by, rel=math.exp(-3.0) + 0.01)


def test_what_walking_leaves_is_none_and_a_push_ends_below_where_it_begins():
    push = PushEstimate(PushRules(time_constant=0.0, begins=1.0, ends=0.5), PERIOD)
    sizes = [0.9, 1.1, 0.6, 0.4, 0.9]
    assert [push.update(np.array([0.0, s]), np.zeros(2)).any() for s in sizes] == [False, True, True, False, False]


def test_without_a_foot_on_the_ground_it_forgets():
    push = PushEstimate(PushRules(time_constant=0.0), PERIOD)
    assert push.update(np.array([5.0, 0.0]), np.zeros(2)).any()
    assert not push.update(np.array([5.0, 0.0]), None).any()
    assert not push.acts
