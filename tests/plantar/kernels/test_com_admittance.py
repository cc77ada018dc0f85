"""The CoM's offset under large gains and errors."""

import numpy as np
import pytest

from plantar.kernels.gait.dcm_feedback import ComAdmittance


@pytest.mark.parametrize("gain", [1.0, 50.0])
def test_the_offset_stays_within_its_length_and_comes_back(gain: float):
    admittance = ComAdmittance(gain, 1.0, 0.02, 0.005, largest=0.3)
    sizes = []
    for _ in range(400):
        admittance.update(np.array([3.0, -4.0]))
        sizes.append(float(np.hypot(*admittance.offset)))
    assert max(sizes) == pytest.approx(0.3)
    assert admittance.offset == pytest.approx([0.18, -0.24])
    for _ in range(4000):
        admittance.update(np.zeros(2))
    assert np.abs(admittance.offset).max() < 1e-6


def test_what_is_shorter_is_left_alone_to_the_last_bit():
    free, bound = ComAdmittance(1.0, 4.0, 0.02, 0.005), ComAdmittance(1.0, 4.0, 0.02, 0.005, largest=0.3)
    for error in np.random.default_rng(0).normal(0.0, 0.05, (500, 2)):
        free.update(error)
        bound.update(error)
        assert np.array_equal(free.offset, bound.offset)
