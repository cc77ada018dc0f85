"""The papers' experiments that are scenes here: the list of benchmarks/papers.py."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from plantar.errors import PlantarError

_ON_SLAB = 4  # which landing of `obstacle`


class PaperExperiment(NamedTuple):
    """An experiment of a paper.

    Attributes:
        source: Section, figure or table.
        paper: What the paper reports.
        figure: Which figure of a run is compared (`figure_of`).
        without: Settings of the ablation; empty where there is none.
        robot: Robot; empty for that of the scene.
        settings: Settings of all variants.
    """

    name: str
    source: str
    scene: str
    paper: str
    figure: str
    without: tuple[str, ...] = ()
    robot: str = ""
    settings: tuple[str, ...] = ()


_LEVEL = ("walk.steps=6",)
_BLIND = ("pfc=false", "footholds=off")
_NO_PFC = ("pfc=false",)
_ANKLES = ("control.feasibility=force_torque", "sensing.force_torque=true")
_TOPPLE = "skin walks around, ankles fall"
_STILL = ("step_adjustment=false",)
_TOLERABLE = "pushes with at most 15 N"
_AVOID = ("control.policy=avoid", "experiment.duration=10")
_ON_LEG = "balance on one leg kept"
_SLAB = "impact on the slab"
EXPERIMENTS = (
    *(
        PaperExperiment(name, source, scene, paper, figure, tuple(without))
        for name, source, scene, paper, figure, *without in (
            ("many hands", "T 3.2.3.1", "hug", "balance kept", "cop_margin_min_mm", "control.skin=false"),
            ("26 tasks", "T 3.2.4.1, 5.1", "multi-contact", _ON_LEG, "cop_margin_min_mm", "control.skin=false"),
            ("pressure", "T 3.2.5.1", "pressure", "by the area", "speed_ratio", "control.by_pressure=false"),
            ("feather", "T 3.3.1.1", "feather", "repelled, untouched", "distance_min_mm", "control.proximity=false"),
            ("stove", "T 3.3.2.1", "stove", "retracts at 31 degrees", "temperature_max", "control.temperature=false"),
            ("nociception", "T 3.4.1.1", "nociception", "reflex", "threshold_ratio", "control.reflex=false"),
            ("planar arm", "T 3.4.2.1", "intentional-contact", _TOLERABLE, "force_max_N", *_AVOID),
            ("arm over a table", "T 3.4.2.2", "table-contact", _TOLERABLE, "force_max_N", *_AVOID),
        )
    ),
    PaperExperiment(
        "balance",
        "T 4.3.1",
        "balance",
        "ZMPs differ by 10 mm",
        "largest difference",
    ),
    *(
        PaperExperiment(f"feasibility-{n}", "T 4.3.2, Table 3", f"feasibility-{n}", paper, "steps", _ANKLES)
        for n, paper in enumerate(("both step on", "both walk around", _TOPPLE, _TOPPLE), 1)
    ),
    *(
        PaperExperiment(
            f"level ground, {name}",
            place,
            "flat",
            f"{with_} N, without {without}",
            "mean impact",
            _NO_PFC,
            robot,
            _LEVEL,
        )
        for name, place, robot, with_, without in (
            ("HRP-2Kai", "T 4.4.1.2", "hrp2kai", 58, 340),
            ("H1", "T 4.4.1.3", "h1", 109, 486),
        )
    ),
    PaperExperiment(
        "slab of 3 cm",
        "T 4.4.1.4",
        "obstacle",
        "370 N, without 1100 and falls",
        _SLAB,
        _NO_PFC,
    ),
    PaperExperiment("half a foothold, rear", "T Fig. 61", "partial-rear", "walks on", "steps", _BLIND),
    PaperExperiment("30 % of the sole", "T Fig. 62", "partial-third", "walks on", "steps", _BLIND),
    PaperExperiment("beam of 12 cm", "T Fig. 63", "beam", "50 steps", "steps", _BLIND),
    PaperExperiment("beam, turned", "T Fig. 64", "beam-yaw", "50 steps", "steps", _BLIND),
    PaperExperiment(
        "pushed in place", "K 5.1", "push-step", "small push keeps the step, large moves it", "steps", _STILL
    ),
    PaperExperiment(
        "follower",
        "K 5.2",
        "leader-follower",
        "steps back once, walks on",
        "steps",
        _STILL,
        settings=("walk.length=0", "walk.confidence=0", "partner.role=leader"),
    ),
    PaperExperiment("box step", "K 5.3", "box-step", "12 of 16 strides", "strides", _STILL),
    *(
        PaperExperiment(f"force tracking {n}", f"A 4.3.{n}", f"force-tracking-{n}", paper, figure, (without,))
        for n, paper, figure, without in (
            (1, "RMS 0.37 N", "force_rms_disturbed_N", "control.priority=sum"),
            (2, "guided", "distance_error_max_mm", "control.guidance_stiffness=0"),
            (3, "RMS 0.58 N", "force_rms_disturbed_N", "control.wrist=false"),
            (4, "RMS 0.80 N", "force_rms_disturbed_N", "control.avoidance=false"),
        )
    ),
)
"""In the order of the page."""


def figure_of(name: str, summary: Mapping[str, Any]) -> float | None:
    """A figure of a run.

    Args:
        name: As an experiment's `figure`, or a number of the summary.
        summary: The run's.

    Returns:
        Impact in N, steps, longer strides, ZMPs' difference in mm, or the number; None where the run has none.

    Raises:
        PlantarError: If no figure has that name.
    """
    impacts = summary.get("impacts_N") or []
    match name:
        case "mean impact":
            return round(math.fsum(impacts) / len(impacts), 1) if impacts else None
        case "largest impact":
            return float(max(impacts)) if impacts else None
        case "impact on the slab":
            return float(impacts[_ON_SLAB]) if len(impacts) > _ON_SLAB else None
        case "steps":
            return float(summary["steps_taken"])
        case "strides":
            longer = (r["value"] for r in summary["reasons"] if r["criterion"] == "strides")
            return float(next(longer, len(summary["push"]["pushes"])))
        case "largest difference":
            return round(1e3 * float(summary["balance"]["skin_against_force_torque"]["max_m"]), 2)
    if name in summary:
        return None if summary[name] is None else float(summary[name])
    raise PlantarError(f"no figure is called '{name}'")
