"""What a swinging sole sees of made-up ground, and how it comes down on it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from gait.swing_compliance import (
    ComplianceGains,
    GroundView,
    SwingCompliance,
    turned_to_ground,
    vector_from_rotation,
)
from plantar import Percept, Reading, hex_layout

LAYOUT = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
PERIOD = 0.005
X, Y = LAYOUT.positions[:, 0], LAYOUT.positions[:, 1]


def percept(distance: NDArray[np.float64], time: float = 0.0) -> Percept:
    return Percept(LAYOUT, Reading(time=time, force=np.zeros(len(LAYOUT)), proximity=distance))


def looked(
    distance: NDArray[np.float64], gains: ComplianceGains | None = None, noise: float = 0.0
) -> GroundView | None:
    rng = np.random.default_rng(1)
    compliance = SwingCompliance(LAYOUT, gains or ComplianceGains())
    compliance.begin()
    view = None
    for k in range(20):
        reading = distance + rng.normal(0.0, noise, len(distance)) if noise else distance
        view = compliance.look(percept(reading, 0.005 * k), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.005 * k)
    return view


@pytest.mark.parametrize("orientation", ["plane", "moment"])
def test_sloping_ground_gives_its_slope_and_the_first_contact(orientation: str) -> None:
    view = looked(0.03 - 0.08 * X + 0.05 * Y, ComplianceGains(orientation=orientation))
    assert view is not None
    assert view.slope == pytest.approx((0.08, -0.05), abs=2e-3)
    assert view.middle == pytest.approx(0.03, abs=1e-3)
    assert view.distance == pytest.approx(0.03 - 0.08 * 0.1 - 0.05 * 0.07, abs=1e-3)


def test_noise_averages_out() -> None:
    view = looked(np.full(len(LAYOUT), 0.02), noise=2e-3)
    assert view is not None
    assert view.distance == pytest.approx(0.02, abs=1e-3)
    assert view.slope is not None
    assert np.hypot(*view.slope) < 0.01


def test_a_small_block_is_what_is_met_first_and_is_not_followed() -> None:
    view = looked(np.where(np.hypot(X - 0.05, Y) < 0.035, 0.012, 0.04))
    assert view is not None
    assert view.slope is None
    assert view.distance == pytest.approx(0.012, abs=1e-6)


@pytest.mark.parametrize("rim", [0.02, 0.03, 0.04, 0.06, 0.07])
def test_a_block_under_the_front_rim_is_what_is_met_first(rim: float) -> None:
    view = looked(np.where((0.1 - rim < X) & (np.abs(Y) < 0.05), 0.012, 0.04), noise=2e-3)
    assert view is not None
    assert view.distance < 0.015
    assert view.slope is None or np.hypot(*view.slope) < 0.02  # a sole that followed it would swing its heel down


def test_a_slab_under_half_the_sole_is_what_is_met_first() -> None:
    view = looked(np.where(X > 0.0, 0.012, 0.04))
    assert view is not None
    assert view.distance == pytest.approx(0.012, abs=1e-3)


def test_a_taxel_over_the_edge_does_not_tilt_the_ground() -> None:
    distance = np.full(len(LAYOUT), 0.01)
    distance[np.argmax(X + Y)] = 0.018  # 8 mm lower than the rest, at a corner of the sole
    view = looked(distance)
    assert view is not None
    assert view.slope == pytest.approx((0.0, 0.0), abs=1e-12)
    assert view.distance == pytest.approx(0.01)
    assert view.even


def test_ground_that_half_the_sole_is_above_is_measured_by_all_of_that_half() -> None:
    errors = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        compliance = SwingCompliance(LAYOUT, ComplianceGains())
        compliance.begin()
        for k in range(20):
            reading = np.where(X > -0.03, 0.012, 0.03) + rng.normal(0.0, 2e-3, len(LAYOUT))
            time = PERIOD * k
            view = compliance.look(percept(reading, time), np.array([0.0, 0.0, 0.03]), np.eye(3), time)
        assert view is not None
        assert view.slope is not None
        errors.append((view.middle - 0.012, *view.slope))
    assert np.abs(np.mean(errors, axis=0)).max() < 2e-3  # the upper half of the noise would make it 1 mm too high
    assert np.abs(np.array(errors)[:, 0]).max() < 8e-4
    assert np.abs(np.array(errors)[:, 1:]).max() < 0.015


def test_one_noisy_reading_of_a_taxel_is_not_yet_high_ground() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.begin()
    distance = np.full(len(LAYOUT), 0.01)
    for k in range(40):
        compliance.look(percept(distance, PERIOD * k), np.array([0.0, 0.0, 0.03]), np.eye(3), PERIOD * k)
    compliance._readings[0], compliance._distance[0] = 1.0, 0.005  # a taxel that sees this ground for the first time
    view = compliance.look(percept(distance, 0.195), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.195)
    assert view is not None
    assert view.distance == pytest.approx(0.01, abs=5e-4)
    assert view.slope == pytest.approx((0.0, 0.0), abs=5e-3)


def test_dead_taxels_and_no_ground_are_no_obstacle() -> None:
    distance = np.full(len(LAYOUT), 0.02)
    distance[:5] = np.nan
    view = looked(distance)
    assert view is not None
    assert view.distance == pytest.approx(0.02)
    assert looked(np.full(len(LAYOUT), np.inf)) is None
    assert looked(np.full(len(LAYOUT), np.nan)) is None


def test_the_map_moves_with_the_sole_between_readings() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.begin()
    compliance.look(percept(np.full(len(LAYOUT), 0.03)), np.array([0.0, 0.0, 0.03]), np.eye(3), 0.0)
    blind = Percept(LAYOUT, Reading(time=0.01, force=np.zeros(len(LAYOUT))))
    view = compliance.look(blind, np.array([0.0, 0.0, 0.021]), np.eye(3), 0.01)
    assert view is not None
    assert view.middle == pytest.approx(0.021)
    angle = 0.05
    tilted = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    view = compliance.look(blind, np.array([0.0, 0.0, 0.021]), tilted, 0.015)  # toes down
    assert view is not None
    assert view.slope is not None
    assert view.slope[0] == pytest.approx(np.tan(angle), rel=0.02)


def swung(
    compliance: SwingCompliance, distance: Callable[[float], NDArray[np.float64]], start: float, age: float = 0.0
) -> GroundView | None:
    """A swing from the ground to 20 mm above it and half way down again; readings are as old as `age`."""
    compliance.begin()
    view = None
    heights = [0.02 * np.sin(0.75 * np.pi * max(0.0, k) / 60) for k in range(-10, 61)]
    late = round(age / PERIOD)
    for k, height in enumerate(heights):
        time = start + PERIOD * k
        seen = percept(distance(heights[max(0, k - late)]), time - PERIOD * late)
        view = compliance.look(seen, np.array([0.0, 0.0, height]), np.eye(3), time)
    return view


def test_a_bias_is_learned_from_the_touch() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    for _ in range(8):
        compliance.begin()
        for k in range(20):
            compliance.look(percept(np.full(len(LAYOUT), 0.005), 0.005 * k), np.zeros(3), np.eye(3), 0.005 * k)
        compliance.touched()
    assert compliance.bias == pytest.approx(0.005, abs=1e-4)


def test_one_touch_does_not_take_moved_ground_for_a_bias() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.begin()
    compliance.look(percept(np.full(len(LAYOUT), 0.012)), np.zeros(3), np.eye(3), 0.0)
    compliance.touched()
    assert 0.0 < compliance.bias <= 0.0015


@pytest.mark.parametrize("bias", [-0.01, -0.005, 0.005, 0.01])
def test_a_bias_is_learned_where_the_sole_leaves_the_ground(bias: float) -> None:
    rng = np.random.default_rng(2)
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    swung(compliance, lambda z: z + bias + rng.normal(0.0, 2e-3, len(LAYOUT)), 0.0)
    assert compliance.bias == pytest.approx(bias, abs=8e-4)


def test_a_sole_that_left_the_ground_before_its_swing_learns_no_bias_of_that() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.stand(np.array([0.0, 0.0, -0.004]), np.eye(3))  # where it last carried load
    swung(compliance, lambda z: np.full(len(LAYOUT), z + 0.004), 0.0)
    assert compliance.bias == 0.0


def test_close_to_the_ground_an_edge_goes_down_no_faster_than_the_sole() -> None:
    gains = ComplianceGains()
    compliance = SwingCompliance(LAYOUT, gains)
    slow = compliance.turn_rate(0.0, (0.005, 0.0))
    assert slow * np.hypot(*np.ptp(LAYOUT.outline, axis=0)) / 2 == pytest.approx(gains.touch_speed)
    assert compliance.turn_rate(0.03, (0.005, 0.0)) == gains.turn_rate
    assert compliance.turn_rate(0.0, (0.1, 0.0)) == gains.turn_rate  # a wedge slides in


def test_ground_that_was_no_plane_teaches_no_bias() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    block = np.where(np.hypot(X - 0.05, Y) < 0.04, 0.0, 0.03)
    swung(compliance, lambda z: z + block, 0.0)
    assert compliance.bias == 0.0


def test_a_reading_counts_for_when_it_was_taken() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    view = swung(compliance, lambda z: np.full(len(LAYOUT), z), 0.0, age=2 * PERIOD)
    assert view is not None
    assert view.distance == pytest.approx(0.02 * np.sin(0.75 * np.pi), abs=1e-4)


def test_ground_that_moves_is_seen_at_once_and_noise_is_no_move() -> None:
    rng = np.random.default_rng(3)
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.begin()
    views = []
    for k in range(120):
        distance = (0.03 if k < 100 else 0.015) + rng.normal(0.0, 2e-3, len(LAYOUT))
        view = compliance.look(percept(distance, PERIOD * k), np.array([0.0, 0.0, 0.03]), np.eye(3), PERIOD * k)
        assert view is not None
        views.append(view.distance)
    assert np.ptp(views[60:100]) < 1e-3
    assert views[100] == pytest.approx(0.015, abs=2.5e-3)


@pytest.mark.parametrize("height", [0.06, 0.04, 0.02])
def test_the_swing_slows_down_and_touches_at_a_crawl(height: float) -> None:
    gains = ComplianceGains()
    compliance = SwingCompliance(LAYOUT, gains)
    compliance.begin()
    speeds = []
    for _ in range(400):
        seen = GroundView(height, height, (0.0, 0.0)) if height < gains.sensing_range else None
        drop = compliance.descent(seen, 0.1, 0.0, 0.5, PERIOD)
        speeds.append(drop / PERIOD)
        height -= drop
        if height <= 0.0:
            break
    assert height <= 0.0
    assert max(speeds) <= gains.top_speed + 1e-9
    assert speeds[-1] < 2.0 * gains.touch_speed
    assert np.diff(speeds).max() <= gains.acceleration * PERIOD + 0.02


def test_a_foot_that_still_moves_forward_keeps_its_clearance() -> None:
    gains = ComplianceGains()
    compliance = SwingCompliance(LAYOUT, gains)
    compliance.begin()
    height = 0.04
    for _ in range(400):
        height -= compliance.descent(GroundView(height, height, None), 0.1, 0.1, 0.5, PERIOD)
    assert height == pytest.approx(gains.clearance, abs=1e-3)


def test_touchdown_has_hysteresis_and_the_load_is_held() -> None:
    gains = ComplianceGains()
    compliance = SwingCompliance(LAYOUT, gains)
    compliance.begin()
    assert not any(compliance.feel(load) for load in (5.0, -3.0, 8.0, 6.0))
    assert [compliance.feel(40.0) for _ in range(3)][-1]
    assert compliance.feel(10.0)  # above half the threshold
    load, height = 0.0, 0.001
    for _ in range(800):
        height -= compliance.yielding(load, gains.hold_force, 0.0, PERIOD)
        load = max(0.0, -2e5 * height)
    assert load == pytest.approx(gains.hold_force, abs=2.0)


def test_a_descent_is_over_before_weight_is_put_on_the_foot() -> None:
    for height in (0.006, 0.012, 0.03):
        gains = ComplianceGains()
        compliance = SwingCompliance(LAYOUT, gains)
        compliance.begin()
        left, speed = 0.35, 0.0
        while height > 0.0:
            drop = compliance.descent(GroundView(height, height, None), 0.1, 0.0, left, PERIOD)
            speed, height, left = drop / PERIOD, height - drop, left - PERIOD
        assert 0.0 < left < 0.2
        assert speed < 1.5 * gains.haste * gains.touch_speed


def test_a_foot_past_the_ground_that_it_sees_goes_down_faster() -> None:
    speeds = []
    for past in (0.0, 0.002, 0.004):
        compliance = SwingCompliance(LAYOUT, ComplianceGains())
        compliance.begin()
        for _ in range(50):
            drop = compliance.descent(GroundView(-past, -past, None), 0.1, 0.0, 0.5, PERIOD)
        speeds.append(drop)
    assert np.diff(speeds).min() > 0.0


def test_a_load_is_held_while_the_body_moves_and_grows_gently() -> None:
    gains = ComplianceGains()
    compliance = SwingCompliance(LAYOUT, gains)
    compliance.begin()
    assert compliance.holding(0.0) == gains.touch_force < compliance.holding(1.0) == gains.hold_force
    load, height = 20.0, -1e-4
    for _ in range(400):
        height += 0.002 * PERIOD - compliance.yielding(load, gains.hold_force, 0.0, PERIOD)
        load = max(0.0, -2e5 * height)
    assert load == pytest.approx(gains.hold_force, abs=1.0)


def test_a_foot_that_lost_the_ground_comes_back() -> None:
    compliance = SwingCompliance(LAYOUT, ComplianceGains())
    compliance.begin()
    near, far = (compliance.yielding(0.0, 30.0, above, PERIOD) for above in (0.0, 0.0003))
    assert 0.0 < near < far


def test_turning_goes_to_the_slope_at_a_limited_rate() -> None:
    rotation = np.eye(3)
    for _ in range(200):
        normal = rotation.T @ np.array([-0.1, 0.05, 1.0])
        slope = (-normal[0] / normal[2], -normal[1] / normal[2])
        turned = turned_to_ground(rotation, slope, 0.2, 0.01)
        step = np.linalg.norm(vector_from_rotation(rotation.T @ turned))
        assert step <= 0.01 + 1e-9
        rotation = turned
    up = rotation[:, 2] / rotation[2, 2]
    assert up[:2] == pytest.approx([-0.1, 0.05], abs=1e-3)


@pytest.mark.parametrize("vector", [[0.0, 0.0, 0.0], [0.3, -0.2, 0.1], [1e-12, 0.0, 0.0], [0.0, 2.0, 0.0]])
def test_rotation_vectors_come_back(vector: list[float]) -> None:
    from gait.estimator import rotation_from_vector

    assert vector_from_rotation(rotation_from_vector(np.array(vector))) == pytest.approx(vector, abs=1e-9)
