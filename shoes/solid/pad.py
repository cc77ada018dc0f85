"""The replaceable silicone pad: a sheet under the taxels, its rim around them ends below the print. Lengths in mm."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shoes.geometry.outline import GRID, ring
from shoes.parameters import ShoeParameters
from shoes.plan.pad_outline import pad_rim
from shoes.plan.shoe_plan import ShoePlan

__all__ = ["pad_surface", "taxel_surfaces", "volume_of"]

Array = NDArray[np.float64]


def pad_surface(plan: ShoePlan, parameters: ShoeParameters) -> Array:
    """Surface of the pad, its lower face at z = 0.

    Args:
        plan: The sole.
        parameters: Dimensions; `pad_thickness` above 0.

    Returns:
        Closed surface (n, 3, 3) in mm, outward counter-clockwise.
    """
    import shapely

    p = parameters
    rim, full = pad_rim(plan, p), p.pad_thickness + p.pad_rim_height
    # Borders cut each other where they meet, so that neighbouring faces share their corners.
    lines = shapely.union_all([plan.contact.boundary, rim.boundary], grid_size=GRID)
    faces = [f for f in shapely.polygonize([lines]).geoms if plan.contact.buffer(GRID).covers(f)]
    high = [rim.buffer(GRID).covers(f) for f in faces]
    parts = []
    for face, raised in zip(faces, high, strict=True):
        flat = _triangles(face)
        parts += [_at(flat, 0.0)[:, ::-1], _at(flat, full if raised else p.pad_thickness)]
    owners: dict[tuple[tuple[float, float], tuple[float, float]], bool] = {}
    for face, raised in zip(faces, high, strict=True):
        face = shapely.geometry.polygon.orient(face)
        for line in (face.exterior, *face.interiors):
            points = [tuple(c) for c in np.array(line.coords)]
            owners |= dict.fromkeys(pairwise(points), raised)
    for (a, b), raised in owners.items():
        beyond = owners.get((b, a))
        top = full if raised else p.pad_thickness
        low = 0.0 if beyond is None else (full if beyond else p.pad_thickness)
        if top > low:
            levels = [low, p.pad_thickness, top] if low < p.pad_thickness < top else [low, top]
            for z, up in pairwise(levels):
                wall = np.array([[*a, z], [*b, z], [*b, up], [*a, up]])
                parts.append(wall[[[0, 1, 2], [0, 2, 3]]])
    return np.concatenate(parts)


def taxel_surfaces(plan: ShoePlan, parameters: ShoeParameters) -> list[Array]:
    """Surface of each taxel: a head below the print, a base in the pocket; both closed.

    Args:
        plan: The sole.
        parameters: Dimensions.

    Returns:
        Surfaces (n, 3, 3) in mm, outward counter-clockwise, in the order of the cells.
    """
    p = parameters
    bases = [_prism(q, p.bottom, p.ceiling) for q in plan.pockets]
    if p.taxel_protrusion <= 0.0:
        return bases
    return [np.concatenate([_prism(c, p.pad_thickness, p.bottom), b]) for c, b in zip(plan.cells, bases, strict=True)]


def _prism(polygon: Any, low: float, high: float) -> Array:
    """Closed surface of a polygon without holes between two heights."""
    flat = _triangles(polygon)
    a = ring(polygon)
    b = np.roll(a, -1, axis=0)

    def at(points: Array, z: float) -> Array:
        return np.column_stack([points, np.full(len(points), z)])

    walls = [(at(a, low), at(b, low), at(b, high)), (at(a, low), at(b, high), at(a, high))]
    return np.concatenate([_at(flat, low)[:, ::-1], _at(flat, high), *(np.stack(w, axis=1) for w in walls)])


def _triangles(face: Any) -> Array:
    """Triangles (n, 3, 2) of a polygon, counter-clockwise, with its own corners only."""
    import shapely

    oriented = [shapely.geometry.polygon.orient(t) for t in shapely.constrained_delaunay_triangles(face).geoms]
    return np.array([np.array(t.exterior.coords)[:3, :2] for t in oriented])


def _at(flat: Array, z: float) -> Array:
    return np.concatenate([flat, np.full((*flat.shape[:-1], 1), z)], axis=-1)


def volume_of(surface: Array) -> float:
    """Volume in mm^3 that a closed surface (n, 3, 3) in mm encloses."""
    a, b, c = np.moveaxis(surface, 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)
