"""Kernels that look at every number that a caller hands over."""

from __future__ import annotations

__all__ = ["points_within", "values_within"]


def points_within(points, limit):
    """Whether no coordinate is beyond a limit; NaN is.

    Args:
        points: Points (k, m).
        limit: Largest absolute value.

    Returns:
        False where one is NaN, inf or larger.
    """
    for i in range(points.shape[0]):
        for j in range(points.shape[1]):
            if not abs(points[i, j]) <= limit:
                return False
    return True


def values_within(values, limit):
    """Whether no value is beyond a limit; NaN is.

    Args:
        values: Values (n,).
        limit: Largest absolute value.

    Returns:
        False where one is NaN, inf or larger.
    """
    for i in range(values.shape[0]):  # noqa: SIM110  compiled, a loop is what is quick
        if not abs(values[i]) <= limit:
            return False
    return True
