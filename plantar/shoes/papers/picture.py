"""Pictures without a display: foot and shoe in shaded parallel projection."""

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, drawn_name, new_figure, png_of, save_figure
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import ring

_PRINTED = (0.36, 0.55, 0.72)
_PAD = (0.30, 0.31, 0.33)
_EDGE = 0.35  # brightness of an edge
_WIDTH = 1120  # pixels of a view, before it is halved

Array = NDArray[np.float64]
Picture = NDArray[np.float32]


def render(
    bodies: list[tuple[Array, tuple[float, float, float]]],
    *,
    azimuth: float,
    elevation: float,
    width: int,
    margin: float = 0.04,
) -> Picture:
    """Render triangles in parallel projection.

    `bodies`: triangles (n, 3, 3), outward counter-clockwise, and colour (r, g, b) 0..1 of each; `azimuth` of the eye,
    in degrees about z from +x; `elevation` of the eye, in degrees; `width` in pixels; `margin`: empty share at each
    side. Returns picture (height, width, 3), 0..1, on white.
    """
    a = math.radians(azimuth)
    e = math.radians(elevation)
    towards = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    frame = np.stack([right, np.cross(towards, right), towards])
    triangles = np.concatenate([b[0] for b in bodies])
    colours = np.repeat(np.array([b[1] for b in bodies]), [len(b[0]) for b in bodies], axis=0)
    seen = triangles @ frame.T
    low = seen.reshape(-1, 3).min(axis=0)
    high = seen.reshape(-1, 3).max(axis=0)
    scale = (1.0 - 2.0 * margin) * width / (high[0] - low[0])
    height = max(1, math.ceil((high[1] - low[1]) * scale + 2.0 * margin * width))
    pixel = np.empty_like(seen)
    pixel[..., 0] = (seen[..., 0] - low[0]) * scale + margin * width
    pixel[..., 1] = (high[1] - seen[..., 1]) * scale + margin * width
    pixel[..., 2] = seen[..., 2]
    normal = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    length = np.linalg.norm(normal, axis=1)
    front = (normal[:, 2] > 1e-9 * length) & (length > 1e-9)
    pixel = pixel[front]
    normal = normal[front] / length[front, None]
    colours = colours[front]
    depth, which = _nearest(pixel, height, width)
    shade = 0.42 + 0.58 * np.clip(normal @ np.array([-0.35, 0.5, 0.79]), 0.0, 1.0)  # lit from there
    picture = np.vstack([shade[:, None] * colours, np.ones(3)]).astype(np.float32)[which]
    picture[_edges(depth, which, normal, 1.2 / scale + 0.15)] *= _EDGE
    return picture


def _nearest(pixel: Array, height: int, width: int) -> tuple[Array, NDArray[np.int64]]:
    """Nearest triangle's depth and number at each pixel; -1 for none."""
    depth = np.full(height * width, -np.inf)
    which = np.full(height * width, -1, dtype=np.int64)
    y = pixel[..., 1]
    first = np.clip(np.ceil(y.min(axis=1) - 0.5), 0, height).astype(np.int64)
    last = np.clip(np.floor(y.max(axis=1) - 0.5), -1, height - 1).astype(np.int64)
    triangle, row = _spread(first, np.maximum(last - first + 1, 0))
    corners = pixel[triangle]
    middle = row + 0.5
    ends = []
    for i in range(3):
        ax, ay = corners[:, i - 1, :2].T
        bx, by = corners[:, i, :2].T
        with np.errstate(all="ignore"):
            share = (middle - ay) / (by - ay)
            ends.append(np.where((share >= 0.0) & (share <= 1.0), ax + share * (bx - ax), np.nan))
    left = np.fmin.reduce(ends)
    right = np.fmax.reduce(ends)
    known = np.isfinite(left)
    triangle = triangle[known]
    row = row[known]
    left = left[known]
    right = right[known]
    start = np.clip(np.ceil(left - 0.5), 0, width).astype(np.int64)
    end = np.clip(np.floor(right - 0.5), -1, width - 1).astype(np.int64)
    span, column = _spread(start, np.maximum(end - start + 1, 0))
    a = pixel[:, 0]
    u = pixel[:, 1] - pixel[:, 0]
    v = pixel[:, 2] - pixel[:, 0]
    up = np.cross(u, v)
    slope_x = -up[:, 0] / up[:, 2]
    slope_y = -up[:, 1] / up[:, 2]
    level = a[:, 2] - slope_x * a[:, 0] - slope_y * a[:, 1]
    begin = level[triangle] + slope_y[triangle] * (row + 0.5) + 0.5 * slope_x[triangle]
    z = begin[span] + slope_x[triangle][span] * column
    place = row[span] * width + column
    np.maximum.at(depth, place, z)
    seen = z >= depth[place]
    which[place[seen]] = triangle[span[seen]]
    return depth.reshape(height, width), which.reshape(height, width)


def _spread(first: NDArray[np.int64], count: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Ranges of `count` numbers from `first`: range number, and number in it."""
    which = np.repeat(np.arange(len(count)), count)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count) + first[which]


def _edges(depth: Array, which: NDArray[np.int64], normal: Array, jump: float) -> NDArray[np.bool_]:
    out = np.zeros(depth.size, dtype=bool)
    number = np.arange(depth.size).reshape(depth.shape)
    flat = np.where(which < 0, -1e6, depth).ravel()
    face = which.ravel()
    for here, there in ((number[:-1], number[1:]), (number[:, :-1], number[:, 1:])):
        apart = face[here] != face[there]  # within a triangle nothing bends
        a = here[apart]
        b = there[apart]
        one = normal[face[a]]
        two = normal[face[b]]
        bend = (np.einsum("ij,ij->i", one, two) < 0.9) & (face[b] >= 0)
        facing = np.minimum(one[:, 2], two[:, 2])
        out[a[bend | (np.abs(flat[a] - flat[b]) > jump / np.maximum(facing, 0.2) * 3.0)]] = True
    return out.reshape(depth.shape) & (which >= 0)


def _halved(view: Picture) -> Picture:
    height = view.shape[0] // 2
    width = view.shape[1] // 2
    return np.asarray(view[: 2 * height].reshape(height, 2, width, 2, 3).mean(axis=(1, 3)))


def rendered_png(
    bodies: list[tuple[Array, tuple[float, float, float]]], *, azimuth: float, elevation: float, width: int = 480
) -> bytes:
    """Gives PNG bytes of bodies from azimuth and elevation, of a width in pixels, as `render` does; deterministic."""
    return png_of(_halved(render(bodies, azimuth=azimuth, elevation=elevation, width=2 * width)).astype(np.float64))


def draw_picture(surface: Array, pad: Array | None, title: str, path: str | os.PathLike[str]) -> Path:
    """Draw a printed surface (n, 3, 3) in mm from above and, its pad or None apart, from below, with a title, to a
    path; returns the path.
    """
    low = surface.reshape(-1, 3).min(axis=0)
    high = surface.reshape(-1, 3).max(axis=0)
    apart = np.array([0.0, 0.0, 0.28 * (high[1] - low[1]) + 12.0])
    above = [(surface, _PRINTED)]
    below = [(surface, _PRINTED)]
    if pad is not None:
        above.append((pad, _PAD))
        below.append((pad - apart, _PAD))
    views = [
        ("from above, toes to the right", render(above, azimuth=-62.0, elevation=38.0, width=_WIDTH)),
        ("from below: pockets, ports, cable channel", render(above[:1], azimuth=-62.0, elevation=-48.0, width=_WIDTH)),
        ("with its pad", render(below, azimuth=-148.0, elevation=24.0, width=_WIDTH)),
    ]
    heights = [v.shape[0] for _, v in views]
    figure, axes = new_figure(9.0, 9.0 * sum(heights) / _WIDTH + 1.0, rows=3, height_ratios=heights)
    for ax, (text, view) in zip(axes, views, strict=True):
        ax.imshow(_halved(view), interpolation="nearest")
        ax.set_title(text, fontsize=9, loc="left")
        ax.set_axis_off()
    figure.suptitle(drawn_name(title), fontsize=11)
    return save_figure(figure, path)


_MOST_POINTS = 20_000  # of the surface
_RIM = 12.0  # mm: height up to which the outline is drawn


def draw_preview(foot: Foot, path: str | os.PathLike[str]) -> Path:
    """Draw a foot to a path, from above and right, with toes, left side, sole plane and origin; returns the path."""
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
    figure.suptitle(
        f"{drawn_name(foot.name)}, left foot as it was read\n" + "; ".join(map(drawn_name, foot.notes)),
        fontsize=7,
        wrap=True,
    )
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
