"""Mean and spread of a measure over steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Spread", "spread"]


@dataclass(frozen=True)
class Spread:
    """Mean, standard deviation (n - 1), coefficient of variation in percent and median of n steps; or None."""

    mean: float | None
    sd: float | None
    cv_percent: float | None
    n: int
    median: float | None = None


def spread(values: Sequence[float] | NDArray[np.float64], circular: bool = False) -> Spread:
    """Returns mean, standard deviation, coefficient of variation and median of the known values.

    Args:
        values: The values, NaN where one is not known.
        circular: Whether they are angles in degrees: the mean is that of their unit vectors, the rest of their
            differences from it (Fisher 1993, Statistical Analysis of Circular Data, ch. 2), without a coefficient of
            variation.

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
