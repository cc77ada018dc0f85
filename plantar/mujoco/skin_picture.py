"""A picture of a body's surface and the cells of its skin, from two sides."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mujoco.geom_surface import GeomSurface
from plantar.plotting import COLOURS, new_figure

_AROUND = 32  # quads round something round
_LIGHT = np.array([0.4, 0.3, 0.87])
_SHOWN = 0.05  # cosine to the viewer from which a cell is drawn


def draw_patch(
    surfaces: Sequence[GeomSurface],
    rings: Sequence[NDArray[np.float64]],
    normals: NDArray[np.float64],
    title: str,
    toward: NDArray[np.float64] | None,
) -> Any:
    """Draw shapes and cells of a body, in its frame.

    `rings`: corners (k, 3) of n cells in m; `normals`: outward (n, 3); `toward`: direction (3,) to the first viewer;
    None for from the front. Returns a Matplotlib figure.
    """
    figure, axes = new_figure(9.0, 4.8, 1, 2)
    first = np.array([0.75, 0.45, 0.5]) if toward is None else toward + np.array([0.31, 0.23, 0.17])
    walls = [ring for surface in surfaces for ring in _walls(surface)]
    for axis, eye in zip(axes, (first, -first), strict=True):
        eye = eye / np.linalg.norm(eye)
        right, up = _screen(eye)
        _fill(axis, walls, [_normal(ring) for ring in walls], eye, right, up, None, 0.0)
        _fill(axis, rings, normals, eye, right, up, COLOURS["active"], _SHOWN)
        length = 0.25 * float(np.ptp(np.vstack(walls), axis=0).max())
        for k, letter in enumerate("xyz"):
            tip = length * np.eye(3)[k]
            axis.plot([0.0, tip @ right], [0.0, tip @ up], color=COLOURS["truth"], linewidth=1.0)
            axis.text(1.15 * tip @ right, 1.15 * tip @ up, letter, ha="center", va="center")
        axis.set_aspect("equal")
        axis.set_axis_off()
    figure.suptitle(title, fontsize=9, wrap=True)
    return figure


def _fill(
    axis: Any,
    rings: Sequence[NDArray[np.float64]],
    normals: Sequence[NDArray[np.float64]] | NDArray[np.float64],
    eye: NDArray[np.float64],
    right: NDArray[np.float64],
    up: NDArray[np.float64],
    colour: str | None,
    least: float,
) -> None:
    """Fill those that face the viewer, the farthest first; shaded in gray without a colour."""
    shown = [(float(ring.mean(axis=0) @ eye), i) for i, ring in enumerate(rings) if normals[i] @ eye > least]
    for _, i in sorted(shown):
        ring = rings[i]
        shade = 0.72 + 0.22 * max(float(normals[i] @ _LIGHT), 0.0)
        face = (shade, shade, shade) if colour is None else colour
        edge = face if colour is None else COLOURS["edge"]
        axis.fill(ring @ right, ring @ up, facecolor=face, edgecolor=edge, linewidth=0.5)


def _screen(eye: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Directions (3,) to the right and up of a viewer."""
    up = np.array([0.0, 0.0, 1.0]) if abs(eye[2]) < 0.95 else np.array([0.0, 1.0, 0.0])
    right = np.cross(up, eye)
    right /= np.linalg.norm(right)
    return right, np.cross(eye, right)


def _normal(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normal (3,) of a polygon, by its area."""
    across = np.cross(ring - ring[0], np.roll(ring, -1, axis=0) - ring[0]).sum(axis=0)
    return np.asarray(across / max(float(np.linalg.norm(across)), 1e-300))


def _walls(surface: GeomSurface) -> list[NDArray[np.float64]]:
    """Polygons (k, 3) that show a geom, body frame, counter-clockwise from outside."""
    walls = surface.faces()
    if len(surface.planes):
        return walls
    a = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)
    if surface.kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        profile = [(surface.size[0], -surface.size[1]), (surface.size[0], surface.size[1])]
    else:
        b = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _AROUND // 2 + 2)
        profile = [(float(np.cos(t)), float(np.sin(t))) for t in b]
        if surface.kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
            r, half = surface.size[:2]
            profile = [(r * w, r * h + (half if h > 0.0 else -half)) for w, h in profile]
    grid = np.array([[[w * np.cos(t), w * np.sin(t), h] for t in a] for w, h in profile])
    if surface.kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        grid = grid * surface.size[0]
    elif surface.kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        grid = grid * surface.size
    seen = grid @ surface.rotation.T + surface.position
    for i in range(len(profile) - 1):
        for j in range(_AROUND):
            walls.append(np.array([seen[i, j], seen[i, j + 1], seen[i + 1, j + 1], seen[i + 1, j]]))
    return walls
