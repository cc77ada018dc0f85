"""Reliability of repeated trials, and agreement of two devices."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.gait.analysis.study.measured_table import Foot, cells_of, feet_of, level_of, measure_keys
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import NORMAL_95, student_quantile

FEWEST_PEOPLE = 3  # two leave one degree of freedom between people, and intervals without end
_TRIAL = ("trial", "session", "repetition", "visit")
"""Columns that number a participant's trials; else recordings count in their order."""


@dataclass(frozen=True)
class Reliability:
    """Reliability of a measure over k trials of n participants, in the measure's unit.

    ICC(2,1) and ICC(2,k), absolute agreement, two-way random (Shrout & Fleiss 1979, Psychol. Bull. 86:420), with 95 %
    confidence intervals (McGraw & Wong 1996, Psychol. Methods 1:30); `sem`: standard error of measurement, the root of
    the variances of trials and error together (de Vet et al. 2006, J. Clin. Epidemiol. 59:1033); `mdc95`: smallest
    change of one trial to another that 95 % of unchanged people do not show, 1.96 sqrt(2) sem.
    """

    n: int
    k: int
    mean: float
    icc_2_1: float
    icc_2_1_low: float
    icc_2_1_high: float
    icc_2_k: float
    icc_2_k_low: float
    icc_2_k_high: float
    sem: float
    mdc95: float


@dataclass(frozen=True)
class Agreement:
    """Agreement of two devices in a measure, B less A, in the measure's unit.

    `bias` with its 95 % confidence interval; limits of agreement `low` and `high` with theirs (Bland & Altman 1999,
    Stat. Methods Med. Res. 8:135; of several pairs a participant with both variances, Bland & Altman 2007, J.
    Biopharm. Stat. 17:571); `slope`: of difference over mean, with its probability of chance.
    """

    people: int
    pairs: int
    bias: float
    bias_low: float
    bias_high: float
    sd: float
    low: float
    low_error: float
    high: float
    high_error: float
    slope: float
    slope_p: float


def reliability_of(values: NDArray[np.float64]) -> Reliability:
    """Returns reliability of values (n, k) of n participants, two or more, in k trials, two or more.

    Example:
        >>> raters = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7.0]])
        >>> found = reliability_of(raters)  # the example of Shrout & Fleiss
        >>> round(found.icc_2_1, 2), round(found.icc_2_k, 2)
        (0.29, 0.62)
    """
    from scipy.special import fdtri

    n, k = values.shape
    grand = float(values.mean())
    people = k * float(((values.mean(axis=1) - grand) ** 2).sum()) / (n - 1)
    trials = n * float(((values.mean(axis=0) - grand) ** 2).sum()) / (k - 1)
    whole = float(((values - grand) ** 2).sum())
    error = max(0.0, whole - (n - 1) * people - (k - 1) * trials) / ((n - 1) * (k - 1))
    single = people + (k - 1) * error + k * (trials - error) / n
    several = people + (trials - error) / n
    icc = (people - error) / single if single > 0.0 else math.nan
    icc_k = (people - error) / several if several > 0.0 else math.nan
    low = math.nan
    high = math.nan
    if error > 0.0 and icc < 1.0:
        a = k * icc / (n * (1.0 - icc))
        b = 1.0 + k * icc * (n - 1) / (n * (1.0 - icc))
        freedom = (a * trials + b * error) ** 2 / ((a * trials) ** 2 / (k - 1) + (b * error) ** 2 / ((n - 1) * (k - 1)))
        f_low = float(fdtri(n - 1, freedom, 0.975))
        f_high = float(fdtri(freedom, n - 1, 0.975))
        rest = k * trials + (k * n - k - n) * error
        low = n * (people - f_low * error) / (f_low * rest + n * people)
        high = n * (f_high * people - error) / (rest + n * f_high * people)
    sem = math.sqrt(max(0.0, (trials - error) / n) + error)
    return Reliability(
        n,
        k,
        grand,
        icc,
        low,
        high,
        icc_k,
        low * k / (1.0 + low * (k - 1)),
        high * k / (1.0 + high * (k - 1)),
        sem,
        NORMAL_95 * math.sqrt(2.0) * sem,
    )


def agreement_of(pairs: Sequence[NDArray[np.float64]]) -> Agreement:
    """Returns agreement of pairs (m, 2) of devices A and B of each participant.

    Example:
        >>> found = agreement_of([np.array([[1.0, 1.1]]), np.array([[2.0, 2.3]]), np.array([[3.0, 3.2]])])
        >>> round(found.bias, 3), round(found.low, 3), round(found.high, 3)
        (0.2, 0.004, 0.396)
    """
    from scipy.special import stdtr

    differences = [own[:, 1] - own[:, 0] for own in pairs]
    counts = np.array([len(d) for d in differences], dtype=float)
    means = np.array([d.mean() for d in differences])
    n = len(means)
    total = counts.sum()
    bias = float((counts * means).sum() / total)
    between = float((counts * (means - bias) ** 2).sum()) / (n - 1)
    inner = sum(float(((d - d.mean()) ** 2).sum()) for d in differences)
    within = inner / (total - n) if total > n else 0.0
    usual = (total**2 - (counts**2).sum()) / ((n - 1) * total)  # pairs a participant, of unequal numbers
    variance = between if total == n else max(0.0, (between - within) / usual) + within
    sd = math.sqrt(variance)
    bias_error = math.sqrt(between / total)
    reach = student_quantile(0.975, n - 1)
    end_error = math.sqrt(bias_error**2 + NORMAL_95**2 * sd**2 / (2.0 * (n - 1)))
    x = np.array([own.mean() for own in pairs])
    spread = float(((x - x.mean()) ** 2).sum())
    slope = float(((x - x.mean()) * means).sum()) / spread if spread > 0.0 else math.nan
    p = math.nan
    if spread > 0.0 and n > 2:
        rest = means - means.mean() - slope * (x - x.mean())
        error = math.sqrt(float((rest**2).sum()) / (n - 2) / spread)
        p = 2.0 * float(stdtr(n - 2, -abs(slope) / error)) if error > 0.0 else math.nan
    return Agreement(
        n,
        int(total),
        bias,
        bias - reach * bias_error,
        bias + reach * bias_error,
        sd,
        bias - NORMAL_95 * sd,
        reach * end_error,
        bias + NORMAL_95 * sd,
        reach * end_error,
        slope,
        p,
    )


def reliabilities(results: Sequence[RecordingResult]) -> dict[str, dict[str, Reliability]]:
    """Returns reliability of each measure and region in each condition with repeated trials.

    Trials are a participant's recordings in a condition; the number of trials is what most participants have, and
    those with fewer are left out.
    """
    out: dict[str, dict[str, Reliability]] = {}
    cells = cells_of(results, "condition")
    for condition in dict.fromkeys(cell.level for cell in cells):
        own = [cell for cell in cells if cell.level == condition]
        trials = [_trials(cell.recordings) for cell in own]
        counts = [len(rows) for rows in trials]
        k = max(set(counts), key=lambda count: (counts.count(count), count))
        kept = [rows[:k] for rows in trials if len(rows) >= k]
        if k < 2 or len(kept) < FEWEST_PEOPLE:
            continue
        keys = measure_keys(own)
        tables = {key: np.array([[_mean(r, key) for r in rows] for rows in kept]) for key in keys}
        out[condition] = {key: reliability_of(v) for key, v in tables.items() if np.isfinite(v).all()}
    return out


def _trials(recordings: Sequence[RecordingResult]) -> list[RecordingResult]:
    def order(result: RecordingResult) -> tuple[float, str]:
        text = next((result.who.more[name] for name in _TRIAL if result.who.more.get(name)), "")
        return (float(text), "") if text.replace(".", "", 1).isdigit() else (math.inf, text)

    return sorted(recordings, key=order)


def _mean(result: RecordingResult, key: str) -> float:
    values = [foot[key] for foot in result.feet.values() if key in foot]
    return float(np.mean(values)) if values else math.nan


def agreements(results: Sequence[RecordingResult], column: str) -> tuple[tuple[str, str], Mapping[str, Agreement]]:
    """Returns two devices, levels of a column, and their agreement by measure.

    Pairs are recordings of one participant in one condition, in the order of trials, by A and B.
    """
    devices = list(dict.fromkeys(level_of(foot, column) for foot in feet_of(results) if level_of(foot, column)))
    if len(devices) != 2:
        names = ", ".join(devices[:8]) or "none"
        raise InputError(f"--devices {column}: it names {names}; allowed: a column that names two devices")
    groups: dict[tuple[str, str], dict[str, list[RecordingResult]]] = {}
    for result in dict.fromkeys(r for r, _ in feet_of(results)):
        level = level_of(_first(result), column)
        own = groups.setdefault((result.who.participant, result.who.condition), {})
        own.setdefault(level, []).append(result)
    people: dict[str, list[tuple[RecordingResult, RecordingResult]]] = {}
    for (who, _), own in groups.items():
        a, b = (_trials(own.get(device, [])) for device in devices)
        people.setdefault(who, []).extend(zip(a, b, strict=False))
    people = {who: rows for who, rows in people.items() if rows}
    if len(people) < FEWEST_PEOPLE:
        return (devices[0], devices[1]), {}
    out: dict[str, Agreement] = {}
    for key in measure_keys([cell for cell in cells_of(results, column) if cell.participant in people]):
        pairs = [np.array([[_mean(a, key), _mean(b, key)] for a, b in rows]) for rows in people.values()]
        if all(np.isfinite(own).all() for own in pairs):
            out[key] = agreement_of(pairs)
    return (devices[0], devices[1]), out


def _first(result: RecordingResult) -> Foot:
    return result, next(iter(result.feet))
