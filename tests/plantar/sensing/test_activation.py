from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from plantar import InputError, Percept, PerceptOptions, Reading, ReadingError, batch, hex_layout
from plantar.layouts.curved_sole import rotations_to_normals
from plantar.percepts import any_array
from plantar.percepts.foot_tick import walking_tick
from plantar.sensing.activation import TaxelActivation, active_of, active_taxels, hysteresis
from plantar.sensing.force import center_of_pressure, ground_reaction_wrench

anything = st.floats(allow_nan=True, allow_infinity=True)
forces = st.lists(anything, max_size=20)
series = hnp.arrays(
    float, st.tuples(st.integers(0, 12), st.integers(0, 5)), elements=st.one_of(st.floats(0, 4), anything)
)


@given(forces, st.floats(0.0, 100.0))
def test_active_is_finite_and_above_the_threshold(force, threshold):
    got = active_taxels(np.array(force, dtype=float), threshold)
    assert got.dtype == bool
    assert got.tolist() == [bool(np.isfinite(f)) and f > threshold for f in force]


def test_the_threshold_itself_is_not_active():
    assert active_taxels(np.array([1.4715, np.nextafter(1.4715, 2.0)]), 1.4715).tolist() == [False, True]


def test_a_saturated_taxel_is_not_active_where_the_range_is_given():
    force = np.array([784.9, 785.0, 900.0, np.inf, np.nan])
    assert active_taxels(force, 1.5, 785.0).tolist() == [True, False, False, False, False]
    assert active_taxels(force, 1.5).tolist() == [True, True, True, False, False]


def test_frames_and_single_readings_agree():
    frames = np.random.default_rng(0).normal(2.0, 3.0, (7, 11))
    assert (active_taxels(frames, 1.5) == np.array([active_taxels(f, 1.5) for f in frames])).all()


def test_no_taxel():
    assert active_taxels(np.empty(0), 1.0).shape == (0,)


def switched(values, high, low, initial, saturation):
    """The rule, one taxel and one frame at a time."""
    state, out = list(initial), []
    for frame in values:
        for i, v in enumerate(frame):
            if not (np.isfinite(v) and v < saturation) or v <= low:
                state[i] = False
            elif v > high:
                state[i] = True
        out.append(list(state))
    return out


@given(series, st.floats(0.0, 2.0), st.floats(0.0, 2.0), st.integers(0, 31))
def test_hysteresis_over_frames_is_the_rule_step_by_step(values, a, b, bits):
    low, high = min(a, b), max(a, b)
    initial = [bool(bits >> i & 1) for i in range(values.shape[1])]
    expected = switched(values, high, low, initial, 3.5)
    assert hysteresis(values, high, low, initial, 3.5).tolist() == expected


@given(series, st.floats(0.0, 2.0), st.floats(0.0, 2.0))
def test_the_stateful_form_is_the_batch_form(values, a, b):
    low, high = min(a, b), max(a, b)
    activation = TaxelActivation(high, low, 3.5)
    stepped = [activation.update(frame).tolist() for frame in values]
    assert stepped == hysteresis(values, high, low, saturation=3.5).tolist()


@given(series, st.floats(0.0, 2.0))
def test_without_a_gap_hysteresis_is_the_plain_threshold(values, threshold):
    assert (hysteresis(values, threshold, threshold) == active_taxels(values, threshold)).all()


def test_hysteresis_does_not_chatter_where_the_plain_threshold_does():
    force = 1.5 + 0.3 * np.random.default_rng(1).uniform(-1, 1, 500)
    force[0] = 3.0
    assert np.diff(active_taxels(force, 1.5).astype(int)).any()
    assert hysteresis(force, 1.5, 1.0).all()


def test_reset_forgets_and_a_result_is_the_callers_own():
    activation = TaxelActivation(2.0)
    assert activation.release == 1.0
    active = activation.update([3.0, 0.0])
    active[:] = True
    assert activation.update([1.5, 1.5]).tolist() == [True, False]
    activation.reset()
    assert activation.update([1.5, 1.5, 1.5]).tolist() == [False] * 3


def test_bad_arguments_are_refused():
    with pytest.raises(InputError, match="off not above on"):
        hysteresis([[1.0]], 1.0, 2.0)
    with pytest.raises(InputError, match="off not above on"):
        TaxelActivation(float("nan"))
    activation = TaxelActivation(1.0)
    activation.update([1.0])
    with pytest.raises(ReadingError, match="taxels"):
        activation.update([1.0, 2.0])


NOISY = hex_layout([[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]])
NOISY = replace(NOISY, noise={"force": 1.5})
_SLOPE = 5.0 * NOISY.positions[:, 0]
CURVED = replace(
    NOISY, rotations=rotations_to_normals(np.column_stack([-np.sin(_SLOPE), np.zeros(len(NOISY)), np.cos(_SLOPE)]))
)


def noisy_frames() -> np.ndarray:
    """A foot in the air, one that a cell or an even load just touches, one that stands; dead and saturated cells."""
    rng = np.random.default_rng(3)
    load = np.zeros((60, len(NOISY)))
    load[20:30, 4] = np.linspace(4.0, 10.0, 10)
    load[30:40] = np.linspace(0.0, 4.0, 10)[:, None]
    load[40:] = rng.uniform(0.0, 40.0, (20, len(NOISY)))
    frames = np.maximum(load + 1.5 * rng.standard_normal(load.shape), 0.0)
    frames[rng.random(frames.shape) < 0.02] = np.nan
    frames[55:, 7] = 900.0
    frames[58, 8] = np.inf
    return frames


@pytest.mark.parametrize("layout", [NOISY, CURVED], ids=["flat", "curved"])
def test_a_sole_of_noise_alone_has_no_active_taxel_in_any_form(layout):
    frames = noisy_frames()
    wanted = active_of(layout, frames)
    above = active_taxels(frames, layout.force_threshold, layout.force_limit)
    assert not wanted[:20].any()
    assert above[:20].any(axis=1).sum() > 15
    assert 0 < wanted[20:40].any(axis=1).sum() < 20
    assert np.array_equal(wanted[40:], above[40:])
    assert np.array_equal(any_array.active(layout, frames), wanted)
    sums = batch.loads(layout, frames)
    hulls = batch.support_polygons(layout, frames)
    wrenches = batch.wrenches(layout, frames)
    for k, force in enumerate(frames):
        on = wanted[k]
        percept = Percept(layout, Reading(0.0, force))
        assert percept.active.tolist() == on.tolist()
        assert percept.contact_area == pytest.approx(layout.areas[on].sum())
        assert sums.contact_area[k] == pytest.approx(percept.contact_area)
        assert percept.wrench_in_sole == pytest.approx(np.where(on, force, 0.0) @ layout.wrench_map.T)
        assert wrenches[k] == pytest.approx(percept.wrench_in_sole)
        assert ground_reaction_wrench(layout, force) == pytest.approx(percept.wrench_in_sole)
        assert (len(percept.support_polygon_in_sole) > 0) == on.any()
        assert (percept.position_cop_in_sole is None) == (not on.any())
        assert (center_of_pressure(layout, force) is None) == (not on.any())
        assert hulls.area[k] == pytest.approx(percept.support_area)
        assert walking_tick(layout, force, (0.0, 0.0)).active.tolist() == on.tolist()
        quick = layout.kernel.unsaturated_loads(force, layout.force_threshold, layout.force_limit)
        if quick is not None:
            assert quick[:7] == pytest.approx(layout.kernel.loads(force, on)[:7])
    filled = Percept(layout, Reading(0.0, frames[0]), options=PerceptOptions(fill=True))
    assert not filled.active.any()


def test_another_threshold_than_the_layouts_stands_for_itself():
    frames = noisy_frames()
    for threshold in (-np.inf, 0.0, 3.0):
        above = active_taxels(frames, threshold, NOISY.force_limit)
        assert np.array_equal(active_of(NOISY, frames, threshold), above)
        assert np.array_equal(any_array.active(NOISY, frames, threshold), above)
        kept = np.where(above, frames, 0.0)
        assert np.allclose(batch.wrenches(NOISY, frames, threshold), kept @ NOISY.wrench_map.T)
    assert Percept(NOISY, Reading(0.0, frames[0]), force_threshold=1.0).active.any()
