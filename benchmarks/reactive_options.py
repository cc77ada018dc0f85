"""Compare what a scene may choose of the reactive layer: `python benchmarks/outcomes.py MINUTES reactive_options`.

The path of the swing foot (`control.swing_shape`) and the estimate of the CoM's velocity (`control.dcm_estimate`), on
the same scenes and seeds, against the true motion.
"""

from __future__ import annotations

import math
from pathlib import Path
from statistics import mean, median
from typing import Any

import numpy as np
from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

from plantar.recordings.recording import read_mcap

FOLDER = Path(__file__).parent
COLUMNS = (
    *("velocity_rms_mm_s", "velocity_most_mm_s", "dcm_rms_mm", "dcm_most_mm"),
    *("impact_N", "largest_impact_N", "tilt_deg", "slip_mm", "torque_share", "steps_off_m"),
)
SEEDS = 2
SCENES = {"flat": (), "uneven": ("walk.steps=20",), "push-step": ()}
OPTIONS = {
    "as it is": (),
    "swing fitted": ("control.swing_shape=fit",),
    "Kalman filter": ("control.dcm_estimate=kalman",),
}
CASES = [
    Case(f"{scene}, {option}", scene, "h1", (*settings, *chosen), SEEDS)
    for scene, settings in SCENES.items()
    for option, chosen in OPTIONS.items()
]
STANDS = 2.0  # s until the estimator has averaged gravity and the first weight shift begins


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run: errors of the estimate beside the truth, how feet landed, and what the body did."""
    run = read_mcap(out["recording"])
    estimate, truth = run.topics["/estimate"], run.topics["/truth/body"]
    com = truth.fields["com"][:, :2]
    walks = truth.time > STANDS
    velocity = np.gradient(com, truth.time, axis=0)
    off = np.linalg.norm(estimate.fields["com_velocity"][:, :2] - velocity, axis=1)[walks]
    missed = np.linalg.norm(estimate.fields["dcm"] - com - velocity / simulation.controller.omega, axis=1)[walks]
    push = out.get("push", {})
    return {
        "velocity_rms_mm_s": 1e3 * math.sqrt(float(np.mean(off * off))),
        "velocity_most_mm_s": 1e3 * float(off.max()),
        "dcm_rms_mm": 1e3 * math.sqrt(float(np.mean(missed * missed))),
        "dcm_most_mm": 1e3 * float(missed.max()),
        "impact_N": median(out["impacts_N"]),
        "largest_impact_N": max(out["impacts_N"]),
        "tilt_deg": out["tilt_max_deg"],
        "slip_mm": 1e3 * out["slip_max_m"],
        "torque_share": out["torque_limit"]["share_of_time"],
        "steps_off_m": max(push.get("step_changes_m", []), default=out["final"]["position_error_m"]),
    }


BENCHMARK = Benchmark(FOLDER / "reactive_options.csv", COLUMNS, CASES, figures, recorded=True)


def report() -> None:
    """Write the table between its markers in reactive_options.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| what | robot | {HEADS} | CoM velocity off, rms, most [mm/s] | DCM off, rms, most [mm] | "
        "impact, median, most [N] | tilt [deg] | slip [mm] | torque at its limit [%] | farthest step or end [m] |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)

        def of(name: str, pick: Any = mean, scale: float = 1.0, mine: list[dict[str, str]] = mine) -> str:
            return f"{scale * pick(float(r[name]) for r in mine):.3g}"

        lines.append(
            f"| {case.name} | {case.robot} | {cells} | {of('velocity_rms_mm_s')}, {of('velocity_most_mm_s', max)} | "
            f"{of('dcm_rms_mm')}, {of('dcm_most_mm', max)} | {of('impact_N')}, {of('largest_impact_N', max)} | "
            f"{of('tilt_deg', max)} | {of('slip_mm', max)} | {of('torque_share', mean, 100.0)} | {of('steps_off_m')} |"
        )
    lines += ["", f'Means over seeds; "most", tilt and slip are the largest. {origin(BENCHMARK)}']
    write_table(FOLDER / "reactive_options.md", lines)
