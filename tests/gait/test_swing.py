import math

import numpy as np
import pytest

from gait.swing import SwingTrajectory, minimum_jerk

SWING = SwingTrajectory(
    start=np.array([0.0, 0.1, 0.0]),
    end=np.array([0.4, 0.1, 0.02]),
    yaw_start=3.0,
    yaw_end=-3.0,
    height=0.05,
    duration=0.9,
)


def test_minimum_jerk_rate_is_its_derivative() -> None:
    for s in np.linspace(0.01, 0.99, 33):
        slope = (minimum_jerk(s + 1e-6)[0] - minimum_jerk(s - 1e-6)[0]) / 2e-6
        assert minimum_jerk(s)[1] == pytest.approx(slope, abs=1e-6)


def test_ends_and_apex() -> None:
    assert np.allclose(SWING.at(0.0)[0], SWING.start)
    assert np.allclose(SWING.at(0.9)[0], SWING.end)
    assert np.allclose(SWING.at(5.0)[0], SWING.end)
    heights = [SWING.at(t)[0][2] for t in np.linspace(0.0, 0.9, 901)]
    assert max(heights) == pytest.approx(0.02 + 0.05, abs=1e-6)


def test_lifts_and_lands_without_speed_and_vertically() -> None:
    for time in (0.0, 0.9):
        inner = abs(time - 0.01)
        a, b = SWING.at(time)[0], SWING.at(inner)[0]
        assert np.abs(b - a).max() < 1e-3 * 0.5
        assert np.abs((b - a)[:2]).max() < 1e-9  # nothing but up or down


def test_turns_the_short_way() -> None:
    yaw = SWING.at(0.9)[1]
    assert math.remainder(yaw + 3.0, 2 * math.pi) == pytest.approx(0.0, abs=1e-12)
    assert abs(yaw - 3.0) < 0.3
