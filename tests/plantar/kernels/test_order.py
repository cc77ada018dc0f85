"""Order of a few numbers against numpy's sorting, in both forms."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.base import order


@pytest.mark.parametrize("module", [order, python_form("base.order")], ids=["compiled", "python"])
@pytest.mark.parametrize("seed", range(40))
def test_median_and_mean_of_the_least_are_those_of_sorted_numbers(module, seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 60))
    numbers = rng.integers(0, 6, count) / 3.0 if seed % 2 else rng.normal(size=count)  # with and without equal ones
    least = int(rng.integers(1, count + 1))
    behind = np.append(numbers, -9.0)  # beyond the count: not looked at
    assert module.median(behind.copy(), count) == pytest.approx(np.median(numbers), abs=1e-15)
    assert module.mean_of_least(behind.copy(), count, least) == pytest.approx(
        np.sort(numbers)[:least].mean(), abs=1e-13
    )
    place = least - 1
    module.select(behind, count, place)
    assert behind[place] == np.sort(numbers)[place]
    assert behind[:place].max(initial=-np.inf) <= behind[place] <= behind[place:count].min()
    assert behind[count] == -9.0
