import numpy as np
import pytest

from plantar.gait.estimate.com_height import CoMHeight


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
