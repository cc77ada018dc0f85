"""Effect of a measure between two conditions: difference, effect size, their intervals, and equivalence."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

_SPREAD = 1e-6  # Standard deviation of participants, as a share of their mean, below which it is rounding and no spread
_CONFIDENCE = 0.95
NORMAL_95 = 1.959963984540054  # of the standard normal distribution: 95 % of it lies within this of 0


@dataclass(frozen=True)
class Effect:
    """Difference of a measure between conditions A and B.

    `paired`: whether the same participants are in both; `low`: lower end of its 95 % confidence interval;
    `effect_size`: hedges' g; NaN without spread; `effect_low`: lower end of its 95 % confidence interval; `p`:
    probability of such |t| by chance, by permutation; `p_all`: the same of all measures and pairs of one family;
    `error`: standard error of the difference, with `freedom` degrees of freedom; `margin`: differences up to it are
    called equivalent, NaN where none is stated; `p_equivalent`: probability of such a small difference where the true
    one is the margin (two one-sided tests); `sd_a`, `sd_b`: standard deviations of the participants' means.
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
    error: float = math.nan
    freedom: float = math.nan
    margin: float = math.nan
    p_equivalent: float = math.nan
    sd_a: float = math.nan
    sd_b: float = math.nan


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
    half = NORMAL_95 * math.sqrt(scale + size**2 * weight)
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
        error,
        max(freedom, 1.0),
        sd_a=math.sqrt(va),
        sd_b=math.sqrt(vb),
    )


def adjusted(effect: Effect, difference: float, error: float, freedom: float) -> Effect:
    """Returns effect with an adjusted difference, its standard error and degrees of freedom, as with covariates.

    Hedges' g is that of the adjusted difference over the same standard deviation, its interval that of `effect_of` with
    the adjusted error.
    """
    reach = student_quantile(0.5 + 0.5 * _CONFIDENCE, freedom) * error
    scale = effect.effect_size / effect.difference if effect.difference else math.nan
    size = difference * scale
    weight = 1.0 / (2.0 * (effect.n_a if effect.paired else effect.n_a + effect.n_b))
    half = NORMAL_95 * math.sqrt((scale * error) ** 2 + size**2 * weight)
    return replace(
        effect,
        difference=difference,
        low=difference - reach,
        high=difference + reach,
        effect_size=size,
        effect_low=size - half,
        effect_high=size + half,
        error=error,
        freedom=freedom,
    )


def with_margin(effect: Effect, margin: float) -> Effect:
    """Returns effect with the probability of two one-sided t tests against -margin and margin (Schuirmann 1987).

    Below 0.05, the 90 % confidence interval of the difference lies within the margin.

    Example:
        >>> effect = effect_of(np.array([1.0, 2.0, 3.0]), np.array([1.1, 2.0, 2.9]), True, 1.0, 1.0)
        >>> round(with_margin(effect, 0.5).p_equivalent, 4)
        0.0065
    """
    from scipy.special import stdtr

    away = margin - abs(effect.difference)
    p = float(away <= 0.0) if effect.error <= 0.0 else float(stdtr(effect.freedom, -away / effect.error))
    return replace(effect, margin=margin, p_equivalent=p)


def _correction(freedom: float) -> float:
    return 1.0 - 3.0 / (4.0 * freedom - 1.0) if freedom > 1 else 1.0
