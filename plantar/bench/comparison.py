"""Routes to one result: interleaved times of a call, and error."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

_ONE_MEASUREMENT = 1.5e-3  # Least time in s of one measurement: a call that is shorter is repeated


class Time(NamedTuple):
    """Time of one call.

    `median`: median over the rounds in s; `spread`: interquartile range over the rounds, as a share of the median.
    """

    median: float
    spread: float


def time_routes(
    routes: Mapping[str, Callable[[Any], object]],
    cases: Mapping[str, Sequence[Any]],
    rounds: int = 9,
    most: float = 1.0,
) -> dict[str, Time]:
    """Returns the mean time of a call of each of `routes`, functions of a case by name, on its `cases`, in the same
    order, interleaved.

    Over `rounds` of median; a route that takes more than `most` s in all gets fewer, 2 or more.

    Example:
        >>> times = time_routes({"sum": sum, "max": max}, {"sum": [[1, 2]], "max": [[1, 2]]}, rounds=3)
        >>> sorted(times), 0.0 < times["sum"].median < 1e-3
        (['max', 'sum'], True)
    """
    repeats = {}
    limits = {}
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


class Route(NamedTuple):
    """One way to a result.

    `call`: what is timed: a function of one case; `value`: what is compared, from what `call` returns; not timed;
    `approximate`: whether the route is one by nature, not by rounding.
    """

    name: str
    call: Callable[[Any], object]
    cases: Sequence[Any] = ()
    value: Callable[[Any], ArrayLike] = lambda result: result
    ours: bool = False
    approximate: bool = False


class Reference(NamedTuple):
    """Right results for each case, and an error's unit.

    `scales`: size by which an error is divided; the reference's largest component where None.
    """

    values: Sequence[ArrayLike]
    scales: Sequence[float] | None = None


@dataclass(frozen=True)
class Result:
    """Time and error of one route.

    `size`: active taxels, or another size; `spread`: interquartile range of rounds over median; `ratio`: its time over
    our first route's; `error`: largest relative error over cases, or None.
    """

    kernel: str
    size: str
    route: str
    ours: bool
    approximate: bool
    median_us: float
    spread: float
    ratio: float
    error: float | None


def compare(
    kernel: str,
    size: str,
    routes: Sequence[Route],
    reference: Reference | None,
    rounds: int = 9,
    most: float = 0.5,
) -> list[Result]:
    """Returns a result a route, in order, timed interleaved and compared with the `reference`, right results or None.

    `kernel` is what is computed, `size` its size; `routes` have ours first. Over `rounds` of median, up to `most` s a
    route; error 1 if it raises.

    Example:
        >>> routes = [Route("builtin", sum, [[1.0, 2.0]], ours=True), Route("first", min, [[1.0, 2.0]])]
        >>> [r.error for r in compare("sum", "2", routes, Reference([3.0]), rounds=3)]
        [0.0, 0.6666666666666666]
    """
    errors = {r.name: _error(r, reference) for r in routes}
    calls = {r.name: r.call if _runs(r) else _shielded(r.call) for r in routes}
    times = time_routes(calls, {r.name: r.cases for r in routes}, rounds, most)
    base = times[routes[0].name].median
    return [
        Result(
            kernel,
            size,
            r.name,
            r.ours,
            r.approximate,
            1e6 * times[r.name].median,
            times[r.name].spread,
            times[r.name].median / base,
            errors[r.name],
        )
        for r in routes
    ]


def _runs(route: Route) -> bool:
    try:
        for case in route.cases:
            route.call(case)
    except Exception:
        return False
    return True


def _shielded(call: Callable[[Any], object]) -> Callable[[Any], object]:
    def run(case: Any) -> object:
        try:
            return call(case)
        except Exception:
            return None

    return run


def _error(route: Route, reference: Reference | None) -> float | None:
    if reference is None:
        return None
    worst = 0.0
    for i, (case, right) in enumerate(zip(route.cases, reference.values, strict=True)):
        wanted = np.asarray(right, dtype=float)
        scale = float(np.abs(wanted).max()) if reference.scales is None else reference.scales[i]
        try:
            got = np.asarray(route.value(route.call(case)), dtype=float)
            error = float(np.abs(got - wanted).max()) / scale if got.shape == wanted.shape else 1.0
        except Exception:
            error = 1.0
        worst = max(worst, error if np.isfinite(error) else 1.0)
    return worst
