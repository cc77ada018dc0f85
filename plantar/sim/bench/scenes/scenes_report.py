"""`plantar bench scenes`: cost and error of walks in many settings."""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from plantar.bench.tables import Mark, draw_errors, markdown_table, plain_row, write_rows
from plantar.common.atomic import write_text
from plantar.errors import InputError
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.bench.scenes.scene_row import NOISE, KnobVerdict, SceneRow, knob_verdicts, scene_rows
from plantar.sim.bench.scenes.scene_runs import TABLE, SceneCase, SceneRuns
from plantar.sim.bench.scenes.scene_setting import OWN, SETTINGS

_WALKS = {"flat": "steps=4", "beam": "steps=6", "uneven": "steps=4"}

CASES: tuple[SceneCase, ...] = tuple(
    SceneCase(scene, robot, (steps, "walk.settle=0.2"))
    for robot in ("h1", "hrp2kai")
    for scene, steps in _WALKS.items()
)
"""The walks: a few steps of each scene, since each setting walks them several times."""

_SEEDS = 5
_TRACED = 2


def measure_scenes(
    folder: Path,
    progress: Callable[[float, str], None],
    scenes: Sequence[str] = (),
    robots: Sequence[str] = (),
    quick: bool = False,
) -> dict[str, Any]:
    """Run what scene_runs.csv in a `folder` (made if needed) lacks, and write scenes.md, scenes.csv and scenes.png.

    `scenes` and `robots` are names, all of `CASES` where empty; `quick` runs the most informative settings with one
    seed, by default of H1 on flat ground. `progress` gets fraction done and text. Returns rows and verdicts as plain
    JSON values, and the files' names; an InputError if invalid.
    """
    cases = _chosen(scenes, robots, quick)
    folder.mkdir(parents=True, exist_ok=True)
    runs = SceneRuns(folder)
    settings = [s for s in SETTINGS if s.quick or not quick]
    seeds = range(1, 2 if quick else _SEEDS + 1)
    runs.run(cases, settings, seeds, 1 if quick else _TRACED, progress)
    return write_scenes(folder, runs.rows)


def write_scenes(folder: Path, runs: Sequence[dict[str, str]]) -> dict[str, Any]:
    """Write `runs` (one row of `SceneRuns` or more) into `folder`; returns as `measure_scenes`."""
    rows = scene_rows(runs)
    verdicts = knob_verdicts(rows)
    write_rows(folder / "scenes.csv", [plain_row(row) for row in rows])
    write_text(folder / "scenes.md", _page(verdicts))
    _draw(folder / "scenes.png", rows)
    return {
        "rows": [plain_row(row) for row in rows],
        "verdicts": [v._asdict() for v in verdicts],
        "files": ["scenes.md", "scenes.csv", "scenes.png", TABLE],
    }


def _chosen(scenes: Sequence[str], robots: Sequence[str], quick: bool) -> list[SceneCase]:
    known = {"scene": dict.fromkeys(c.scene for c in CASES), "robot": dict.fromkeys(c.robot for c in CASES)}
    for what, names in (("scene", scenes), ("robot", robots)):
        for name in names:
            if name not in known[what]:
                raise InputError(f"{what} '{name}' is not among the walks; allowed: {', '.join(known[what])}")
    scenes = scenes or (("flat",) if quick else ())
    robots = robots or (("h1",) if quick else ())
    return [c for c in CASES if (not scenes or c.scene in scenes) and (not robots or c.robot in robots)]


_SHOWN = {"ratio": (".2f", 7), "com_mm": (".3f", 9), "zmp_mm": (".2f", 9), "force": (".1%", 8)}


def scenes_text(result: Mapping[str, Any]) -> str:
    """The main figures as text."""
    lines = [f"{'scene':10}{'robot':9}{'setting':34}{'time':>7}{'CoM mm':>9}{'ZMP mm':>9}{'force':>8}  walked"]
    for row in result["rows"]:
        if row["setting"] == row["against"]:
            continue
        cells = (f"{'-' if row[k] is None else format(row[k], form):>{width}}" for k, (form, width) in _SHOWN.items())
        walked = f"{row['completed']}/{row['seeds']}" if row["seeds"] else "yes" if row["walked"] else "NO"
        lines.append(f"{row['scene']:10}{row['robot']:9}{row['setting']:34}{''.join(cells)}  {walked}")
    for v in result["verdicts"]:
        kept = "kept" if v["stays"] else "A BETTER VALUE EXISTS"
        lines.append(f"{v['scene']}, {v['robot']}, {v['knob']}: {kept}: {v['reason']}")
    return "\n".join(lines)


_HEAD = """# Run time against error of whole scenes

![Run time against error](scenes.png)

`plantar bench scenes -o DIR` writes this page and continues from `scene_runs.csv`, whose rows keep the times of the
program that ran them. Each row changes one setting and runs the same walk.

- **Time**: processor time of a simulated second over that of the scene as it is, with the same seed. - **Error**:
root mean square of the difference from a reference with the same seed, both without sensor noise, until the   centers
of mass are a sixtieth of the leg apart; "together" is the share of the walk until then. - *Physics step, contact
time, solver iterations* compute the same robot in another way; the reference   takes steps of 0.1 ms
with up to 100 iterations. *Skin rate, control rate, taxel area and model* are another robot, and   are compared with
their own finest value. - *Sensor noise* is how far the scene's own noise moves the walk. Errors below it do not
matter.

## Defaults

A default is kept where its errors are below sensor noise and no other such value saves a twentieth of the time. All
rows are in `scenes.csv`.
"""


def _page(verdicts: Sequence[KnobVerdict]) -> str:
    kept = [(v.scene, v.robot, v.knob, "kept" if v.stays else "**a better one**", v.reason) for v in verdicts]
    return _HEAD + "\n" + markdown_table(("scene", "robot", "knob", "default", "reason"), kept) + "\n"


def pareto(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points (cost, error) that none beats in both, the cheapest first.

    Example:
        >>> pareto([(2.0, 1.0), (1.0, 3.0), (3.0, 2.0)])
        [(1.0, 3.0), (2.0, 1.0)]
    """
    front: list[tuple[float, float]] = []
    for cost, error in sorted(points):
        if not front or error < front[-1][1]:
            front.append((cost, error))
    return front


_ERRORS = (("com_mm", "error of the CoM [mm]", 1.0), ("force", "error of the ground forces [% of weight]", 100.0))


def _draw(path: Path, rows: Sequence[SceneRow]) -> None:
    cases = list(dict.fromkeys((r.scene, r.robot) for r in rows))
    figure, axes = new_figure(5.2 * len(cases) + 0.4, 9.0, len(_ERRORS), len(cases), squeeze=False)
    for column, case in enumerate(cases):
        mine = [r for r in rows if (r.scene, r.robot) == case]
        for line, (name, label, factor) in enumerate(_ERRORS):
            axis = axes[line, column]
            title = ", ".join(case) if line == 0 else ""
            errors = {id(r): factor * float(getattr(r, name)) for r in mine}
            kept = [r for r in mine if r.setting not in (NOISE, r.against) and math.isfinite(errors[id(r)] * r.ratio)]
            marks = [
                Mark(
                    r.ratio,
                    errors[id(r)],
                    "scene as it is" if r.setting == OWN.name else r.knob,
                    r.setting == OWN.name,
                    r.machine,
                    "o" if r.walked else "x",
                    r.value,
                )
                for r in kept
                if r.setting != OWN.name or r.against == "reference"
            ]
            draw_errors(axis, marks, (title, "processor time over that of the scene as it is", label), 1e-6)
            for r in (r for r in mine if r.setting == NOISE):
                axis.axhline(errors[id(r)], color=COLOURS["reference"], linestyle="--", label="sensor noise")
            numbers = [r for r in kept if r.walked and not r.machine and r.against == "reference"]
            if front := pareto([(r.ratio, errors[id(r)]) for r in numbers]):
                axis.step(*zip(*front, strict=True), where="post", color=COLOURS["truth"], lw=0.8, label="Pareto front")
            axis.xaxis.set_major_formatter("{x:g}")
            axis.set_xticks([0.5, 1, 2, 4, 8])
            axis.yaxis.set_major_formatter("{x:g}")
            low, high = axis.get_ylim()
            axis.yaxis.set_minor_formatter("{x:g}" if high < 30.0 * low else "")
    named = {text: mark for axis in axes.flat for mark, text in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(named.values(), named, loc="outside lower center", ncols=min(6, len(named)), fontsize=9)
    figure.suptitle(
        "Scenes: run time against error (lower left is better; hollow: another robot; cross: does not walk)"
    )
    save_figure(figure, path)
