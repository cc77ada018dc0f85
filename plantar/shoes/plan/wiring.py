"""Cable's way through the ribs to the heel, and the board's holder."""

import math
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.geometry.outline import gathered
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block, Step, tapered
from plantar.shoes.plan.heel import HOLE_OFF, LIP, POST, holder_depth, slot_entry
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.units import to_mm

_BARB = 0.1  # mm
_STEP = 0.01  # mm between two corners that are one
_WIDER = 0.3  # mm
_WITHIN = 1.0  # mm
_THICKER = 0.6  # of a wall, half of what remains of a post: its corners are cut by an octagon
_SLACK = 200.0  # mm of each lead beyond the heel's board, to the read-out on the shank
_SHARP = 0.14  # of a width squared: what its bevel takes of a corner of 87 degrees, so ends at a right angle stay


def pocket_outlines(plan: ShoePlan, parameters: ShoeParameters) -> list[Any]:
    """Gives shapely pockets of a plan by parameters, joined where the cable passes."""
    cable = cable_outlines(plan, parameters)
    openings = shapely.union_all([*plan.pockets, *cable])
    ways = shapely.union_all(cable)
    wall = parameters.wall_min
    # A wedge is cut off square, so far as it is near; where that ends, a barb of some hundredths may be left.
    for near, thin in ((1.3 * wall, 1.1 * wall), (2.0 * wall, _BARB)):
        slivers = _slivers(openings, ways.buffer(near), thin)
        if slivers:  # where they end, steps of some thousandths would be walls of no width
            openings = shapely.remove_repeated_points(shapely.union_all([openings, *slivers]), _STEP)
            # and the pockets' corners stay where they are
            openings = shapely.snap(openings, shapely.multipoints(shapely.get_coordinates(list(plan.pockets))), _STEP)
    joined = shapely.transform(openings, lambda points: gathered(points, shapely.get_coordinates(list(plan.pockets))))
    joined = shapely.set_precision(joined.buffer(0.0), 1e-4)
    return sorted((_without_posts(g, wall) for g in getattr(joined, "geoms", [joined])), key=lambda g: g.bounds)


def _without_posts(opening: Any, wall: float) -> Any:
    """Opening without what stands in it alone and thinner than a wall.

    What touches a rib or another post in a point, where the print would be joined by a line without width, ends a wall
    before it.
    """
    holes = list(opening.interiors)
    kept = []
    for hole in holes:
        post = shapely.Polygon(hole)
        others = [opening.exterior, *(other for other in holes if other is not hole)]
        touched = hole.intersection(shapely.union_all(others))
        if not touched.is_empty:
            left = post.difference(touched.buffer(wall, quad_segs=2))
            thick = left.buffer(-_THICKER * wall, quad_segs=2).buffer(_THICKER * wall, quad_segs=2)  # no wedge remains
            post = shapely.set_precision(thick & left, 1e-4)
        kept += [q.exterior for q in shapely.get_parts(post) if not q.buffer(-0.5 * wall).is_empty]
    return shapely.Polygon(opening.exterior, kept)


def _slivers(openings: Any, near: Any, thin: float) -> list[Any]:
    # With bevels, which end a wedge where it is wide enough; a mitre, even a limited one, reaches far into it.
    closed = openings.buffer(0.5 * thin, join_style="mitre").buffer(-0.5 * thin, join_style="bevel")
    left = shapely.get_parts(closed.difference(openings.buffer(1e-4)) & near)
    return [g.buffer(2e-3, join_style="mitre") for g in left if g.area > _SHARP * thin**2]


def cable_outlines(plan: ShoePlan, parameters: ShoeParameters) -> list[Any]:
    """Gives shapely cable ways of a plan by parameters: ports, channels between patches and to the heel."""
    if not plan.connectors:
        return []
    parts = []
    width = parameters.port_width
    for i, j in plan.route:
        ends, across, most = plan.port(i, j)
        middle = ends.mean(axis=0)
        along = ends[1] - ends[0]
        length = math.hypot(*along)
        along = along / length
        reach = 0.5 * parameters.rib + 1.0
        port = min(width, most)
        if plan.cell is not None:  # into the pockets, until a round one is as wide as the port
            radius = 0.5 * min(plan.cell.body)
            reach = 0.5 * length + 1.0 + radius - math.sqrt(max(0.0, radius**2 - 0.25 * port**2))
        parts.append(shapely.Polygon([middle + a * reach * along + b * 0.5 * port * across for a, b in _SQUARE]))
    half = 0.5 * parameters.channel_width
    lines = channel_lines(plan, parameters)
    return parts + [shapely.LineString(c).buffer(half, cap_style="flat", join_style="mitre") for c in lines]


def channel_lines(plan: ShoePlan, parameters: ShoeParameters) -> list[NDArray[np.float64]]:
    """Gives points (k, 2) in mm along each connector's channel, by plan and parameters: to the heel, or the nearest
    pocket of an earlier patch.
    """
    if not plan.connectors:
        return []
    skin = plan.cell is None
    pockets = [np.array(p.centroid.coords[0]) for p in plan.pockets] if skin else to_mm(plan.layout.positions[:, :2])
    heel = plan.heel
    # Straight into the hole behind the wall, or out of the plate where there is none.
    end = heel.point(-0.5 * parameters.board_gap if heel.board else -40.0, 0.0)
    lines = [np.stack([pockets[plan.connectors[0]], heel.point(6.0, 0.0), end])]
    for n, later in enumerate(plan.connectors[1:], start=1):
        before = [i for c in plan.connectors[:n] for i in _patch_of(plan, c)]
        nearest = min(before, key=lambda i: (float(math.hypot(*(pockets[i] - pockets[later]))), i))
        lines.append(np.stack([pockets[later], pockets[nearest]]))
    return lines


def wire_lines(plan: ShoePlan) -> dict[int, NDArray[np.float64]]:
    """Way (3, 2) in mm of each wire of `plan.route`, by second cell: centre, port, centre."""
    centres = [np.array(c.centroid.coords[0]) for c in plan.cells]
    return {j: np.stack([centres[i], plan.port(i, j)[0].mean(axis=0), centres[j]]) for i, j in plan.route}


def length_of(line: NDArray[np.float64]) -> float:
    """Length in mm of a line (k, 2) in mm.

    Example:
        >>> length_of(np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]]))
        6.0
    """
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def cable_ways(plan: ShoePlan, parameters: ShoeParameters) -> dict[int, float]:
    """Gives length in mm of the way from each wired cell of a plan to the end of the channel at the heel, by
    parameters: by the route to its patch's connector, and by the channel.
    """
    wires = wire_lines(plan)
    ways = dict[int, float]()
    for connector, line in zip(plan.connectors, channel_lines(plan, parameters), strict=True):
        # a later patch's channel ends at a cell of an earlier one
        ends = {i: math.dist(plan.cells[i].centroid.coords[0], line[-1]) for i in ways}
        before = min(ends, key=lambda i: ends[i], default=connector)
        ways[connector] = length_of(line) + ways.get(before, 0.0)
        for i, j in plan.route:  # a tree, from the connectors outwards
            if i in ways and j not in ways:
                ways[j] = ways[i] + length_of(wires[j])
    return ways


def lead_lengths(plan: ShoePlan, parameters: ShoeParameters) -> list[float]:
    """Gives length in mm of each cell's own lead, by plan and parameters: its way to the heel, up behind it, and on to
    the read-out.
    """
    ways = cable_ways(plan, parameters)
    rise = parameters.thickness - parameters.bottom + _SLACK
    return [ways[k] + rise for k in range(len(plan.cells))]


def hole_outline(plan: ShoePlan, parameters: ShoeParameters) -> Any:
    """Gives shapely cable hole behind the wall, by plan and parameters; empty without a board."""
    if not plan.heel.board:
        return shapely.Polygon()

    p = parameters
    half = min(0.5 * p.channel_width + _WIDER, 0.5 * p.board_length - POST - 0.5)
    return plan.heel.placed(shapely.box(-p.board_gap, -half, -HOLE_OFF, half))


_SQUARE = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))


def _patch_of(plan: ShoePlan, connector: int) -> list[int]:
    inside = {connector}
    for i, j in plan.route:  # a tree, from the connector outwards
        if i in inside:
            inside.add(j)
    return sorted(inside)


def wiring_steps(plan: ShoePlan, parameters: ShoeParameters) -> tuple[list[Block], list[Step]]:
    """Gives blocks of the board's holder behind the heel, and steps that cut slot and hole, by plan and parameters."""
    p = parameters
    heel = plan.heel
    if not heel.board:
        return [], []
    half = 0.5 * p.board_length
    play = p.made_by.slide
    back = -holder_depth(p)
    outer = half + POST + play
    low_x, _, high_x, _ = plan.rim.bounds
    length = high_x - low_x
    inner = 0.2 * length  # well inside: what reaches into the foot's place is cut away
    inside = plan.contact.buffer(-_WITHIN)  # no edge along another, which the kernel might miss by a hair

    def block(y: tuple[float, float], z: tuple[float, float]) -> Block:
        # Behind the plate as it is, up to where the plate is as wide; farther in only what meets the plate.
        full = _WITHIN
        for v in y:
            start = heel.point(back, v)
            end = heel.point(0.5 * length, v)
            full = max(full, back + _WITHIN + shapely.Point(start).distance(shapely.LineString([start, end]) & inside))
        behind, on = (heel.placed(shapely.box(back, y[0], x, y[1])) for x in (full, max(inner, full)))
        shape = on & (behind | inside)
        # Not on the grid: edges of blocks that lie along each other would leave a hair between them.
        return Block(max(getattr(shape, "geoms", [shape]), key=lambda g: g.area), *z)

    shelf = block((-outer, outer), (p.bottom, p.thickness))
    posts = [block(y, (p.thickness - 1.0, p.rim_top)) for y in ((half - POST, outer), (-outer, POST - half))]
    slot = heel.placed(shapely.box(back + LIP, -half - play, -p.board_gap, half + play))
    bevel = slot_entry(p)
    entry = tapered(slot, -0.02, bevel, p.rim_top - bevel, p.rim_top + 0.02) if bevel > 0.0 else None
    cuts = (
        Block(slot, p.thickness, p.rim_top + 1.0),
        *([] if entry is None else [entry]),
        Block(hole_outline(plan, p), p.bottom - 1.0, p.thickness + 1.0),
    )
    return [shelf, *posts], [Step("cut", "slot of the connection board and hole of the cable", cuts)]
