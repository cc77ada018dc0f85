"""Scenes of either kind: a walk on plantar feedback, or an experiment of the companion.

What only one kind needs is loaded where there is one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plantar.errors import SceneError
from plantar.files.structured_text import read_toml
from plantar.sim.run.scene import Scene, scene_file, scene_of, setting_name

if TYPE_CHECKING:
    from plantar.sim.companion.scene import CompanionScene

__all__ = [
    "full_setting_name",
    "open_scene",
    "robot_file_of",
    "run",
    "run_opened",
    "summary_text",
]


def open_scene(
    name: str | os.PathLike[str], settings: Sequence[str] = (), robot: str | None = None
) -> Scene | CompanionScene:
    """Load a scene by its built-in name or from a TOML file; one that names an experiment is the companion's.

    Args:
        name: A built-in name or the path of a scene TOML.
        settings: `key=value` settings that override the file's.
        robot: Robot or machine to use instead of the file's.

    Returns:
        The scene.

    Raises:
        SceneError: If the name is unknown or a field is not valid; the message names it.

    Example:
        >>> open_scene("flat", ["steps=4"]).walk.steps
        4
    """
    path = scene_file(name)
    source = read_toml(path, SceneError, f"scene file {path}")
    if "experiment" in source:
        from plantar.sim.companion.scene import companion_scene

        return companion_scene(source, path, settings, robot)
    return scene_of(source, path, settings, robot)


def full_setting_name(scene: Scene | CompanionScene, key: str) -> str:
    """Full name of a setting's key in a scene.

    Args:
        scene: The scene.
        key: Any name that the setting is given by.

    Returns:
        "table.name", or "robot".

    Raises:
        SceneError: If the scene has no such key.
    """
    if isinstance(scene, Scene):
        return setting_name(scene, key)
    from plantar.sim.companion.scene import companion_setting_name

    return companion_setting_name(scene, key)


def robot_file_of(scene: Scene | CompanionScene) -> Path:
    """The TOML of a scene's robot or machine.

    Raises:
        RobotError: If it is unknown, or not valid.
    """
    if isinstance(scene, Scene):
        from plantar.robots import load_robot

        return load_robot(scene.robot).path
    from plantar.sim.companion.machine import load_machine

    return load_machine(scene.robot).path


def run_opened(scene: Scene | CompanionScene, seed: int) -> dict[str, Any]:
    """Run a scene of either kind.

    Args:
        scene: The scene.
        seed: Seed of what is left to chance.

    Returns:
        The summary.
    """
    if isinstance(scene, Scene):
        from plantar.sim.run.runner import run_scene

        return run_scene(scene, seed)
    from plantar.sim.companion.runner import run_companion

    return run_companion(scene, seed)


def run(
    scene: Scene | CompanionScene | str | os.PathLike[str],
    seed: int = 0,
    *,
    record: Path | None = None,
    video: Path | None = None,
    plot: Path | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> dict[str, Any]:
    """Simulate a scene, judge the run by the true contact forces, and write the files that are asked for.

    Args:
        scene: The scene, its built-in name or the path of its TOML file.
        seed: Seed of what is left to chance.
        record: File of the recording, .mcap; None leaves none behind.
        video: File of the video, .mp4; None makes none.
        plot: Folder of the figures; None draws none.
        progress: Called with the fraction done and a text.

    Returns:
        The summary, as `plantar sim --json` prints it: "completed", "reasons" (each criterion that failed), "fell" and
        more, with the paths of figures under "figures".

    Raises:
        SceneError: If the scene cannot be run.
        InputError: If a file or folder cannot be written, or the scene cannot be recorded.

    Example:
        >>> run("flat", 0)["completed"]  # doctest: +SKIP
        True
    """
    if isinstance(scene, str | os.PathLike):
        scene = open_scene(scene)
    if isinstance(scene, Scene):
        from plantar.sim.run.run_files import run_to_files

        return run_to_files(scene, seed, record=record, video=video, plot=plot, progress=progress)
    from plantar.sim.companion.runner import run_companion_to_files

    return run_companion_to_files(scene, seed, record=record, video=video, plot=plot, progress=progress)


def summary_text(summary: dict[str, Any]) -> str:
    """A run's summary for people."""
    if "steps_planned" in summary:
        from plantar.sim.run.run_text import run_text

        return run_text(summary)
    from plantar.sim.companion.companion_text import companion_text

    return companion_text(summary)
