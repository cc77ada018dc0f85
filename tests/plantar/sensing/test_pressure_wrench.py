import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar import InputError
from plantar.sensing.force import ground_reaction_wrench, joint_torque, pressure_driven_wrench

seeds = st.integers(0, 2**32 - 1)


@given(seeds, seeds)
def test_it_is_the_wrench_over_the_contact_area(tilted_sole, pushed, layout_seed, seed):
    rng = np.random.default_rng(seed)
    layout = tilted_sole(layout_seed)
    force = rng.uniform(-2.0, 10.0, len(layout))
    force[rng.random(len(layout)) < 0.1] = np.nan
    force[rng.random(len(layout)) < 0.1] = 785.0  # saturated
    active = [math.isfinite(f) and 3.0 < f < 785.0 for f in force]
    contact = sum(a for a, on in zip(layout.areas, active, strict=True) if on)
    w_f = pushed(layout, [f if on else 0.0 for f, on in zip(force, active, strict=True)])
    expected = 2e-6 / contact * w_f if any(active) else np.zeros(6)
    got = pressure_driven_wrench(layout, force, 2e-6, 3.0)
    assert got == pytest.approx(expected, rel=1e-9, abs=1e-12)
    frames = np.stack([force, np.zeros(len(layout)), 2 * force])
    single = np.array([pressure_driven_wrench(layout, f, 2e-6, 3.0) for f in frames])
    assert pressure_driven_wrench(layout, frames, 2e-6, 3.0) == pytest.approx(single, rel=1e-9, abs=1e-12)


def test_a_load_on_half_the_area_counts_twice(sole):
    near = np.abs(sole.positions[:, 0]) < 0.03
    force = np.where(near, 100.0 * sole.areas / sole.areas[near].sum(), 0.0)
    narrow = near & (sole.positions[:, 1] > 0)
    other = np.where(narrow, 100.0 * sole.areas / sole.areas[narrow].sum(), 0.0)
    gain = sole.areas[near].sum() / sole.areas[narrow].sum()
    wide = pressure_driven_wrench(sole, force, 1e-3, 0.1)[2]
    assert pressure_driven_wrench(sole, other, 1e-3, 0.1)[2] == pytest.approx(gain * wide)
    assert pressure_driven_wrench(sole, force, sole.areas[near].sum(), 0.1)[2] == pytest.approx(100.0)


def test_without_contact_it_is_zero(sole):
    for value in (0.0, np.nan, np.inf, -5.0):
        assert pressure_driven_wrench(sole, np.full(len(sole), value), 1e-3).tolist() == [0.0] * 6
    for area in (0.0, -1.0, math.nan):
        with pytest.raises(InputError, match="reference area"):
            pressure_driven_wrench(sole, np.zeros(len(sole)), area)


@given(seeds)
def test_joint_torques_do_the_work_of_the_wrench(seed):
    """tau . q' = f . v + m . omega for any joint velocity, in base coordinates."""
    rng = np.random.default_rng(seed)
    jacobian, wrench, velocity = rng.normal(size=(6, 4)), rng.normal(size=6), rng.normal(size=4)
    turn = Rotation.from_rotvec(rng.uniform(-2, 2, 3))
    twist = jacobian @ velocity
    power = turn.apply(wrench[:3]) @ twist[:3] + turn.apply(wrench[3:]) @ twist[3:]
    tau = joint_torque(jacobian, turn.as_matrix(), wrench)
    assert tau @ velocity == pytest.approx(power, abs=1e-10)
    assert joint_torque(jacobian, turn.as_matrix(), [wrench, 2 * wrench]) == pytest.approx(np.stack([tau, 2 * tau]))


def test_the_gain_is_that_of_the_plain_wrench(sole):
    force = np.full(len(sole), 4.0)
    total = ground_reaction_wrench(sole, force)
    assert pressure_driven_wrench(sole, force, float(sole.areas.sum())) == pytest.approx(total)
