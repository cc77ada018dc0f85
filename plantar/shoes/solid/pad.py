"""Replaceable silicone pad: a sheet under the taxels, with a rim. In mm."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.cells.cell import Cell
from plantar.shoes.geometry.outline import GRID
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block
from plantar.shoes.plan.shoe_plan import ShoePlan, pad_rim

# mm around and below the cast pad
_MOULD_WALL = 6.0
_MOULD_FLOOR = 3.0

Array = NDArray[np.float64]


def pad_surface(plan: ShoePlan, parameters: ShoeParameters) -> Array:
    """Gives closed surface (n, 3, 3) of the pad of a plan and parameters, outward counter-clockwise, lower face at z =
    0.
    """
    faces, tops = _faces(plan, parameters)
    return _height_field(faces, tops)


def mould_surface(plan: ShoePlan, parameters: ShoeParameters) -> Array:
    """Gives closed surface (n, 3, 3) of an open pad mould of a plan and parameters, on z = 0, turned about x against
    the pad.
    """
    faces, tops = _faces(plan, parameters, _MOULD_WALL)
    height = max(tops) + _MOULD_FLOOR
    surface = _height_field(faces, [height - top for top in tops])
    return np.asarray((surface * np.array([1.0, -1.0, 1.0]))[:, ::-1])


def _faces(plan: ShoePlan, p: ShoeParameters, around: float = 0.0) -> tuple[list[Any], list[float]]:
    rim = pad_rim(plan, p)
    full = p.pad_thickness + p.pad_rim_height
    # Borders cut each other where they meet, so that neighbouring faces share their corners.
    whole = plan.contact.buffer(around, join_style="mitre")
    pad = plan.contact.buffer(GRID)
    raised = rim.buffer(GRID)
    lands = [land.buffer(GRID) for land in plan.lands]
    borders = [shape.boundary for shape in (plan.contact, rim, whole, *plan.lands)]
    lines = shapely.union_all(borders, grid_size=GRID)
    faces = [f for f in shapely.polygonize([lines]).geoms if whole.buffer(GRID).covers(f)]
    tops = [full if raised.covers(f) else p.pad_thickness if pad.covers(f) else 0.0 for f in faces]
    if lands:
        tree = shapely.STRtree(lands)
        for k in np.unique(tree.query(faces, predicate="covered_by")[0]).tolist():
            tops[k] = land_top(plan, p)
    return faces, tops


def land_top(plan: ShoePlan, parameters: ShoeParameters) -> float:
    """Gives height in mm above the sole frame of lands under films or a sheet, by plan and parameters."""
    assert plan.cell is not None
    return parameters.ceiling - plan.cell.thickness


def _height_field(faces: Sequence[Any], tops: Sequence[float]) -> Array:
    """Closed surface over z = 0 of polygons sharing corners, each to its own height."""
    parts = []
    owners: dict[tuple[tuple[float, float], tuple[float, float]], float] = {}
    for face, top in zip(faces, tops, strict=True):
        flat = _triangles(face)
        parts += [_at(flat, 0.0)[:, ::-1], _at(flat, top)]
        face = shapely.geometry.polygon.orient(face)
        for line in (face.exterior, *face.interiors):
            owners |= dict.fromkeys(pairwise([tuple(c) for c in np.array(line.coords)]), top)
    levels = sorted(set(tops))
    for (a, b), top in owners.items():
        low = owners.get((b, a), 0.0)
        if top > low:  # cut at every height, so that walls that meet share their corners
            for z, up in pairwise([low, *(v for v in levels if low < v < top), top]):
                wall = np.array([[*a, z], [*b, z], [*b, up], [*a, up]])
                parts.append(wall[[[0, 1, 2], [0, 2, 3]]])
    return np.concatenate(parts)


def taxel_blocks(plan: ShoePlan, parameters: ShoeParameters) -> list[list[Block]]:
    """Gives blocks of each taxel of a plan, by parameters: head below the print and base in the pocket, or a film's or
    sheet's body.
    """
    p = parameters
    if plan.cell is not None and plan.cell.kind == "film":
        return [_film(plan.cell, *shapes, p) for shapes in zip(plan.pockets, plan.lands, strict=True)]
    bodies = [[Block(q, land_top(plan, p) if plan.lands else p.bottom, p.ceiling)] for q in plan.pockets]
    if plan.lands or p.taxel_protrusion <= 0.0:
        return bodies
    return [[Block(c, p.pad_thickness, p.bottom), *b] for c, b in zip(plan.cells, bodies, strict=True)]


def _film(cell: Cell, pocket: Any, land: Any, p: ShoeParameters) -> list[Block]:
    """Body with its tail, less play, at the ceiling; below the tail's end, away from the land, its connector."""
    blocks = [Block(pocket.buffer(-cell.play, join_style="mitre"), p.ceiling - cell.thickness, p.ceiling)]
    if cell.connector_height > cell.thickness:
        end = 0.5 * cell.body[0] + cell.tail_length
        half = 0.5 * cell.tail_width
        x, y = np.subtract(pocket.centroid.coords[0], land.centroid.coords[0])
        box = shapely.box(end - cell.connector_length, -half, end, half)
        turned = shapely.affinity.rotate(box, math.atan2(y, x), origin=(0.0, 0.0), use_radians=True)
        placed = shapely.affinity.translate(turned, land.centroid.x, land.centroid.y)
        blocks.append(Block(placed, p.ceiling - cell.connector_height, p.ceiling - cell.thickness))
    return blocks


def taxel_surfaces(plan: ShoePlan, parameters: ShoeParameters) -> list[Array]:
    """Gives surfaces (n, 3, 3) of each taxel, by plan and parameters; without a pad with lands."""
    blocks = taxel_blocks(plan, parameters)
    if plan.lands and parameters.pad_thickness <= 0.0:
        lands = [Block(q, 0.0, land_top(plan, parameters)) for q in plan.lands]
        shared = [lands] if len(blocks) == 1 else [[land] for land in lands]  # a sheet has them all
        blocks = [body + own for body, own in zip(blocks, shared, strict=True)]
    return [np.concatenate([prism_surface(b.low, b.z_low, b.z_high) for b in each]) for each in blocks]


def prism_surface(polygon: Any, low: float, high: float) -> Array:
    """Gives closed surface (n, 3, 3) of a shapely polygon without holes between low and high in mm."""
    return np.asarray(_height_field([polygon], [high - low]) + np.array([0.0, 0.0, low]))


def _triangles(face: Any) -> Array:
    oriented = [shapely.geometry.polygon.orient(t) for t in shapely.constrained_delaunay_triangles(face).geoms]
    return np.array([np.array(t.exterior.coords)[:3, :2] for t in oriented])


def _at(flat: Array, z: float) -> Array:
    return np.concatenate([flat, np.full((*flat.shape[:-1], 1), z)], axis=-1)
