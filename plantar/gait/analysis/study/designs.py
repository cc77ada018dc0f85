"""Factors with any number of levels compared by permutation, with covariates, as one family over all pairs.

The statistic of a pair of levels is the t of their difference in a linear model of the rows of these two levels. Of a
factor within participants, the model has a constant for each participant, and levels are exchanged within
participants; of a factor between participants, all rows are exchanged. Covariates are partialled out: what a model
without the factor leaves of the values is permuted (Freedman & Lane 1983, J. Bus. Econ. Stat. 1:292; Winkler et al.
2014, NeuroImage 92:381). The largest |t| over all values and all pairs holds the familywise error of all of them
(Westfall & Young 1993, Resampling-Based Multiple Testing); values on a line or grid have clusters, too (Maris &
Oostenveld 2007, J. Neurosci. Methods 164:177).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.study.clusters import Clusters
from plantar.gait.analysis.study.orders import blocks_of_orders
from plantar.gait.analysis.study.statistics import student_quantile

# Permutations that are drawn where there are more: a p of 0.05 is then known to 0.005 (one standard deviation).
PERMUTATIONS = 2000
_SPREAD = 1e-10  # Share of a value below which differences are rounding
_ROUNDING = 1e-9  # Share of a statistic that is rounding: a permuted one this much below the observed one equals it


@dataclass(frozen=True, eq=False)
class Design:
    """Rows of a factor's comparison: one for each participant and level.

    Attributes:
        participant: Number (r,) of each row's participant.
        level: Number (r,) of each row's level, from 0.
        covariates: Covariates (r, q), or (r, 0).
        within: Whether levels are compared within participants.
    """

    participant: NDArray[np.int64]
    level: NDArray[np.int64]
    covariates: NDArray[np.float64]
    within: bool

    @property
    def levels(self) -> int:
        """Number of levels."""
        return int(self.level.max()) + 1

    def of_rows(self, rows: NDArray[np.int64]) -> "Design":
        """Design of some rows by their numbers."""
        return Design(self.participant[rows], self.level[rows], self.covariates[rows], self.within)

    @cached_property
    def nuisance(self) -> NDArray[np.float64]:
        """Orthonormal columns (r, n) of all that is not the factor: constants and covariates."""
        if self.within:
            constants = (self.participant[:, None] == np.unique(self.participant)).astype(float)
        else:
            constants = np.ones((len(self.level), 1))
        return _orthonormal(np.column_stack([constants, _scaled(self.covariates)]))

    def orders(self, values: int, most: int) -> Iterator[NDArray[np.int64]]:
        """Orders (b, r) of its rows, some at a time, by `blocks_of_orders`."""
        groups = [np.arange(len(self.level))]
        if self.within:
            groups = [np.flatnonzero(self.participant == who) for who in np.unique(self.participant)]
        return blocks_of_orders(self.level, groups, values, most)

    @property
    def beside_constants(self) -> NDArray[np.float64]:
        """Orthonormal columns (r, n) of `nuisance` without the constants: permuted residuals have a share in these."""
        if not self.within:
            return self.nuisance
        _, who, rows = np.unique(self.participant, return_inverse=True, return_counts=True)
        constants = (who[:, None] == np.arange(len(rows))) / np.sqrt(rows)
        # The constants are among the nuisance: each of its directions is one of them, or at right angles to all.
        rest, size, _ = np.linalg.svd(self.nuisance - constants @ (constants.T @ self.nuisance), full_matrices=False)
        return np.asarray(rest[:, size > 0.5])

    @property
    def pairs(self) -> NDArray[np.int64]:
        """Both rows (n, 2) of each participant, of two levels."""
        return np.argsort(self.participant, kind="stable").reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class Contrast:
    """Difference of two levels, B less A, in k values.

    Attributes:
        a: Number of level A.
        b: Number of level B.
        difference: Adjusted difference (k,).
        error: Its standard error (k,).
        freedom: Degrees of freedom of the error.
        t: t (k,); 0 where nothing varies.
        p: Probability (k,) of such |t| by chance, of this pair and value alone.
        p_all: The same (k,) of all values and all pairs together.
        threshold: |t| that the largest of all values and pairs exceeds in 5 % of permutations.
        clusters: Number (k,) of the cluster of each value, from 1; 0 for none.
        cluster_p: Probability of each cluster's mass by chance, of all pairs together.
        permutations: Number, the observed one included.
    """

    a: int
    b: int
    difference: NDArray[np.float64]
    error: NDArray[np.float64]
    freedom: int
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


@dataclass(frozen=True, eq=False)
class Omnibus:
    """Whether any levels differ: F (k,), its probabilities alone and for all values, and degrees of freedom."""

    f: NDArray[np.float64]
    p: NDArray[np.float64]
    p_all: NDArray[np.float64]
    freedom: tuple[int, int]


def compare_levels(
    values: NDArray[np.float64], design: Design, places: NDArray[np.bool_] | None = None, most: int = PERMUTATIONS
) -> list[Contrast]:
    """Returns contrasts of all pairs of levels, in order (0, 1), (0, 2), ...

    Args:
        values: Values (r, k) of the design's rows.
        design: Which row is of whom.
        places: Line (k,) or grid of which k places are values, for clusters; each value is one by itself where None.
        most: Permutations that are drawn where there are more.

    Example:
        >>> random = np.random.default_rng(0)
        >>> who, level = np.divmod(np.arange(24), 3)
        >>> values = random.normal(size=(24, 2)) + np.outer(level == 2, [3.0, 0.0])
        >>> design = Design(who, level, np.zeros((24, 0)), within=True)
        >>> [(c.a, c.b, (c.p_all < 0.05).tolist()) for c in compare_levels(values, design)]
        [(0, 1, [False, False]), (0, 2, [True, False]), (1, 2, [True, False])]
    """
    pairs = [_Pair(design, a, b) for a, b in combinations(range(design.levels), 2)]
    clusters = Clusters(places)
    residuals = _Residuals(_residuals(values, design))
    observed = [_observed(pair, residuals) for pair in pairs]
    beyond = [clusters.of(t, pair.threshold) for t, pair in zip(observed, pairs, strict=True)]
    family = _permuted(residuals, design, pairs, observed, clusters, any(masses for _, masses in beyond), most)
    out = []
    for pair, t, (labels, masses) in zip(pairs, observed, beyond, strict=True):
        # What is permuted over all levels holds the error where no level differs; what is permuted over these two
        # alone, where others do.
        alone = family
        if len(pair.rows) < len(design.level):
            own = design.of_rows(pair.rows)
            same = _Pair(own, pair.a, pair.b, pair.levels)
            rest = _Residuals(_residuals(values[pair.rows], own))
            alone = _permuted(rest, own, [same], [t], clusters, bool(masses), most)
        size = np.abs(t)
        cluster_p = [
            max(float(_shares(found.heaviest, np.array([mass]))[0]) for found in (family, alone)) for mass in masses
        ]
        difference, error = pair.effect_of(values)
        out.append(
            Contrast(
                pair.a,
                pair.b,
                difference,
                error,
                pair.freedom,
                t,
                alone.p[0],
                np.maximum(_shares(family.largest, size), _shares(alone.largest, size)),
                float(np.sort(family.largest)[max(0, math.ceil(0.95 * len(family.largest)) - 1)]),
                labels,
                tuple(cluster_p),
                len(family.largest),
            )
        )
    return out


def any_differ(values: NDArray[np.float64], design: Design, most: int = PERMUTATIONS) -> Omnibus:
    """Returns whether any of a design's levels differ in values (r, k), by the largest F of `most` permutations.

    Of two levels, F is t squared.
    """
    dummies = (design.level[:, None] == np.arange(1, design.levels)).astype(float)
    q = design.nuisance
    own = _orthonormal(dummies - q @ (q.T @ dummies))
    rest = len(design.level) - q.shape[1] - own.shape[1]
    freedom = (own.shape[1], rest)
    residuals = _Residuals(_residuals(values, design))
    squares = (residuals.values**2).sum(axis=0)  # in any order
    floor = np.maximum(1e-24 * squares, 1e-300)
    beside = design.beside_constants

    def f_of(orders: NDArray[np.int64]) -> NDArray[np.float64]:
        told = np.sum([residuals.along(orders, column) ** 2 for column in own.T], axis=0)
        left = squares - told
        for column in beside.T:
            left = left - residuals.along(orders, column) ** 2
        return np.asarray(np.where(told <= floor, 0.0, told / freedom[0] / (np.maximum(left, floor) / freedom[1])))

    observed = f_of(np.arange(len(values))[None])[0]
    each = np.zeros(observed.shape)
    tops = []
    for block in design.orders(values.shape[1], most):
        f = f_of(block)
        each += (f >= observed * (1.0 - _ROUNDING)).sum(axis=0)
        tops.append(f.max(axis=1, initial=0.0))
    largest = np.concatenate(tops)
    return Omnibus(observed, each / len(largest), _shares(largest, observed), freedom)


def explain_levels(design: Design) -> bool:
    """Returns whether covariates and constants alone show a level's rows, so that nothing is left of its effect.

    Example:
        >>> who, level = np.divmod(np.arange(8), 2)
        >>> explain_levels(Design(who, level, level[:, None] + 3.0, within=True))
        True
    """
    of_level = (design.level[:, None] == np.unique(design.level)).astype(float)
    of_level -= of_level.mean(axis=0)
    q = design.nuisance
    left = of_level - q @ (q.T @ of_level)
    return bool(((left**2).sum(axis=0) <= 1e-12 * (of_level**2).sum(axis=0)).any())


class _Pair:
    """t of two levels of a design, of residuals of all its rows in any order.

    Sums of squares are products of matrices of the permutations (b, r) and of the values (r, k), so that no values are
    moved. Of a participant's two rows, only their difference is not the participant's constant.
    """

    def __init__(self, design: Design, a: int, b: int, levels: tuple[int, int] | None = None) -> None:
        first, second = levels or (a, b)
        kept = (design.level == first) | (design.level == second)
        if design.within:  # a participant with one of the two levels shows nothing of their difference
            both = np.intersect1d(design.participant[design.level == first], design.participant[design.level == second])
            kept &= np.isin(design.participant, both)
        self.a = a
        self.b = b
        self.levels = (first, second)
        self.rows = np.flatnonzero(kept)
        own = design.of_rows(self.rows)
        nuisance = own.nuisance
        x = (own.level == second).astype(float)
        x -= nuisance @ (nuisance.T @ x)
        self.length = float(np.sqrt(x @ x))
        self.x = x / max(self.length, 1e-300)
        self.freedom = len(x) - nuisance.shape[1] - 1
        self._of_pairs = own.pairs if design.within else None
        self._rest = own.beside_constants if design.within else nuisance

    @property
    def threshold(self) -> float:
        """|t| from which a value is in a cluster: that of p = 0.05 by itself."""
        return student_quantile(0.975, max(self.freedom, 1))

    def parts(
        self, residuals: "_Residuals", orders: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Projection on the difference, standard deviation of the rest, and length, (b, k) each, of orders (b, r)."""
        taken = orders[:, self.rows]
        along = residuals.along(taken, self.x)
        squares = residuals.squares(taken)
        rest = squares if self._of_pairs is None else residuals.squares_of_pairs(taken[:, self._of_pairs])
        for column in self._rest.T:
            rest = rest - residuals.along(taken, column) ** 2
        rest = np.maximum(rest - along**2, 1e-24 * squares)
        return along, np.asarray(np.sqrt(rest / max(self.freedom, 1))), np.sqrt(squares)

    def t_of(self, residuals: "_Residuals", orders: NDArray[np.int64]) -> NDArray[np.float64]:
        along, spread, length = self.parts(residuals, orders)
        small = np.abs(along) <= 1e-12 * length
        return np.asarray(np.where(small, 0.0, along / np.maximum(spread, 1e-300)))

    def effect_of(self, values: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Adjusted difference and its standard error, from values of all rows."""
        centred = values - values[self.rows].mean(axis=0)
        along, spread, _ = (part[0] for part in self.parts(_Residuals(centred), np.arange(len(values))[None]))
        return along / max(self.length, 1e-300), spread / max(self.length, 1e-300)


class _Residuals:
    """Values (r, k) that are permuted, and sums over them in any order of rows."""

    def __init__(self, values: NDArray[np.float64]) -> None:
        self.values = values
        self._squares = values**2
        self._differences: tuple[NDArray[np.int64], NDArray[np.float64]] | None = None

    def along(self, taken: NDArray[np.int64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sums (b, k) of the rows taken (b, m), times weights (m,)."""
        return self._spread(taken, weights) @ self.values

    def squares(self, taken: NDArray[np.int64]) -> NDArray[np.float64]:
        """Sums (b, k) of the squares of the rows taken (b, m)."""
        return self._spread(taken, np.ones(taken.shape[1])) @ self._squares

    def squares_of_pairs(self, taken: NDArray[np.int64]) -> NDArray[np.float64]:
        """Sums (b, k) of half the squared differences of pairs of rows (b, n, 2), each pair known or not yet."""
        rows = len(self.values)
        low, high = np.sort(taken, axis=2).transpose(2, 0, 1)
        codes, place = np.unique(low * rows + high, return_inverse=True)
        first, second = np.divmod(codes, rows)
        halves = 0.5 * (self.values[second] - self.values[first]) ** 2
        chosen = np.zeros((len(taken), len(codes)))
        np.put_along_axis(chosen, place.reshape(low.shape), 1.0, axis=1)
        return np.asarray(chosen @ halves)

    def _spread(self, taken: NDArray[np.int64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
        out = np.zeros((len(taken), len(self.values)))
        np.put_along_axis(out, taken, np.broadcast_to(weights, taken.shape), axis=1)
        return out


def _orthonormal(columns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Orthonormal basis of columns (r, n) without those that follow from others."""
    if columns.shape[1] == 0:
        return columns
    u, size, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u[:, size > 1e-9 * max(float(size.max()), 1e-300)])


def _scaled(columns: NDArray[np.float64]) -> NDArray[np.float64]:
    centred = columns - columns.mean(axis=0)
    return np.asarray(centred / np.maximum(centred.std(axis=0), 1e-300))


def _residuals(values: NDArray[np.float64], design: Design) -> NDArray[np.float64]:
    q = design.nuisance
    centred = values - values.mean(axis=0)
    rest = centred - q @ (q.T @ centred)
    rounding = _SPREAD * np.abs(values).max(axis=0, initial=0.0)
    return np.where(np.abs(rest).max(axis=0, initial=0.0) <= rounding, 0.0, rest)


class _Permuted(NamedTuple):
    """Largest |t| and heaviest cluster (n,) over all pairs of each of n permutations; `p`: of each pair the share (k,)
    of permutations that reach the observed |t|.
    """

    largest: NDArray[np.float64]
    heaviest: NDArray[np.float64]
    p: list[NDArray[np.float64]]


def _observed(pair: _Pair, residuals: _Residuals) -> NDArray[np.float64]:
    return np.asarray(pair.t_of(residuals, np.arange(len(residuals.values))[None])[0])


def _permuted(
    residuals: _Residuals,
    design: Design,
    pairs: Sequence[_Pair],
    observed: Sequence[NDArray[np.float64]],
    clusters: Clusters,
    heavy: bool,
    most: int,
) -> _Permuted:
    """Permute a design's residuals (r, k); without `heavy` clusters weigh nothing."""
    reached = [np.zeros(t.shape) for t in observed]
    tops: list[NDArray[np.float64]] = []
    weights: list[NDArray[np.float64]] = []
    for block in design.orders(residuals.values.shape[1], most):
        top = np.zeros(len(block))
        heaviest = np.zeros(len(block))
        for pair, t, count in zip(pairs, observed, reached, strict=True):
            found = pair.t_of(residuals, block)
            size = np.abs(found)
            count += (size >= np.abs(t) * (1.0 - _ROUNDING)).sum(axis=0)
            top = np.maximum(top, size.max(axis=1, initial=0.0))
            if heavy:
                heaviest = np.maximum(heaviest, clusters.heaviest(found, pair.threshold))
        tops.append(top)
        weights.append(heaviest)
    largest = np.concatenate(tops)
    return _Permuted(largest, np.concatenate(weights), [count / len(largest) for count in reached])


def _shares(permuted: NDArray[np.float64], observed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of permuted statistics (p,) that reach each observed one (k,)."""
    ordered = np.sort(permuted)
    below = np.searchsorted(ordered, observed * (1.0 - _ROUNDING), side="left")
    return np.asarray((len(ordered) - below) / len(ordered))  # 1 - 0.95 would be more than 0.05
