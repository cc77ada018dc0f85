import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from plantar import InputError, ReadingError
from plantar.sensing.health import (
    StuckMonitor,
    TaxelHealth,
    dead_taxels,
    fill_from_neighbours,
    saturated_taxels,
    stuck_taxels,
)

readings = st.sampled_from([0.0, 1.0, 2.0, 2.25, 785.0, math.nan, math.inf, -1.0])
series = hnp.arrays(float, st.tuples(st.integers(1, 12), st.integers(0, 5)), elements=readings)


@given(st.lists(readings))
def test_dead_and_saturated_exclude_each_other(values):
    dead, full = dead_taxels(values), saturated_taxels(values, 785.0)
    assert dead.tolist() == [not math.isfinite(v) for v in values]
    assert full.tolist() == [math.isfinite(v) and v >= 785.0 for v in values]


@given(series, st.sampled_from([0.0, 0.5]), st.floats(0.05, 1.0))
def test_stuck_over_frames_is_the_rule_step_by_step_and_the_monitor(values, tolerance, hold):
    times = np.cumsum(np.random.default_rng(len(values)).uniform(0.05, 0.3, len(values)))
    batch = stuck_taxels(times, values, hold, tolerance)
    monitor = StuckMonitor(hold, tolerance)
    assert batch.tolist() == [monitor.update(t, v).tolist() for t, v in zip(times, values, strict=True)]
    for i in range(values.shape[1]):
        since = times[0]
        for k, v in enumerate(values[:, i]):
            before = values[k - 1, i]
            if k and not (v == before or abs(v - before) <= tolerance):
                since = times[k]
            assert batch[k, i] == (times[k] - since >= hold and 0.0 < v < math.inf)


def test_a_taxel_in_the_air_is_not_stuck_and_noise_frees_a_loaded_one():
    times = np.arange(0.0, 5.0, 0.01)
    noise = np.random.default_rng(0).normal(0.0, 0.01, len(times))
    values = np.column_stack([np.zeros_like(times), 5.0 + noise, np.full_like(times, 5.0), np.full_like(times, np.nan)])
    assert stuck_taxels(times, values)[-1].tolist() == [False, False, True, False]
    assert not stuck_taxels(times, values)[:99].any()


def test_the_monitor_keeps_its_own_copy_and_resets():
    monitor = StuckMonitor(1.0)
    values = np.array([5.0])
    monitor.update(0.0, values)
    values[0] = 6.0
    assert monitor.update(1.0, values).tolist() == [False]
    monitor.reset()
    assert monitor.update(0.0, [1.0, 2.0]).tolist() == [False, False]


def test_bad_arguments_are_refused():
    for call in (
        lambda: stuck_taxels([0.0, 0.0], [[1.0], [1.0]]),
        lambda: stuck_taxels([0.0], [[1.0]], hold=0.0),
        lambda: StuckMonitor(tolerance=-1.0),
        lambda: StuckMonitor(hold=math.nan),
    ):
        with pytest.raises(InputError):
            call()
    monitor = StuckMonitor()
    monitor.update(1.0, [1.0])
    with pytest.raises(InputError, match="not later"):
        monitor.update(1.0, [1.0])
    with pytest.raises(ReadingError, match="taxels"):
        monitor.update(2.0, [1.0, 2.0])


def test_health_says_what_is_left_out():
    health = TaxelHealth(*np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 1, 1, 0]], dtype=bool))
    assert health.faulty.tolist() == [True, True, True, False]
    assert str(health) == "1 dead, 1 saturated, 2 stuck of 4 taxels"


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_filled_taxels_hold_the_mean_of_their_sound_neighbours(sole, seed, per_area):
    rng = np.random.default_rng(seed)
    values = rng.uniform(0.0, 50.0, (3, len(sole)))
    values[rng.random(values.shape) < 0.1] = np.nan
    faulty = np.isnan(values) & (rng.random(values.shape) < 0.9) | (rng.random(values.shape) < 0.2)
    filled = fill_from_neighbours(sole, values, faulty, per_area=per_area)
    for k, i in np.ndindex(*values.shape):
        if not faulty[k, i]:
            np.testing.assert_equal(filled[k, i], values[k, i])
            continue
        near = [j for j in sole.neighbours[i] if not faulty[k, j] and math.isfinite(values[k, j])]
        parts = [values[k, j] * (sole.areas[i] / sole.areas[j] if per_area else 1.0) for j in near]
        assert filled[k, i] == pytest.approx(np.mean(parts) if parts else math.nan, nan_ok=True)
    single = fill_from_neighbours(sole, values[0], faulty[0], per_area=per_area)
    np.testing.assert_array_equal(single, filled[0])


def test_a_uniform_pressure_is_filled_exactly_where_cells_differ_in_size(sole):
    force = 1e4 * sole.areas
    faulty = np.zeros(len(sole), dtype=bool)
    faulty[[0, 7]] = True
    broken = np.where(faulty, np.nan, force)
    assert fill_from_neighbours(sole, broken, faulty, per_area=True) == pytest.approx(force)
    assert fill_from_neighbours(sole, broken, faulty) != pytest.approx(force)
    assert np.isnan(broken).sum() == 2


def test_a_taxel_without_neighbours_stays_unknown(sole):
    alone = replace(sole, neighbours=((),) * len(sole))
    filled = fill_from_neighbours(alone, np.ones(len(sole)), np.arange(len(sole)) == 3)
    assert np.flatnonzero(np.isnan(filled)).tolist() == [3]
