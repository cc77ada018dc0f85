"""What a sweep runs: a scene, the values of its grid, and seeds; all of it checked before the first run."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plantar.errors import InputError
from sim.run.scene import Scene
from sim.run.scene_kind import full_setting_name, open_scene, robot_file_of
from sim.sweep.grid import canonical, is_word, split_values

if TYPE_CHECKING:
    from sim.companion.scene import CompanionScene

__all__ = ["Sweep"]


@dataclass(frozen=True)
class Sweep:
    """What a sweep runs.

    Attributes:
        scene: Name or file of the scene.
        grid: For each setting the values to try, as texts; kept in their canonical form.
        seeds: Number of seeds.
        robot: Robot to use instead of the scene's, or None.
        settings: "key=value" settings that hold for all runs.
        first_seed: The first of the seeds, which follow one another.

    Raises:
        InputError: If a key or value comes twice, however it is written, or two points are the same scene.
        SceneError: If a setting is unknown or not allowed.
        RobotError: If the robot is unknown or its file not valid.
    """

    scene: str
    grid: tuple[tuple[str, tuple[str, ...]], ...] = ()
    seeds: int = 1
    robot: str | None = None
    settings: tuple[str, ...] = ()
    first_seed: int = 0

    def __post_init__(self) -> None:
        if self.seeds < 1:
            raise InputError(f"number of seeds is {self.seeds}; allowed: 1 or more")
        if self.first_seed < 0:
            raise InputError(f"first seed is {self.first_seed}; allowed: 0 or more")
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
        """A sweep from the command line's texts.

        Args:
            scene: Name or file of the scene.
            grid: Texts of the form "key=a,b,c"; values are TOML, bare words texts, as in "size=[1, 2],[3, 4]".
            seeds: Number of seeds.
            robot: Robot to use instead of the scene's.
            settings: Texts of the form "key=value" that hold for all runs.
            first_seed: The first of the seeds.

        Returns:
            The checked sweep.

        Raises:
            InputError: If a grid text is not of that form, or what it names comes twice.
            SceneError: If a setting is unknown or not allowed.
            RobotError: If the robot is unknown or its file not valid.
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
        axes = [[f"{name}={value}" for value in values] for name, values in self.grid]
        return list(itertools.product(*axes))

    def tasks(self) -> Iterator[tuple[tuple[str, ...], int]]:
        """Settings and seed of every run: all points for one seed before the next, so that a part shows the whole."""
        for seed in self.seed_range:
            for point in self.points():
                yield point, seed

    def opened(self, point: Sequence[str]) -> Scene | CompanionScene:
        """The scene of a grid point."""
        return open_scene(self.scene, [*self.settings, *point], self.robot)

    def robot_of(self, point: Sequence[str]) -> str:
        """Name or file of the robot of a grid point."""
        return self.opened(point).robot

    def identity(self) -> dict[str, Any]:
        """What all rows of one table must share, beside the content of files: JSON values by name.

        Points and seeds may be added to a table; other scenes, settings or axes may not.
        """
        scene = self.opened(self.points()[0])
        settings = {}
        for key, _, value in (s.partition("=") for s in self.settings):
            name = full_setting_name(scene, key)
            settings[name] = canonical(value, word=is_word(name))
        return {
            "scene": Path(self.scene).name,
            "robot": None if self.robot is None else Path(self.robot).name,
            "settings": settings,
            "axes": [name for name, _ in self.grid],
        }

    def _check_points(self) -> None:
        """Load every point's scene and robot, and refuse what is given twice under two names."""
        files: dict[str, str] = {}
        given = [s.partition("=")[0] for s in self.settings]
        seen: dict[str, str] = {}
        for point in self.points():
            scene = self.opened(point)
            origin = dict.fromkeys((full_setting_name(scene, key) for key in given), "--set")
            if self.robot is not None:
                origin["robot"] = "--robot"
            for name, _ in self.grid:
                full = full_setting_name(scene, name)
                if full in origin:
                    raise InputError(f"grid '{name}' gives what {origin[full]} gives already: {full}; give it once")
                origin[full] = f"grid '{name}'"
            if scene.robot not in files:
                files[scene.robot] = str(robot_file_of(scene).resolve())
            key = repr(replace(scene, robot=files[scene.robot]))
            text = " ".join(point)
            if key in seen:
                raise InputError(f"grid points '{seen[key]}' and '{text}' are the same run; leave one out")
            seen[key] = text
