"""Figures of a sweep, drawn from its table alone."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from plantar.bench.intervals import wilson_interval
from plantar.plotting import COLOURS, new_figure
from plantar.sim.sweep.limit_search import LimitSearch
from plantar.sim.sweep.plan import Plan, Rows, settings_of

_WIDEST = 40.0  # inches of a figure
_GROUPS = 8  # of runs along a setting
# Columns whose distributions are drawn, where a table has them
_SHOWN = {
    "tilt_max_deg": "largest tilt [deg]",
    "zmp_margin_min_m": "smallest ZMP margin [m]",
    "impact_max_N": "largest impact [N]",
    "position_error_m": "position error [m]",
}


def figures_of(plan: Plan, found: Mapping[str, Any], rows: Rows) -> dict[str, Any]:
    """Returns figures of a `plan`'s results `found` and `rows` by name: "limit" of a limit search; else "completed",
    "map" over the first two numeric settings, and "distributions".
    """
    scene = plan.checked.scene
    if isinstance(plan, LimitSearch):
        return {"limit": _limits(plan, found["limits"], rows)}
    drawn = {
        "completed": bars_of(found["points"], scene),
        "map": _map(plan, rows),
        "distributions": _distributions(found["points"], rows, scene),
    }
    return {name: figure for name, figure in drawn.items() if figure is not None}


def bars_of(points: Sequence[Mapping[str, Any]], scene: str) -> Any:
    """Returns a figure of completed runs at `points` with Wilson's intervals, titled `scene`."""
    figure, axis = new_figure(min(max(5.0, 1.2 + 1.05 * len(points)), _WIDEST), 4.0)
    names = ["\n".join(f"{k}={v}" for k, v in p["settings"].items()) or scene for p in points]
    shares = np.array([100.0 * p["completed"] / p["runs"] if p["runs"] else 0.0 for p in points])
    ends = 100.0 * np.array([wilson_interval(p["completed"], p["runs"]) for p in points])
    axis.bar(range(len(points)), shares, color=COLOURS["polygon"])
    axis.vlines(range(len(points)), ends[:, 0], ends[:, 1], color=COLOURS["truth"], linewidth=1.2)
    if 1.05 * len(points) < _WIDEST:
        for i, p in enumerate(points):
            axis.text(i, 103.0, f"{p['completed']}/{p['runs']}", ha="center", fontsize=8)
        axis.set_xticks(range(len(points)), names, fontsize=7)
    else:  # no room for words
        axis.set_xlabel("grid point, counted from 0 in the order of the settings")
    axis.set(ylim=(0.0, 112.0), ylabel="completed runs [%], 95 % intervals", title=f"scene '{scene}'")
    return figure


def _limits(plan: LimitSearch, limits: Sequence[Mapping[str, Any]], rows: Rows) -> Any:
    figure, axes = new_figure(7.0, 0.8 + 2.9 * len(limits), len(limits), squeeze=False)
    for axis, point, found in zip(axes[:, 0], plan.sweep.points(), limits, strict=True):
        keys = [key for key in plan.tried(point, rows) if not rows[key]["error"]]
        curve = plan.curve(keys, rows)
        values = np.array([plan.limit.value(key[0][-1]) for key in keys])
        completed = np.array([rows[key]["completed"] == "True" for key in keys])
        along = np.linspace(plan.limit.low, plan.limit.high, 201)
        axis.plot(along, [100.0 * curve.share(v) for v in along], color=COLOURS["polygon"], label="expected share")
        _groups(axis, values, completed)
        axis.plot(values, np.where(completed, 104.0, -4.0), "|", color=COLOURS["reference"], label="a run")
        words = ", ".join(f"{k}={v}" for k, v in settings_of(point).items()) or plan.sweep.scene
        if found["limit"] is None:
            axis.set_title(f"{words}: no limit in this range, {found['runs']} runs", fontsize=9)
        else:
            low, high = found["interval"]
            axis.axvspan(low, high, color=COLOURS["active"], alpha=0.35, linewidth=0, label="95 % interval")
            unit = f" {found['unit']}" if found["unit"] else ""
            axis.set_title(
                f"{words}: limit {found['limit']:.3g}{unit} ({low:.3g} to {high:.3g}), {found['runs']} runs", fontsize=9
            )
        axis.set(ylim=(-8.0, 108.0), ylabel="completed runs [%]")
        axis.legend(fontsize=7, loc="center left" if curve.rising else "center right")
    axes[-1, 0].set_xlabel(f"{plan.limit.name}{f' [{plan.limit.unit}]' if plan.limit.unit else ''}")
    return figure


def _groups(axis: Any, values: Any, completed: Any) -> None:
    order = np.argsort(values, kind="stable")
    for group in np.array_split(order, min(_GROUPS, max(1, len(order) // 5))):
        if len(group):
            low, high = wilson_interval(int(completed[group].sum()), len(group))
            x = float(values[group].mean())
            axis.vlines(x, 100.0 * low, 100.0 * high, color=COLOURS["truth"], linewidth=1.0)
            axis.plot(x, 100.0 * completed[group].mean(), "o", color=COLOURS["truth"], markersize=3)


def _numbers(texts: Sequence[str]) -> list[float] | None:
    try:
        return [float(text.split()[0]) for text in texts]
    except (ValueError, IndexError):
        return None


def _map(plan: Plan, rows: Rows) -> Any:
    axes = plan.checked.axes
    columns = [(name, _numbers([key[0][i] for key in rows])) for i, name in enumerate(axes)]
    numeric = [(name, np.array(found)) for name, found in columns if found and len(set(found)) > 1]
    if len(numeric) < 2:
        return None
    completed = np.array([row["completed"] == "True" for row in rows.values()])
    (name_x, x), (name_y, y) = numeric[:2]
    in_x, names_x = _cells(x)
    in_y, names_y = _cells(y)
    figure, axis = new_figure(max(4.5, 1.6 + 1.05 * len(names_x)), max(3.2, 1.2 + 0.62 * len(names_y)))
    shares = np.full((len(names_y), len(names_x)), np.nan)
    for i in range(len(names_y)):
        for j in range(len(names_x)):
            here = completed[(in_y == i) & (in_x == j)]
            if len(here):
                shares[i, j] = 100.0 * here.mean()
                low, high = wilson_interval(int(here.sum()), len(here))
                found = f"{int(here.sum())}/{len(here)}\n{100 * low:.0f}-{100 * high:.0f} %"
                colour = "#ffffff" if shares[i, j] < 50.0 else "#111111"
                axis.text(j, i, found, ha="center", va="center", fontsize=7, color=colour)
    image = axis.imshow(shares, cmap="viridis", vmin=0.0, vmax=100.0, origin="lower", aspect="auto")
    figure.colorbar(image, label="completed runs [%]")
    axis.set_xticks(range(len(names_x)), names_x, fontsize=7)
    axis.set_yticks(range(len(names_y)), names_y, fontsize=7)
    axis.set(xlabel=name_x, ylabel=name_y)
    axis.set_title(f"scene '{plan.checked.scene}', 95 % intervals", fontsize=10)
    return figure


def _cells(values: Any) -> tuple[Any, list[str]]:
    distinct = np.unique(values)
    if len(distinct) <= 12:
        return np.searchsorted(distinct, values), [f"{v:g}" for v in distinct]
    count = int(np.clip(round(np.sqrt(len(values) / 5.0)), 2, _GROUPS))
    edges = np.linspace(distinct[0], distinct[-1], count + 1)
    index = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, count - 1)
    return index, [f"{a:.3g}-{b:.3g}" for a, b in pairwise(edges)]


def _distributions(points: Sequence[Mapping[str, Any]], rows: Rows, scene: str) -> Any:
    if 1.05 * len(points) >= _WIDEST or not rows:
        return None
    columns = [name for name in _SHOWN if any(row.get(name) for row in rows.values())]
    if not columns:
        return None
    figure, axes = new_figure(max(5.0, 1.4 + 1.05 * len(points)), 2.1 * len(columns), len(columns), squeeze=False)
    names = ["\n".join(f"{k}={v}" for k, v in p["settings"].items()) or scene for p in points]
    places = [tuple(p["settings"].values()) for p in points]
    for axis, column in zip(axes[:, 0], columns, strict=True):
        for i, place in enumerate(places):
            here = [row for key, row in rows.items() if key[0][: len(place)] == place and row[column]]
            if not here:
                continue
            values = np.array([float(row[column]) for row in here])
            good = np.array([row["completed"] == "True" for row in here])
            spread = i + 0.3 * ((np.arange(len(values)) + 0.5) / len(values) - 0.5)
            axis.plot(spread[good], values[good], ".", color=COLOURS["polygon"], markersize=4)
            axis.plot(spread[~good], values[~good], "x", color=COLOURS["right"], markersize=4)
            axis.hlines(np.median(values), i - 0.3, i + 0.3, color=COLOURS["truth"], linewidth=1.2)
        axis.set_ylabel(_SHOWN[column], fontsize=8)
        axis.set_xticks(range(len(points)), names, fontsize=7)
        axis.set_xlim(-0.6, len(points) - 0.4)
    axes[0, 0].set_title(f"scene '{scene}': completed (.), not completed (x), median of all", fontsize=9)
    return figure
