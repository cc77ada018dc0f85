import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.geometry.polygon import area, convex_hull
from plantar.sensing.temperature import temperature_footprint, temperature_measure, temperature_wrench, warm_taxels

seeds = st.integers(0, 2**32 - 1)
anything = st.one_of(st.floats(-50.0, 120.0), st.sampled_from([math.nan, math.inf, -math.inf, 31.0, 60.0]))


def random_temperature(rng, n):
    temperature = rng.uniform(15.0, 70.0, n)
    temperature[rng.random(n) < 0.1] = np.nan
    temperature[rng.random(n) < 0.1] = np.inf
    return temperature


@given(st.lists(anything, max_size=8), st.floats(20.0, 60.0))
def test_the_measure_is_the_excess_up_to_the_end_of_the_range(values, threshold):
    got = temperature_measure(values, threshold, 60.0)
    for t, kappa in zip(values, got, strict=True):
        sees = math.isfinite(t) and t >= threshold
        assert kappa == (min(t, 60.0) - threshold if sees else 0.0)


@given(seeds, seeds)
def test_the_wrench_is_the_sum_of_forces_and_moments(tilted_sole, pushed, layout_seed, seed):
    layout = tilted_sole(layout_seed)
    temperature = random_temperature(np.random.default_rng(seed), len(layout))
    kappa = np.array([min(t, 60.0) - 40.0 if math.isfinite(t) and t >= 40.0 else 0.0 for t in temperature])
    assert temperature_wrench(layout, temperature, 40.0, 2.5) == pytest.approx(pushed(layout, 2.5 * kappa), abs=1e-9)
    frames = np.stack([temperature, temperature + 1.0])
    single = np.array([temperature_wrench(layout, t) for t in frames])
    assert temperature_wrench(layout, frames) == pytest.approx(single, abs=1e-9)


def test_a_sole_recoils_from_a_hot_plate_and_from_the_warm_side(sole):
    temperature = np.where(sole.positions[:, 0] > 0, 45.0, 25.0)
    wrench = temperature_wrench(sole, temperature)
    assert wrench[2] == pytest.approx(14.0 * (sole.positions[:, 0] > 0).sum())
    assert wrench[4] < 0.0  # lifts the toes
    for cold in (25.0, np.nan, np.inf):
        assert temperature_wrench(sole, np.full(len(sole), cold)).tolist() == [0.0] * 6


@given(seeds)
def test_the_footprint_is_the_hull_of_the_warm_cells(sole, seed):
    temperature = random_temperature(np.random.default_rng(seed), len(sole))
    warm = [i for i, t in enumerate(temperature) if math.isfinite(t) and t >= 50.0]
    assert np.flatnonzero(warm_taxels(temperature, 50.0)).tolist() == warm
    expected = convex_hull(np.concatenate([sole.cell_polygon(i) for i in warm]))
    assert area(temperature_footprint(sole, temperature, 50.0)) == pytest.approx(area(expected), rel=1e-12)


def test_a_cold_sole_has_no_footprint_and_the_layout_sets_the_threshold(sole):
    assert sole.temperature_threshold == 31.0
    assert temperature_footprint(sole, np.full(len(sole), 30.9)).shape == (0, 2)
    assert area(temperature_footprint(sole, np.full(len(sole), 31.0))) > 0.0
    assert temperature_footprint(sole, np.full(len(sole), np.nan)).shape == (0, 2)
