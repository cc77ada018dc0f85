"""How many participants the next study takes, by the noncentral t distribution."""

import math

from plantar.gait.analysis.study.statistics import Effect, student_quantile

_MOST = 10_000


def power_of(size: float, n: int, paired: bool, alpha: float = 0.05) -> float:
    """Power of a two-sided t test: n pairs, or n in each of two groups, of a standardised difference.

    `size`: difference over the standard deviation of differences (pairs), or over that within groups.

    Example:
        >>> round(power_of(0.5, 34, paired=True), 3), round(power_of(0.5, 64, paired=False), 3)
        (0.808, 0.801)
    """
    from scipy.special import nctdtr

    freedom = n - 1 if paired else 2 * n - 2
    away = abs(size) * math.sqrt(n if paired else 0.5 * n)
    critical = student_quantile(1.0 - 0.5 * alpha, freedom)
    return float(1.0 - nctdtr(freedom, away, critical) + nctdtr(freedom, away, -critical))


def people_needed(effect: Effect, power: float = 0.8) -> int | None:
    """Returns pairs, or people in each of two groups, that find a true difference as large as the one found.

    None without spread, or of more than 10,000. The difference found is itself uncertain: its interval's lower end
    takes more.
    """
    spread = effect.error * math.sqrt(effect.n_a if effect.paired else 1.0 / (1.0 / effect.n_a + 1.0 / effect.n_b))
    if not spread > 0.0 or not math.isfinite(spread) or effect.difference == 0.0:
        return None
    size = effect.difference / spread
    # From below: the noncentral t of a huge difference in thousands of people is no number.
    low = 2
    high = 2
    while power_of(size, high, effect.paired) < power:
        if high == _MOST:
            return None
        low = high
        high = min(2 * high, _MOST)
    while low < high:  # power rises with n
        middle = (low + high) // 2
        if power_of(size, middle, effect.paired) >= power:
            high = middle
        else:
            low = middle + 1
    return low
