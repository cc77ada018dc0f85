"""What a sweep runs: scene, grid values and seeds, checked first."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from plantar.bench.intervals import wilson_interval
from plantar.errors import InputError, SceneError
from plantar.sim.run.scene import Scene
from plantar.sim.run.scene_kind import open_scene, robot_file_of
from plantar.sim.sweep.task import criteria_of
from plantar.sim.sweep.value_range import ValueRange, canonical, is_word, split_values

if TYPE_CHECKING:
    from plantar.sim.companion.experiment import CompanionScene

Key = tuple[tuple[str, ...], int]
"""Values of the axes, and the seed."""

Run = tuple[tuple[str, ...], int]
"""Settings "name=value" of the axes, and the seed."""

Rows = Mapping[Key, Mapping[str, str]]
"""Rows of the runs that ended."""


def settings_of(point: Sequence[str]) -> dict[str, str]:
    """Values of a point's settings "name=value" by name.

    Example:
        >>> settings_of(("friction=0.7", "lean=true"))
        {'friction': '0.7', 'lean': 'true'}
    """
    return {name: value for name, _, value in (setting.partition("=") for setting in point)}


def key_of(point: Sequence[str], seed: int) -> Key:
    """Returns the key of a run of a `point` "name=value" with a `seed`.

    Example:
        >>> key_of(("friction=0.7",), 3)
        (('0.7',), 3)
    """
    return tuple(settings_of(point).values()), seed


_MOST_SEEDS = 1_000_000
_MOST_POINTS = 100_000
_LAST_SEED = 2**62


class Plan(Protocol):
    """Which runs a table has."""

    @property
    def checked(self) -> Sweep:
        """A sweep with the same axes and checked points."""

    def identity(self) -> dict[str, Any]:
        """What all rows share except file contents: JSON values by name."""

    def runs(self, rows: Rows) -> Iterator[Run | None]:
        """Runs, ordered by outcomes alone; None while more `rows` are needed."""

    def found(self, rows: Rows) -> dict[str, Any]:
        """The result of the rows."""

    def progress(self, rows: Rows) -> tuple[float, str]:
        """Progress, 0 to 1, and in words; the share of the runs in `rows`, unless a plan knows better."""
        done = [key_of(*run) in rows for run in self.runs(rows) if run is not None]
        return sum(done) / len(done), f"{sum(done)} of {len(done)} rows"


@dataclass(frozen=True)
class Sweep(Plan):
    """A grid of settings and seeds, run at all points for one seed first; points may be added.

    Attributes:
        scene: Name or file.
        grid: Values to try for each setting, as canonical texts.
        seeds: Number of seeds.
        robot: Used instead of the scene's, or None.
        settings: "key=value" of all runs.
        first_seed: First of consecutive seeds.

    Raises:
        InputError: If keys, values or points repeat.
        SceneError: If a setting is not allowed.
        RobotError: If the robot is invalid.
    """

    scene: str
    grid: tuple[tuple[str, tuple[str, ...]], ...] = ()
    seeds: int = 1
    robot: str | None = None
    settings: tuple[str, ...] = ()
    first_seed: int = 0

    def __post_init__(self) -> None:
        if not 1 <= self.seeds <= _MOST_SEEDS:
            raise InputError(f"number of seeds is {self.seeds}; allowed: 1 to {_MOST_SEEDS}")
        if not 0 <= self.first_seed <= _LAST_SEED:
            raise InputError(f"first seed is {self.first_seed}; allowed: 0 to {_LAST_SEED}")
        if prod(len(texts) for _, texts in self.grid) > _MOST_POINTS:
            raise InputError(f"the grid has more than {_MOST_POINTS} points; allowed: fewer values")
        axes = []
        for name, texts in self.grid:
            values: dict[str, str] = {}
            for text in texts:
                value = canonical(text, word=is_word(name))
                if value in values:
                    raise InputError(f"a grid gives '{name}' the same value twice: {values[value]}, {text}")
                values[value] = text
            axes.append((name, tuple(values)))
        object.__setattr__(self, "grid", tuple(axes))
        self._check_points()

    @classmethod
    def from_texts(
        cls,
        scene: str,
        grid: Sequence[str],
        seeds: int,
        robot: str | None = None,
        settings: Sequence[str] = (),
        first_seed: int = 0,
    ) -> Sweep:
        """Returns a sweep of texts `grid` "key=a,b,c" (TOML values or bare words); `scene`, `seeds`, `robot`,
        `settings` and `first_seed` as of the class; raises InputError for another form.
        """
        axes = []
        for text in grid:
            key, equals, values = text.partition("=")
            if not equals or not key.strip() or not values.strip():
                raise InputError(f"grid {text!r} is not of the form key=a,b,c")
            axes.append((key.strip(), tuple(split_values(values))))
        return cls(scene, tuple(axes), seeds, robot, tuple(settings), first_seed)

    @property
    def seed_range(self) -> range:
        """The seeds of every point."""
        return range(self.first_seed, self.first_seed + self.seeds)

    def points(self) -> list[tuple[str, ...]]:
        """Settings of every grid point."""
        return list(itertools.product(*([f"{name}={value}" for value in values] for name, values in self.grid)))

    @property
    def axes(self) -> tuple[str, ...]:
        """Settings of the grid."""
        return tuple(name for name, _ in self.grid)

    @property
    def checked(self) -> Sweep:
        return self

    def runs(self, rows: Rows) -> Iterator[Run]:
        for seed in self.seed_range:
            for point in self.points():
                yield point, seed

    def found(self, rows: Rows) -> dict[str, Any]:
        """ "points": the result of each grid point over its seeds (`point_result`)."""
        return {
            "points": [
                point_result(point, [rows[key_of(point, seed)] for seed in self.seed_range]) for point in self.points()
            ]
        }

    def with_axes(self, axes: Sequence[tuple[str, tuple[str, ...]]]) -> Sweep:
        """This sweep with more settings in its grid, after its own."""
        return replace(self, grid=(*self.grid, *axes))

    def fitted(self, wanted: ValueRange) -> ValueRange:
        """A range limited to whole numbers where the setting and ends are such.

        Raises:
            SceneError: If the setting takes no such numbers.
        """
        between = wanted.text(wanted.low + (wanted.high - wanted.low) * 0.3819)
        point = self.points()[0]
        try:
            self.opened((*point, f"{wanted.name}={between}"))
        except SceneError:
            whole = replace(wanted, whole=True)
            if wanted.unit or not wanted.low.is_integer() or not wanted.high.is_integer():
                raise
            self.opened((*point, f"{whole.name}={whole.text(wanted.low)}"))
            return whole
        return wanted

    def opened(self, point: Sequence[str]) -> Scene | CompanionScene:
        """The scene of a grid point."""
        return open_scene(self.scene, [*self.settings, *point], self.robot)

    def robot_of(self, point: Sequence[str]) -> str:
        """Name or file of the robot of a grid point."""
        return self.opened(point).robot

    def identity(self) -> dict[str, Any]:
        scene = self.opened(self.points()[0])
        settings = {}
        for key, _, value in (s.partition("=") for s in self.settings):
            name = scene.setting_name(key)
            settings[name] = canonical(value, word=is_word(name))
        return {
            "scene": Path(self.scene).name,
            "robot": None if self.robot is None else Path(self.robot).name,
            "settings": settings,
            "axes": list(self.axes),
        }

    def _check_points(self) -> None:
        files: dict[str, str] = {}
        given = [s.partition("=")[0] for s in self.settings]
        seen: dict[str, str] = {}
        for point in self.points():
            scene = self.opened(point)
            origin = dict.fromkeys((scene.setting_name(key) for key in given), "--set")
            if self.robot is not None:
                origin["robot"] = "--robot"
            for name, _ in self.grid:
                full = scene.setting_name(name)
                if full in origin:
                    raise InputError(f"grid '{name}' gives what {origin[full]} gives already: {full}; give it once")
                origin[full] = f"grid '{name}'"
            if scene.robot not in files:
                files[scene.robot] = str(robot_file_of(scene).resolve())
            whole = replace(scene, robot=files[scene.robot])
            key = repr([getattr(whole, entry.name) for entry in fields(whole)])
            text = " ".join(point)
            if key in seen:
                raise InputError(f"grid points '{seen[key]}' and '{text}' are the same run; leave one out")
            seen[key] = text


def point_result(point: Sequence[str], ran: Sequence[Mapping[str, str]]) -> dict[str, Any]:
    """Returns the result of a `point` over its rows `ran`: settings, runs, completed, 95 % Wilson interval, failures by
    criterion ("reasons"), errors.
    """
    completed = sum(row["completed"] == "True" for row in ran)
    return {
        "settings": settings_of(point),
        "runs": len(ran),
        "completed": completed,
        "interval": list(wilson_interval(completed, len(ran))),
        "reasons": dict(Counter(criterion for row in ran for criterion in criteria_of(row)).most_common()),
        "errors": [row["error"] for row in ran if row["error"]],
    }
