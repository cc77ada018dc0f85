"""Mixed models of single steps: steps in recordings of people, by statsmodels (optional)."""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library
from plantar.gait.analysis.measures import COMPARED
from plantar.gait.analysis.study.measured_table import Cell, cells_of, key_of_all
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import NORMAL_95

FEWEST_PEOPLE = 5  # of fewer the spread between people is hardly known
_FEWEST_STEPS = 20
_ROUNDING = 1e-9  # Share of a measure below which its spread is rounding
_UNKNOWN = (*(math.nan,) * 8, "")


@dataclass(frozen=True)
class MixedEffect:
    """Difference of a level from the first one in a mixed model of steps, in the measure's unit.

    The model has a constant for each person, one for each person in each level, and covariates; estimated by
    restricted maximum likelihood. `sd_people`, `sd_levels`, `sd_steps`: standard deviations between people, of a
    person's level, and of a person's steps in a level; `low`, `high`: 95 % confidence interval; `p`: of z; `note`: what
    the fit reported.
    """

    factor: str
    a: str
    b: str
    measure: str
    steps: int
    people: int
    difference: float
    error: float
    low: float
    high: float
    p: float
    sd_people: float
    sd_levels: float
    sd_steps: float
    note: str


def mixed_effects(results: Sequence[RecordingResult], factor: str, covariates: Sequence[str] = ()) -> list[MixedEffect]:
    """Returns effects of a factor's levels on each compared measure; DependencyError without statsmodels.

    A level against the first one in order of appearance, of all used steps.
    """
    cells = cells_of(results, factor)
    levels = list(dict.fromkeys(cell.level for cell in cells))
    people = list(dict.fromkeys(cell.participant for cell in cells))
    if len(levels) < 2 or len(people) < FEWEST_PEOPLE:
        return []
    out: list[MixedEffect] = []
    for name in COMPARED:
        key = key_of_all(cells, name)
        table = [] if key is None else _steps(cells, key, levels, people, covariates)
        if key is None or len(table) < _FEWEST_STEPS:
            continue
        rows = np.array(table)
        if len(np.unique(rows[:, 1])) < 2 or np.ptp(rows[:, 0]) <= _ROUNDING * np.abs(rows[:, 0]).max():
            continue
        try:
            fit = fit_mixed(rows[:, 0], rows[:, 1].astype(int), rows[:, 2].astype(int), rows[:, 3:])
        except np.linalg.LinAlgError:
            unknown = MixedEffect(factor, levels[0], levels[1], key, len(rows), len(np.unique(rows[:, 2])), *_UNKNOWN)
            out.append(replace(unknown, note="statsmodels finds no fit: steps of a person do not vary enough"))
            continue
        for i, level in enumerate(levels[1:], 1):
            if i not in fit.levels:
                continue
            at = fit.levels.index(i)
            difference = fit.differences[at]
            error = fit.errors[at]
            out.append(
                MixedEffect(
                    factor,
                    levels[0],
                    level,
                    key,
                    len(rows),
                    len(np.unique(rows[:, 2])),
                    difference,
                    error,
                    difference - NORMAL_95 * error,
                    difference + NORMAL_95 * error,
                    math.erfc(abs(difference / error) / math.sqrt(2.0)) if error > 0.0 else math.nan,
                    *fit.spreads,
                    fit.note,
                )
            )
    return out


def _steps(
    cells: Sequence[Cell], key: str, levels: Sequence[str], people: Sequence[str], covariates: Sequence[str]
) -> list[list[float]]:
    rows: list[list[float]] = []
    for cell in cells:
        known = [cell.covariate(name) for name in covariates]
        if not np.isfinite(known).all():
            continue
        for result, side in cell.feet:
            values = [row[key] for row in result.rows if row["side"] == side and row["used"]]
            place = [float(levels.index(cell.level)), float(people.index(cell.participant))]
            rows += [[float(value), *place, *known] for value in values if value is not None]
    return rows


@dataclass(frozen=True)
class MixedFit:
    """Differences of levels from level 0 and their standard errors; spreads of people, levels in people and steps."""

    levels: tuple[int, ...]
    differences: tuple[float, ...]
    errors: tuple[float, ...]
    spreads: tuple[float, float, float]
    note: str


def fit_mixed(
    values: NDArray[np.float64], level: NDArray[np.int64], person: NDArray[np.int64], covariates: NDArray[np.float64]
) -> MixedFit:
    """Returns mixed model of values (n,) of persons (n,) in levels (n,), with covariates (n, q), by statsmodels' REML.

    DependencyError without statsmodels.
    """
    with optional_library("statsmodels", "study"):
        from statsmodels.regression.mixed_linear_model import MixedLM, VCSpec
    present = [int(k) for k in np.unique(level) if k != level.min()]
    scale = float(values.std()) or 1.0
    dummies = (level[:, None] == np.array(present)).astype(float)
    centred = covariates - covariates.mean(axis=0)
    spread = np.maximum(centred.std(axis=0), 1e-300)
    columns = np.column_stack([np.ones(len(values)), dummies, centred / spread])
    order = np.argsort(person, kind="stable")
    people = np.unique(person)
    parts = []
    names = []
    for who in people:
        own = level[order][person[order] == who]
        cells = np.unique(own)
        parts.append((own[:, None] == cells).astype(float))
        names.append([str(cell) for cell in cells])
    levels_in_people = VCSpec(["level"], [names], [parts])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        model = MixedLM(
            (values[order] - values.mean()) / scale,
            columns[order],
            groups=person[order],
            exog_re=np.ones((len(values), 1)),
            exog_vc=levels_in_people,
        )
        fit = model.fit(reml=True, method=["powell"], ftol=1e-12)  # by default standard errors miss 1e-4
        errors = _errors(columns[order], level[order], person[order], fit)
    doubts = list(dict.fromkeys(str(w.message).partition(".")[0] for w in told))
    count = len(present)
    variances = (float(fit.cov_re[0, 0]), float(fit.vcomp[0]), float(fit.scale))
    return MixedFit(
        tuple(present),
        tuple(float(v) * scale for v in fit.fe_params[1 : 1 + count]),
        tuple((errors[1 : 1 + count] * scale).tolist()),
        (
            scale * math.sqrt(max(0.0, variances[0])),
            scale * math.sqrt(max(0.0, variances[1])),
            scale * math.sqrt(max(0.0, variances[2])),
        ),
        "; ".join(doubts),
    )


def _errors(
    columns: NDArray[np.float64], level: NDArray[np.int64], person: NDArray[np.int64], fit: Any
) -> NDArray[np.float64]:
    """Standard errors of the fixed effects by the fit's variances: statsmodels' own are 1e-3 off in unbalanced sets.

    They are those of generalised least squares; the inverse of a person's covariance is known in closed form, as it is
    a constant on the diagonal, one in each level and one over all.
    """
    of_people, of_levels, of_steps = float(fit.cov_re[0, 0]), float(fit.vcomp[0]), float(fit.scale)
    information = np.zeros((columns.shape[1],) * 2)
    for who in np.unique(person):
        own = columns[person == who]
        cells = level[person == who]
        products = own.T @ own
        along = np.zeros(own.shape[1])
        total = 0.0
        for cell in np.unique(cells):
            sums = own[cells == cell].sum(axis=0)
            count = int((cells == cell).sum())
            weight = of_levels / (of_steps + of_levels * count)
            products -= weight * np.outer(sums, sums)
            along += (1.0 - weight * count) * sums
            total += count - weight * count**2
        share = of_people / (of_steps + of_people * total)
        information += (products - share * np.outer(along, along)) / of_steps
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(information))))
