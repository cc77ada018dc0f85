"""The kernels of the judge, which look after each physics step and tick, against plain counting; both forms."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.judging import joint_extremes, step_watch


@pytest.mark.parametrize("module", [step_watch, python_form("step_watch")], ids=["compiled", "python"])
@pytest.mark.parametrize("seed", range(3))
def test_each_step_says_who_lands_who_touches_and_who_is_fast(module, seed):
    rng = np.random.default_rng(seed)
    ground, legs, speeds = np.zeros(2), np.zeros(1), np.zeros(5)
    places, limits = np.array([4, 0, 2]), np.array([3.0, 2.0, np.inf])
    warnings = np.zeros((8, 2), dtype=np.int32)[:, 1]
    watch = module.StepWatch(ground, legs, speeds, places, 1.0 / limits, 20.0, 30, warnings, np.array([5, 6]))
    last, landings = [0, 0], 0
    for now in range(1, 2000):
        if rng.random() < 0.03:
            ground[:] = rng.choice([0.0, 19.9, 20.0, 300.0], 2)
        legs[:] = rng.choice([0.0, 1.0])
        speeds[:] = rng.normal(0.0, 1.4, 5)
        wanted = module.LEGS * int(legs[0]) + module.FAST * bool((np.abs(speeds[places]) > limits).any())
        for foot in range(2):
            if ground[foot] >= 20.0:
                wanted += (1 << foot) * (now - last[foot] > 30)
                landings += now - last[foot] > 30
                last[foot] = now
        assert watch.step() == wanted
    assert watch.now == 1999
    assert landings > 3
    legs[:], speeds[:], watch.awake = 0.0, 0.0, True
    assert watch.step() == module.AWAKE
    watch.awake = False
    warnings[4] = 3  # of something else
    assert watch.step() == 0
    warnings[6] = 1
    assert watch.step() == module.DIVERGED
    warnings[6] = 0
    speeds[:] = 1.0, np.nan, 100.0, np.nan, 2.0
    assert not watch.step() & module.FAST  # joints without a limit, or that are not asked for
    speeds[2] = np.nan
    assert watch.step() & module.FAST  # what is no number is looked at


@pytest.mark.parametrize("module", [joint_extremes, python_form("joint_extremes")], ids=["compiled", "python"])
def test_extremes_are_those_of_all_that_was_taken_in(module):
    rng = np.random.default_rng(4)
    speeds, torques = np.zeros(9), np.zeros(12)
    places, servos = rng.permutation(9)[:6], rng.permutation(12)[:6]
    limits = np.array([10.0, 20.0, np.inf, 5.0, 8.0, 40.0])
    joints = module.JointExtremes(speeds, places, torques, servos, 1.0 / limits)
    seen, held = [np.zeros(6)], 0
    for k in range(300):
        speeds[:], torques[:] = rng.normal(0.0, 3.0, 9), rng.normal(0.0, 4.0, 12)
        seen.append(speeds[places])
        if k % 3:
            joints.extend()
            continue
        at_limit = joints.tick()
        assert np.array_equal(joints.shares, torques[servos] * (1.0 / limits))
        assert at_limit == bool((np.abs(torques[servos]) >= limits).any())
        held += at_limit
    assert np.array_equal(joints.high, np.max(seen, axis=0))
    assert np.array_equal(joints.low, np.min(seen, axis=0))
    assert 0 < held < 100
