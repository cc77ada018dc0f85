"""The foothold benchmark: trials with many seeds in a growing table."""

import hashlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import GrowingTable, markdown_table
from plantar.common.atomic import write_text
from plantar.errors import InputError, SceneError
from plantar.sim.bench.footholds.foothold_run import TRIALS, run_trial
from plantar.sim.bench.footholds.policy import OwnController, load_policy

_COLUMNS = (
    *("policy", "robot", "kind", "value", "seed", "completed", "steps", "planned", "fell", "tilt_deg", "froude"),
    "failed",
)
_TABLE = "footholds.csv"
_PAGE = "footholds.md"


def measure_footholds(
    folder: Path,
    policy: Path | None = None,
    robots: Sequence[str] = (),
    seeds: int = 100,
    kinds: Sequence[str] = (),
    progress: Callable[[float, str], None] | None = None,
) -> dict[str, Any]:
    """Run a policy on all trials that footholds.csv in a `folder` lacks.

    `policy` is a Python file with `make_policy(task)`, None the built-in controller; `robots` are names or files, h1
    where empty; `seeds` are runs a trial; `kinds` are all where empty. `progress` gets fraction and text. Returns rows
    and names of files; InputError if invalid.
    """
    known = list(dict.fromkeys(t.kind for t in TRIALS))
    if seeds < 1 or set(kinds) - set(known):
        raise InputError(f"{seeds} seeds of {', '.join(kinds) or 'all'}; allowed: 1 or more of {', '.join(known)}")
    make, name = (OwnController, "plantar") if policy is None else (load_policy(policy), _named(policy))
    folder.mkdir(parents=True, exist_ok=True)
    table = GrowingTable(folder / _TABLE, _COLUMNS, "foothold runs")
    done = {tuple(row[c] for c in _COLUMNS[:5]) for row in table.rows}
    wanted = [
        (robot, trial, seed)
        for robot in (robots or ("h1",))
        for trial in TRIALS
        if not kinds or trial.kind in kinds
        for seed in range(seeds)
    ]
    for k, (robot, trial, seed) in enumerate(wanted):
        key = (name, robot, trial.kind, f"{trial.value:g}", str(seed))
        if key in done:
            continue
        try:
            found = run_trial(make, trial, robot, seed)
            row = (found.completed, found.steps, found.planned, found.fell, round(found.tilt, 2))
            values: tuple[Any, ...] = (*key, *row, round(found.froude, 4), " ".join(found.failed))
        except SceneError:  # unstable physics: a policy that shakes the robot to pieces
            values = (*key, False, 0, len(trial.tables), True, 180.0, 0.0, "unstable")
        table.add(dict(zip(_COLUMNS, values, strict=True)))
        if progress is not None:
            progress((k + 1) / len(wanted), f"{name}, {trial.kind} {trial.value:g}, seed {seed}")
    rows = _summary(table.rows)
    write_text(folder / _PAGE, footholds_text({"rows": rows}) + "\n")
    return {"rows": rows, "files": [_TABLE, _PAGE]}


def _named(policy: Path) -> str:
    """Name of a policy's file and content: rows of a changed one are no longer its own."""
    return f"{policy.stem}-{hashlib.sha256(policy.read_bytes()).hexdigest()[:6]}"


def _summary(table: Sequence[dict[str, str]]) -> list[dict[str, Any]]:
    groups: dict[tuple[str, ...], list[dict[str, str]]] = {}
    for row in table:
        groups.setdefault(tuple(row[c] for c in _COLUMNS[:4]), []).append(row)
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


def footholds_text(result: dict[str, Any]) -> str:
    """A result of `measure_footholds` as a table in Markdown."""
    titles = ("policy", "robot", "trial", "completed", "95 %", "steps", "fell", "Froude", "runs")
    rows = [
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
        for r in result["rows"]
    ]
    return markdown_table(titles, rows)
