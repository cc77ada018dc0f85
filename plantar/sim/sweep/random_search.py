"""Runs at random points of settings' ranges, one seed a point."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from plantar.errors import InputError
from plantar.sim.sweep.plan import Plan, Rows, Run, Sweep, key_of, point_result
from plantar.sim.sweep.value_range import ValueRange


@dataclass(frozen=True)
class RandomSearch(Plan):
    """Runs at random points, the same at every grid point.

    `sweep`: scene, grid, and seeds: one point a seed; `ranges`: settings drawn uniformly from their ranges.
    """

    sweep: Sweep
    ranges: tuple[ValueRange, ...]

    def __post_init__(self) -> None:
        if not self.ranges:
            raise InputError("no setting is drawn at random; allowed: one or more")
        object.__setattr__(self, "ranges", tuple(self.sweep.fitted(wanted) for wanted in self.ranges))
        _ = self.checked

    @cached_property
    def checked(self) -> Sweep:
        """The checked sweep of the ends of all ranges."""
        return self.sweep.with_axes([(r.name, (r.text(r.low), r.text(r.high))) for r in self.ranges])

    def identity(self) -> dict[str, Any]:
        return self.checked.identity() | {"random": {r.name: [r.text(r.low), r.text(r.high)] for r in self.ranges}}

    def runs(self, rows: Rows) -> Iterator[Run]:
        for seed in self.sweep.seed_range:
            share = np.random.default_rng(seed).random(len(self.ranges))
            drawn = [
                f"{r.name}={r.text(r.low + s * (r.high - r.low))}" for r, s in zip(self.ranges, share, strict=True)
            ]
            for point in self.sweep.points():
                yield (*point, *drawn), seed

    def found(self, rows: Rows) -> dict[str, Any]:
        """ "points": the result of each grid point over the ended rows (`point_result`)."""
        ran_at: dict[tuple[str, ...], list[Any]] = {point: [] for point in self.sweep.points()}
        for point, seed in self.runs(rows):
            if (row := rows.get(key_of(point, seed))) is not None:
                ran_at[point[: len(self.sweep.grid)]].append(row)
        return {"points": [point_result(point, ran) for point, ran in ran_at.items()]}
