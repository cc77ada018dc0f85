"""The figures of `plantar bench scenes` in words and tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from plantar.sim.bench.markdown_table import markdown_table
from plantar.sim.bench.scenes.scene_row import NOISE, SceneRow
from plantar.sim.bench.scenes.verdict import KnobVerdict

__all__ = ["scenes_page", "scenes_text"]


def scenes_text(result: Mapping[str, Any]) -> str:
    """The main figures for people.

    Args:
        result: What `measure_scenes` gave.

    Returns:
        Lines.
    """
    lines = [f"{'scene':10}{'robot':9}{'setting':34}{'time':>7}{'CoM mm':>9}{'ZMP mm':>9}{'force':>8}  walked"]
    for row in result["rows"]:
        if row["setting"] == row["against"]:
            continue
        figures = "".join(
            f"{'-' if row[name] is None else format(row[name], form):>{width}}"
            for name, form, width in (
                ("ratio", ".2f", 7),
                ("com_mm", ".3f", 9),
                ("zmp_mm", ".2f", 9),
                ("force", ".1%", 8),
            )
        )
        walked = f"{row['completed']}/{row['seeds']}" if row["seeds"] else "yes" if row["walked"] else "NO"
        lines.append(f"{row['scene']:10}{row['robot']:9}{row['setting']:34}{figures}  {walked}")
    lines += [
        f"{v['scene']}, {v['robot']}, {v['knob']}: {'kept' if v['stays'] else 'BETTER THERE IS'}: {v['reason']}"
        for v in result["verdicts"]
    ]
    return "\n".join(lines)


def scenes_page(rows: Sequence[SceneRow], verdicts: Sequence[KnobVerdict]) -> str:
    """The page.

    Args:
        rows: What `scene_rows` gave; one at least.
        verdicts: What `knob_verdicts` gave.

    Returns:
        Markdown.
    """
    parts = [
        _HEAD,
        _VERDICTS,
        markdown_table(("scene", "robot", "knob", "default", "reason"), map(_verdict_cells, verdicts)),
    ]
    for case in dict.fromkeys((r.scene, r.robot, r.walk) for r in rows):
        mine = [r for r in rows if (r.scene, r.robot, r.walk) == case]
        scene, robot, walk = case
        parts.append(f"## {scene}, {robot}\n\nWith `{walk}`." if walk else f"## {scene}, {robot}")
        parts.append(
            markdown_table(_COLUMNS, [_cells(r) for r in mine if r.setting != r.against or r.knob == "reference"])
        )
    return "\n".join(part.strip("\n") + "\n" for part in parts)


_HEAD = """# Run time against error of whole scenes

Written by `plantar bench scenes -o DIR`; goes on where it was left, from `scene_runs.csv`. Each row changes one thing
of a scene and runs the same walk. Rows keep the times of the program that ran them: begin in another folder where it
has changed since.

![Run time against error](scenes.png)

**Time** is CPU time of a simulated second over that of the scene as it is, median of runs with the same seed in which
all settings take turns; the world's building does not count. **Error** is the root mean square of the difference from
a reference of the same scene and seed, both without sensor noise, in means of 10 ms: centre of mass, zero moment
point of the mean wrench, vertical force of each sole over the weight, impacts of the landings over the reference's.
It counts until the centres of mass are a sixtieth of the leg apart (10 mm on H1): two walks that differ in the last
digit may decide otherwise about a step, after which a distance says nothing. "Together" is the share of the walk
until then. What comes after is told by statistics of runs with noise: how many were completed, the impact of a
landing, the smallest ZMP margin.

What an error is depends on the knob:

- *Numbers* (physics step, contact time, solver iterations, contact points): another way to compute the same robot.
  The reference has the same contact of 5 ms in steps of 0.1 ms with up to 100 iterations. "Physics step" keeps that
  contact; "physics step and contact" is what `control.physics_period` does, whose contacts take five steps and grow
  stiffer with it: impacts then grow with no limit, since those of rigid bodies have none. 1.67 ms is a third of a
  control tick: a tick is a whole number of steps, and the skin is then read every 3.3 ms, not 4.
- *The machine* (skin rate, control rate, taxel area and model): another robot, which really walks otherwise. Each is
  compared with its own finest value, the rest as it is: what the robot loses by having no better one.

**Sensor noise** is the yardstick: the scene's own run with noise beside itself without. An error below it is none
that a run on another seed would show.

There is no knob for simplified polygons: hull, outline and support polygon are exact, and take 0.5 to 5 us
([kernels.md](kernels.md)), under a hundredth of a tick. Approximations are compared there.
"""

_VERDICTS = """## Defaults

A default is kept where its errors are within sensor noise and no other value that is saves a twentieth of the time.
What the machine has is kept as the papers' robots have it (skin at 250 Hz, control at 200 Hz, taxels of 691 mm^2).
"""

_COLUMNS = (
    *("setting", "time", "CPU s / s", "CoM mm", "ZMP mm", "force %", "impact %", "together", "completed"),
    *("impact N", "margin mm", "beside"),
)


def _verdict_cells(verdict: KnobVerdict) -> tuple[str, ...]:
    kept = "kept" if verdict.stays else "**a better one**"
    return (verdict.scene, verdict.robot, verdict.knob, kept, verdict.reason)


def _cells(row: SceneRow) -> tuple[str, ...]:
    own = row.setting == row.against
    errors = [row.com_mm, row.zmp_mm, 100.0 * row.force, 100.0 * row.impact]
    walked = "yes" if row.walked else "**no**"
    return (
        f"*{row.setting}*" if row.setting == NOISE else row.setting,
        *(_number(row.ratio, 2), _number(row.cpu, 3)),
        *("-" if own else _number(value, digits) for value, digits in zip(errors, (3, 2, 2, 0), strict=True)),
        f"{100 * row.together:.0f} %",
        f"{row.completed}/{row.seeds}" if row.seeds else walked,
        *(_number(row.impact_N, 0), _number(row.margin_mm, 1)),
        "-" if own else row.against,
    )


def _number(value: float, digits: int) -> str:
    return "-" if math.isnan(value) else f"{value:.{digits}f}"
