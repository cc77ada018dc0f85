import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.errors import InputError
from plantar.sensing.clipping import clipped_mean, unclipped_mean


def test_the_mean_of_clipped_noise_is_what_it_says():
    noise = np.random.default_rng(0).normal(0.0, 1.5, 400_000)
    for force in (0.0, 0.5, 2.0, 6.0, 20.0):
        assert clipped_mean(force, 1.5) == pytest.approx(np.clip(force + noise, 0.0, None).mean(), abs=0.01)


@given(force=st.floats(0.0, 1000.0), noise=st.floats(0.0, 50.0))
def test_unclipping_is_the_inverse(force, noise):
    assert unclipped_mean(clipped_mean(force, noise), noise) == pytest.approx(force, abs=1e-3 * max(noise, 1e-6))


def test_many_unloaded_taxels_add_up_to_nothing():
    rng = np.random.default_rng(1)
    readings = np.clip(rng.normal(0.0, 1.5, (2000, 50)), 0.0, None)
    mean = readings.reshape(200, 10, 50).mean(axis=1)  # a running mean of ten readings
    assert readings.sum(axis=1).mean() > 29.0
    assert abs(unclipped_mean(mean, 1.5).sum(axis=1).mean()) < 5.0


def test_no_noise_changes_nothing_and_wrong_noise_is_refused():
    assert unclipped_mean([0.0, 3.0], 0.0).tolist() == [0.0, 3.0]
    assert clipped_mean([0.0, 3.0], 0.0).tolist() == [0.0, 3.0]
    assert unclipped_mean([], 1.0).shape == (0,)
    for noise in (-1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="noise"):
            unclipped_mean([1.0], noise)
