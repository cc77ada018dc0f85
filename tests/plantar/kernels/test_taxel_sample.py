"""The kernels of samples of taxels, and of the noise in them, against numpy, in both forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.kernels import noise_rows, pressed_sole, python_form, taxel_sample

PYTHON = tuple(map(python_form, ("noise_rows", "pressed_sole", "taxel_sample")))
FORMS = ((noise_rows, pressed_sole, taxel_sample), PYTHON)


@given(st.integers(0, 2**32 - 1))
def test_it_is_what_numpy_makes_of_them(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 60))
    force, noise = 30.0 * rng.random((3, n)), rng.normal(size=(3, n))
    force[rng.random((3, n)) < 0.1] = np.nan
    dead = np.flatnonzero(rng.random(n) < 0.2)
    wanted = np.minimum(np.maximum(force + noise, 2.0), 20.0)
    wanted[:, dead] = np.nan
    for rows, soles, samples in FORMS:
        sample = samples.TaxelSample(rows.NoiseRows(lambda: noise), n, 2.0, 20.0, dead)
        sole = soles.PressedSole(np.ones(n), 1e-4, 4, None, None)
        np.asarray(sole.forces)[:] = force[1]
        told = [sample.of(force[0]), sample.of_sole(sole), sample.of(force[2])]
        assert np.array_equal(told, wanted, equal_nan=True)


@pytest.mark.parametrize("rows", [noise_rows, PYTHON[0]], ids=["compiled", "python"])
def test_noise_is_drawn_anew_when_all_of_it_was_handed_out(rows):
    drawn = [np.arange(6.0).reshape(2, 3), np.arange(6.0, 9.0).reshape(1, 3), np.zeros((2, 3))]
    left = iter(drawn)
    noise = rows.NoiseRows(lambda: next(left))
    assert [next(noise).tolist() for _ in range(2)] == drawn[0].tolist()
    assert noise.advance() == 0
    assert np.asarray(noise.rows)[0].tolist() == [6.0, 7.0, 8.0]
    assert next(iter(noise)).tolist() == [0.0, 0.0, 0.0]
    assert noise.advance() == 1
