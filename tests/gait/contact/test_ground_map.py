"""What a swinging sole sees of made-up ground."""

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar import Percept, Reading, hex_layout
from plantar.gait.contact.ground_map import GroundMap, GroundMapSettings

LAYOUT = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
PERIOD = 0.005
X, Y = LAYOUT.positions[:, 0], LAYOUT.positions[:, 1]


def percept(distance: NDArray[np.float64], time: float = 0.0) -> Percept:
    return Percept(LAYOUT, Reading(time=time, force=np.zeros(len(LAYOUT)), proximity=distance))


def looked(distance, gains=None, noise=0.0):
    rng = np.random.default_rng(1)
    ground = GroundMap(LAYOUT, gains or GroundMapSettings())
    ground.begin()
    view = None
    for k in range(20):
        reading = distance + rng.normal(0.0, noise, len(distance)) if noise else distance
        view = ground.update(percept(reading, 0.005 * k), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.005 * k)
    return view


@pytest.mark.parametrize("orientation", ["plane", "moment"])
def test_sloping_ground_gives_its_slope_and_the_first_contact(orientation):
    view = looked(0.03 - 0.08 * X + 0.05 * Y, GroundMapSettings(orientation=orientation))
    assert view.slope == pytest.approx((0.08, -0.05), abs=2e-3)
    assert view.middle == pytest.approx(0.03, abs=1e-3)
    assert view.distance == pytest.approx(0.03 - 0.08 * 0.1 - 0.05 * 0.07, abs=1e-3)


def test_noise_averages_out():
    view = looked(np.full(len(LAYOUT), 0.02), noise=2e-3)
    assert view.distance == pytest.approx(0.02, abs=1e-3)
    assert np.hypot(*view.slope) < 0.01


def test_a_small_block_is_what_is_met_first_and_is_not_followed():
    view = looked(np.where(np.hypot(X - 0.05, Y) < 0.035, 0.012, 0.04))
    assert view is not None
    assert view.slope is None
    assert view.distance == pytest.approx(0.012, abs=1e-6)


@pytest.mark.parametrize("rim", [0.02, 0.03, 0.04, 0.06, 0.07])
def test_a_block_under_the_front_rim_is_what_is_met_first(rim):
    view = looked(np.where((0.1 - rim < X) & (np.abs(Y) < 0.05), 0.012, 0.04), noise=2e-3)
    assert view.distance < 0.015
    assert view.slope is None or np.hypot(*view.slope) < 0.02  # a sole that followed it would swing its heel down


def test_a_slab_under_half_the_sole_is_what_is_met_first():
    view = looked(np.where(X > 0.0, 0.012, 0.04))
    assert view.distance == pytest.approx(0.012, abs=1e-3)


def test_a_taxel_over_the_edge_does_not_tilt_the_ground():
    distance = np.full(len(LAYOUT), 0.01)
    distance[np.argmax(X + Y)] = 0.018  # 8 mm lower than the rest, at a corner of the sole
    view = looked(distance)
    assert view.slope == pytest.approx((0.0, 0.0), abs=1e-12)
    assert view.distance == pytest.approx(0.01)
    assert view.even


def test_ground_that_half_the_sole_is_above_is_measured_by_all_of_that_half():
    errors = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        ground = GroundMap(LAYOUT, GroundMapSettings())
        ground.begin()
        for k in range(20):
            reading = np.where(X > -0.03, 0.012, 0.03) + rng.normal(0.0, 2e-3, len(LAYOUT))
            time = PERIOD * k
            view = ground.update(percept(reading, time), np.array([0.0, 0.0, 0.03]), np.eye(3), time)
        assert view is not None
        assert view.slope is not None
        errors.append((view.middle - 0.012, *view.slope))
    assert np.abs(np.mean(errors, axis=0)).max() < 2e-3  # the upper half of the noise would make it 1 mm too high
    assert np.abs(np.array(errors)[:, 0]).max() < 8e-4
    assert np.abs(np.array(errors)[:, 1:]).max() < 0.015


def test_one_noisy_reading_of_a_taxel_is_not_yet_high_ground():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    ground.begin()
    distance = np.full(len(LAYOUT), 0.01)
    for k in range(40):
        ground.update(percept(distance, PERIOD * k), np.array([0.0, 0.0, 0.03]), np.eye(3), PERIOD * k)
    ground._sight.readings[0] = 1.0  # a taxel that sees this ground for the first time
    ground._sight.distance[0] = 0.005
    view = ground.update(percept(distance, 0.195), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.195)
    assert view.distance == pytest.approx(0.01, abs=5e-4)
    assert view.slope == pytest.approx((0.0, 0.0), abs=5e-3)


def test_dead_taxels_and_no_ground_are_no_obstacle():
    distance = np.full(len(LAYOUT), 0.02)
    distance[:5] = np.nan
    view = looked(distance)
    assert view.distance == pytest.approx(0.02)
    assert looked(np.full(len(LAYOUT), np.inf)) is None
    assert looked(np.full(len(LAYOUT), np.nan)) is None


def test_the_map_moves_with_the_sole_between_readings():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    ground.begin()
    ground.update(percept(np.full(len(LAYOUT), 0.03)), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.0)
    blind = Percept(LAYOUT, Reading(time=0.01, force=np.zeros(len(LAYOUT))))
    view = ground.update(blind, np.array([0.0, 0.0, 0.021]), np.eye(3), 0.01)
    assert view.middle == pytest.approx(0.021)
    angle = 0.05
    tilted = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    view = ground.update(blind, np.array([0.0, 0.0, 0.021]), tilted, 0.015)  # toes down
    assert view.slope[0] == pytest.approx(np.tan(angle), rel=0.02)


def swung(ground, distance, start, age=0.0):
    """A swing from the ground to 20 mm above it and half way down again; readings are as old as `age`."""
    ground.begin()
    view = None
    heights = [0.02 * np.sin(0.75 * np.pi * max(0.0, k) / 60) for k in range(-10, 61)]
    late = round(age / PERIOD)
    for k, height in enumerate(heights):
        time = start + PERIOD * k
        seen = percept(distance(heights[max(0, k - late)]), time - PERIOD * late)
        view = ground.update(seen, np.array([0.0, 0.0, height]), np.eye(3), time)
    return view


def test_a_bias_is_learned_from_the_touch():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    for _ in range(8):
        ground.begin()
        for k in range(20):
            ground.update(percept(np.full(len(LAYOUT), 0.005), 0.005 * k), np.zeros(3), np.eye(3), 0.005 * k)
        ground.touched()
    assert ground.bias == pytest.approx(0.005, abs=1e-4)


def test_one_touch_does_not_take_moved_ground_for_a_bias():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    ground.begin()
    ground.update(percept(np.full(len(LAYOUT), 0.012)), np.zeros(3), np.eye(3), 0.0)
    ground.touched()
    assert 0.0 < ground.bias <= 0.0015


@pytest.mark.parametrize("bias", [-0.01, -0.005, 0.005, 0.01])
def test_a_bias_is_learned_where_the_sole_leaves_the_ground(bias):
    rng = np.random.default_rng(2)
    ground = GroundMap(LAYOUT, GroundMapSettings())
    swung(ground, lambda z: z + bias + rng.normal(0.0, 2e-3, len(LAYOUT)), 0.0)
    assert ground.bias == pytest.approx(bias, abs=8e-4)


def test_a_sole_that_left_the_ground_before_its_swing_learns_no_bias_of_that():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    ground.stand(np.array([0.0, 0.0, -0.004]), np.eye(3))  # where it last carried load
    swung(ground, lambda z: np.full(len(LAYOUT), z + 0.004), 0.0)
    assert ground.bias == 0.0


def test_ground_that_was_no_plane_teaches_no_bias():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    block = np.where(np.hypot(X - 0.05, Y) < 0.04, 0.0, 0.03)
    swung(ground, lambda z: z + block, 0.0)
    assert ground.bias == 0.0


def test_a_reading_counts_for_when_it_was_taken():
    ground = GroundMap(LAYOUT, GroundMapSettings())
    view = swung(ground, lambda z: np.full(len(LAYOUT), z), 0.0, age=2 * PERIOD)
    assert view.distance == pytest.approx(0.02 * np.sin(0.75 * np.pi), abs=1e-4)


def test_ground_that_moves_is_seen_at_once_and_noise_is_no_move():
    rng = np.random.default_rng(3)
    ground = GroundMap(LAYOUT, GroundMapSettings())
    ground.begin()
    views = []
    for k in range(120):
        distance = (0.03 if k < 100 else 0.015) + rng.normal(0.0, 2e-3, len(LAYOUT))
        view = ground.update(percept(distance, PERIOD * k), np.array([0.0, 0.0, 0.03]), np.eye(3), PERIOD * k)
        views.append(view.distance)
    assert np.ptp(views[60:100]) < 1e-3
    assert views[100] == pytest.approx(0.015, abs=2.5e-3)
