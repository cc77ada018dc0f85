"""Checks of all numbers of a caller."""

from . import memory

__all__ = ["are_plane_points", "pair_of", "points_within", "values_within"]


def are_plane_points(value, limit):
    """Returns whether `value` is a contiguous float64 array (k, 2) within `limit`; NaN is."""
    k = memory.rows(value, 2)
    if k < 0:
        return False
    p = memory.values(value)
    for i in range(2 * k):  # noqa: SIM110  compiled, a loop is what is quick
        if not abs(p[i]) <= limit:
            return False
    return True


def pair_of(value):
    """Two numbers of a float64 array (2,); None for anything else."""
    if memory.size(value) != 2:
        return None
    p = memory.values(value)
    return float(p[0]), float(p[1])


def points_within(points, limit):
    """Returns whether no coordinate of points (k, m) is beyond a limit; NaN is."""
    for i in range(points.shape[0]):
        for j in range(points.shape[1]):
            if not abs(points[i, j]) <= limit:
                return False
    return True


def values_within(values, limit):
    """Returns whether no value of (n,) is beyond a limit; NaN is."""
    for i in range(values.shape[0]):  # noqa: SIM110  compiled, a loop is what is quick
        if not abs(values[i]) <= limit:
            return False
    return True
