"""Wilson's interval: against its definition, and that it holds what it says."""

import math

import pytest

from plantar.bench.intervals import wilson_interval


@pytest.mark.parametrize(("completed", "runs"), [(0, 5), (1, 5), (8, 10), (10, 10), (50, 100), (999, 1000)])
def test_at_both_ends_the_count_is_196_standard_deviations_away(completed, runs):
    low, high = wilson_interval(completed, runs)
    assert 0.0 <= low <= completed / runs <= high <= 1.0
    for share in {low, high} - {0.0, 1.0}:
        distance = abs(completed / runs - share) / math.sqrt(share * (1.0 - share) / runs)
        assert distance == pytest.approx(1.96, abs=1e-4)


def test_all_and_none_are_certain_of_one_end_only_and_mirror_each_other():
    assert wilson_interval(0, 20)[0] == 0.0
    assert wilson_interval(20, 20)[1] == 1.0
    assert wilson_interval(20, 20)[0] == pytest.approx(1.0 - wilson_interval(0, 20)[1])
    assert wilson_interval(0, 0) == (0.0, 1.0)


@pytest.mark.parametrize(("completed", "runs"), [(-1, 5), (6, 5), (1, 0)])
def test_counts_that_cannot_be_are_refused(completed, runs):
    with pytest.raises(ValueError, match="cannot be"):
        wilson_interval(completed, runs)
