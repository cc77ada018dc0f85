"""A foot as it was read, with the detected axes: a picture to look at before anything is built."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import ring

__all__ = ["draw_preview"]

_MOST_POINTS = 20_000  # of the surface
_RIM = 12.0  # mm: height up to which the outline is drawn


def draw_preview(foot: Foot, path: str | os.PathLike[str]) -> Path:
    """Draw a foot to a path, from above and from its right side, with toes, left side, sole plane and origin; returns
    the path.
    """
    figure, (top, side) = new_figure(9.0, 7.5, rows=2, height_ratios=(3.0, 2.0))
    outline = foot.passing(min(_RIM, foot.height))
    _surface(foot, top, 1)
    _surface(foot, side, 2)
    top.plot(*_closed(outline), color=COLOURS["left"], lw=1.5, label=f"outline of the lowest {_RIM:g} mm")
    top.plot(*_closed(foot.sole), color=COLOURS["truth"], lw=1.0, ls=":", label="sole")
    support = foot.support if foot.support is not None else foot.sole
    for part in getattr(support, "geoms", [support]):
        if part.geom_type == "Polygon" and not part.is_empty:
            top.fill(*_closed(part), color=COLOURS["active"], alpha=0.35, lw=0)
    low_x, low_y, high_x, high_y = outline.bounds
    reach = 0.18 * (high_x - low_x)
    middle = 0.5 * (low_y + high_y)
    _arrow(top, (high_x, middle), (high_x + reach, middle), "toes, x")
    _arrow(top, (0.5 * (low_x + high_x), high_y), (0.5 * (low_x + high_x), high_y + reach), "left, y")
    side.axhline(0.0, color=COLOURS["reference"], lw=1.0)
    side.text(low_x, 0.0, "sole plane", va="top", fontsize=8)
    _arrow(side, (high_x, 5.0), (high_x + reach, 5.0), "toes, x")
    for axes, label in ((top, "y in mm"), (side, "z in mm")):
        axes.plot(0.0, 0.0, "+", color=COLOURS["cop"], ms=14, mew=2, label="origin, taken as below the ankle")
        axes.set_aspect("equal")
        axes.set(xlim=(low_x - reach, high_x + 2.0 * reach), ylabel=label)
    top.set_ylim(low_y - 0.5 * reach, high_y + 1.4 * reach)
    side.set_xlabel("x in mm")
    top.legend(fontsize=7, loc="upper left", frameon=False)
    figure.suptitle(f"{foot.name}, left foot as it was read\n" + "; ".join(foot.notes), fontsize=7, wrap=True)
    return save_figure(figure, path)


def _surface(foot: Foot, axes: Any, row: int) -> None:
    if foot.triangles is None:
        return
    points = np.unique(foot.triangles.reshape(-1, 3).round(1), axis=0)
    points = points[:: max(1, len(points) // _MOST_POINTS)]
    axes.plot(points[:, 0], points[:, row], ",", color=COLOURS["reference"])
    lines = foot.triangles[:: max(1, len(foot.triangles) // 2000)][:, [0, 1, 2, 0]]
    gap = np.full((len(lines), 1), np.nan)
    x, y = (np.concatenate([lines[..., i], gap], axis=1).ravel() for i in (0, row))
    axes.plot(x, y, color=COLOURS["reference"], lw=0.2)


def _closed(polygon: Any) -> Any:
    points = ring(polygon)
    return np.concatenate([points, points[:1]]).T


def _arrow(axes: Any, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    axes.annotate(text, xy=end, xytext=start, arrowprops={"arrowstyle": "->", "lw": 1.6}, fontsize=9, va="center")
