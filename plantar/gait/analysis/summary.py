"""Means over steps: measures, symmetry, and the walk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.measures import MEASURES, REGION_MEASURES
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.layouts.layout import Side


@dataclass(frozen=True)
class Spread:
    """Mean, standard deviation (n - 1), coefficient of variation in percent and median of n steps; or None."""

    mean: float | None
    sd: float | None
    cv_percent: float | None
    n: int
    median: float | None = None


def spread(values: Sequence[float] | NDArray[np.float64], circular: bool = False) -> Spread:
    """Returns mean, standard deviation, coefficient of variation and median of known values.

    Args:
        values: NaN where unknown.
        circular: Whether angles in degrees: mean of their unit vectors, the rest of differences from it (Fisher 1993,
            Statistical Analysis of Circular Data, ch. 2), no coefficient of variation.

    Example:
        >>> spread([1.0, 2.0, 3.0, float("nan")])
        Spread(mean=2.0, sd=1.0, cv_percent=50.0, n=3, median=2.0)
        >>> abs(round(spread([175.0, -175.0], circular=True).mean or 0.0))
        180
    """
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known)]
    n = len(known)
    if n == 0:
        return Spread(None, None, None, 0)
    if circular:
        middle = float(np.degrees(np.angle(np.exp(1j * np.radians(known)).sum())))
        away = spread((known - middle + 180.0) % 360.0 - 180.0)
        return Spread(middle, away.sd, None, n, (middle + (away.median or 0.0) + 180.0) % 360.0 - 180.0)
    mean = float(known.mean())
    if n == 1:
        return Spread(mean, None, None, 1, mean)
    sd = float(known.std(ddof=1))
    return Spread(mean, sd, 100.0 * sd / abs(mean) if mean != 0.0 else None, n, float(np.median(known)))


# Values below which two feet differ by noise alone, by the unit at a key's end: no symmetry index is formed.
_RESOLVED = {"s": 2e-3, "percent": 0.2, "m": 5e-4, "m2": 5e-6, "N": 1.0, "Nm": 0.05, "Ns": 0.5, "Pa": 5e2, "Pas": 1e2}


_OF_BOTH = ("double_support_percent", "single_support_percent", "step_length_m", "step_width_m", "stride_length_m")


def summary_of_foot(gait: FootGait) -> dict[str, Spread]:
    """Each measure of a foot over used steps."""
    return {name: spread(gait.columns.get(name, ()), name.endswith("_deg")) for name in MEASURES}


def regions_of_foot(gait: FootGait) -> dict[str, dict[str, Spread]]:
    """Each measure of each region over used steps; missing regions left out."""
    out: dict[str, dict[str, Spread]] = {}
    for region, _ in gait.masks.names:
        rows = [step.regions[region] for step in gait.used if region in step.regions]
        if rows:
            out[region] = {name: spread([row.get(name, np.nan) for row in rows]) for name in REGION_MEASURES}
    return out


def gait_of_feet(feet: Mapping[Side, FootGait]) -> dict[str, float | int | None]:
    """Measures of the whole walk; None if not shown.

    landings are heel strikes of all feet, stride_time_s is of all complete steps (of several activities of the used
    ones); others are of used steps.
    """
    several = len({step.activity for gait in feet.values() for step in gait.steps if step.activity}) > 1
    steps = [s for gait in feet.values() for s in gait.steps if s.used or not several]
    stride = spread([step["stride_time_s"] for step in steps]).mean
    steady = _mean(feet, "stride_time_s")
    return {
        "landings": sum(len(gait.heel_strikes) for gait in feet.values()),
        "stride_time_s": stride,
        "cadence_steps_per_min": None if stride is None else 120.0 / stride,
        "steady_cadence_steps_per_min": None if steady is None else 120.0 / steady,
        **{key: _mean(feet, key) for key in _OF_BOTH},
        **({} if _of_one_way(feet) else {"step_length_m": None}),
        "walking_speed_m_s": _mean(feet, "stride_velocity_m_s"),
    }


def _of_one_way(feet: Mapping[Side, FootGait]) -> bool:
    """Whether both feet step ahead of the other one: sideways one leads, and a mean of both is half of a stride."""
    means = [spread(gait.columns.get("step_length_m", ())).mean for gait in feet.values()]
    known = [mean for mean in means if mean is not None]
    return min(known, default=0.0) >= 0.0 or max(known, default=0.0) <= 0.0


def _mean(feet: Mapping[Side, FootGait], key: str) -> float | None:
    return spread([value for gait in feet.values() for value in gait.columns.get(key, ())]).mean


def symmetry(feet: Mapping[Side, FootGait]) -> dict[str, float | None]:
    """Symmetry index in percent of each measure of two feet, 100 (L - R) / ((L + R) / 2) (Robinson 1987).

    Left larger is positive; None for missing values, differing signs, unresolved ones and angles.
    """
    if "left" not in feet or "right" not in feet:
        return dict.fromkeys(MEASURES)
    left = summary_of_foot(feet["left"])
    right = summary_of_foot(feet["right"])
    out: dict[str, float | None] = {}
    for name in MEASURES:
        a = left[name].mean
        b = right[name].mean
        out[name] = None
        small = max(abs(a or 0.0), abs(b or 0.0)) < _RESOLVED.get(name.rpartition("_")[2], 0.0)
        angle = name.endswith("_deg")
        if a is not None and b is not None and a * b >= 0.0 and a + b != 0.0 and not small and not angle:
            out[name] = 200.0 * (a - b) / (a + b)
    return out
