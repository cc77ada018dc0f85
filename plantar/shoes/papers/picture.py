"""A rendered picture of a shoe: its triangles seen in parallel projection, shaded, edges drawn, without a display."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import new_figure, png_of, save_figure

__all__ = ["draw_picture", "render", "rendered_png"]

_PRINTED = (0.36, 0.55, 0.72)
_PAD = (0.30, 0.31, 0.33)
_EDGE = 0.35  # brightness of an edge

Array = NDArray[np.float64]


def render(
    bodies: list[tuple[Array, tuple[float, float, float]]],
    *,
    azimuth: float,
    elevation: float,
    width: int = 1200,
    margin: float = 0.04,
) -> Array:
    """Render triangles in parallel projection.

    Args:
        bodies: Triangles (n, 3, 3), outward counter-clockwise, and the colour (r, g, b) 0..1 of each body.
        azimuth: Where the eye is, in degrees about z from +x.
        elevation: How high the eye is, in degrees; negative looks from below.
        width: Width of the picture in pixels.
        margin: Empty share of the picture at each side.

    Returns:
        Picture (height, width, 3), 0..1, on white.
    """
    a, e = math.radians(azimuth), math.radians(elevation)
    towards = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    frame = np.stack([right, np.cross(towards, right), towards])
    triangles = np.concatenate([b[0] for b in bodies])
    colours = np.repeat(np.array([b[1] for b in bodies]), [len(b[0]) for b in bodies], axis=0)
    seen = triangles @ frame.T
    low, high = seen.reshape(-1, 3).min(axis=0), seen.reshape(-1, 3).max(axis=0)
    scale = (1.0 - 2.0 * margin) * width / (high[0] - low[0])
    height = max(1, math.ceil((high[1] - low[1]) * scale + 2.0 * margin * width))
    pixel = np.empty_like(seen)
    pixel[..., 0] = (seen[..., 0] - low[0]) * scale + margin * width
    pixel[..., 1] = (high[1] - seen[..., 1]) * scale + margin * width
    pixel[..., 2] = seen[..., 2]
    normal = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    length = np.linalg.norm(normal, axis=1)
    front = (normal[:, 2] > 1e-9 * length) & (length > 1e-9)
    pixel, normal, colours = pixel[front], normal[front] / length[front, None], colours[front]
    depth, which = _nearest(pixel, height, width)
    hit = which >= 0
    face = np.where(hit, which, 0)
    light = np.array([-0.35, 0.5, 0.79])
    shade = 0.42 + 0.58 * np.clip(normal @ light, 0.0, 1.0)
    picture = np.where(hit[..., None], (shade[:, None] * colours)[face], 1.0)
    edges = _edges(depth, normal[face], hit, 1.2 / scale + 0.15)
    return np.asarray(np.where(edges[..., None], picture * _EDGE, picture))


def _nearest(pixel: Array, height: int, width: int) -> tuple[Array, NDArray[np.int64]]:
    """Depth of the nearest triangle at each pixel, and which it is; -1 for none."""
    depth = np.full((height, width), -np.inf)
    which = np.full((height, width), -1, dtype=np.int64)
    low = np.maximum(np.ceil(pixel[..., :2].min(axis=1) - 0.5), 0).astype(int)
    high = np.floor(pixel[..., :2].max(axis=1) - 0.5).astype(int)
    high = np.minimum(high, [width - 1, height - 1])
    for i in np.flatnonzero((high >= low).all(axis=1)).tolist():
        (x0, y0), (x1, y1) = low[i], high[i]
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = pixel[i]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        x = np.arange(x0, x1 + 1) + 0.5
        y = np.arange(y0, y1 + 1)[:, None] + 0.5
        second = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        third = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        z = az + second * (bz - az) + third * (cz - az)
        window = (slice(y0, y1 + 1), slice(x0, x1 + 1))
        nearer = (second >= -1e-9) & (third >= -1e-9) & (second + third <= 1.0 + 1e-9) & (z > depth[window])
        depth[window][nearer] = z[nearer]
        which[window][nearer] = i
    return depth, which


def _edges(depth: Array, normal: Array, hit: NDArray[np.bool_], jump: float) -> NDArray[np.bool_]:
    """Pixels where the surface bends or ends against the pixel to the right or below."""
    out = np.zeros(depth.shape, dtype=bool)
    bounded = np.where(hit, depth, -1e6)
    for axis in (0, 1):
        here = [slice(None), slice(None)]
        there = [slice(None), slice(None)]
        here[axis], there[axis] = slice(None, -1), slice(1, None)
        a, b = tuple(here), tuple(there)
        bend = (normal[a] * normal[b]).sum(axis=-1) < 0.9
        facing = np.minimum(normal[a][..., 2], normal[b][..., 2])
        step = np.abs(bounded[a] - bounded[b]) > jump / np.maximum(facing, 0.2) * 3.0
        out[a] |= (bend & hit[a] & hit[b]) | step
    return out & hit


def _halved(view: Array) -> Array:
    """A picture of an even width at half the size, each pixel the mean of four."""
    height, width = view.shape[0] // 2, view.shape[1] // 2
    return np.asarray(view[: 2 * height].reshape(height, 2, width, 2, 3).mean(axis=(1, 3)))


def rendered_png(
    bodies: list[tuple[Array, tuple[float, float, float]]], *, azimuth: float, elevation: float, width: int = 480
) -> bytes:
    """Render triangles as a PNG file; the same triangles give the same bytes.

    Args:
        bodies: Triangles (n, 3, 3), outward counter-clockwise, and the colour (r, g, b) 0..1 of each body.
        azimuth: Where the eye is, in degrees about z from +x.
        elevation: How high the eye is, in degrees; negative looks from below.
        width: Width of the picture in pixels.

    Returns:
        The file's bytes.
    """
    return png_of(_halved(render(bodies, azimuth=azimuth, elevation=elevation, width=2 * width)))


def draw_picture(
    surface: Array, pad: Array | None, title: str, path: str | os.PathLike[str], *, width: int = 720
) -> Path:
    """Draw a shoe from above and, its pad apart, from below.

    Args:
        surface: Triangles (n, 3, 3) of the printed part in mm.
        pad: Triangles of the pad in mm; None without one.
        title: What it is.
        path: Where to write; the ending gives the format.
        width: Width of each view in pixels.

    Returns:
        The path.
    """
    low, high = surface.reshape(-1, 3).min(axis=0), surface.reshape(-1, 3).max(axis=0)
    apart = np.array([0.0, 0.0, 0.28 * (high[1] - low[1]) + 12.0])
    above = [(surface, _PRINTED)]
    below = [(surface, _PRINTED)]
    if pad is not None:
        above.append((pad, _PAD))
        below.append((pad - apart, _PAD))
    views = [
        ("from above, toes to the right", render(above, azimuth=-62.0, elevation=38.0, width=2 * width)),
        (
            "from below: pockets, ports, cable channel",
            render(above[:1], azimuth=-62.0, elevation=-48.0, width=2 * width),
        ),
        ("with its pad", render(below, azimuth=-148.0, elevation=24.0, width=2 * width)),
    ]
    heights = [v.shape[0] for _, v in views]
    figure, axes = new_figure(9.0, 9.0 * sum(heights) / (2 * width) + 1.0, rows=3, height_ratios=heights)
    for ax, (text, view) in zip(axes, views, strict=True):
        ax.imshow(_halved(view), interpolation="nearest")
        ax.set_title(text, fontsize=9, loc="left")
        ax.set_axis_off()
    figure.suptitle(title, fontsize=11)
    return save_figure(figure, path)
