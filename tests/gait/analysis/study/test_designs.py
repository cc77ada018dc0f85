"""Designs by permutation keep their promise where nothing differs, and find what is planted."""

import zlib
from itertools import combinations, permutations, product

import numpy as np
import pytest
from scipy import stats

from plantar.gait.analysis.study.clusters import Clusters
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


@pytest.mark.long
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


def t_by_least_squares(y, who, level, speed):
    """t of level 1 beside level 0 with a constant for each participant and a covariate, solved column by column."""
    x = np.column_stack([who[:, None] == np.unique(who), speed, level]).astype(float)
    out = []
    for own in y.T:
        beta, *_ = np.linalg.lstsq(x, own, rcond=None)
        rest = ((own - x @ beta) ** 2).sum() / (len(own) - x.shape[1])
        out.append(beta[-1] / np.sqrt(rest * np.linalg.inv(x.T @ x)[-1, -1]))
    return np.array(out)


def left_by_least_squares(y, who, speed):
    x = np.column_stack([who[:, None] == np.unique(who), speed]).astype(float)
    return y - x @ np.linalg.lstsq(x, y, rcond=None)[0]


def orders_within(who):
    """Every order of rows within participants."""
    groups = [np.flatnonzero(who == one) for one in np.unique(who)]
    for choice in product(*(permutations(group) for group in groups)):
        order = np.arange(len(who))
        for group, chosen in zip(groups, choice, strict=True):
            order[group] = chosen
        yield order


def test_probabilities_of_three_levels_and_a_covariate_are_those_of_every_order_by_least_squares():
    random = seeded("every order")
    who = np.repeat(np.arange(4), 3)
    level = np.tile(np.arange(3), 4)
    speed = random.normal(1.2, 0.1, 12) + 0.1 * level
    values = random.normal(size=(12, 2)) + 3.0 * speed[:, None] + np.outer(level == 2, [2.0, 0.0])
    found = compare_levels(values, Design(who, level, speed[:, None], True), most=2000)
    whole = left_by_least_squares(values, who, speed)
    pairs = {(a, b): np.flatnonzero((level == a) | (level == b)) for a, b in combinations(range(3), 2)}

    def t_of(y, a, b):
        rows = pairs[a, b]
        return t_by_least_squares(y[rows], who[rows], level[rows] == b, speed[rows])

    largest = [max(np.abs(t_of(whole[order], *pair)).max() for pair in pairs) for order in orders_within(who)]
    for contrast in found:
        a, b = contrast.a, contrast.b
        rows = pairs[a, b]
        observed = t_of(whole, a, b)
        assert contrast.t == pytest.approx(observed, rel=1e-9)
        left = left_by_least_squares(values[rows], who[rows], speed[rows])
        alone = np.array(
            [
                np.abs(t_by_least_squares(left[order], who[rows], level[rows] == b, speed[rows]))
                for order in orders_within(who[rows])
            ]
        )
        reached = np.abs(observed) * (1.0 - 1e-7)
        assert contrast.p == pytest.approx((alone >= reached).mean(axis=0), rel=1e-9)
        of_family = (np.array(largest)[:, None] >= reached).mean(axis=0)
        of_pair = (alone.max(axis=1)[:, None] >= reached).mean(axis=0)
        assert contrast.p_all == pytest.approx(np.maximum(of_family, of_pair), rel=1e-9)


def test_a_measure_that_never_varies_differs_nowhere():
    """Beside one that does; of three levels, F of nothing over nothing is 0."""
    random = seeded("constant")
    design = design_of(3, True)
    values = np.column_stack([np.full(len(design.level), 7.0), random.normal(size=len(design.level))])
    test = any_differ(values, design, most=50)
    assert (test.f[0], test.p[0], test.p_all[0]) == (0.0, 1.0, 1.0)
    for contrast in compare_levels(values, design, most=50):
        assert (contrast.t[0], contrast.p[0], contrast.p_all[0]) == (0.0, 1.0, 1.0)


def test_the_heaviest_cluster_of_a_map_is_the_one_that_is_found_in_it_alone():
    random = seeded("heaviest")
    places = random.random((9, 7)) < 0.8
    clusters = Clusters(places)
    maps = random.normal(size=(40, int(places.sum()))) * 2.0
    alone = [max([*clusters.of(one, 1.5)[1], 0.0]) for one in maps]
    assert clusters.heaviest(maps, 1.5) == pytest.approx(alone, rel=1e-12)


@pytest.mark.parametrize("within", [True, False])
def test_an_f_with_a_covariate_is_that_of_two_models_by_least_squares(within):
    random = seeded(f"f of models {within}")
    design = design_of(3, within)
    speed = random.normal(1.2, 0.1, len(design.level)) + 0.05 * design.level
    own = Design(design.participant, design.level, speed[:, None], within)
    values = random.normal(size=len(speed)) + 4.0 * speed + 0.5 * design.level
    constants = (own.participant[:, None] == np.unique(own.participant)).astype(float)
    smaller = np.column_stack([constants if within else np.ones(len(speed)), speed])
    larger = np.column_stack([smaller, design.level[:, None] == [1, 2]])
    left = [((values - x @ np.linalg.lstsq(x, values, rcond=None)[0]) ** 2).sum() for x in (smaller, larger)]
    rest = len(speed) - larger.shape[1]
    found = any_differ(values[:, None], own, most=50)
    assert found.f[0] == pytest.approx((left[0] - left[1]) / 2 / (left[1] / rest), rel=1e-9)
    assert found.freedom == (2, rest)


def test_one_against_a_group_is_each_person_against_all_others():
    random = seeded("each")
    everyone = random.normal(size=(21, 4)) + 3.0
    found = deviation_of(everyone[0], everyone[1:])
    t = []
    for k in range(21):
        others = np.delete(everyone, k, axis=0)
        t.append((everyone[k] - others.mean(axis=0)) / (others.std(axis=0, ddof=1) * np.sqrt(21 / 20)))
    assert found.t == pytest.approx(t[0], rel=1e-9)
    largest = np.abs(t).max(axis=1)
    assert found.p_all == pytest.approx((largest[:, None] >= np.abs(t[0]) * (1 - 1e-12)).mean(axis=0), rel=1e-9)


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
