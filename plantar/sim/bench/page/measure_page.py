"""The end of `plantar bench all`: scenes, the papers' experiments, and the page."""

from __future__ import annotations

import platform
import shutil
import time
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from plantar.atomic import write_text
from plantar.sim.bench.page.bench_page import bench_page
from plantar.sim.bench.page.paper_figures import measure_papers
from plantar.sim.bench.scenes.scene_runs import TABLE
from plantar.sim.bench.scenes.scenes_report import measure_scenes

__all__ = ["measure_page"]

_FIGURES = {"kernels": "kernels.png", "contact": "contact_models.png", "scenes": "scenes.png"}

Progress = Callable[[float, str], None]


def measure_page(
    folder: Path, before: Path, progress: tuple[Progress, Progress], result: Mapping[str, Any], quick: bool
) -> dict[str, Any]:
    """Measure scenes and papers, and write bench.html.

    Args:
        folder: Existing folder.
        before: Folder of an earlier run, whose table of scene runs is continued.
        progress: Called with the fraction done and a text: for scenes, and for papers.
        result: Results of the other parts, by name.
        quick: Leave out the long experiments.

    Returns:
        "scenes", "papers" and "made", each with the names of its files.
    """
    if (before / TABLE).is_file():
        shutil.copy(before / TABLE, folder / TABLE)
    added: dict[str, Any] = {
        "scenes": measure_scenes(folder, progress[0], quick=True),
        "papers": measure_papers(progress[1], quick=quick),
        "made": {"version": _version(), "date": time.strftime("%Y-%m-%d"), "machine": _machine(), "quick": quick},
    }
    drawn = {part: folder / name for part, name in _FIGURES.items() if (folder / name).is_file()}
    figures = {part: path.read_bytes() for part, path in drawn.items()}
    write_text(folder / "bench.html", bench_page({**result, **added}, figures))
    added["made"]["files"] = ["bench.html"]
    return added


def _version() -> str:
    try:
        return f"Plantar {version('plantar')}"
    except PackageNotFoundError:  # run from a folder that was not installed
        return "Plantar"


def _machine() -> str:
    return f"{platform.system()} on {platform.machine()}, Python {platform.python_version()}"
