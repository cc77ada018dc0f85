"""Choices of the reactive layer: `python benchmarks/outcomes.py MINUTES reactive_options`.

The path of the swing foot (`control.swing_shape`) and the estimate of the CoM's velocity (`control.dcm_estimate`), on
the same scenes and seeds, against the true motion.
"""

import math
from statistics import median
from typing import Any

import numpy as np
from resumable import Benchmark, Case, shown

from plantar.recordings.recording import read_mcap

SCENES = {"flat": (), "uneven": ("walk.steps=20",), "push-step": ()}
OPTIONS = {
    "as it is": (),
    "swing fitted": ("control.swing_shape=fit",),
    "Kalman filter": ("control.dcm_estimate=kalman",),
}
STANDS = 2.0  # s until the estimator has averaged gravity and the first weight shift begins


def errors(simulation: Any, out: dict[str, Any]) -> dict[str, float]:
    run = read_mcap(out["recording"])
    estimate, truth = run.topics["/estimate"], run.topics["/truth/body"]
    com, walks = truth.fields["com"][:, :2], truth.time > STANDS
    velocity = np.gradient(com, truth.time, axis=0)
    off = np.linalg.norm(estimate.fields["com_velocity"][:, :2] - velocity, axis=1)[walks]
    missed = np.linalg.norm(estimate.fields["dcm"] - com - velocity / simulation.controller.omega, axis=1)[walks]
    found = {}
    for name, unit, error in (("velocity", "mm_s", off), ("dcm", "mm", missed)):
        found[f"{name}_rms_{unit}"] = 1e3 * math.sqrt(float(np.mean(error * error)))
        found[f"{name}_most_{unit}"] = 1e3 * float(error.max())
    return found


def farthest(simulation: Any, out: dict[str, Any]) -> float:
    """Largest change of a step, or error of the end, in m."""
    return float(max(out.get("push", {}).get("step_changes_m", []), default=out["final"]["position_error_m"]))


def _error(name: str) -> Any:
    return lambda simulation, out: errors(simulation, out)[name]


BENCHMARK = Benchmark(
    "reactive_options",
    {
        **{n: _error(n) for n in ("velocity_rms_mm_s", "velocity_most_mm_s", "dcm_rms_mm", "dcm_most_mm")},
        "impact_N": lambda simulation, out: median(out["impacts_N"]),
        "largest_impact_N": lambda simulation, out: max(out["impacts_N"]),
        "tilt_deg": "tilt_max_deg",
        "slip_mm": lambda simulation, out: 1e3 * out["slip_max_m"],
        "torque_share": "torque_limit.share_of_time",
        "steps_off_m": farthest,
    },
    [
        Case(f"{scene}, {option}", scene, "h1", (*settings, *chosen), 2)
        for scene, settings in SCENES.items()
        for option, chosen in OPTIONS.items()
    ],
    {
        "CoM velocity off, RMS [mm/s]": shown("velocity_rms_mm_s", "{mean:.3g}"),
        "most": shown("velocity_most_mm_s", "{most:.3g}"),
        "DCM off, RMS [mm]": shown("dcm_rms_mm", "{mean:.3g}"),
        "most [mm]": shown("dcm_most_mm", "{most:.3g}"),
        "impact, median [N]": shown("impact_N", "{mean:.3g}"),
        "most [N]": shown("largest_impact_N", "{most:.3g}"),
        "tilt [deg]": shown("tilt_deg", "{most:.3g}"),
        "slip [mm]": shown("slip_mm", "{most:.3g}"),
        "torque at its limit [%]": shown("torque_share", "{mean:.3g}", 100.0),
        "farthest step or end [m]": shown("steps_off_m", "{mean:.3g}"),
    },
    'Means over seeds; "most", tilt and slip are the largest.',
    recorded=True,
)
