import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar import InputError
from plantar.sensing.body_skin import active_cells, patch_signal, pseudo_force, skin_wrench
from plantar.sensing.force import ground_reaction_wrench

seeds = st.integers(0, 2**32 - 1)
signals = st.lists(
    st.tuples(*[st.one_of(st.floats(0.0, 1.0), st.sampled_from([math.nan, math.inf, -math.inf]))] * 2), max_size=8
)


@given(signals, st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_a_cell_is_active_by_force_or_by_proximity(pairs, low_force, low_proximity):
    force, proximity = np.array([p[0] for p in pairs]), np.array([p[1] for p in pairs])
    expected = [(math.isfinite(f) and f > low_force) or (math.isfinite(p) and p > low_proximity) for f, p in pairs]
    assert active_cells(force, proximity, low_force, low_proximity).tolist() == expected


def test_a_cell_about_to_be_touched_is_active_which_the_printed_and_never_is():
    force, proximity = np.array([0.0]), np.array([0.9])
    assert active_cells(force, proximity, 0.05, 0.1).tolist() == [True]
    printed = (force > 0.05) & (proximity > 0.1)
    assert printed.tolist() == [False]
    active = active_cells(force, proximity, 0.05, 0.1)
    assert pseudo_force(force, proximity, 10.0, 2.0, active).tolist() == [1.8]
    assert pseudo_force(force, proximity, 10.0, 2.0, printed).tolist() == [0.0]


@given(signals, st.floats(0.0, 20.0), st.floats(0.0, 20.0))
def test_pseudo_force_is_the_weighted_sum_of_the_signals_that_are_numbers(pairs, wf, wp):
    force, proximity = np.array([p[0] for p in pairs]), np.array([p[1] for p in pairs])
    clean = [[v if math.isfinite(v) else 0.0 for v in pair] for pair in pairs]
    assert pseudo_force(force, proximity, wf, wp) == pytest.approx([wf * f + wp * p for f, p in clean])
    active = active_cells(force, proximity, 0.5, 0.5)
    assert (pseudo_force(force, proximity, wf, wp, active)[~active] == 0.0).all()


@given(signals, st.floats(0.0, 1.0))
def test_patch_signal_goes_from_proximity_to_force(pairs, weight):
    force, proximity = np.array([p[0] for p in pairs]), np.array([p[1] for p in pairs])
    clean = np.array([[v if math.isfinite(v) else 0.0 for v in pair] for pair in pairs]).reshape(-1, 2)
    assert patch_signal(force, proximity, 1.0).tolist() == clean[:, 0].tolist()
    assert patch_signal(force, proximity, 0.0).tolist() == clean[:, 1].tolist()
    assert patch_signal(force, proximity, weight) == pytest.approx(clean @ [weight, 1.0 - weight])


@pytest.mark.parametrize("weight", [-0.01, 1.01, math.nan])
def test_a_weight_is_a_share(weight):
    with pytest.raises(InputError, match="allowed: 0 to 1"):
        patch_signal([0.0], [0.0], weight)


@given(seeds, seeds)
def test_it_is_the_sum_of_forces_and_moments(tilted_sole, pushed, layout_seed, seed):
    layout = tilted_sole(layout_seed)
    force = np.random.default_rng(seed).uniform(0.0, 9.0, len(layout))
    got = skin_wrench(layout.positions, layout.rotations, force)
    assert got == pytest.approx(pushed(layout, force), abs=1e-10)
    assert got == pytest.approx(ground_reaction_wrench(layout, force, 0.0), abs=1e-10)
    frames = np.stack([force, np.where(force > 4, np.nan, force)])
    holes = pushed(layout, np.where(force > 4, 0.0, force))
    assert skin_wrench(layout.positions, layout.rotations, frames) == pytest.approx(np.stack([got, holes]), abs=1e-10)


@given(seeds)
def test_the_printed_sign_of_k_is_the_same_push_with_the_axis_out_of_the_body(tilted_sole, seed):
    layout = tilted_sole(seed)
    force = np.random.default_rng(seed).uniform(0.0, 9.0, len(layout))
    flip = Rotation.from_rotvec([np.pi, 0, 0]).as_matrix()  # z out of the body, as K has it
    expected = np.zeros(6)
    for p, rotation, f in zip(layout.positions, layout.rotations @ flip, force, strict=True):
        pushed = rotation @ np.array([0.0, 0.0, -f])
        expected += np.concatenate([pushed, np.cross(p, pushed)])
    assert skin_wrench(layout.positions, layout.rotations, force) == pytest.approx(expected, abs=1e-9)


@given(seeds)
def test_turning_and_moving_the_frame_turns_and_moves_the_wrench(tilted_sole, seed):
    rng = np.random.default_rng(seed)
    layout, force = tilted_sole(seed % 5), rng.uniform(0.0, 9.0, 12)
    turn, shift = Rotation.from_rotvec(rng.uniform(-2, 2, 3)).as_matrix(), rng.uniform(-1, 1, 3)
    before = skin_wrench(layout.positions, layout.rotations, force)
    after = skin_wrench(layout.positions @ turn.T + shift, turn @ layout.rotations, force)
    pushed = turn @ before[:3]
    expected = np.concatenate([pushed, turn @ before[3:] + np.cross(shift, pushed)])
    assert after == pytest.approx(expected, abs=1e-9)


def test_no_cell_is_no_wrench():
    assert skin_wrench(np.empty((0, 3)), np.empty((0, 3, 3)), []).tolist() == [0.0] * 6


def test_a_signal_that_no_sum_could_hold_is_none():
    """One rule for the mask of active cells and for what is summed over them."""
    force, proximity = [1e300, -1e300, 2.0], [0.0, 1e300, 1e101]
    assert active_cells(force, proximity, 0.1, 0.1).tolist() == [False, False, True]
    assert pseudo_force(force, proximity, 10.0, 2.0).tolist() == [0.0, 0.0, 20.0]
    assert patch_signal(force, proximity, 0.5).tolist() == [0.0, 0.0, 1.0]
