import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from plantar import active_taxels

forces = st.lists(st.floats(allow_nan=True, allow_infinity=True), max_size=20)


@given(forces, st.floats(0.0, 100.0))
def test_active_is_finite_and_above_the_threshold(force, threshold):
    got = active_taxels(np.array(force, dtype=float), threshold)
    assert got.dtype == bool
    assert got.tolist() == [bool(np.isfinite(f)) and f > threshold for f in force]


def test_the_threshold_itself_is_not_active():
    assert active_taxels(np.array([1.4715, np.nextafter(1.4715, 2.0)]), 1.4715).tolist() == [False, True]


def test_frames_and_single_readings_agree():
    frames = np.random.default_rng(0).normal(2.0, 3.0, (7, 11))
    assert (active_taxels(frames, 1.5) == np.array([active_taxels(f, 1.5) for f in frames])).all()


def test_no_taxel():
    assert active_taxels(np.empty(0), 1.0).shape == (0,)
