"""A run with the files that are asked for: a recording, a video, figures; all of them whole, or none."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from plantar.atomic import output_folder, parent_folder
from plantar.sim.figures.run_figure import plot_run
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import Scene

__all__ = ["run_to_files"]


def run_to_files(
    scene: Scene,
    seed: int,
    *,
    record: Path | None = None,
    video: Path | None = None,
    plot: Path | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> dict[str, Any]:
    """Run a scene, record and film it, and draw its figures.

    Args:
        scene: The scene.
        seed: Seed of what is left to chance.
        record: File of the recording, .mcap; None leaves none behind.
        video: File of the video, .mp4; None makes none.
        plot: Folder of the figures; None draws none.
        progress: Called with the fraction done and a text.

    Returns:
        The summary, with the paths of the figures under "figures" where they were drawn.

    Raises:
        SceneError: If the scene cannot be run.
        InputError: If a file or folder cannot be written.
    """
    with ExitStack() as stack:
        folder = None if plot is None else stack.enter_context(output_folder(plot))
        for file in (record, video):
            if file is not None:
                stack.enter_context(parent_folder(file))
        # The figures are drawn from a recording, whether or not somebody wants to keep it.
        kept = folder / "run.mcap" if record is None and folder is not None else record
        summary = run_scene(scene, seed, record=kept, video=video, progress=progress)
        if plot is not None and folder is not None and kept is not None:
            summary["figures"] = [str(plot / f.name) for f in plot_run(kept, folder)]
            if record is None:
                kept.unlink()
    return summary
