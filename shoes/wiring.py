"""The way of the cable: through the ribs from taxel to taxel, to the heel, and the holder of the connection board."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from shoes.block import Block, Step, box_block
from shoes.parameters import ShoeParameters
from shoes.plan import ShoePlan

__all__ = ["cable_outlines", "pocket_outlines", "wiring_depth", "wiring_steps"]

_SLIVER = 0.02  # mm^2
_LIP = 1.5  # mm of rail behind the board
_POST = 2.5  # mm of rail beside the board
_PLAY = 0.3  # mm between board and rail


def wiring_depth(parameters: ShoeParameters) -> float:
    """How far the board's holder reaches behind the rim in mm; 0 without one."""
    p = parameters
    return p.board_gap + p.board_thickness + _PLAY + _LIP if p.board_length > 0.0 else 0.0


def pocket_outlines(plan: ShoePlan, parameters: ShoeParameters) -> list[Any]:
    """Pockets, joined where the cable passes a rib or runs to the heel.

    Args:
        plan: The sole.
        parameters: Dimensions.

    Returns:
        Shapely polygons, possibly with holes, from the printed lower face to the pockets' ceiling.
    """
    import shapely

    cable = cable_outlines(plan, parameters)
    openings = shapely.union_all([*plan.pockets, *cable])
    joined = shapely.set_precision(shapely.union_all([openings, *_slivers(openings, cable, parameters)]), 1e-4)
    return sorted(getattr(joined, "geoms", [joined]), key=lambda g: g.bounds)


def _slivers(openings: Any, cable: list[Any], parameters: ShoeParameters) -> list[Any]:
    """What would be left of ribs beside the cable too thin to print: a wedge, cut off square."""
    import shapely

    half = 0.55 * parameters.wall_min
    closed = openings.buffer(half, join_style="mitre").buffer(-half, quad_segs=1)
    near = shapely.union_all(cable).buffer(parameters.wall_min)
    thin = closed.difference(openings.buffer(1e-4)).intersection(near)
    return [g.buffer(2e-3, join_style="mitre") for g in getattr(thin, "geoms", [thin]) if g.area > _SLIVER]


def cable_outlines(plan: ShoePlan, parameters: ShoeParameters) -> list[Any]:
    """Where the cable passes: ports in the ribs, channels between patches, and the channel to the heel.

    Args:
        plan: The sole.
        parameters: Dimensions.

    Returns:
        Shapely polygons.
    """
    import shapely

    parts = []
    width = parameters.port_width
    for i, j in plan.route if width > 0.0 else ():
        edge = plan.cells[i].intersection(plan.cells[j])
        middle = np.array(edge.centroid.coords[0])
        along = np.array(plan.cells[j].centroid.coords[0]) - np.array(plan.cells[i].centroid.coords[0])
        along /= math.hypot(*along)
        across = np.array([-along[1], along[0]])
        reach, port = 0.5 * parameters.rib + 1.0, min(width, 0.6 * edge.length)
        parts.append(shapely.Polygon([middle + a * reach * along + b * 0.5 * port * across for a, b in _SQUARE]))
    pockets = [np.array(p.centroid.coords[0]) for p in plan.pockets]
    x, y = plan.heel
    exit_x = x - parameters.board_gap if parameters.board_length > 0.0 else x - 40.0
    channels: list[tuple[Any, ...]] = [
        (pockets[plan.connectors[0]], np.array([x + 6.0, y]), np.array([exit_x, y])),
    ]
    for n, later in enumerate(plan.connectors[1:], start=1):
        before = [i for c in plan.connectors[:n] for i in _patch_of(plan, c)]
        nearest = min(before, key=lambda i: (float(math.hypot(*(pockets[i] - pockets[later]))), i))
        channels.append((pockets[later], pockets[nearest]))
    half = 0.5 * parameters.channel_width
    return parts + [shapely.LineString(c).buffer(half, cap_style="flat", join_style="mitre") for c in channels]


_SQUARE = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))


def _patch_of(plan: ShoePlan, connector: int) -> list[int]:
    """The cells of a connector's patch."""
    inside = {connector}
    for i, j in plan.route:  # a tree, from the connector outwards
        if i in inside:
            inside.add(j)
    return sorted(inside)


def wiring_steps(plan: ShoePlan, parameters: ShoeParameters) -> tuple[list[Block], list[Step]]:
    """The board's holder behind the heel, and what is cut for the cable.

    Args:
        plan: The sole.
        parameters: Dimensions.

    Returns:
        Blocks of the body, and the steps that cut it: the board's slot and the cable's hole.
    """
    p = parameters
    if p.board_length <= 0.0:
        return [], []
    x, y = plan.heel
    half = 0.5 * p.board_length
    back = x - wiring_depth(p)
    slot_low = back + _LIP
    slot_high = slot_low + p.board_thickness + _PLAY
    inner = x + 0.25 * (plan.rim.bounds[2] - x)  # well inside: what reaches into the foot's place is cut away
    outer = half + _POST + 0.5 * _PLAY

    shelf = box_block((back, y - outer, p.bottom), (inner, y + outer, p.thickness))
    posts = [
        box_block((back, y + a, p.thickness - 1.0), (inner, y + b, p.rim_top))
        for a, b in ((half - _POST, outer), (-outer, -half + _POST))
    ]
    slot = box_block(
        (slot_low, y - half - 0.5 * _PLAY, p.thickness), (slot_high, y + half + 0.5 * _PLAY, p.rim_top + 1.0)
    )
    hole_half = min(0.5 * p.channel_width, half - _POST - 0.5)
    hole = box_block((slot_high, y - hole_half, p.bottom - 1.0), (x - 0.2, y + hole_half, p.thickness + 1.0))
    return [shelf, *posts], [Step("cut", "slot of the connection board and hole of the cable", (slot, hole))]
