import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar import InputError
from plantar.sensing.virtual_wrench import SoleWrenchSwitch, early_stop, virtual_ground_reaction_wrench

seeds = st.integers(0, 2**32 - 1)


def random_distance(rng, n):
    distance = rng.uniform(-0.005, 0.08, n)
    distance[rng.random(n) < 0.1] = np.inf
    distance[rng.random(n) < 0.1] = np.nan
    return distance


def measure(distance, reach):
    return np.array([0.0 if math.isnan(d) else min(max(reach - d, 0.0), reach) for d in distance])


@given(seeds, seeds)
def test_it_is_the_sum_of_forces_and_moments(tilted_sole, pushed, layout_seed, seed):
    layout = tilted_sole(layout_seed)
    distance = random_distance(np.random.default_rng(seed), len(layout))
    got = virtual_ground_reaction_wrench(layout, distance, 70.0, 0.04)
    assert got == pytest.approx(pushed(layout, 70.0 * measure(distance, 0.04)), abs=1e-10)
    expected = pushed(layout, 70.0 * measure(distance, layout.ranges["proximity"][1]))
    assert virtual_ground_reaction_wrench(layout, distance, 70.0) == pytest.approx(expected, abs=1e-10)
    assert np.isfinite(got).all()


def test_the_virtual_ground_repels_where_the_printed_sign_attracts(sole):
    """T 3.30 sets the force along the sensing direction u; out of the body that is -z, which pulls the foot down."""
    distance = np.where(sole.positions[:, 0] > 0, 0.01, 0.04)
    wrench = virtual_ground_reaction_wrench(sole, distance, 50.0, 0.05)
    assert wrench[2] > 0.0
    assert wrench[4] < 0.0  # pushes the toes up: rotates about -y
    sensing = -sole.rotations[:, :, 2]
    printed = (50.0 * measure(distance, 0.05)) @ sensing
    assert printed[2] == pytest.approx(-wrench[2])


@given(seeds)
def test_turning_the_sole_frame_turns_the_wrench(tilted_sole, seed):
    rng = np.random.default_rng(seed)
    layout = tilted_sole(seed % 7)
    turn = Rotation.from_rotvec(rng.uniform(-2, 2, 3)).as_matrix()
    turned = replace(
        layout,
        positions=layout.positions @ turn.T,
        vertices=layout.vertices @ turn.T,
        rotations=turn @ layout.rotations,
    )
    distance = random_distance(rng, len(layout))
    wrench = virtual_ground_reaction_wrench(layout, distance, 50.0)
    expected = np.concatenate([turn @ wrench[:3], turn @ wrench[3:]])
    assert virtual_ground_reaction_wrench(turned, distance, 50.0) == pytest.approx(expected, abs=1e-10)


@given(seeds)
def test_frames_are_single_readings_and_parts_add_up(sole, seed):
    rng = np.random.default_rng(seed)
    frames = np.stack([random_distance(rng, len(sole)) for _ in range(4)])
    batch = virtual_ground_reaction_wrench(sole, frames, 50.0)
    assert batch == pytest.approx(np.array([virtual_ground_reaction_wrench(sole, d, 50.0) for d in frames]), abs=1e-12)
    half = rng.random(len(sole)) < 0.5
    parts = [virtual_ground_reaction_wrench(sole, np.where(m, frames[0], np.inf), 50.0) for m in (half, ~half)]
    assert sum(parts) == pytest.approx(batch[0], abs=1e-12)


def test_nothing_in_range_is_no_wrench(sole):
    for value in (np.inf, np.nan, 0.05, 1.0):
        assert virtual_ground_reaction_wrench(sole, np.full(len(sole), value), 50.0).tolist() == [0.0] * 6


def test_early_stop_is_a_matter_of_force_not_of_moment():
    assert early_stop([3.0, 0.0, 4.0, 0, 0, 0], 4.9) is True
    assert early_stop([3.0, 0.0, 4.0, 99.0, 0, 0], 5.0) is False
    assert early_stop(np.array([[0, 0, 9.0, 0, 0, 0], [0, 0, 1.0, 0, 0, 0]]), 5.0).tolist() == [True, False]
    assert early_stop([math.nan] * 6, 5.0) is False


@given(seeds)
def test_the_switch_step_by_step_is_the_rule_over_frames(seed):
    rng = np.random.default_rng(seed)
    contact = rng.uniform(0.0, 8.0, (30, 1)) * [0, 0, 1, 0.1, 0.1, 0]
    virtual = rng.normal(0, 5, (30, 6))
    contact[rng.random(30) < 0.1] = np.nan
    virtual[rng.random(30) < 0.1] = np.inf
    switch, landed, expected = SoleWrenchSwitch(5.0, 2.0), False, []
    for f, p in zip(contact, virtual, strict=True):
        f = f if np.isfinite(f).all() else np.zeros(6)
        p = p if np.isfinite(p).all() else np.zeros(6)
        force = np.linalg.norm(f[:3])
        landed = force > 5.0 or (landed and force > 2.0)
        expected.append(f if landed else f + p)
    stepped = [switch.update(f, p) for f, p in zip(contact, virtual, strict=True)]
    assert np.array(stepped) == pytest.approx(np.array(expected))


def test_noise_about_zero_keeps_the_virtual_part_which_the_printed_rule_drops():
    """T 4.30 prints |w_f| > 0: with sensor noise the virtual part is gone at once, and comes and goes."""
    rng = np.random.default_rng(0)
    noise = np.maximum(rng.normal(0.0, 0.5, 200), 0.0)[:, None] * [0, 0, 1.0, 0, 0, 0]
    virtual = np.tile([0, 0, 30.0, 0, 0, 0], (200, 1))
    switch = SoleWrenchSwitch(5.0)
    ours = np.array([switch.update(f, p)[2] for f, p in zip(noise, virtual, strict=True)])
    printed = np.where(noise[:, 2] > 0.0, noise[:, 2], noise[:, 2] + virtual[:, 2])
    assert ours.min() >= 30.0
    assert np.abs(np.diff(ours)).max() < 3.0
    assert np.abs(np.diff(printed)).max() > 25.0
    landing = noise + np.where(np.arange(200) >= 100, 8.0, 0.0)[:, None] * [0, 0, 1.0, 0, 0, 0]
    stepped = np.array([switch.update(f, p) for f, p in zip(landing, virtual, strict=True)])
    assert (stepped[100:] == landing[100:]).all()


def test_a_switch_can_start_on_the_ground():
    switch = SoleWrenchSwitch(5.0)
    switch.reset(landed=True)
    up = np.array([0, 0, 1.0, 0, 0, 0])
    assert switch.update(3.0 * up, up)[2] == 3.0
    switch.reset()
    assert switch.update(3.0 * up, up)[2] == 4.0
    for release in (6.0, math.nan):
        with pytest.raises(InputError):
            SoleWrenchSwitch(5.0, release)


def test_a_force_alone_switches_as_its_wrench_does():
    forces = [0.0, 4.9, 5.1, 3.0, 2.4, -6.0, np.nan, 5.1, np.inf, 0.0]
    by_wrench = SoleWrenchSwitch(5.0)
    by_force = SoleWrenchSwitch(5.0)
    for force in forces:
        by_wrench.update([0.0, 0.0, force, 0.0, 0.0, 0.0], np.zeros(6))
        assert by_force.update_force(force) == by_wrench.landed == by_force.landed
