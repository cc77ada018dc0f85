"""The figure of `plantar bench scenes`: run time against error, a column a scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.bench.scenes.scene_row import NOISE, SceneRow
from plantar.sim.bench.scenes.scene_setting import OWN

__all__ = ["draw_scenes", "pareto"]

_PAINT = ("#4c78a8", "#f2a541", "#59a14f", "#b279a2", "#9d755d", "#e4572e", "#2f4b7c", "#76b7b2", "#e377c2", "#8c8c8c")
_ERRORS = (("com_mm", "error of the CoM [mm]", 1.0), ("force", "error of the ground forces [% of weight]", 100.0))


def pareto(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points than which none is cheaper and better.

    Args:
        points: Cost and error of each; less is better.

    Returns:
        Those on the front, the cheapest first.

    Example:
        >>> pareto([(2.0, 1.0), (1.0, 3.0), (3.0, 2.0)])
        [(1.0, 3.0), (2.0, 1.0)]
    """
    front: list[tuple[float, float]] = []
    for cost, error in sorted(points):
        if not front or error < front[-1][1]:
            front.append((cost, error))
    return front


def draw_scenes(path: Path, rows: Sequence[SceneRow]) -> None:
    """Draw the figure.

    Args:
        path: Where to.
        rows: What `scene_rows` gave; one at least.
    """
    cases = list(dict.fromkeys((r.scene, r.robot) for r in rows))
    knobs = list(dict.fromkeys(r.knob for r in rows if r.setting not in (OWN.name, NOISE, r.against)))
    paint = {knob: _PAINT[i % len(_PAINT)] for i, knob in enumerate(knobs)}
    figure, axes = new_figure(5.2 * len(cases) + 0.4, 9.0, len(_ERRORS), len(cases), squeeze=False)
    for column, case in enumerate(cases):
        mine = [r for r in rows if (r.scene, r.robot) == case]
        for line, (name, label, factor) in enumerate(_ERRORS):
            axis = axes[line, column]
            _draw(axis, mine, name, factor, paint)
            axis.set(xscale="log", yscale="log", title=f"{case[0]}, {case[1]}" if line == 0 else "")
            axis.set_xlabel("CPU time, times the scene's own")
            axis.set_ylabel(label)
            axis.xaxis.set_major_formatter("{x:g}")
            axis.xaxis.set_minor_formatter("")
            axis.set_xticks([0.5, 1, 2, 4, 8])
            axis.yaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_minor_formatter("{x:g}" if _narrow(axis) else "")
            axis.grid(True, which="major", color="#e5e5e5", linewidth=0.6)
    handles, names = _legend(axes[0, 0], paint, rows)
    figure.legend(handles, names, loc="outside lower center", ncols=min(5, len(names)), fontsize=9)
    figure.suptitle("Scenes: run time against error (lower left is better)")
    save_figure(figure, path)


def _draw(axis: Any, rows: Sequence[SceneRow], name: str, factor: float, paint: dict[str, str]) -> None:
    for row in rows:
        error = factor * float(getattr(row, name))
        if row.setting == NOISE:
            axis.axhline(error, color=COLOURS["reference"], linestyle="--", linewidth=1.0)
            continue
        if row.setting == row.against or math.isnan(error) or math.isnan(row.ratio):
            continue
        if row.setting == OWN.name:
            if row.against == "reference":
                axis.plot(row.ratio, error, marker="*", markersize=15, color=COLOURS["truth"], zorder=5)
            continue
        marker = "o" if row.walked else "x"
        face = "none" if row.machine else paint[row.knob]
        axis.plot(row.ratio, error, marker=marker, color=paint[row.knob], markerfacecolor=face, linestyle="none")
        axis.annotate(row.value, (row.ratio, error), xytext=(4, 3), textcoords="offset points", fontsize=6.5)
    front = pareto(
        [
            (r.ratio, factor * float(getattr(r, name)))
            for r in rows
            if r.walked and not r.machine and r.against == "reference" and r.setting not in (NOISE, r.against)
            if not math.isnan(r.ratio) and not math.isnan(float(getattr(r, name)))
        ]
    )
    if front:
        axis.step(*zip(*front, strict=True), where="post", color=COLOURS["truth"], linewidth=0.8, zorder=1)


def _narrow(axis: Any) -> bool:
    """Whether an axis has fewer than two decades, so that its ticks between them are named."""
    low, high = axis.get_ylim()
    return bool(high < 30.0 * low)


def _legend(axis: Any, paint: dict[str, str], rows: Sequence[SceneRow]) -> tuple[list[Any], list[str]]:
    machine = {r.knob for r in rows if r.machine}
    found: list[tuple[Any, str]] = []
    for knob, colour in paint.items():
        face = "none" if knob in machine else colour
        found.append((axis.plot([], [], "o", color=colour, markerfacecolor=face)[0], knob))
    found.append((axis.plot([], [], "*", color=COLOURS["truth"], markersize=12)[0], "the scene as it is"))
    found.append((axis.plot([], [], "x", color="#444444")[0], "falls or stops"))
    found.append((axis.plot([], [], "--", color=COLOURS["reference"])[0], "what sensor noise does"))
    found.append((axis.plot([], [], "-", color=COLOURS["truth"], linewidth=0.8)[0], "Pareto front of the numbers"))
    handles, names = zip(*found, strict=True)
    return list(handles), list(names)
