"""Levels of contact above a sole's noise."""

import math

import numpy as np
import pytest

from plantar.layouts.contact_levels import FALSE_CONTACTS, contact_levels


@pytest.mark.sample(3)
@pytest.mark.parametrize("cells", [1, 4, 8, 42, 51, pytest.param(300, marks=pytest.mark.long)])
@pytest.mark.parametrize("clipped", [False, True])
def test_noise_alone_is_a_contact_in_fewer_samples_than_stated(cells, clipped):
    """Clipped at zero or not, as sensors deliver it; each level alone is good for about half of the share."""
    rng = np.random.default_rng(cells)
    levels = contact_levels(1.5, cells)
    samples = 1_000_000
    one = 0
    both = 0
    for _ in range(20):
        noise = 1.5 * rng.standard_normal((samples // 20, cells))
        if clipped:
            noise = np.maximum(noise, 0.0)
        high = noise.max(axis=1) > levels.cell
        one += int(high.sum())
        both += int((high | (np.maximum(noise, 0.0).sum(axis=1) > levels.sole)).sum())
    expected = FALSE_CONTACTS * samples
    spread = 4.0 * math.sqrt(expected)
    assert both < expected + spread
    assert abs(one - 0.5 * expected) < spread


@pytest.mark.parametrize("cells", [42, 300])
def test_the_bound_of_the_sum_is_not_far_from_what_is_needed(cells):
    """Of many cells the sum is nearly normal: the bound is 1.6 of its standard deviations higher at most."""
    mean = 1.0 / math.sqrt(2.0 * math.pi)
    spread = math.sqrt(cells * (0.5 - mean * mean))
    needed = cells * mean + 3.89 * spread
    assert needed < contact_levels(1.0, cells).sole < needed + 1.6 * spread


def test_without_known_noise_any_force_is_a_contact():
    assert contact_levels(0.0, 42) == (0.0, 0.0)
    assert contact_levels(1.0, 0) == (0.0, 0.0)
