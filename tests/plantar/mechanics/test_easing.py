"""A share that goes from 0 to 1."""

import numpy as np
import pytest

from plantar.mechanics.easing import minimum_jerk


def test_minimum_jerk_rate_is_its_derivative():
    for s in np.linspace(0.01, 0.99, 33):
        slope = (minimum_jerk(s + 1e-6)[0] - minimum_jerk(s - 1e-6)[0]) / 2e-6
        assert minimum_jerk(s)[1] == pytest.approx(slope, abs=1e-6)


def test_minimum_jerk_is_held_outside():
    assert [minimum_jerk(s) for s in (-2.0, 0.0, 1.0, 5.0)] == [(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)]
