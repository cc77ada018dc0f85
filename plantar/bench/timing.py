"""Timing of interleaved routes to one result, so that a machine that changes speed changes all of them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

__all__ = ["Time", "time_routes"]

_ONE_MEASUREMENT = 1.5e-3
"""Least time in s of one measurement: a call that is shorter is repeated."""


class Time(NamedTuple):
    """Time of one call."""

    median: float
    """Median over the rounds in s."""
    spread: float
    """Interquartile range over the rounds, as a share of the median."""


def time_routes(
    routes: Mapping[str, Callable[[Any], object]],
    cases: Mapping[str, Sequence[Any]],
    rounds: int = 9,
    most: float = 1.0,
) -> dict[str, Time]:
    """Time each route on its cases, a case a call, the routes interleaved.

    Args:
        routes: Each route's name and function of a case.
        cases: Each route's cases, in the same order.
        rounds: Rounds to take the median over.
        most: Time in s to spend on a route; a slow one gets fewer rounds, 2 or more.

    Returns:
        Mean time of one call of each route.

    Example:
        >>> times = time_routes({"sum": sum, "max": max}, {"sum": [[1, 2]], "max": [[1, 2]]}, rounds=3)
        >>> sorted(times), 0.0 < times["sum"].median < 1e-3
        (['max', 'sum'], True)
    """
    repeats, limits = {}, {}
    for name, route in routes.items():
        once = min(_seconds(route, cases[name], 1) for _ in range(2))
        repeats[name] = max(1, min(1000, round(_ONE_MEASUREMENT / max(once, 1e-9))))
        limits[name] = max(2, min(rounds, int(most / max(repeats[name] * once, 1e-9))))
    taken: dict[str, list[float]] = {name: [] for name in routes}
    for turn in range(rounds):
        for name, route in routes.items():
            if turn < limits[name]:
                spent = _seconds(route, cases[name], repeats[name])
                taken[name].append(spent / repeats[name] / len(cases[name]))
    out = {}
    for name, values in taken.items():
        low, middle, high = np.percentile(values, (25, 50, 75)).tolist()
        out[name] = Time(middle, (high - low) / middle)
    return out


def _seconds(route: Callable[[Any], object], cases: Sequence[Any], repeats: int) -> float:
    start = time.perf_counter()
    for _ in range(repeats):
        for case in cases:
            route(case)
    return time.perf_counter() - start
