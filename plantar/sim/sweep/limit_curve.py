"""Where the outcome of runs changes along a setting, and how certainly.

The share of completed runs is a logistic curve between a lapse and one less the lapse; the limit is at one half. Limit,
width and lapse have a probability on a grid, at first flat in the limit, the logarithm of the width and three lapses
(Kontsevich and Tyler, Bayesian adaptive estimation of psychometric slope and threshold, Vision Research 39, 1999).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

_LAPSES = (0.0, 0.02, 0.1)
_WIDTHS = 12
# widths of the logistic curve, in shares of the range
_NARROWEST = 1e-3
_WIDEST = 0.5
_BEYOND = 0.5  # how far limits are looked for outside of the range, in shares of it: whether it is in it is to be found
_LIMITS = 161
_NEGLIGIBLE = 1e-6  # probability that is left out when the grid is drawn around the rest
_LEAST = 1e-12
# least runs of a group by which a curve is held against its runs, and most groups
_GROUP = 10
_GROUPS = 20


@dataclass(frozen=True, eq=False)
class LimitCurve:
    """What outcomes show of a limit.

    `rising`: whether larger values complete more runs; `limits`: possible limits (n,) in the setting's unit, ascending;
    `probability`: probability (n,) of each; `widths`: possible widths (k,) in that unit; `joint`: probability (k, n,
    lapses) of width, limit and lapse.

    Example:
        >>> curve = limit_curve([1.0, 2.0, 3.0, 4.0] * 5, [True, True, False, False] * 5, 0.0, 5.0)
        >>> curve.rising, bool(2.0 < curve.limit < 3.0)
        (False, True)
    """

    rising: bool
    limits: NDArray[np.float64]
    probability: NDArray[np.float64]
    widths: NDArray[np.float64]
    joint: NDArray[np.float64]

    @property
    def limit(self) -> float:
        """The median of the limit."""
        return self.quantile(0.5)

    @property
    def interval(self) -> tuple[float, float]:
        """The limit's 95 % interval, for a number of runs chosen before."""
        return self.quantile(0.025), self.quantile(0.975)

    @property
    def interval_of_search(self) -> tuple[float, float]:
        """The 95 % interval of a search that its width ended: a probability of 98 %.

        Such a search ends early by chance: `interval` holds the limit in only 90 of 100
        (`tests/sim/sweep/test_limit_search.py` counts).
        """
        return self.quantile(0.01), self.quantile(0.99)

    def quantile(self, probability: float) -> float:
        """The value below which the limit is with a probability."""
        step = self.limits[1] - self.limits[0]
        ends = np.concatenate([[self.limits[0] - step / 2.0], self.limits + step / 2.0])
        return float(np.interp(probability, np.concatenate([[0.0], np.cumsum(self.probability)]), ends))

    def inside(self, low: float, high: float) -> float:
        """Returns the probability of a limit between `low` and `high`."""
        return float(self.probability[(low <= self.limits) & (self.limits <= high)].sum())

    def share(self, value: float) -> float:
        """Expected share, 0 to 1, of completed runs at a value."""
        rising = float((self.joint * _shares(value, self.limits, self.widths)).sum())
        return rising if self.rising else 1.0 - rising

    def agreement(self, values: Sequence[float], completed: Sequence[bool]) -> float:
        """Probability of runs as far from this curve; tiny where none explains them.

        Returns Pearson's chi square of groups of ten runs or more by `values`, with whether each was `completed`; 1
        below 40 runs.
        """
        if len(values) < 4 * _GROUP:
            return 1.0
        order = np.argsort(np.asarray(values, dtype=float), kind="stable")
        share = np.array([self.share(float(v)) for v in np.asarray(values, dtype=float)[order]])
        off = np.asarray(completed, dtype=float)[order] - share
        groups = np.array_split(np.arange(len(order)), min(_GROUPS, len(order) // _GROUP))
        # Where all or none are expected a group would count one run that is otherwise for everything.
        scatter = [max(float((share[g] * (1.0 - share[g])).sum()), 0.05) for g in groups]
        square = sum(float(off[g].sum()) ** 2 / s for g, s in zip(groups, scatter, strict=True))
        return float(chdtrc(len(groups) - 3, square))  # limit, width and lapse were chosen by the runs

    def turned(self, part: float, low: float, high: float) -> float:
        """Returns the value between `low` and `high` where a `part` (0 to 1, one half at the limit) of the change is
        expected, to a thousandth of the range.
        """
        weights = self.joint.sum(2)
        step = high - low
        for _ in range(10):
            step /= 2.0
            turn = np.tanh((low + step - self.limits) / (2.0 * self.widths[:, None]))
            if float((weights * turn).sum()) < 2.0 * part - 1.0:
                low += step
        return low + step / 2.0


def limit_curve(values: Sequence[float], completed: Sequence[bool], low: float, high: float) -> LimitCurve:
    """Returns what `values` and whether each was `completed` show of a limit between `low` and `high`, which
    is above `low`.
    """
    span = high - low
    tried, which = np.unique(np.asarray(values, dtype=float), return_inverse=True)
    good = np.bincount(which, completed).astype(float)
    bad = np.bincount(which) - good
    widths = np.geomspace(_NARROWEST, _WIDEST, _WIDTHS) * span
    limits = np.linspace(low - _BEYOND * span, high + _BEYOND * span, _LIMITS)
    up, down = _log_likelihoods(tried, good, bad, limits, widths)
    rising = bool(np.logaddexp.reduce(up, axis=None) >= np.logaddexp.reduce(down, axis=None))
    mass = np.cumsum(_normalised(up if rising else down).sum((0, 2)))
    # Once more where the limit is, with steps as fine as the answer.
    first = int(np.searchsorted(mass, _NEGLIGIBLE)) - 1
    last = int(np.searchsorted(mass, 1.0 - _NEGLIGIBLE)) + 1
    fine = np.linspace(limits[max(first, 0)], limits[min(last, _LIMITS - 1)], _LIMITS)
    found = _normalised(_log_likelihoods(tried, good, bad, fine, widths)[0 if rising else 1])
    return LimitCurve(rising, fine, found.sum((0, 2)), widths, found)


def _log_likelihoods(
    tried: NDArray[np.float64],
    good: NDArray[np.float64],
    bad: NDArray[np.float64],
    limits: NDArray[np.float64],
    widths: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Log likelihood (widths, limits, lapses) of a rising curve and of a falling one."""
    up = np.zeros((len(widths), len(limits), len(_LAPSES)))
    down = np.zeros_like(up)
    for value, completed, failed in zip(tried, good, bad, strict=True):
        share = _shares(float(value), limits, widths)
        yes = np.log(np.maximum(share, _LEAST))
        no = np.log(np.maximum(1.0 - share, _LEAST))
        up += completed * yes + failed * no
        down += completed * no + failed * yes
    return up, down


def _normalised(log_likelihood: NDArray[np.float64]) -> NDArray[np.float64]:
    likelihood = np.exp(log_likelihood - log_likelihood.max())
    return np.asarray(likelihood / likelihood.sum())


def _shares(value: float, limits: NDArray[np.float64], widths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share (widths, limits, lapses) of runs that a rising curve completes at a value."""
    turn = np.tanh((value - limits) / (2.0 * widths[:, None]))  # the logistic curve, between -1 and 1
    return np.asarray((1.0 + turn[..., None] * (1.0 - 2.0 * np.array(_LAPSES))) / 2.0)
