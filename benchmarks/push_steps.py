"""Count the scenes in which hands push or a partner leads: `python benchmarks/outcomes.py MINUTES push_steps`.

Each ablation gets the first eight of the seeds, and changes one thing; both built-in robots are counted.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from introduced_robots import robot_file
from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("fell", "impulse_Ns", "largest_change_m", "partner_moved_m", "robot_moved_m", "largest_force_N", "ratio")
SEEDS, FEW = 20, 8
FOLLOWER = ("partner.role=leader", "walk.length=0")
LINES: list[tuple[str, str, tuple[str, ...], bool]] = [
    ("steps in place, 16 and 40 N s", "push-step", (), False),
    ("the same, no step moves", "push-step", ("control.step_adjustment=false", "lean=true"), True),
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
ANKLES = ("control.step_adjustment=false", "lean=true")
CASES = [
    Case(name, scene, robot, settings, FEW if aside else SEEDS, aside)
    for name, scene, settings, aside in LINES
    for robot in ("h1", "hrp2kai")
]
for _name, _file in (("hrp2kai", ""), *((n, str(robot_file(n))) for n in ("JVRC-1", "OP3"))):
    CASES.append(Case(f"{_name}, 0.25 m/s in any direction", "push", _name, ANY, SEEDS, file=_file))
    CASES.append(Case(f"{_name}, the same, no step moves", "push", _name, (*ANY, *ANKLES), FEW, True, _file))


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


def report() -> None:
    """Write the table between its markers in push_steps.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| what | robot | {HEADS} | fell | failed criteria | largest change of a step [m] | "
        "robot, partner moved [m] | force [N] | CoM against prediction |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if (r["case"], r["robot"]) == (case.name, case.robot)]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        fell = sum(r["fell"] == "True" for r in mine)
        failed: dict[str, int] = {}
        for name in " ".join(r["failed"] for r in mine).split():
            failed[name] = failed.get(name, 0) + 1
        told = ", ".join(f"{name} {n}" for name, n in sorted(failed.items(), key=lambda f: -f[1])) or "-"
        ways = " ".join(middle(mine, name) for name in ("robot_moved_m", "partner_moved_m"))
        numbers = [middle(mine, "largest_change_m"), ways, middle(mine, "largest_force_N"), middle(mine, "ratio")]
        lines.append(f"| {case.name} | {case.robot} | {cells} | {fell} | {told} | {' | '.join(numbers)} |")
    lines += ["", f"Medians. {origin(BENCHMARK)}"]
    write_table(FOLDER / "push_steps.md", lines)


def middle(rows: list[dict[str, str]], name: str) -> str:
    """Median of a column, for the table."""
    values = [float(r[name]) for r in rows if r[name] not in ("", "nan")]
    return f"{median(values):.3g}" if values else "-"
