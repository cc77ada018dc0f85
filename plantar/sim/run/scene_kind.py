"""Scenes of either kind: a walk on plantar feedback, or an experiment of the companion; each is loaded when needed."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plantar.errors import SceneError
from plantar.files.structured_text import read_toml
from plantar.sim.run.scene import Scene, scene_file, scene_of

if TYPE_CHECKING:
    from plantar.sim.companion.experiment import CompanionScene
    from plantar.sim.loop import Run

__all__ = ["open_scene", "robot_file_of", "run", "simulation_of"]


def open_scene(
    name: str | os.PathLike[str], settings: Sequence[str] = (), robot: str | None = None
) -> Scene | CompanionScene:
    """Load a scene; one that names an experiment is the companion's.

    Args:
        name: A built-in name or the path of a scene TOML.
        settings: `key=value` settings that override the file's.
        robot: Robot or machine to use instead of the file's.

    Returns:
        The scene.

    Raises:
        SceneError: If the name is unknown or a field is not valid.

    Example:
        >>> open_scene("flat", ["steps=4"]).walk.steps
        4
    """
    path = scene_file(name)
    source = read_toml(path, SceneError, f"scene file {path}")
    if "experiment" in source:
        from plantar.sim.companion.experiment import companion_scene

        return companion_scene(source, path, settings, robot)
    return scene_of(source, path, settings, robot)


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


def simulation_of(scene: Scene | CompanionScene, seed: int) -> Run:
    """Returns the run, not begun, of a `scene` of either kind with a `seed`.

    Raises:
        SceneError: If the scene cannot be simulated.
        RobotError: If the robot is unknown or not valid.
    """
    if isinstance(scene, Scene):
        from plantar.sim.run.runner import Simulation

        return Simulation(scene, seed)
    from plantar.sim.companion.runner import Companion

    return Companion(scene, seed)


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
        seed: Of sensor noise and what the scene leaves open.
        record: Recording, .mcap, or None.
        video: Video, .mp4, or None.
        plot: Folder of the figures, or None.
        progress: Called with the fraction done and a text.

    Returns:
        The summary, as `plantar sim --json` prints it: "completed", "reasons" (each criterion that failed), "fell" and
        more, with the paths of figures under "figures".

    Raises:
        SceneError: If the scene cannot be run.
        InputError: If a file or folder cannot be written.

    Example:
        >>> run("flat", 0)["completed"]  # doctest: +SKIP
        True
    """
    if isinstance(scene, str | os.PathLike):
        scene = open_scene(scene)
    return simulation_of(scene, seed).run_to_files(record, video, plot, progress)
