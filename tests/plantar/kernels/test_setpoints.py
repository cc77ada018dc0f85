"""The kernel of set-points in both forms against the same in numpy, tick after tick."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.kernels import python_form
from plantar.kernels.joints import setpoints

from ...examples import examples

PERIOD, STEP, SHARE, LEFT = 0.005, 0.001, 0.2, 0.8
FORMS = (setpoints, python_form("setpoints"))


@pytest.mark.parametrize("limited", [True, False])
@examples(30)
@given(seed=st.integers(0, 2**32 - 1))
def test_it_writes_what_numpy_would(limited, seed):
    rng = np.random.default_rng(seed)
    k = int(rng.integers(1, 14))
    servos, stiffness, damping = rng.permutation(k + 3)[:k], rng.uniform(50.0, 300.0, k), rng.uniform(0.1, 9.0, k)
    per_way = rng.uniform(2.0, 20.0, k) if limited else np.empty(0)
    goals, loads = np.zeros(k), np.zeros(k)
    controls = [np.zeros(k + 3) for _ in FORMS]
    kernels = [
        module.Setpoints(written, servos, stiffness, damping, per_way, PERIOD, STEP, SHARE, LEFT, goals, loads)
        for module, written in zip(FORMS, controls, strict=True)
    ]
    last, written_now, between, behind = None, np.zeros(k), np.zeros(k), np.zeros(k)
    for tick in range(6):
        joints, torques, offsets = rng.normal(0.0, 0.1, k), rng.normal(0.0, 40.0, k), rng.normal(0.0, 0.01, k)
        friction = rng.normal(0.0, 5.0, k) if tick == 3 else None
        goals[:], loads[:] = joints, torques
        held = tick == 2
        last = joints if last is None or held else last
        wish = joints - LEFT * behind
        shares = np.abs(wish - last) * per_way if limited else np.zeros(k)
        fastest = np.repeat([shares[: k // 2].max(initial=0.0), shares[k // 2 :].max()], [k // 2, k - k // 2])
        goal = np.where(fastest > 1.0, last + (wish - last) / np.maximum(fastest, 1.0), wish)
        if held:
            goal = joints
        behind = joints - goal
        velocity = np.zeros(k) if held else (goal - last) / PERIOD
        held_up = torques if friction is None else torques + friction
        wanted = goal + (damping * velocity + held_up) / stiffness
        for kernel in kernels:
            if held:
                kernel.hold(joints, torques)
            else:
                kernel.go_to()
                kernel.load(friction, offsets if tick != 1 else None)
        wanted = wanted if held or tick == 1 else wanted + offsets
        if held:
            written_now = between = wanted
        for _ in range(5):
            for kernel, written in zip(kernels, controls, strict=True):
                kernel.drive()
                assert np.array_equal(written[servos], written_now)
                assert np.count_nonzero(written) <= k
            rate = velocity * STEP
            written_now = written_now + SHARE * (between - written_now)
            between = between + SHARE * (wanted - between)
            wanted = wanted + rate
        for kernel in kernels:
            assert np.array_equal(kernel.reference, goal)
            assert np.array_equal(kernel.velocity, velocity)
        last = goal


@pytest.mark.parametrize("module", FORMS)
def test_a_leg_catches_up_without_a_jump_in_velocity(module):
    """The slow joint is at its limit for a while; as it comes free, the other one's velocity changes by its own only.

    Without a gradual approach the other one falls from what caught up to the motion's own speed within one tick.
    """
    controls, goals, loads = np.zeros(4), np.zeros(4), np.zeros(4)
    one = np.ones(4)
    per_way = np.full(4, 1.0 / (2.0 * PERIOD))  # rad/s
    kernel = module.Setpoints(
        controls, np.arange(4), one, np.zeros(4), per_way, PERIOD, STEP, SHARE, LEFT, goals, loads
    )
    kernel.hold(goals, loads)
    velocities = []
    for tick in range(200):
        time = PERIOD * (tick + 1)
        # A smooth motion for which the first joint would have to be half again as fast as it can be.
        goals[:2] = 0.5 * (1.0 - np.cos(np.pi * min(1.0, time / 0.5))) * np.array([1.0, 0.6])
        kernel.go_to()
        velocities.append(np.array(kernel.velocity[:2]))
    found = np.array(velocities)
    assert np.abs(found[:, 0]).max() == pytest.approx(2.0)
    own = 0.5 * 0.6 * (np.pi / 0.5) ** 2 * PERIOD
    assert np.abs(np.diff(found[1:, 1])).max() < (1.0 - LEFT) * 1.2 + own
    assert np.asarray(kernel.reference)[:2] == pytest.approx(goals[:2], abs=1e-6)


@pytest.mark.parametrize("module", FORMS)
def test_joint_angles_that_are_no_numbers_leave_nothing_behind(module):
    goals, loads = np.zeros(2), np.zeros(2)
    per_way = np.full(2, 1.0)
    kernel = module.Setpoints(
        np.zeros(2), np.arange(2), np.ones(2), np.zeros(2), per_way, PERIOD, STEP, SHARE, LEFT, goals, loads
    )
    for angle in (0.1, np.nan, 0.2, 0.2):
        goals[:] = angle
        kernel.go_to()
    assert np.array_equal(kernel.reference, goals)


@pytest.mark.parametrize("module", FORMS)
def test_a_goal_that_jumps_is_approached_without_a_jump_and_reached(module):
    """Two stages of a low pass: the largest step is less than half of what one would make, and nothing is left."""
    controls, goals, loads = np.zeros(1), np.zeros(1), np.zeros(1)
    one = np.ones(1)
    kernel = module.Setpoints(
        controls, np.arange(1), one, np.zeros(1), np.empty(0), PERIOD, STEP, SHARE, LEFT, goals, loads
    )
    kernel.hold(goals, loads)
    written = []
    for _ in range(20):
        loads[0] = 1.0
        kernel.go_to()
        kernel.load()
        for _ in range(5):
            kernel.drive()
            written.append(controls[0])
    steps = np.diff(written)
    assert steps.min() >= 0.0
    assert steps.max() < 0.5 * SHARE
    assert written[-1] == pytest.approx(1.0, abs=1e-6)
