"""Search the limit of one setting with the most informative runs."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from plantar.errors import InputError
from plantar.sim.sweep.limit_curve import LimitCurve, limit_curve
from plantar.sim.sweep.plan import Key, Plan, Rows, Run, Sweep, key_of, settings_of
from plantar.sim.sweep.value_range import ValueRange

AHEAD = 8
"""A run is chosen by all outcomes but the newest of these, so that as many workers are at work. It is the same number
everywhere: the runs of a search do not depend on who ran them."""

_ENDS = 4  # runs at each end of the range before any between
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0  # its multiples fill (0, 1) evenly, any a seed's remainder chooses
_TURNING = 0.15  # part of the way from all to none, at either side, that is left out: runs there show little
_SURE = 0.95


@dataclass(frozen=True)
class LimitSearch(Plan):
    """The setting's value with half of the runs completed, at each grid point.

    `sweep`: scene, grid and, as "seeds", the most runs at each point; every run has its own seed; `within`: width of
    the limit's 95 % interval, as a share of limit, that ends the search.
    """

    sweep: Sweep
    limit: ValueRange
    within: float = 0.1

    def __post_init__(self) -> None:
        if not 0.0 < self.within < 1.0:
            raise InputError(f"a limit is to be known within {self.within:g}; allowed: above 0 and below 1")
        if self.sweep.seeds < 2 * _ENDS:
            raise InputError(f"number of seeds is {self.sweep.seeds}; allowed for a limit: {2 * _ENDS} or more")
        object.__setattr__(self, "limit", self.sweep.fitted(self.limit))
        _ = self.checked

    @cached_property
    def checked(self) -> Sweep:
        """The checked sweep of both range ends."""
        ends = (self.limit.text(self.limit.low), self.limit.text(self.limit.high))
        return self.sweep.with_axes([(self.limit.name, ends)])

    def identity(self) -> dict[str, Any]:
        ends = [self.limit.text(self.limit.low), self.limit.text(self.limit.high)]
        return self.checked.identity() | {"limit": ends, "first_seed": self.sweep.first_seed}

    def runs(self, rows: Rows) -> Iterator[Run | None]:
        chains = [self._chain(point, rows) for point in self.sweep.points()]
        while chains:
            waiting = True
            for chain in list(chains):
                run = next(chain, "end")
                if run == "end":
                    chains.remove(chain)
                    waiting = False
                elif run is not None:
                    waiting = False
                    yield run  # type: ignore[misc]
            if waiting and chains:
                yield None

    def found(self, rows: Rows) -> dict[str, Any]:
        """ "limits": for each grid point its settings, the searched setting ("setting", "unit", "range"), its "limit",
        the 95 % "interval" and its "width" as a share of the limit (None outside of the range), whether it is known
        well enough ("reached"), whether larger values hold ("rising"), one curve's fit ("agreement"), runs, completed,
        and errors.
        """
        return {"limits": [self._found(point, rows) for point in self.sweep.points()]}

    def progress(self, rows: Rows) -> tuple[float, str]:
        widths = [_width(self.curve(self.tried(point, rows), rows)) for point in self.sweep.points()]
        widest = max(widths)
        words = f"{100.0 * widest:.0f} %" if widest < 10.0 else "its range"
        return min(1.0, (self.within / widest) ** 2), f"{len(rows)} rows (limit known within {words})"

    def tried(self, point: Sequence[str], rows: Rows) -> list[Key]:
        """Returns keys of a grid `point`'s runs in `rows`, by seed."""
        values = tuple(settings_of(point).values())
        return sorted((key for key in rows if key[0][:-1] == values), key=lambda key: key[1])

    def curve(self, keys: Sequence[Key], rows: Rows) -> LimitCurve:
        """Returns the curve of the runs `keys` in `rows`, without impossible ones."""
        return limit_curve(*self._outcomes(keys, rows), self.limit.low, self.limit.high)

    def _outcomes(self, keys: Sequence[Key], rows: Rows) -> tuple[list[float], list[bool]]:
        ran = [key for key in keys if not rows[key]["error"]]
        return [self.limit.value(key[0][-1]) for key in ran], [rows[key]["completed"] == "True" for key in ran]

    def _chain(self, point: Sequence[str], rows: Rows) -> Iterator[Run | None]:
        keys: list[Key] = []
        for number, seed in enumerate(self.sweep.seed_range):
            if number < 2 * _ENDS:
                value = self.limit.low if number % 2 == 0 else self.limit.high
            else:
                known = number - AHEAD + 1
                while any(key not in rows for key in keys[:known]):
                    yield None
                curve = self.curve(keys[:known], rows)
                if self._enough(curve):
                    while any(key not in rows for key in keys):
                        yield None
                    curve = self.curve(keys, rows)
                    if self._enough(curve):
                        return
                # All over the curve's flank: runs at the limit alone do not show how steep the curve is.
                part = _TURNING + (1.0 - 2.0 * _TURNING) * (number * _GOLDEN % 1.0)
                value = curve.turned(part, self.limit.low, self.limit.high)
            run = (*point, f"{self.limit.name}={self.limit.text(value)}"), seed
            keys.append(key_of(*run))
            yield run
        while any(key not in rows for key in keys):
            yield None

    def _enough(self, curve: LimitCurve) -> bool:
        inside = curve.inside(self.limit.low, self.limit.high)
        return inside < 1.0 - _SURE or (inside > _SURE and _width(curve) <= self.within)

    def _found(self, point: Sequence[str], rows: Rows) -> dict[str, Any]:
        keys = self.tried(point, rows)
        curve = self.curve(keys, rows)
        inside = curve.inside(self.limit.low, self.limit.high)
        there = inside > 1.0 - _SURE and any(not rows[key]["error"] for key in keys)
        ran = [rows[key] for key in keys]
        return {
            "settings": settings_of(point),
            "setting": self.limit.name,
            "unit": self.limit.unit,
            "range": [self.limit.low, self.limit.high],
            "limit": curve.limit if there else None,
            "interval": list(curve.interval_of_search) if there else None,
            "width": _width(curve) if there else None,
            "reached": inside > _SURE and _width(curve) <= self.within,
            "rising": curve.rising,
            "agreement": curve.agreement(*self._outcomes(keys, rows)),
            "runs": len(ran),
            "completed": sum(row["completed"] == "True" for row in ran),
            "errors": [row["error"] for row in ran if row["error"]],
        }


def _width(curve: LimitCurve) -> float:
    low, high = curve.interval_of_search
    return (high - low) / max(abs(curve.limit), 1e-12 * (high - low))
