"""The papers' experiments as written and ours: `python benchmarks/papers.py [SEEDS] [EXPERIMENT...]`.

Each run is a row of papers.csv, which is gone on with; papers.md has a row an experiment. Seeds are drawn from a fixed
word. "as written" is the scene with `--set paper=...`, "ours" the scene by itself; "without" leaves out what the
experiment is about.
"""

import sys
from collections.abc import Mapping, Sequence
from statistics import mean
from typing import Any, NamedTuple

from resumable import FOLDER, append_row, commit, drawn_seeds, rows_of, write_table

from plantar.sim.run.scene_kind import open_scene, run

TABLE = FOLDER / "papers.csv"
COLUMNS = ("experiment", "variant", "seed", "completed", "fell", "failed", "figure", "commit")


class Experiment(NamedTuple):
    """An experiment of a paper.

    Attributes:
        source: Section, figure or table.
        paper: What the paper reports.
        figure: Which figure of a run is compared (`figure_of`).
        robot: Robot; empty for that of the scene.
        settings: Settings of all variants.
        without: Settings of the ablation, added to "ours"; empty where there is none.
    """

    name: str
    source: str
    scene: str
    paper: str
    figure: str
    without: tuple[str, ...]
    robot: str = ""
    settings: tuple[str, ...] = ()


LEVEL, BLIND = ("walk.steps=6",), ("pfc=false", "footholds=off")
FALLS = ("control.feasibility=force_torque", "sensing.force_torque=true")
EXPERIMENTS = (
    Experiment("balance", "T 4.3.1", "balance", "ZMPs differ by 10 mm", "zmp", ()),
    *(
        Experiment(f"feasibility-{n}", "T 4.3.2, Table 3", f"feasibility-{n}", paper, "steps", FALLS)
        for n, paper in enumerate(("both step on", "both walk around", *2 * ("skin walks around, ankles fall",)), 1)
    ),
    Experiment(
        "level ground, HRP-2Kai", "T 4.4.1.2", "flat", "58 N, without 340", "impact", ("pfc=false",), "hrp2kai", LEVEL
    ),
    Experiment("level ground, H1", "T 4.4.1.3", "flat", "109 N, without 486", "impact", ("pfc=false",), "h1", LEVEL),
    Experiment("slab of 3 cm", "T 4.4.1.4", "obstacle", "370 N, without 1100 and falls", "slab", ("pfc=false",)),
    Experiment("half a foothold, rear", "T Fig. 61", "partial-rear", "walks on", "steps", BLIND),
    Experiment("30 % of the sole", "T Fig. 62", "partial-third", "walks on", "steps", BLIND),
    Experiment("beam of 12 cm", "T Fig. 63", "beam", "50 steps", "steps", BLIND),
    Experiment("beam, turned", "T Fig. 64", "beam-yaw", "50 steps", "steps", BLIND),
    Experiment(
        "pushed in place",
        "K 5.1",
        "push-step",
        "small push keeps the step, large moves it",
        "steps",
        ("step_adjustment=false",),
    ),
    Experiment(
        "follower",
        "K 5.2",
        "leader-follower",
        "steps back once, walks on",
        "steps",
        ("step_adjustment=false",),
        settings=("walk.length=0", "walk.confidence=0", "partner.role=leader"),
    ),
    Experiment("box step", "K 5.3", "box-step", "12 of 16 strides", "strides", ("step_adjustment=false",)),
    *(
        Experiment(f"force tracking {n}", f"A 4.3.{n}", f"force-tracking-{n}", paper, "force", ())
        for n, paper in ((1, "RMS 0.37 N"), (3, "RMS 0.58 N"), (4, "RMS 0.80 N"))
    ),
)


def variants(one: Experiment) -> dict[str, tuple[str, ...]]:
    """Settings of each variant."""
    found = {"as written": (f"paper={one.source[0]}", *one.settings), "ours": one.settings}
    return found | ({"without": (*one.settings, *one.without)} if one.without else {})


def figure_of(name: str, summary: Mapping[str, Any]) -> float | None:
    """The compared figure: mean impact or that on the slab in N, steps, longer strides, ZMP in mm, RMS force in N."""
    impacts = summary.get("impacts_N") or []
    match name:
        case "impact":
            return mean(impacts) if impacts else None
        case "slab":
            return impacts[4] if len(impacts) > 4 else None
        case "steps":
            return summary["steps_taken"]
        case "strides":
            return sum(1 for change in summary["push"]["step_changes_m"][6:22] if change > 0.01)
        case "zmp":
            return 1e3 * summary["balance"]["skin_against_force_torque"]["max_m"]
    return summary.get("force_rms_disturbed_N")


def run_missing(seeds: int, names: Sequence[str]) -> None:
    """Run what papers.csv lacks."""
    made = commit()
    done = {(r["experiment"], r["variant"], r["seed"]) for r in rows_of(TABLE)}
    jobs = [
        (s, e, v, given) for s in drawn_seeds("papers", seeds) for e in EXPERIMENTS for v, given in variants(e).items()
    ]
    for seed, one, variant, given in jobs:
        if (names and one.name not in names) or (one.name, variant, str(seed)) in done:
            continue
        summary = run(open_scene(one.scene, given, one.robot or None), seed)
        found = figure_of(one.figure, summary)
        row = (one.name, variant, seed, summary["completed"], summary["fell"])
        failed = " ".join(r["criterion"] for r in summary["reasons"])
        values = (*row, failed, "" if found is None else round(found, 3), made)
        append_row(TABLE, COLUMNS, dict(zip(COLUMNS, values, strict=True)))
        print(*row, failed, found, file=sys.stderr, flush=True)


def cell(rows: Sequence[Mapping[str, str]]) -> str:
    """Completed runs, falls, and the mean figure."""
    if not rows:
        return "-"
    figures = [float(r["figure"]) for r in rows if r["figure"]]
    fell = sum(r["fell"] == "True" for r in rows)
    text = f"{sum(r['completed'] == 'True' for r in rows)}/{len(rows)}" + (f", {fell} fell" if fell else "")
    return f"{text}; {mean(figures):.4g}" if figures else text


def report() -> None:
    """Write the page's table."""
    rows, lines = rows_of(TABLE), []
    units = {"impact": "mean impact [N]", "slab": "impact [N]", "zmp": "largest difference [mm]", "force": "RMS [N]"}
    for one in EXPERIMENTS:
        mine = [r for r in rows if r["experiment"] == one.name]
        cells = [cell([r for r in mine if r["variant"] == v]) for v in ("as written", "ours", "without")]
        robot = f" --robot {one.robot}" if one.robot else ""
        command = f"`plantar sim {one.scene}{robot} --set paper={one.source[0]}`"
        figure = units.get(one.figure, one.figure)
        without = " ".join(one.without) or "-"
        lines.append(
            f"| {one.name} | {one.source} | {command} | {figure} | {one.paper} | {' | '.join(cells)} | {without} |"
        )
    heads = "| experiment | source | command | figure | paper | as written | ours | without | left out |"
    commits = ", ".join(sorted({r["commit"] for r in rows}))
    write_table(FOLDER / "papers.md", [heads, "|" + "---|" * 9, *lines, "", f"Runs of commits {commits}."])


if __name__ == "__main__":
    counts = [int(a) for a in sys.argv[1:] if a.isdigit()]
    run_missing(counts[0] if counts else 0, [a for a in sys.argv[1:] if not a.isdigit()])
    report()
