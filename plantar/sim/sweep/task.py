"""One run of a sweep as a flat row."""

from __future__ import annotations

import socket
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from plantar.common.workers.workers import Job
from plantar.errors import DependencyError, InputError, PlantarError
from plantar.sim.run.scene import Scene
from plantar.sim.run.scene_kind import open_scene, simulation_of
from plantar.sim.sweep.inputs import changes, inputs_of

if TYPE_CHECKING:
    from plantar.sim.companion.experiment import CompanionScene

_BETWEEN = " | "  # two reasons; their texts hold commas and semicolons

Row = dict[str, Any]
"""Values by column."""

COLUMNS = (
    "completed",
    "fell",
    "steps_planned",
    "steps_taken",
    "sim_time_s",
    "real_time_factor",
    "tilt_max_deg",
    "zmp_margin_min_m",
    "impact_median_N",
    "impact_max_N",
    "position_error_m",
    "heading_error_deg",
    "com_error_max_m",
    "control_p99_us",
    "replans",
    "foothold_error_p95_m",
    "area_ratios",
    "zmp_margins_mm",
    "reasons",
    "error",
)
"""Columns of a walk's row, after the settings and the seed."""

# Those of an experiment of the companion; its own figures stand before the reasons
_COMPANION = ("completed", "fell", "sim_time_s", "real_time_factor", "control_p99_us", "reasons", "error")


@dataclass(frozen=True)
class Task:
    """A worker's task: `scene`, another `robot`, "key=value" `settings`, `seed`, and the first `inputs` (`inputs_of`),
    empty for no check.
    """

    scene: str
    robot: str | None
    settings: tuple[str, ...]
    seed: int
    inputs: tuple[tuple[str, str], ...] = ()


def columns_of(scene: Scene | CompanionScene) -> tuple[str, ...]:
    """Columns of a scene's rows after settings and seed."""
    if isinstance(scene, Scene):
        return COLUMNS
    return (*_COMPANION[:-2], *scene.experiment_type.columns, *_COMPANION[-2:])


def run_one(scene: str, robot: str | None, settings: Sequence[str], seed: int) -> Row:
    """Returns one run as a flat row: `scene`, another `robot` or None, "key=value" `settings`, `seed`.

    A scenario's error becomes a row, a missing library a DependencyError.
    """
    try:
        loaded = open_scene(scene, settings, robot)
        summary = simulation_of(loaded, seed).run()
    except DependencyError:  # no run will be possible here
        raise
    except PlantarError as error:
        return failed(str(error))
    columns = columns_of(loaded)
    row: Row = {
        **dict.fromkeys(columns, ""),
        **{name: summary[name] for name in columns if summary.get(name) is not None},
        "control_p99_us": summary["control_us"]["p99"],
        "reasons": _BETWEEN.join(f"{r['criterion']}: {r['text']}" for r in summary["reasons"]),
    }
    return row | (_of_walk(summary) if isinstance(loaded, Scene) else {})


def _of_walk(summary: Mapping[str, Any]) -> Row:
    impacts = sorted(summary["impacts_N"])
    return {
        "impact_median_N": impacts[len(impacts) // 2] if impacts else "",
        "impact_max_N": impacts[-1] if impacts else "",
        "position_error_m": summary["final"]["position_error_m"],
        "heading_error_deg": summary["final"]["heading_error_deg"],
        "com_error_max_m": max(summary["estimate"]["com_error_max_m"]),
        "foothold_error_p95_m": summary.get("footholds", {}).get("centroid_error_m", {}).get("p95", ""),
        # A value a landing, in their order.
        "area_ratios": " ".join(f"{v:g}" for v in summary["contact_area_ratio"]),
        "zmp_margins_mm": " ".join("-" if v is None else f"{1e3 * v:.1f}" for v in summary["zmp_margins_m"]),
    }


def criteria_of(row: Mapping[str, str]) -> list[str]:
    """Names of failed criteria, from the reasons in a row.

    Example:
        >>> criteria_of({"reasons": "fall: the base is low | steps: 2 of 8 steps; step 2 (from 0): never landed"})
        ['fall', 'steps']
    """
    return [reason.partition(":")[0] for reason in row["reasons"].split(_BETWEEN) if reason]


def run_task(task: Task) -> Row:
    """Run a task on a worker; a defect becomes its row."""
    _check_inputs(task)
    try:
        return run_one(task.scene, task.robot, task.settings, task.seed)
    except (DependencyError, ImportError):
        raise
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return failed(f"{type(error).__name__} in {place.filename}, line {place.lineno}: {error}")


def _check_inputs(task: Task) -> None:
    if task.inputs and task.robot is not None:
        try:
            what = changes(dict(task.inputs), inputs_of(task.scene, task.robot))
        except PlantarError as error:
            what = str(error)
        if what:
            raise InputError(f"{what} since the sweep began (seen on {socket.gethostname()})")


def failed(error: str) -> Row:
    """The row of an impossible run."""
    return {**dict.fromkeys(COLUMNS, ""), "completed": False, "error": error}


def load_runner() -> None:
    """Load the heavy part of a run, so that what dies from here on died of its run."""
    import plantar.sim.run.runner  # noqa: F401


JOB = Job(run_task, failed, load_runner)
"""What the workers of a sweep do."""
