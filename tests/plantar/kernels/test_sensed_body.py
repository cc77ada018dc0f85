"""The kernel of encoders and IMU against numpy, in both forms."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.sensors import noise_rows, sensed_body

FORMS = (noise_rows, sensed_body), tuple(map(python_form, ("noise_rows", "sensed_body")))


@pytest.mark.parametrize("errs", [False, True])
@pytest.mark.parametrize("forms", FORMS, ids=["compiled", "python"])
def test_they_read_what_is_there_with_noise_and_errors(forms, errs):
    rng = np.random.default_rng(2)
    positions, rate, force = np.zeros(9), np.zeros(3), np.zeros(3)
    places, noise = np.array([7, 2, 3, 8]), rng.normal(size=(5, 10))
    offsets, bias = (rng.normal(size=4), rng.normal(size=3)) if errs else (np.empty(0), np.empty(0))
    body = forms[1].SensedBody(positions, places, rate, force, forms[0].NoiseRows(lambda: noise), offsets, bias)
    kept = []
    for k in range(12):
        positions[:], rate[:], force[:] = rng.normal(size=9), rng.normal(size=3), rng.normal(size=3)
        row = noise[k % 5]
        wanted = positions[places] + row[:4], rate + row[4:7], force + row[7:]
        if errs:
            wanted = wanted[0] + offsets, wanted[1] + bias, wanted[2]
        kept.append((body.read(), wanted))
    for told, wanted in kept:  # what was read once stays
        assert all(np.array_equal(a, b) for a, b in zip(told, wanted, strict=True))
