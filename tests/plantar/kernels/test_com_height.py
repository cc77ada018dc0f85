import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.gait import com_height
from plantar.kernels.gait.com_height import CoMHeight


def test_it_follows_a_step_without_a_jump_in_speed():
    height = CoMHeight(0.1, 0.005)
    track = np.array([height.update(0.14) for _ in range(600)])
    speed = np.diff(track, prepend=0.1) / 0.005
    assert track[-1] == pytest.approx(0.14, abs=1e-5)
    assert track.max() <= 0.14
    assert np.abs(np.diff(speed, prepend=0.0)).max() < 8.0**2 * 0.04 * 0.005 * 1.01


def test_it_stays_where_the_ground_is():
    height = CoMHeight(-0.7, 0.005)
    assert {height.update(-0.7) for _ in range(10)} == {-0.7}


def test_compiled_and_interpreted_filter_agree():
    heights = [form.CoMHeight(0.1, 0.005) for form in (com_height, kernels.python_form("com_height"))]
    for target in np.random.default_rng(0).normal(0.0, 0.1, 200):
        height, expected = (filtered.update(target) for filtered in heights)
        assert height == expected
        assert heights[0].rate == heights[1].rate
