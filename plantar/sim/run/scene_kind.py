"""Scenes of a walk or a companion experiment, each loaded when needed."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plantar.common.arguments import integer
from plantar.common.files.structured_text import read_toml
from plantar.common.optional_library import missing_libraries
from plantar.errors import InputError, SceneError
from plantar.sim.run.scene import Scene, scene_file, scene_of

if TYPE_CHECKING:
    from plantar.sim.companion.experiment import CompanionScene
    from plantar.sim.loop import Run


@missing_libraries("sim")
def open_scene(
    name: str | os.PathLike[str], settings: Sequence[str] = (), robot: str | None = None
) -> Scene | CompanionScene:
    """Returns a scene, of a walk or an experiment, by built-in name or TOML path.

    `key=value` `settings` and `robot`, or machine, replace the file's. A SceneError if name or field is invalid.

    Example:
        >>> import plantar
        >>> plantar.load_scene("flat", ["steps=4"]).walk.steps
        4
    """
    path = scene_file(name)
    source = read_toml(path, SceneError, f"scene file {path}")
    if "experiment" in source:
        from plantar.sim.companion.experiment import companion_scene

        return companion_scene(source, path, settings, robot)
    return scene_of(source, path, settings, robot)


def robot_file_of(scene: Scene | CompanionScene) -> Path:
    """The TOML of a scene's robot or machine."""
    if isinstance(scene, Scene):
        from plantar.robots import load_robot

        return load_robot(scene.robot).path
    from plantar.sim.companion.machine import load_machine

    return load_machine(scene.robot).path


def simulation_of(scene: Scene | CompanionScene, seed: int) -> Run:
    """Returns the run, not begun, of a `scene` with a `seed`."""
    if isinstance(scene, Scene):
        from plantar.sim.run.runner import Simulation

        return Simulation(scene, seed)
    from plantar.sim.companion.runner import Companion

    return Companion(scene, seed)


@missing_libraries("sim")
def run(
    scene: Scene | CompanionScene | str | os.PathLike[str],
    seed: int = 0,
    *,
    record: str | os.PathLike[str] | None = None,
    video: str | os.PathLike[str] | None = None,
    plot: str | os.PathLike[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
    robot: str | None = None,
    **settings: object,
) -> dict[str, Any]:
    """Simulate a scene, judge it by true contact forces, and write files.

    Args:
        scene: Scene, built-in name or TOML path.
        seed: Of noise and open choices.
        record: Recording, .mcap, or None.
        video: Video, .mp4, or None.
        plot: Figure folder, or None.
        progress: Called with fraction and text.
        robot: Robot or machine instead of the scene's.
        settings: Values of the scene, as `--set` takes them: `steps=3`, `footholds="off"`, `**{"push.dv": 0.2}`.

    Returns:
        The summary, as `plantar sim --json` prints it: "completed", "reasons" (failed criteria), "fell" and more,
        figure paths under "figures".

    Raises:
        SceneError: If it cannot run.
        InputError: If a file cannot be written, or settings are given with a scene that is loaded already.

    Example:
        >>> import plantar
        >>> plantar.run("flat", steps=3)["completed"]  # doctest: +SKIP
        True
    """
    for what, file, ending in (("record", record, ".mcap"), ("video", video, ".mp4")):
        if file is not None and Path(file).suffix != ending:
            raise InputError(f"{what} {os.fspath(file)} needs a name that ends in {ending}")
    if hasattr(scene, "robot") and (settings or robot is not None):
        raise InputError(
            "settings are given with a loaded scene; allowed: load_scene(name, settings), or run(name, ...)"
        )
    texts = [f"{name}={_setting_text(value)}" for name, value in settings.items()]
    found: Any = scene if hasattr(scene, "robot") else open_scene(scene, texts, robot)
    recording, film, figures = (None if path is None else Path(path) for path in (record, video, plot))
    return simulation_of(found, integer(seed, "seed", 0)).run_to_files(recording, film, figures, progress)


def _setting_text(value: object) -> str:
    """Value of a setting as `--set` takes it."""
    return str(value).lower() if isinstance(value, bool) else str(value)
