"""Two conditions compared: effect sizes and permutation tests corrected for multiple values.

The largest |t|, and largest cluster beyond a threshold, are compared with those of permuted labels, of pairs with
permuted signs (Nichols & Holmes 2002, Hum. Brain Mapp. 15:1; Maris & Oostenveld 2007, J. Neurosci. Methods 164:177).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.joined import joined

# Permutations that are drawn where there are more: a p of 0.05 is then known to 0.005 (one standard deviation).
PERMUTATIONS = 2000
_SEED = 1
_SPREAD = 1e-6  # Standard deviation of participants, as a share of their mean, below which it is rounding and no spread
_CONFIDENCE = 0.95


@dataclass(frozen=True)
class Effect:
    """Difference of a measure between conditions A and B.

    `paired`: whether the same participants are in both; `low`: lower end of its 95 % confidence interval;
    `effect_size`: hedges' g; NaN without spread; `effect_low`: lower end of its 95 % confidence interval; `p`:
    probability of such |t| by chance, by permutation.
    """

    paired: bool
    n_a: int
    n_b: int
    mean_a: float
    mean_b: float
    difference: float
    low: float
    high: float
    effect_size: float
    effect_low: float
    effect_high: float
    p: float
    p_all: float


@dataclass(frozen=True, eq=False)
class PermutationTest:
    """Where (samples, values) of two conditions differ.

    Attributes:
        t: t statistic (k,), B less A; 0 where nothing varies.
        p: Probability (k,) of each |t| by chance, alone.
        p_all: Same (k,) of the largest |t| of all.
        threshold: |t| that the largest exceeds in 5 % of permutations.
        clusters: Cluster number (k,) of each value, from 1; 0 for none.
        cluster_p: Probability of each mass by chance of the largest.
        permutations: Number, observed labels included.
    """

    t: NDArray[np.float64]
    p: NDArray[np.float64]
    p_all: NDArray[np.float64]
    threshold: float
    clusters: NDArray[np.int64]
    cluster_p: tuple[float, ...]
    permutations: int

    @property
    def significant(self) -> NDArray[np.bool_]:
        """Values (k,) in a cluster with p at most 0.05."""
        return np.isin(self.clusters, [number for number, p in enumerate(self.cluster_p, 1) if p <= 0.05])


def student_quantile(probability: float, freedom: float) -> float:
    """Student's t quantile of a `probability` at `freedom` degrees.

    Example:
        >>> round(student_quantile(0.975, 9.0), 4), round(student_quantile(0.975, 1e6), 3)
        (2.2622, 1.96)
    """
    from scipy.special import stdtrit  # takes 0.2 s to load, which an analysis of one recording does not need

    return float(stdtrit(freedom, probability))


def effect_of(a: NDArray[np.float64], b: NDArray[np.float64], paired: bool, p: float, p_all: float) -> Effect:
    """Returns effect of one measure.

    The difference's interval is Student's (Welch's of independent samples), the effect size's normal with the variance
    of Hedges & Olkin 1985, *Statistical Methods for Meta-Analysis*, ch. 5; of pairs with that of their changes next to
    the pooled one.

    `a`: values (n,) in A, two or more; `b`: values (m,) in B; of pairs in the same order.

    Example:
        >>> effect = effect_of(np.array([1.0, 2.0, 3.0]), np.array([2.0, 3.0, 4.0]), False, 0.4, 0.4)
        >>> effect.difference, round(effect.effect_size, 2)
        (1.0, 0.8)
    """
    n = len(a)
    m = len(b)
    difference = float(b.mean() - a.mean())
    va = float(a.var(ddof=1))
    vb = float(b.var(ddof=1))
    pooled = math.sqrt(((n - 1) * va + (m - 1) * vb) / (n + m - 2))
    if paired:
        freedom = float(n - 1)
        error = float((b - a).std(ddof=1)) / math.sqrt(n)
        # Of equal variances 2 (1 - r) / n, r the correlation; of others that would be too small where r is near 1.
        correction = _correction(n - 1)
        scale = (error / pooled) ** 2 if pooled > 0.0 else 0.0
        weight = 1.0 / (2.0 * n)
    else:
        error = math.sqrt(va / n + vb / m)
        parts = (va / n) ** 2 / (n - 1) + (vb / m) ** 2 / (m - 1)
        freedom = error**4 / parts if parts > 0.0 else float(n + m - 2)
        correction = _correction(n + m - 2)
        scale = 1.0 / n + 1.0 / m
        weight = 1.0 / (2.0 * (n + m))
    reach = student_quantile(0.5 + 0.5 * _CONFIDENCE, max(freedom, 1.0)) * error
    least = _SPREAD * max(abs(float(a.mean())), abs(float(b.mean())))
    size = correction * difference / pooled if pooled > least else math.nan
    half = student_quantile(0.5 + 0.5 * _CONFIDENCE, 1e6) * math.sqrt(scale + size**2 * weight)
    means = float(a.mean()), float(b.mean())
    return Effect(
        paired,
        n,
        m,
        *means,
        difference,
        difference - reach,
        difference + reach,
        size,
        size - half,
        size + half,
        p,
        p_all,
    )


def _correction(freedom: float) -> float:
    return 1.0 - 3.0 / (4.0 * freedom - 1.0) if freedom > 1 else 1.0


def permutation_test(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    paired: bool,
    neighbours: Sequence[Sequence[int]] | None = None,
    permutations: int = PERMUTATIONS,
) -> PermutationTest:
    """Returns where two conditions differ, corrected for all values.

    `a`: samples (n, k) of A, two or more; `b`: samples (m, k) of B; of pairs in the same order; `neighbours` of each
    value, for clusters; each value is one by itself where None; `permutations`: number drawn where there are more.

    Example:
        >>> random = np.random.default_rng(0)
        >>> a, b = random.normal(0.0, 1.0, (8, 5)), random.normal(0.0, 1.0, (8, 5))
        >>> b[:, 2] += 5.0
        >>> (permutation_test(a, b, paired=False).p_all < 0.05).tolist()
        [False, False, True, False, False]
    """
    a = np.asarray(a, dtype=float)
    b = np.asarray(b, dtype=float)
    freedom = len(a) - 1 if paired else len(a) + len(b) - 2
    beyond = student_quantile(0.975, freedom)
    both = b - a if paired else np.vstack([a, b])

    def t_of(label: NDArray[np.float64]) -> NDArray[np.float64]:
        return _paired_t(both * label[:, None]) if paired else _independent_t(both, label)

    observed = t_of(np.ones(len(a)) if paired else _first(len(a), len(both)))
    clusters, masses = _clusters(observed, beyond, neighbours)
    each = np.zeros(observed.shape)
    largest = []
    heaviest = []
    for t in map(t_of, _labels(len(a), len(b), paired, permutations)):
        size = np.abs(t)
        each += size >= np.abs(observed) - 1e-9
        largest.append(float(size.max(initial=0.0)))
        heaviest.append(max(_clusters(t, beyond, neighbours)[1], default=0.0) if masses else 0.0)
    tops = np.array(largest)
    weights = np.array(heaviest)
    count = len(largest)
    return PermutationTest(
        t=observed,
        p=each / count,
        p_all=(tops[:, None] >= np.abs(observed) - 1e-9).mean(axis=0),
        threshold=float(np.sort(tops)[max(0, math.ceil(0.95 * count) - 1)]),
        clusters=clusters,
        cluster_p=tuple(float((weights >= mass - 1e-9).mean()) for mass in masses),
        permutations=count,
    )


def _first(n: int, total: int) -> NDArray[np.float64]:
    return (np.arange(total) < n).astype(float)


def _labels(n: int, m: int, paired: bool, most: int) -> Iterator[NDArray[np.float64]]:
    """Signs (n,) of pairs, or which of n + m samples are of A: every choice, or the observed and drawn ones."""
    random = np.random.default_rng(_SEED)
    observed = np.ones(n) if paired else _first(n, n + m)
    if paired and 2**n <= most:
        yield from map(np.array, product((1.0, -1.0), repeat=n))
    elif not paired and math.comb(n + m, n) <= most:
        yield from (np.isin(np.arange(n + m), chosen).astype(float) for chosen in combinations(range(n + m), n))
    else:
        yield observed
        for _ in range(most - 1):
            yield random.choice((-1.0, 1.0), size=n) if paired else random.permutation(observed)


def _paired_t(change: NDArray[np.float64]) -> NDArray[np.float64]:
    n = len(change)
    mean = change.mean(axis=0)
    sd = change.std(axis=0, ddof=1)
    return _ratio(mean, sd / math.sqrt(n))


def _independent_t(both: NDArray[np.float64], first: NDArray[np.float64]) -> NDArray[np.float64]:
    n = first.sum()
    m = len(first) - first.sum()
    mean_a = first @ both / n
    mean_b = (1.0 - first) @ both / m
    rest = ((both - np.where(first[:, None] > 0.5, mean_a, mean_b)) ** 2).sum(axis=0)
    return _ratio(mean_b - mean_a, np.sqrt(rest / (n + m - 2.0) * (1.0 / n + 1.0 / m)))


def _ratio(mean: NDArray[np.float64], error: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.where(mean == 0.0, 0.0, mean / np.maximum(error, 1e-12 * np.maximum(np.abs(mean), 1e-300))))


def _clusters(
    t: NDArray[np.float64], beyond: float, neighbours: Sequence[Sequence[int]] | None
) -> tuple[NDArray[np.int64], list[float]]:
    """Cluster (k,) of each value beyond a threshold, of one sign, and each cluster's sum of |t|."""
    label = np.zeros(len(t), dtype=np.int64)
    masses: list[float] = []
    if neighbours is None:
        return label, masses
    far = np.flatnonzero(np.abs(t) > beyond).tolist()
    alike = {at: [k for k in neighbours[at] if abs(t[k]) > beyond and t[k] * t[at] > 0.0] for at in far}
    for number, places in enumerate(joined(alike), 1):
        label[places] = number
        masses.append(float(np.abs(t[places]).sum()))
    return label, masses
