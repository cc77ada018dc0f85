"""The papers' experiments as written and ours: `python benchmarks/papers.py [SEEDS] [EXPERIMENT...]`.

Each run is a row of papers.csv, which is gone on with; papers.md has a row an experiment. Seeds are drawn from a fixed
word. "as written" is the scene with `--set paper=...`, "ours" the scene by itself; "without" leaves out what the
experiment is about. Experiments of A run as written with one thing changed, too.
"""

import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from statistics import mean

from paper_experiments import EXPERIMENTS, PaperExperiment, figure_of
from resumable import FOLDER, append_row, commit, drawn_seeds, rows_of, write_table

from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table
from plantar.sim.run.scene_kind import open_scene, run

TABLE = FOLDER / "papers.csv"
ONE_CHANGED = {
    "torque drives": "control.servo=torque",
    "control at 500 Hz": "control.period=0.002",
    "taxels alike": "skin.gain_error=0",
}
COLUMNS = ("experiment", "variant", "seed", "completed", "fell", "failed", "figure", "commit")


def variants(one: PaperExperiment) -> dict[str, tuple[str, ...]]:
    """Settings of each variant."""
    written = f"paper={one.source[0]}", *one.settings
    found = {"as written": written, "ours": one.settings}
    if one.without:
        found["without"] = *one.settings, *one.without
    if one.source.startswith("A"):
        found |= {name: (*written, changed) for name, changed in ONE_CHANGED.items()}
    return found


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
    """Completed runs with Wilson's interval at 95 % in percent, falls, and the mean figure."""
    if not rows:
        return "-"
    figures = [float(r["figure"]) for r in rows if r["figure"]]
    fell, done = (sum(r[name] == "True" for r in rows) for name in ("fell", "completed"))
    low, high = wilson_interval(done, len(rows))
    text = f"{done}/{len(rows)} ({100 * low:.0f}-{100 * high:.0f})" + (f", {fell} fell" if fell else "")
    return f"{text}; {mean(figures):.4g}" if figures else text


def cells_of(rows: Sequence[Mapping[str, str]], experiment: str, names: Sequence[str]) -> list[str]:
    """Cells of an experiment's variants."""
    return [cell([r for r in rows if (r["experiment"], r["variant"]) == (experiment, v)]) for v in names]


def report() -> None:
    """Write the page's table."""
    rows, lines = rows_of(TABLE), []
    units = {"mean impact": " [N]", "impact on the slab": " [N]", "largest difference": " [mm]"}
    for one in EXPERIMENTS:
        cells = cells_of(rows, one.name, ("as written", "ours", "without"))
        robot = f" --robot {one.robot}" if one.robot else ""
        command = f"`plantar sim {one.scene}{robot} --set paper={one.source[0]}`"
        figure = one.figure + units.get(one.figure, "")
        without = " ".join(one.without) or "-"
        lines.append((one.name, one.source, command, figure, str(one.paper), *cells, without))
    heads = ("experiment", "source", "command", "figure", "paper", "as written", "ours", "without", "left out")
    commits = ", ".join(f"{n} of {c}" for c, n in Counter(r["commit"] for r in rows).items())
    write_table(FOLDER / "papers.md", [markdown_table(heads, lines), "", f"Runs by commit: {commits}."])
    names = "as written", *ONE_CHANGED
    of_a = [(one.name, one.figure, *cells_of(rows, one.name, names)) for one in EXPERIMENTS if one.source[0] == "A"]
    write_table(FOLDER / "papers.md", [markdown_table(("experiment", "figure", *names), of_a)], "one changed")


if __name__ == "__main__":
    counts = [int(a) for a in sys.argv[1:] if a.isdigit()]
    run_missing(counts[0] if counts else 0, [a for a in sys.argv[1:] if not a.isdigit()])
    report()
