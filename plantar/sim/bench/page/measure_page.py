"""The end of `plantar bench all`: scenes, papers' experiments, and page."""

import platform
import shutil
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.common.atomic import write_text
from plantar.common.console.progress import Progress
from plantar.common.version import VERSION
from plantar.sim.bench.page.bench_page import bench_page
from plantar.sim.bench.scenes.scene_runs import TABLE
from plantar.sim.bench.scenes.scenes_report import measure_scenes
from plantar.sim.papers.experiments import EXPERIMENTS, figure_of
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

_SEED = 1000  # a fresh one: nothing was ever tuned on it


def measure_papers(progress: Progress, quick: bool = False) -> dict[str, Any]:
    """Run the experiments with printed figures, without long ones if `quick`; `progress` gets fraction and text.

    Returns "experiments": each with the paper's figures and source, ours by the same names, and whether each robot
    fell; plain JSON values. "files": none.
    """
    kept = [
        (e, e.settings + ablation, printed, fell)
        for e in EXPERIMENTS
        if not (quick and e.long)
        for ablation, printed, fell in (((), e.printed, False), (e.without, e.printed_without, e.fell_without))
        if printed
    ]
    found = []
    for number, (one, settings, printed, fell) in enumerate(kept):
        progress(number / len(kept), one.name)
        summary = run_scene(load_scene(one.scene, settings, one.robot or None), _SEED)
        found.append(
            {
                "what": f"{one.name}, without" if printed is one.printed_without else one.name,
                "scene": one.scene,
                "robot": summary["robot"],
                "settings": " ".join(settings),
                "source": one.source,
                "printed": dict(printed),
                "printed_fell": fell,
                "ours": {name: figure_of(name, summary) for name in printed},
                "fell": summary["fell"],
                "completed": summary["completed"],
            }
        )
    return {"experiments": found, "files": []}


_FIGURES = {"kernels": "kernels.png", "contact": "contact_models.png", "scenes": "scenes.png"}


def measure_page(
    folder: Path, before: Path, progress: tuple[Progress, Progress], result: Mapping[str, Any], quick: bool
) -> dict[str, Any]:
    """Measure scenes and papers, and write bench.html into an existing `folder`.

    The table of scene runs in the folder `before` is continued; `progress` gets fraction done and text, for scenes and
    papers; `result` has the other parts' by name; `quick` leaves out the long experiments. Returns "scenes", "papers"
    and "made", each with its files' names.
    """
    if (before / TABLE).is_file():
        shutil.copy(before / TABLE, folder / TABLE)
    added: dict[str, Any] = {
        "scenes": measure_scenes(folder, progress[0], quick=True),
        "papers": measure_papers(progress[1], quick=quick),
        "made": {
            "version": f"Plantar {VERSION}",
            "date": time.strftime("%Y-%m-%d"),
            "machine": f"{platform.system()} on {platform.machine()}, Python {platform.python_version()}",
            "quick": quick,
        },
    }
    figures = {part: (folder / name).read_bytes() for part, name in _FIGURES.items() if (folder / name).is_file()}
    write_text(folder / "bench.html", bench_page({**result, **added}, figures))
    added["made"]["files"] = ["bench.html"]
    return added
