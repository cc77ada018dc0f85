"""`plantar bench scenes`: cost and error of walks in many settings."""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable, Row
from plantar.bench.tables import Mark, draw_errors, plain_row
from plantar.errors import InputError
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.bench.scenes.scene_row import NOISE, SceneRow, knob_verdicts, scene_rows
from plantar.sim.bench.scenes.scene_runs import COLUMNS, KEYS, SceneCase, SceneRuns
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


def _cases(options: BenchOptions) -> list[Case]:
    walks = _chosen(options.scene, options.robot, options.quick)
    settings = [s for s in SETTINGS if s.quick or not options.quick]
    seeds = range(1, 2 if options.quick else _SEEDS + 1)
    return SceneRuns().cases(walks, settings, seeds, 1 if options.quick else _TRACED)


def _find(runs: Sequence[Row], options: BenchOptions) -> Finding:
    rows = scene_rows(runs)
    verdicts = knob_verdicts(rows)
    plain = [plain_row(row) for row in rows]
    compared = [_line(row) for row in rows if row.setting != row.against]
    kept = [(v.scene, v.robot, v.knob, "kept" if v.stays else "**a better one**", v.reason) for v in verdicts]
    tables = [
        PageTable("Settings", ("scene", "robot", "setting", "time", "CoM mm", "ZMP mm", "force %", "walked"), compared),
        PageTable("Defaults", ("scene", "robot", "knob", "default", "reason"), kept),
    ]
    result = {"rows": plain, "verdicts": [v._asdict() for v in verdicts]}
    return Finding(result, tables, draw=partial(_draw, rows), summary=plain)


def _line(row: SceneRow) -> tuple[Any, ...]:
    walked = f"{row.completed}/{row.seeds}" if row.seeds else "yes" if row.walked else "NO"
    return (row.scene, row.robot, row.setting, row.ratio, row.com_mm, row.zmp_mm, 100.0 * row.force, walked)


def _chosen(scenes: Sequence[str], robots: Sequence[str], quick: bool) -> list[SceneCase]:
    known = {"scene": dict.fromkeys(c.scene for c in CASES), "robot": dict.fromkeys(c.robot for c in CASES)}
    for what, names in (("scene", scenes), ("robot", robots)):
        for name in names:
            if name not in known[what]:
                raise InputError(f"{what} '{name}' is not among the walks; allowed: {', '.join(known[what])}")
    scenes = scenes or (("flat",) if quick else ())
    robots = robots or (("h1",) if quick else ())
    return [c for c in CASES if (not scenes or c.scene in scenes) and (not robots or c.robot in robots)]


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


def _draw(rows: Sequence[SceneRow], path: Path) -> None:
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


SCENES = Kind(
    page="scenes",
    title="Run time against error of whole scenes",
    lead="""\
Rows of `scene_runs.csv` keep the times of the program that ran them. Each row changes one setting and runs the same
walk.

- **Time**: processor time of a simulated second over that of the scene as it is, with the same seed.
- **Error**: root mean square of the difference from a reference with the same seed, both without sensor noise, until
  the centers of mass are a sixtieth of the leg apart; "together" in `scenes.csv` is the share of the walk until then.
- *Physics step, contact time, solver iterations* compute the same robot in another way; the reference takes steps of
  0.1 ms with up to 100 iterations. *Skin rate, control rate, taxel area and model* are another robot, and are compared
  with their own finest value.
- *Sensor noise* is how far the scene's own noise moves the walk. Errors below it do not matter.

A default is kept where its errors are below sensor noise and no other such value saves a twentieth of the time.""",
    table="scene_runs.csv",
    keys=KEYS,
    columns=COLUMNS,
    cases=_cases,
    find=_find,
)
"""`plantar bench scenes`."""
