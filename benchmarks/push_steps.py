"""Count the scenes in which hands push or a partner leads: `python benchmarks/push_steps.py [MINUTES]`.

Rows go to push_steps.csv, one a run; stopped, it goes on where it was. Fresh seeds only, from 1000 on, which nothing
was tuned on; each ablation gets the first eight of them. `... report` writes the table. Robots that are not
built in are introduced from `PLANTAR_REAL_DATA`; without it their rows wait.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from introduced_robots import introduce, robot_file
from resumable import Benchmark, Case, latest, rows_of, run_for, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("fell", "impulse_Ns", "largest_change_m", "partner_moved_m", "robot_moved_m", "largest_force_N", "ratio")
SEEDS, FEW = range(1000, 1020), 8
FOLLOWER = ("partner.role=leader", "walk.length=0")
LINES: list[tuple[str, str, tuple[str, ...], bool]] = [
    ("steps in place, 16 and 40 N s", "push-step", (), False),
    ("the same, ankles alone", "push-step", ("control.step_adjustment=false", "control.step_timing=false"), True),
    ("the same, felt by the skin", "push-step", ("control.push_estimate=skin",), True),
    ("the same, push not estimated", "push-step", ("control.push_estimate=off",), True),
    ("at the shoulders", "push-height", (), False),
    ("at the CoM", "push-height", ("push.place=com",), False),
    ("at the hips", "push-height", ("push.place=hip",), False),
    ("leads a partner, c = 1", "leader-follower", (), False),
    ("follows a partner, c = 0", "leader-follower", (*FOLLOWER, "confidence=0"), False),
    *(
        (f"follows, c = {c / 10:g}", "leader-follower", (*FOLLOWER, f"confidence={c / 10:g}"), True)
        for c in range(1, 11)
    ),
    ("box step, 16 pushes of 25 N s", "box-step", (), False),
    *((f"box step, {v} N s", "box-step", (f"push.impulse={v}",), True) for v in (10, 15, 25, 30)),
    ("on half a foothold, 10 N s", "push-partial", (), False),
    ("the same, taken for a whole one", "push-partial", ("footholds=off",), True),
    ("along a beam, 20 N s", "push-beam", (), False),
]
ANY = ("push.dv=0.25",)
ANKLES = ("control.step_adjustment=false", "control.push_estimate=off")
CASES = [Case(name, scene, "h1", settings, 0, aside=aside) for name, scene, settings, aside in LINES]
for _name, _file in (("hrp2kai", ""), *((n, str(robot_file(n))) for n in ("JVRC-1", "OP3"))):
    CASES.append(Case(f"{_name}, 0.25 m/s in any direction", "push", _name, ANY, 0, file=_file))
    CASES.append(Case(f"{_name}, the same, ankles alone", "push", _name, (*ANY, *ANKLES), 0, aside=True, file=_file))


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    push, partner = out.get("push", {}), out.get("partner", {})
    ratios = [p["ratio"] for p in push.get("pushes", [])]
    return {
        "fell": out["fell"],
        "impulse_Ns": push.get("impulse_Ns", ""),
        "largest_change_m": max(push.get("step_changes_m", []), default=""),
        "partner_moved_m": partner.get("moved_m", ""),
        "robot_moved_m": partner.get("robot_moved_m", ""),
        "largest_force_N": partner.get("largest_force_N", ""),
        "ratio": ratios[-1] if ratios else "",
    }


BENCHMARK = Benchmark(FOLDER / "push_steps.csv", COLUMNS, CASES, figures)


def missing() -> Iterator[tuple[int, Case, int]]:
    """Runs that are missing, each with its rank: seed by seed over all cases, comparisons between them."""
    done = {(r["case"], int(r["seed"])) for r in rows_of(BENCHMARK.path)}
    for case in CASES:
        for i, seed in enumerate(SEEDS):
            if (case.name, seed) not in done and not (case.aside and i >= FEW):
                if case.file and not Path(case.file).exists():
                    continue
                yield (4 * i + 2 if case.aside else i), case, seed


def report() -> None:
    """Write the table between its markers in push_steps.md."""
    rows = latest(rows_of(BENCHMARK.path))
    lines = [
        "| what | completed | fell | failed criteria | largest change of a step [m] | robot, partner moved [m] | "
        "force [N] | CoM against prediction |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name]
        if not mine:
            continue
        good = sum(r["completed"] == "True" for r in mine)
        fell = sum(r["fell"] == "True" for r in mine)
        failed: dict[str, int] = {}
        for name in " ".join(r["failed"] for r in mine).split():
            failed[name] = failed.get(name, 0) + 1
        told = ", ".join(f"{name} {n}" for name, n in sorted(failed.items(), key=lambda f: -f[1])) or "-"
        ways = " ".join(middle(mine, name) for name in ("robot_moved_m", "partner_moved_m"))
        numbers = [middle(mine, "largest_change_m"), ways, middle(mine, "largest_force_N"), middle(mine, "ratio")]
        lines.append(f"| {case.name} | {good}/{len(mine)} | {fell} | {told} | {' | '.join(numbers)} |")
    commits = sorted({r["commit"] for r in rows})
    lines += ["", f"Medians. Runs of {', '.join(commits)}. Still to be run: {sum(1 for _ in missing())}."]
    write_table(FOLDER / "push_steps.md", lines)


def middle(rows: list[dict[str, str]], name: str) -> str:
    """Median of a column, for the table."""
    values = [float(r[name]) for r in rows if r[name] not in ("", "nan")]
    return f"{median(values):.3g}" if values else "-"


if __name__ == "__main__":
    if sys.argv[1:] != ["report"]:
        if "PLANTAR_REAL_DATA" in os.environ:
            introduce(Path(os.environ["PLANTAR_REAL_DATA"]))
        else:
            print("PLANTAR_REAL_DATA is not set: robots that are not built in are left out")
        run_for(BENCHMARK, missing(), float(sys.argv[1]) if len(sys.argv) > 1 else 1e6)
    report()
