"""`plantar bench footholds`: a policy on narrow and uneven ground and under pushes."""

import hashlib
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from plantar.bench.intervals import wilson_interval
from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable, Row
from plantar.errors import InputError, SceneError
from plantar.sim.bench.footholds.foothold_run import TRIALS, Trial, run_trial
from plantar.sim.bench.footholds.policy import BASELINES, load_policy

_QUICK_SEEDS = 1
_KEYS = ("policy", "robot", "kind", "value", "seed")


def _cases(options: BenchOptions) -> list[Case]:
    known = list(dict.fromkeys(t.kind for t in TRIALS))
    kinds = options.scene
    seeds = _QUICK_SEEDS if options.quick else options.seeds
    if seeds < 1 or set(kinds) - set(known):
        raise InputError(f"{seeds} seeds of {', '.join(kinds) or 'all'}; allowed: 1 or more of {', '.join(known)}")
    return [
        Case((name, robot, trial.kind, f"{trial.value:g}", str(seed)), partial(_run, make, trial, robot, seed))
        for name, make in _policies(options.policy).items()
        for robot in (options.robot or ("h1",))
        for trial in TRIALS
        if not kinds or trial.kind in kinds
        for seed in range(seeds)
    ]


def _policies(policy: Path | None) -> dict[str, Any]:
    """Policies by the names of their rows: all that every trial has, one of them, or a file's.

    A file's has a mark of its content: rows of a changed one are no longer its own.
    """
    if policy is None:
        return dict(BASELINES)
    if str(policy) in BASELINES:
        return {str(policy): BASELINES[str(policy)]}
    make = load_policy(policy)
    return {f"{policy.stem}-{hashlib.sha256(policy.read_bytes()).hexdigest()[:6]}": make}


def _run(make: Any, trial: Trial, robot: str, seed: int) -> list[Row]:
    try:
        found = run_trial(make, trial, robot, seed)
    except SceneError:  # unstable physics: a policy that shakes the robot to pieces
        return [
            {
                "completed": False,
                "steps": 0,
                "planned": len(trial.tables),
                "fell": True,
                "tilt_deg": 180.0,
                "froude": 0,
                "failed": "unstable",
            }
        ]
    return [
        {
            "completed": found.completed,
            "steps": found.steps,
            "planned": found.planned,
            "fell": found.fell,
            "tilt_deg": round(found.tilt, 2),
            "froude": round(found.froude, 4),
            "failed": " ".join(found.failed),
        }
    ]


def _summary(table: Sequence[Row]) -> list[dict[str, Any]]:
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in table:
        groups.setdefault(tuple(row[c] for c in _KEYS[:4]), []).append(row)
    units = {(t.kind, f"{t.value:g}"): t.unit for t in TRIALS}
    rows = []
    for (policy, robot, kind, value), runs in groups.items():
        completed = sum(r["completed"] == "True" for r in runs)
        low, high = wilson_interval(completed, len(runs))
        rows.append(
            {
                "policy": policy,
                "robot": robot,
                "trial": kind,
                "value": float(value),
                "unit": units.get((kind, value), ""),
                "runs": len(runs),
                "completed": completed / len(runs),
                "low": low,
                "high": high,
                "steps": sum(int(r["steps"]) / max(int(r["planned"]), 1) for r in runs) / len(runs),
                "fell": sum(r["fell"] == "True" for r in runs) / len(runs),
                "froude": sum(float(r["froude"]) for r in runs) / len(runs),
            }
        )
    return rows


def _find(table: Sequence[Row], options: BenchOptions) -> Finding:
    rows = _summary(table)
    lines = [
        (
            r["policy"],
            r["robot"],
            f"{r['trial']} {r['value']:g} {r['unit']}".strip(),
            f"{100 * r['completed']:.0f} %",
            f"{100 * r['low']:.0f} to {100 * r['high']:.0f} %",
            f"{100 * r['steps']:.0f} %",
            f"{100 * r['fell']:.0f} %",
            f"{r['froude']:.4f}",
            str(r["runs"]),
        )
        for r in rows
    ]
    head = ("policy", "robot", "trial", "completed", "95 %", "steps", "fell", "Froude", "runs")
    return Finding({"rows": rows}, [PageTable("Trials", head, lines)])


FOOTHOLDS = Kind(
    page="footholds",
    title="Walks of a policy on footholds that it does not know of",
    lead="Completed: every step in its place and no fall. Steps: share of the planned ones. Froude: v^2 / (g l).",
    table="footholds.csv",
    keys=_KEYS,
    columns=("completed", "steps", "planned", "fell", "tilt_deg", "froude", "failed"),
    cases=_cases,
    find=_find,
)
"""`plantar bench footholds`."""
