"""The end of `plantar bench all`: scenes, papers' experiments, and page."""

from __future__ import annotations

import math
import platform
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from plantar.atomic import write_text
from plantar.errors import PlantarError
from plantar.sim.bench.page.bench_page import bench_page
from plantar.sim.bench.scenes.scene_runs import TABLE
from plantar.sim.bench.scenes.scenes_report import measure_scenes
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

__all__ = ["EXPERIMENTS", "Experiment", "measure_page", "measure_papers"]

_ON_SLAB = 4  # which landing of `obstacle`
_SEED = 1000  # a fresh one: nothing was ever tuned on it


@dataclass(frozen=True)
class Experiment:
    """A scene's run, and a paper's figures of it on a real robot.

    Attributes:
        settings: Changes of scene.
        printed: The paper's figures by name: "mean impact", "largest impact" and "impact on the slab" in N, "largest
            difference" of two ZMPs in mm, "steps" done.
        fell: Whether the paper's robot fell.
        long: Whether a quick run leaves it out.
    """

    what: str
    scene: str
    robot: str
    settings: tuple[str, ...]
    printed: Mapping[str, float]
    source: str
    fell: bool = False
    long: bool = False


_LEVEL = ("steps=6", "terrain.height_range=0")
EXPERIMENTS: tuple[Experiment, ...] = (
    Experiment(
        *("level ground, skin before contact", "uneven", "h1", _LEVEL),
        {"mean impact": 109.0, "largest impact": 261.0},
        "T 4.4.1.3",
    ),
    Experiment(
        *("level ground, stop at contact", "uneven", "h1", (*_LEVEL, "pfc=false")),
        {"mean impact": 486.0, "largest impact": 615.0},
        "T 4.4.1.3",
    ),
    Experiment(
        *("level ground, skin before contact", "uneven", "hrp2kai", _LEVEL),
        {"mean impact": 58.0, "largest impact": 200.0},
        "T 4.4.1.2",
    ),
    Experiment(
        *("level ground, stop at contact", "uneven", "hrp2kai", (*_LEVEL, "pfc=false")),
        {"mean impact": 340.0, "largest impact": 430.0},
        "T 4.4.1.2",
    ),
    Experiment(
        *("a slab of 3 cm, skin before contact", "obstacle", "h1", ()), {"impact on the slab": 370.0}, "T 4.4.1.4"
    ),
    Experiment(
        *("a slab of 3 cm, stop at contact", "obstacle", "h1", ("pfc=false",)),
        {"impact on the slab": 1100.0},
        "T 4.4.1.4",
        fell=True,
    ),
    Experiment(*("a foothold of 30 % of the sole", "partial-third", "h1", ()), {"steps": 6.0}, "T Fig. 62"),
    Experiment(*("a beam of 12 cm, side steps", "beam", "h1", ()), {"steps": 50.0}, "T 4.4.3", long=True),
    Experiment(
        *("ZMP of skin and of ankle sensors, pushed", "balance", "h1", ()),
        {"largest difference": 10.0},
        "T 4.3.1",
        long=True,
    ),
)
"""In the order of the page."""


def measure_papers(
    progress: Callable[[float, str], None], experiments: Sequence[Experiment] = EXPERIMENTS, quick: bool = False
) -> dict[str, Any]:
    """Run the `experiments`, without long ones if `quick`; `progress` gets fraction done and text.

    Returns:
        "experiments": each with the paper's figures and source, ours by the same names, and whether each robot fell;
        plain JSON values. "files": none.
    """
    kept = [e for e in experiments if not (quick and e.long)]
    found = []
    for number, one in enumerate(kept):
        progress(number / len(kept), f"{one.what}, {one.robot}")
        summary = run_scene(load_scene(one.scene, one.settings, one.robot), _SEED)
        found.append(
            {
                "what": one.what,
                "scene": one.scene,
                "robot": one.robot,
                "settings": " ".join(one.settings),
                "source": one.source,
                "printed": dict(one.printed),
                "printed_fell": one.fell,
                "ours": {name: _figure(name, summary) for name in one.printed},
                "fell": summary["fell"],
                "completed": summary["completed"],
            }
        )
    return {"experiments": found, "files": []}


def _figure(name: str, summary: Mapping[str, Any]) -> float | None:
    impacts = summary["impacts_N"]
    match name:
        case "mean impact":
            return round(math.fsum(impacts) / len(impacts), 1) if impacts else None
        case "impact on the slab":
            return float(impacts[_ON_SLAB]) if len(impacts) > _ON_SLAB else None
        case "largest impact":
            return float(max(impacts)) if impacts else None
        case "steps":
            return float(summary["steps_taken"])
        case "largest difference":
            return round(1e3 * float(summary["balance"]["skin_against_force_torque"]["max_m"]), 2)
    raise PlantarError(f"no figure is called '{name}'")


_FIGURES = {"kernels": "kernels.png", "contact": "contact_models.png", "scenes": "scenes.png"}
Progress = Callable[[float, str], None]


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
