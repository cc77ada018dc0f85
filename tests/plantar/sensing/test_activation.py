import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from plantar import InputError, ReadingError
from plantar.sensing.activation import TaxelActivation, active_taxels, hysteresis

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
