import math
from typing import Any

import numpy as np
import pytest

from plantar.gait.feet.swing import SwingTrajectory

SWING = SwingTrajectory(
    start=np.array([0.0, 0.1, 0.0]),
    end=np.array([0.4, 0.1, 0.02]),
    yaw_start=3.0,
    yaw_end=-3.0,
    height=0.05,
    duration=0.9,
)


def test_ends_and_apex():
    assert np.allclose(SWING.at(0.0)[0], SWING.start)
    assert np.allclose(SWING.at(0.9)[0], SWING.end)
    assert np.allclose(SWING.at(5.0)[0], SWING.end)
    heights = [SWING.at(t)[0][2] for t in np.linspace(0.0, 0.9, 901)]
    assert max(heights) == pytest.approx(0.02 + 0.05, abs=1e-6)


def test_lifts_and_lands_without_speed_and_vertically():
    for time in (0.0, 0.9):
        inner = abs(time - 0.01)
        a, b = SWING.at(time)[0], SWING.at(inner)[0]
        assert np.abs(b - a).max() < 1e-3 * 0.5
        assert np.abs((b - a)[:2]).max() < 1e-9  # nothing but up or down


def test_turns_the_short_way():
    yaw = SWING.at(0.9)[1]
    assert math.remainder(yaw + 3.0, 2 * math.pi) == pytest.approx(0.0, abs=1e-12)
    assert abs(yaw - 3.0) < 0.3


def slow(**options: Any) -> tuple[np.ndarray, np.ndarray]:
    swing = SwingTrajectory(np.array([0.0, 0.1, 0.0]), np.array([0.4, 0.1, 0.0]), 0.0, 0.2, 0.05, 0.9, **options)
    time = np.linspace(0.0, 0.9, 1801)
    return time, np.array([swing.at(t)[0] for t in time])


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"approach_height": 0.015},
        {"approach_height": 0.03, "approach_speed": 0.1},
        {"approach_height": 0.015, "rises_first": True},
    ],
)
def test_speed_does_not_jump(options):
    time, track = slow(**options)
    speed = np.diff(track, axis=0) / (time[1] - time[0])
    assert np.abs(np.diff(speed, axis=0)).max() < 0.03


def test_a_slow_approach_is_even_and_goes_below_the_expected_ground():
    time, track = slow(approach_height=0.015, approach_speed=0.06)
    late = (track[:, 2] < 0.0149) & (time > 0.4)
    assert np.diff(track[late, 2]) / (time[1] - time[0]) == pytest.approx(np.full(late.sum() - 1, -0.06), abs=1e-6)
    assert track[-1, 2] < -0.005
    arrived = np.flatnonzero(np.abs(track[:, 0] - 0.4) < 1e-6)[0]
    assert time[arrived] < 0.6


def test_too_slow_an_approach_is_made_fast_enough_to_reach_the_ground():
    _, track = slow(approach_height=0.03, approach_speed=0.005)
    assert track[-1, 2] == pytest.approx(0.0, abs=1e-9)


def test_a_toe_is_above_the_next_stone_when_it_comes_to_it():
    track = slow(approach_height=0.015)[1]  # 0.4 m from heel to heel
    ahead = 0.109  # m from the toe of a sole of 0.241 m to a stone 0.4 m further on, 50 mm larger at each end
    height = track[np.searchsorted(track[:, 0], ahead), 2]
    assert height > 0.035  # the stones of `uneven` differ by up to 30 mm


def test_a_foot_that_rises_first_is_half_up_before_it_moves_and_arrives_with_the_others():
    time, track = slow(approach_height=0.015)
    _, first = slow(approach_height=0.015, rises_first=True)
    assert (first[:, 2] == track[:, 2]).all()
    heights = [rows[np.argmax(rows[:, 0] > 0.005), 2] for rows in (first, track)]  # where it has moved by 5 mm
    assert heights[0] > 0.6 * 0.05
    assert heights[1] < 0.1 * 0.05
    assert np.allclose(first[time >= 0.62 * 0.9, :2], [0.4, 0.1])
