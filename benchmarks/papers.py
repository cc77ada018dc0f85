"""The papers' experiments as written and ours: `python benchmarks/papers.py [SEEDS] [EXPERIMENT...]`.

Each run is a row of papers.csv, which is gone on with; papers.md has a row an experiment. Seeds are drawn from a fixed
word. "as written" is the scene with `--set paper=...`, "ours" the scene by itself; "without" leaves out what the
experiment is about.
"""

import sys
from collections.abc import Mapping, Sequence
from statistics import mean

from resumable import FOLDER, append_row, commit, drawn_seeds, rows_of, write_table

from plantar.sim.papers.experiments import EXPERIMENTS, PaperExperiment, figure_of
from plantar.sim.run.scene_kind import open_scene, run

TABLE = FOLDER / "papers.csv"
COLUMNS = ("experiment", "variant", "seed", "completed", "fell", "failed", "figure", "commit")


def variants(one: PaperExperiment) -> dict[str, tuple[str, ...]]:
    """Settings of each variant."""
    found = {"as written": (f"paper={one.source[0]}", *one.settings), "ours": one.settings}
    return found | ({"without": (*one.settings, *one.without)} if one.without else {})


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
    units = {"mean impact": " [N]", "impact on the slab": " [N]", "largest difference": " [mm]"}
    for one in EXPERIMENTS:
        mine = [r for r in rows if r["experiment"] == one.name]
        cells = [cell([r for r in mine if r["variant"] == v]) for v in ("as written", "ours", "without")]
        robot = f" --robot {one.robot}" if one.robot else ""
        command = f"`plantar sim {one.scene}{robot} --set paper={one.source[0]}`"
        figure = one.figure + units.get(one.figure, "")
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
