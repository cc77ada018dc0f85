"""Effect sizes and permutation tests against formulas, scipy, spm1d where it is installed, and their own promise."""

import numpy as np
import pytest
from scipy import stats

from plantar.gait.analysis.study.designs import Contrast, Design, compare_levels
from plantar.gait.analysis.study.statistics import adjusted, effect_of, student_quantile, with_margin

LINE = np.ones(101, dtype=bool)


def two_levels(a, b, paired, places=None, permutations=2000) -> Contrast:
    """The contrast of samples (n, k) and (m, k) of two levels."""
    level = np.repeat([0, 1], [len(a), len(b)])
    who = np.tile(np.arange(len(a)), 2) if paired else np.arange(len(level))
    design = Design(who, level, np.zeros((len(level), 0)), paired)
    (contrast,) = compare_levels(np.vstack([a, b]), design, places, permutations)
    return contrast


@pytest.mark.parametrize("freedom", [1, 2, 3, 7, 30, 400, 1e6])
@pytest.mark.parametrize("probability", [0.5, 0.8, 0.95, 0.975, 0.999])
def test_quantiles_of_student(freedom, probability):
    assert student_quantile(probability, freedom) == pytest.approx(
        stats.t.ppf(probability, freedom), rel=1e-9, abs=1e-9
    )


def test_intervals_of_a_difference_are_students_and_welchs():
    random = np.random.default_rng(3)
    a, b = random.normal(10.0, 1.0, 9), random.normal(11.0, 2.0, 14)
    effect = effect_of(a, b, False, 1.0, 1.0)
    welch = stats.ttest_ind(b, a, equal_var=False).confidence_interval()
    assert (effect.low, effect.high) == pytest.approx((welch.low, welch.high), rel=1e-9)
    pairs = effect_of(a, b[:9], True, 1.0, 1.0)
    student = stats.ttest_rel(b[:9], a).confidence_interval()
    assert (pairs.low, pairs.high) == pytest.approx((student.low, student.high), rel=1e-9)


@pytest.mark.parametrize("paired", [True, False])
def test_an_effect_size_is_that_of_hedges_and_olkin(paired):
    random = np.random.default_rng(13)
    a, b = random.normal(10.0, 1.0, 9), random.normal(11.0, 1.6, 9)
    found = effect_of(a, b, paired, 1.0, 1.0)
    pooled = np.sqrt((a.var(ddof=1) + b.var(ddof=1)) / 2.0)
    freedom = 8 if paired else 16
    size = (1.0 - 3.0 / (4.0 * freedom - 1.0)) * (b.mean() - a.mean()) / pooled
    variance = (b - a).var(ddof=1) / 9 / pooled**2 + size**2 / 18 if paired else 2.0 / 9.0 + size**2 / 36
    reach = stats.norm.ppf(0.975) * np.sqrt(variance)
    assert (found.effect_size, found.effect_low, found.effect_high) == pytest.approx(
        (size, size - reach, size + reach), rel=1e-9
    )


@pytest.mark.parametrize("paired", [True, False])
def test_participants_that_are_all_alike_have_no_effect_size(paired):
    """Rounding is no spread: a size of ten million standard deviations says nothing."""
    alike = 154.0 + np.array([0.0, 1e-8, -1e-8, 2e-8])
    effect = effect_of(alike, alike - 0.4, paired, 0.03, 0.03)
    assert np.isnan([effect.effect_size, effect.effect_low, effect.effect_high]).all()
    assert effect.difference == pytest.approx(-0.4)


def test_the_interval_of_an_effect_size_holds_it_in_95_of_100():
    random = np.random.default_rng(5)
    draws = [effect_of(random.normal(0, 1, 15), random.normal(0.8, 1, 15), False, 1.0, 1.0) for _ in range(200)]
    assert np.mean([d.effect_size for d in draws]) == pytest.approx(0.8, abs=0.06)
    assert 0.90 < np.mean([d.effect_low < 0.8 < d.effect_high for d in draws]) < 0.99


@pytest.mark.parametrize("spread", [1.0, 1.3])
@pytest.mark.parametrize("alike", [0.5, 0.9, 0.99])
def test_the_interval_of_pairs_holds_it_whatever_they_share(alike, spread):
    """Of conditions that spread differently, too: with the correlation alone it held it in 87 of 100."""
    random, size, held = np.random.default_rng(0), 0.5, 0
    for _ in range(300):
        own, other = random.normal(size=(2, 20))
        b = spread * (alike * own + np.sqrt(1.0 - alike**2) * other) + size * np.sqrt((1.0 + spread**2) / 2.0)
        found = effect_of(own, b, True, 1.0, 1.0)
        held += found.effect_low <= size <= found.effect_high
    assert 0.91 < held / 300 < 0.99


@pytest.mark.parametrize("paired", [True, False])
def test_a_permutation_test_agrees_with_scipys(paired):
    random = np.random.default_rng(1)
    a, b = random.normal(0.0, 1.0, (7, 3)), random.normal(0.6, 1.0, (7, 3))
    ours = two_levels(a, b, paired, permutations=4000)
    if paired:
        theirs = stats.permutation_test(
            (a, b), lambda x, y, axis: np.abs(stats.ttest_rel(y, x, axis=axis)[0]), permutation_type="samples",
            vectorized=True, n_resamples=np.inf, alternative="greater",
        )  # fmt: skip
    else:
        theirs = stats.permutation_test(
            (a, b), lambda x, y, axis: np.abs(stats.ttest_ind(y, x, axis=axis)[0]), permutation_type="independent",
            vectorized=True, n_resamples=np.inf, alternative="greater",
        )  # fmt: skip
    assert ours.p == pytest.approx(theirs.pvalue, abs=1e-9)
    assert (ours.p_all >= ours.p).all()


def smooth(random: np.random.Generator, n: int) -> np.ndarray:
    """Curves (n, 101) that vary over about a sixth of the stance."""
    kernel = np.exp(-0.5 * (np.arange(-30, 31) / 8.0) ** 2)
    return np.array(
        [np.convolve(random.normal(0.0, 1.0, 161), kernel / np.sqrt((kernel**2).sum()), "valid") for _ in range(n)]
    )


@pytest.mark.parametrize("paired", [True, False])
def test_the_null_stays_null_in_95_of_100(paired):
    """Curves without a difference: a cluster, or a largest |t|, is called significant in 1 of 20 draws or about."""
    random = np.random.default_rng(11)
    found = []
    for _ in range(40):
        test = two_levels(smooth(random, 7), smooth(random, 7), paired, LINE, permutations=100)
        found.append((test.significant.any(), (test.p_all <= 0.05).any()))
    assert np.mean(found, axis=0).max() <= 0.15  # 40 draws of 0.05: more than 6 is one in 100


def test_a_difference_is_found_where_it_is():
    random = np.random.default_rng(2)
    a, b = smooth(random, 10), smooth(random, 10)
    b[:, 40:60] += 3.0
    test = two_levels(a, b, False, LINE, permutations=400)
    assert test.significant[45:55].all()
    assert not test.significant[:25].any()
    assert not test.significant[75:].any()
    assert (test.t[45:55] > 0.0).all()


def test_where_nothing_varies():
    same = np.ones((4, 3))
    test = two_levels(same, same, True, np.ones(3, dtype=bool))
    assert test.t.tolist() == [0.0, 0.0, 0.0]
    assert test.p_all.tolist() == [1.0, 1.0, 1.0]
    assert not test.significant.any()


@pytest.mark.parametrize("paired", [True, False])
def test_thresholds_and_clusters_are_those_of_spm1d(paired):
    """spm1d is GPL and no dependency; where somebody has it, both have to say the same."""
    spm1d = pytest.importorskip("spm1d", reason="spm1d is not installed")
    random = np.random.default_rng(4)
    a, b = smooth(random, 6), smooth(random, 6)
    b[:, 60:80] += 2.5
    ours = two_levels(a, b, paired, LINE, permutations=10_000)
    whole = spm1d.stats.nonparam.ttest_paired(b, a) if paired else spm1d.stats.nonparam.ttest2(b, a)
    theirs = whole.inference(0.05, two_tailed=True, iterations=-1)
    assert ours.t == pytest.approx(theirs.z, rel=1e-6)
    assert ours.threshold == pytest.approx(theirs.zstar, rel=0.03)
    for cluster in theirs.clusters:
        first, last = (round(end) for end in cluster.endpoints)
        assert (ours.p_all[first + 1 : last] <= 0.055).all()


def test_an_adjusted_difference_is_that_of_least_squares():
    """Of a model with a constant for each participant and a covariate, solved by another route."""
    random = np.random.default_rng(7)
    who = np.repeat(np.arange(9), 2)
    level = np.tile([0, 1], 9)
    speed = random.normal(1.2, 0.1, 18) + 0.1 * level
    values = 50.0 * speed + random.normal(0.0, 1.0, 18) + np.repeat(random.normal(0.0, 5.0, 9), 2) + 2.0 * level
    (found,) = compare_levels(values[:, None], Design(who, level, speed[:, None], True))
    x = np.column_stack([who[:, None] == np.arange(9), speed, level]).astype(float)
    beta, rest, *_ = np.linalg.lstsq(x, values, rcond=None)
    error = np.sqrt(rest[0] / (18 - 11) * np.linalg.inv(x.T @ x)[-1, -1])
    assert found.difference == pytest.approx([beta[-1]], rel=1e-9)
    assert found.error == pytest.approx([error], rel=1e-9)
    assert found.freedom == 7
    first = values[level == 0]
    second = values[level == 1]
    effect = adjusted(effect_of(first, second, True, 1.0, 1.0), beta[-1], error, 7)
    reach = stats.t.ppf(0.975, 7) * error
    assert (effect.low, effect.high) == pytest.approx((beta[-1] - reach, beta[-1] + reach), rel=1e-9)


def test_equivalence_is_two_one_sided_tests_of_scipy():
    random = np.random.default_rng(8)
    a = random.normal(10.0, 1.0, 12)
    b = a + random.normal(0.1, 0.4, 12)
    ours = with_margin(effect_of(a, b, True, 1.0, 1.0), 0.5).p_equivalent
    low = stats.ttest_1samp(b - a, -0.5, alternative="greater").pvalue
    high = stats.ttest_1samp(b - a, 0.5, alternative="less").pvalue
    assert ours == pytest.approx(max(low, high), rel=1e-9)
