"""Designs by permutation keep their promise where nothing differs, and find what is planted."""

import zlib
from itertools import combinations

import numpy as np
import pytest
from scipy import stats

from plantar.gait.analysis.study.designs import Design, any_differ, compare_levels
from plantar.gait.analysis.study.one_against_group import deviation_of

PEOPLE = 10
DRAWS = 200
MOST = 19  # of 200 at 0.05: more is one in 200


def seeded(name: str) -> np.random.Generator:
    return np.random.default_rng(zlib.crc32(name.encode()))


def design_of(levels: int, within: bool) -> Design:
    people = PEOPLE if within else PEOPLE * levels
    who = np.repeat(np.arange(PEOPLE), levels) if within else np.arange(people)
    level = np.tile(np.arange(levels), PEOPLE)
    return Design(who, level, np.zeros((len(level), 0)), within)


@pytest.mark.sample(1)
@pytest.mark.parametrize("within", [True, False])
@pytest.mark.parametrize("levels", [2, 4])
def test_one_family_over_all_pairs_errs_in_5_of_100(levels, within):
    """Over the six pairs of four levels by themselves it was 22 of 100."""
    random = seeded(f"family {levels} {within}")
    design = design_of(levels, within)
    found = 0
    for _ in range(DRAWS):
        own = random.normal(size=(len(design.level), 3)) + random.normal(size=(PEOPLE * levels, 3))[design.participant]
        found += any((c.p_all <= 0.05).any() for c in compare_levels(own, design, most=100))
    assert found <= MOST


def test_a_pair_that_does_not_differ_is_safe_where_another_does():
    """One level is far from the others, which are alike: these three pairs err in 5 of 100 or fewer."""
    random = seeded("partial")
    design = design_of(4, True)
    found = 0
    for _ in range(DRAWS):
        own = random.normal(size=(len(design.level), 1)) + 5.0 * (design.level == 0)[:, None]
        found += any((c.p_all <= 0.05).any() for c in compare_levels(own, design, most=100) if c.a != 0)
    assert found <= MOST


def test_a_covariate_that_differs_between_levels_is_no_difference():
    """Speed rises with the level and force with speed; allowed for, an error stays 5 of 100. Planted, it is found."""
    random = seeded("speed")
    plain = design_of(2, True)
    found = 0
    planted = 0
    for _ in range(DRAWS):
        speed = random.normal(1.2, 0.1, len(plain.level)) + 0.1 * plain.level
        design = Design(plain.participant, plain.level, speed[:, None], True)
        values = 10.0 * speed + random.normal(size=len(speed)) + random.normal(0.0, 3.0, PEOPLE)[plain.participant]
        (null,) = compare_levels(values[:, None], design, most=100)
        (real,) = compare_levels((values + 5.0 * plain.level)[:, None], design, most=100)
        found += bool(null.p_all[0] <= 0.05)
        planted += bool(real.p_all[0] <= 0.05)
    assert found <= MOST
    assert planted > 0.9 * DRAWS


@pytest.mark.sample(1)
@pytest.mark.parametrize("shape", [(60,), (12, 8)])
def test_curves_and_maps_err_in_5_of_100_over_all_pairs(shape):
    random = seeded(f"cluster {shape}")
    design = design_of(3, True)
    found = 0
    for _ in range(60):
        noise = random.normal(size=(len(design.level), *shape))
        for axis in range(1, noise.ndim):
            noise = noise + np.roll(noise, 1, axis) + np.roll(noise, -1, axis)
        own = noise.reshape(len(noise), -1)
        found += any(c.significant.any() for c in compare_levels(own, design, np.ones(shape, dtype=bool), most=60))
    assert found <= 8  # of 60 at 0.05: more is one in 200


def test_an_f_is_that_of_two_ways_and_of_one():
    random = seeded("f")
    within = design_of(4, True)
    between = design_of(4, False)
    values = random.normal(size=(40, 1))
    assert any_differ(values, between, most=50).f[0] == pytest.approx(
        stats.f_oneway(*(values[between.level == k, 0] for k in range(4))).statistic, rel=1e-9
    )
    table = values.reshape(PEOPLE, 4)
    grand = table.mean()
    told = PEOPLE * ((table.mean(axis=0) - grand) ** 2).sum() / 3
    rest = table - table.mean(axis=0) - table.mean(axis=1, keepdims=True) + grand
    assert any_differ(values, within, most=50).f[0] == pytest.approx(told / ((rest**2).sum() / 27), rel=1e-9)
    for c, (a, b) in zip(compare_levels(values, within, most=50), combinations(range(4), 2), strict=True):
        assert c.t[0] == pytest.approx(stats.ttest_rel(table[:, b], table[:, a]).statistic, rel=1e-9)


def test_one_against_a_group_errs_in_5_of_100():
    """A person like the 19 of the group: a probability of 1 in 20 by construction, in any of many values."""
    random = seeded("one")
    mix = random.normal(size=(30, 30))
    found = sum(bool(deviation_of(*_split(random.normal(size=(20, 30)) @ mix)).differs.any()) for _ in range(1000))
    assert 27 <= found <= 77  # 50, by four standard deviations


def _split(values):
    return values[0], values[1:]


def test_the_largest_of_twenty_has_a_probability_of_exactly_5_percent():
    from plantar.gait.analysis.study.designs import _shares

    assert _shares(np.arange(20.0), np.array([19.0, 18.0, -1.0])).tolist() == [0.05, 0.1, 1.0]
