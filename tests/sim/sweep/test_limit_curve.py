"""Limits of curves that are known, from runs drawn of them."""

import math

import numpy as np
import pytest

from plantar.sim.sweep.limit_curve import limit_curve


def test_the_limit_of_a_step_is_between_the_last_run_that_held_and_the_first_that_did_not():
    values = np.linspace(0.0, 10.0, 21)
    curve = limit_curve(values, values < 6.2, 0.0, 10.0)
    low, high = curve.interval
    assert not curve.rising
    assert low < 6.25 < high
    assert high - low < 1.5
    assert curve.share(2.0) > 0.9 > 0.1 > curve.share(9.0)


def test_a_curve_read_from_the_other_side_has_the_mirrored_limit():
    generator = np.random.default_rng(3)
    values = generator.uniform(2.0, 8.0, 60)
    completed = generator.random(60) < 1.0 / (1.0 + np.exp(-(values - 4.0) / 0.7))
    here = limit_curve(values, completed, 2.0, 8.0)
    there = limit_curve(10.0 - values, completed, 2.0, 8.0)
    assert (here.rising, there.rising) == (True, False)
    np.testing.assert_allclose(there.interval, [10.0 - end for end in reversed(here.interval)], atol=1e-9)
    np.testing.assert_allclose(there.share(7.0), here.share(3.0), atol=1e-9)


def test_units_and_the_order_of_runs_do_not_matter():
    generator = np.random.default_rng(4)
    values = generator.uniform(0.0, 1.0, 40)
    completed = values + 0.1 * generator.standard_normal(40) > 0.4
    meters = limit_curve(values, completed, 0.0, 1.0)
    order = generator.permutation(40)
    millimeters = limit_curve(1e3 * values[order], completed[order], 0.0, 1e3)
    assert millimeters.limit == pytest.approx(1e3 * meters.limit, rel=1e-9)


def test_without_runs_the_limit_is_open_and_equal_ends_put_it_outside():
    nothing = limit_curve([], [], 0.0, 1.0)
    assert nothing.limit == pytest.approx(0.5)
    assert nothing.interval[0] < 0.0
    assert nothing.interval[1] > 1.0
    always = limit_curve([0.0, 1.0] * 6, [True] * 12, 0.0, 1.0)
    assert always.inside(0.0, 1.0) < 0.05


def test_one_run_that_lapses_does_not_move_a_limit_that_many_tell():
    values = np.linspace(0.0, 1.0, 41)
    completed = values > 0.5
    completed[-2] = False
    low, high = limit_curve(values, completed, 0.0, 1.0).interval
    assert low < 0.5 < high
    assert high - low < 0.2


@pytest.mark.parametrize(("width", "lapse"), [(1e-4, 0.0), (0.03, 0.05), (0.08, 0.0)])
def test_intervals_of_95_percent_hold_the_limit_that_often(width, lapse):
    """Of 30 draws 28.5 are expected; less than 25 come by chance once in 300."""
    generator = np.random.default_rng(round(1e4 * width))
    held = 0
    for _ in range(30):
        limit = generator.uniform(0.3, 0.7)
        values = generator.uniform(0.0, 1.0, 50)
        share = [0.5 * (1.0 + (1.0 - 2.0 * lapse) * math.tanh((v - limit) / (2.0 * width))) for v in values]
        low, high = limit_curve(values, generator.random(50) < share, 0.0, 1.0).interval
        held += low <= limit <= high
    assert held >= 25


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("width", "lapse", "limits", "least"),
    [
        *((0.005, 0.0, (0.5,), 0), (0.03, 0.02, (0.5,), 0), (0.1, 0.0, (0.5,), 0)),
        *((0.005, 0.0, (0.3, 0.7), 9), (0.03, 0.02, (0.2, 0.8), 6)),
    ],
)
def test_runs_of_one_curve_agree_with_it_and_those_of_two_steep_ones_do_not(width, lapse, limits, least):
    """Of 10 draws: of one curve more than one is doubted at 1e-3 once in 20,000 tests; two wide ones look like one."""
    generator, doubted = np.random.default_rng(round(1e4 * width)), 0
    for _ in range(10):
        values = generator.uniform(0.0, 1.0, 400)
        limit = generator.choice(limits, 400)
        share = 0.5 * (1.0 + (1.0 - 2.0 * lapse) * np.tanh((values - limit) / (2.0 * width)))
        completed = (generator.random(400) < share).tolist()
        doubted += limit_curve(values.tolist(), completed, 0.0, 1.0).agreement(values.tolist(), completed) < 1e-3
    assert doubted >= least if least else doubted <= 1


def test_a_few_runs_are_not_doubted():
    values, completed = [0.1, 0.9] * 10, [True, True] * 10
    assert limit_curve(values, completed, 0.0, 1.0).agreement(values, completed) == 1.0
