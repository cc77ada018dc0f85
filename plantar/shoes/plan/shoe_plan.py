"""Sole from above in mm: contact face, rim, pockets, cable, and layout."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError, LayoutError
from plantar.layouts.cell_layout import layout_of_cells
from plantar.layouts.layout import Side, SoleLayout, mirrored
from plantar.layouts.tiling import hex_layout
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.fine_rim import blind_rim
from plantar.shoes.fit.taxels import TaxelFit, rows_and_columns
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import GRID, flush, grown, ring, single_outline, tidy
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import moved_edges
from plantar.shoes.plan.heel import Heel, find_heel
from plantar.shoes.units import to_m, to_mm

_TOUCH = 1e-3  # mm between cells that share an edge
_PORT_SHARE = 0.6  # of a shared edge or a body: the widest port
_LAND_PLAY = 0.3  # mm between a sheet's land and its recess
_PASSABLE = 6.0  # mm of a shared edge: a port in a shorter one is narrow for a cable


@dataclass(frozen=True)
class ShoePlan:
    """One shoe's shapely outlines in mm in its sole frame, and its layout.

    Attributes:
        foot: Below the rim's upper edge.
        contact: Pad, and plate but for heel shelf and lugs.
        cavity: Inside of the rim at its upper edge.
        rim: Outside of the rim.
        cells: In the layout's taxel order.
        pockets: Cells less half a rib, or bodies with play; a sheet's recess.
        route: Pairs of taxel indices joined by cable, from the connectors outwards.
        connectors: Taxel index of each patch's cable exit, the heel's first.
        lines: Row and column (n, 2) of sheet cells.
        crossings: Of these, (n, 2) in mm.
    """

    side: Side
    foot: Any
    contact: Any
    cavity: Any
    rim: Any
    cells: tuple[Any, ...]
    pockets: tuple[Any, ...]
    route: tuple[tuple[int, int], ...]
    connectors: tuple[int, ...]
    heel: Heel
    layout: SoleLayout
    notes: tuple[str, ...] = ()
    cell: Cell | None = None
    lines: NDArray[np.int64] | None = None
    crossings: NDArray[np.float64] | None = None

    @cached_property
    def lands(self) -> tuple[Any, ...]:
        """Shapely pad parts that press on films or a sheet."""
        if self.cell is None or self.cell.kind == "tile":
            return ()
        if self.cell.kind == "film":
            return self.cells
        # Only below cells: what presses next to them would not be measured.
        land = shapely.union_all(self.cells, grid_size=GRID).intersection(self.pockets[0].buffer(-_LAND_PLAY))
        parts = shapely.get_parts(shapely.set_precision(land, GRID))
        return tuple(shapely.geometry.polygon.orient(q) for q in parts if q.geom_type == "Polygon")

    def port(self, i: int, j: int) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
        """Cable passage from taxel i to j.

        Returns:
            Ends (2, 2) of the way through the rib between the pockets; unit vector (2,) across; most width in mm.
        """
        if self.cell is None:
            edge = self.shared_edge(i, j)
            middle = edge.mean(axis=0)
            across = edge[1] - edge[0]
            length = float(np.hypot(*across))
            across = across / length
            along = np.array([across[1], -across[0]])
            return np.stack([middle - along, middle + along]), across, _PORT_SHARE * length
        ends = to_mm(self.layout.positions[[i, j], :2])
        line = shapely.LineString(ends)
        step = (ends[1] - ends[0]) / line.length
        leaves = max(line.project(shapely.Point(c)) for c in _crossed(self.pockets[i], line))
        enters = min(line.project(shapely.Point(c)) for c in _crossed(self.pockets[j], line))
        across = np.array([-step[1], step[0]])
        body = self.cell.tail_width or min(self.cell.body)
        return np.stack([ends[0] + leaves * step, ends[0] + enters * step]), across, _PORT_SHARE * body

    @property
    def sheet_lines(self) -> tuple[int, int]:
        assert self.lines is not None
        return rows_and_columns(self.lines)

    @property
    def overhang(self) -> float:
        """Contact face's reach beyond the foot, in mm."""
        return float(max(self.foot.distance(shapely.points(ring(self.contact)))))

    @property
    def blind_rim(self) -> float:
        """Contact face's widest place beyond the hull of taxel centres, in mm."""
        return blind_rim(self.contact, to_mm(self.layout.positions[:, :2]))

    def shared_edge(self, i: int, j: int) -> NDArray[np.float64]:
        """Gives ends (2, 2) in mm of the longest line shared by cells i and j, up to rounding."""
        common = self.cells[i].exterior.intersection(self.cells[j].buffer(_TOUCH))
        lines = [shapely.get_coordinates(line) for line in shapely.get_parts(shapely.line_merge(common))]
        ends = [np.stack(pair) for line in lines for pair in pairwise(line)]
        return max(ends, key=lambda pair: float(np.hypot(*(pair[1] - pair[0]))))

    @property
    def fewest_taxels(self) -> tuple[int, str]:
        """Taxels in the barest of five places, and its name: thirds along the foot, and left and right bands of a third
        of the width or a taxel.
        """
        x, y = to_mm(self.layout.positions[:, :2]).T
        low_x, low_y, high_x, high_y = self.contact.bounds
        third = (high_x - low_x) / 3.0
        band = max((high_y - low_y) / 3.0, float(self.cells[0].area) ** 0.5)
        counts = {
            "heel's third": int((x < low_x + third).sum()),
            "middle third": int(((x >= low_x + third) & (x <= high_x - third)).sum()),
            "toes' third": int((x > high_x - third).sum()),
            "left band": int((y > high_y - band).sum()),
            "right band": int((y < low_y + band).sum()),
        }
        where = min(counts, key=lambda name: counts[name])
        return counts[where], where


def plan_shoe(foot: Foot, fit: TaxelFit, parameters: ShoeParameters, *, name: str | None = None) -> ShoePlan:
    """Gives left plan of a foot and fit by parameters, its face around the foot's rim and taxels' border, layout with a
    name or the foot's.
    """
    outline = foot.passing(parameters.rim_height)
    cavity = tidy(grown(outline, parameters.clearance))
    rim = tidy(grown(outline, parameters.clearance + parameters.rim_thickness))
    # Corners that cells share are bit-identical, so the union leaks no slivers.
    patch = shapely.union_all([shapely.Polygon(c) for c in (fit.cells if fit.rooms is None else fit.rooms)])
    walls = patch.convex_hull if patch.geom_type == "Polygon" else patch
    shape = rim.union(grown(walls, fit.border))
    contact = flush(single_outline(shape, shape.convex_hull, detail=0.0), rim)
    return plan_face(outline, contact, cavity, rim, fit, parameters, name=name or foot.name)


def plan_face(
    outline: Any, contact: Any, cavity: Any, rim: Any, fit: TaxelFit, parameters: ShoeParameters, *, name: str
) -> ShoePlan:
    """Gives left plan with pockets, layout of a name and cable of a contact face, by foot outline, cavity and rim
    (inside and outside of the wall), fit and parameters.
    """
    cells = tuple(shapely.Polygon(c) for c in fit.cells)
    if fit.pockets is not None:
        pockets = tuple(shapely.Polygon(p) for p in fit.pockets)
    else:
        pockets = tuple(_pocket(c, parameters.rib) for c in cells)
        if any(p is None or p.area < 0.1 * c.area for p, c in zip(pockets, cells, strict=True)):
            raise FootError(
                f"cells of {fit.cell_area:g} mm^2 leave no pocket between ribs of {parameters.rib:g} mm; "
                "use larger cells or a thinner rib"
            )
    layout = _layout(contact, fit, name)
    heel, note = find_heel(rim, outline, parameters)
    neighbours = _passable(layout) if fit.links is None else _linked(fit.links, len(layout))
    connectors, route = _route(layout, neighbours, (heel.x, heel.y))
    if fit.lines is not None:  # one sheet, whose tail leaves where it is nearest to the heel
        connectors = connectors[:1]
        route = ()
    if parameters.port_width <= 0.0:
        heel = replace(heel, board=False)
        connectors = ()
        route = ()
        note = "no ports, channel or board for a cable (port_width 0): the cells are to be wired by themselves"
    notes = () if note is None else (note,)
    kinds = (fit.cell, fit.lines, fit.crossings)
    return ShoePlan(
        "left", outline, contact, cavity, rim, cells, pockets, route, connectors, heel, layout, notes, *kinds
    )


def _crossed(pocket: Any, line: Any) -> NDArray[np.float64]:
    return np.asarray(shapely.get_coordinates(pocket.exterior.intersection(line)))


def _linked(links: Sequence[tuple[int, int]], count: int) -> tuple[tuple[int, ...], ...]:
    near: list[list[int]] = [[] for _ in range(count)]
    for i, j in links:
        near[i].append(j)
        near[j].append(i)
    return tuple(tuple(sorted(n)) for n in near)


def _pocket(cell: Any, rib: float) -> Any | None:
    moved = moved_edges(ring(cell), -0.5 * rib)
    if moved is not None:
        return shapely.Polygon(moved)
    shape = cell.buffer(-0.5 * rib, join_style="mitre")  # a cut cell with an edge that vanishes
    return shape if shape.geom_type == "Polygon" and not shape.is_empty else None


def _layout(contact: Any, fit: TaxelFit, name: str) -> SoleLayout:
    outline = to_m(ring(contact)).round(6)
    shape = "hexagon" if fit.blind_most is None else "mixed"
    if fit.cell is not None:
        shape = {"hex": "hexagon", "round": "polygon"}.get(fit.cell.shape, "rectangle")
    try:
        if fit.lattice_cells is not None:
            x, y = fit.lattice.origin
            layout = hex_layout(
                outline,
                name=name,
                side="left",
                cell_area=fit.cell_area * 1e-6,
                origin=(to_m(x), to_m(y)),
                angle=fit.lattice.angle,
                cells=fit.lattice_cells,
            )
        else:
            layout = layout_of_cells(
                [to_m(c) for c in fit.cells], name=name, side="left", outline=outline, cell_shape=shape
            )
            layout = replace(layout, cell_area=fit.cell_area * 1e-6)
        if fit.cell is None:
            return layout
        ranges = {**layout.ranges, "force": (0.0, fit.cell.rated_load)}
        thresholds = {**layout.thresholds, "force": fit.cell.threshold}
        return replace(layout, modalities=("force",), ranges=ranges, thresholds=thresholds)
    except LayoutError as error:
        raise FootError(f"the shoe's outline cannot carry a layout: {error}") from None


def _route(
    layout: SoleLayout, neighbours: Sequence[Sequence[int]], heel: tuple[float, float]
) -> tuple[tuple[int, ...], tuple[tuple[int, int], ...]]:
    """Each patch's taxel nearest the heel, and the tree of fewest hops from it."""
    centres = layout.positions[:, :2]
    distance = np.hypot(*(centres - to_m(np.array(heel))).T)
    left = set(range(len(layout)))
    connectors: list[int] = []
    route: list[tuple[int, int]] = []
    while left:
        rest = sorted(left)
        first = rest[int(np.argmin(distance[rest]))]
        connectors.append(first)
        left.discard(first)
        queue = deque([first])
        group = [first]
        while queue:
            here = queue.popleft()
            for near in sorted(neighbours[here], key=lambda j: (round(float(distance[j]), 9), j)):
                if near in left:
                    left.discard(near)
                    route.append((here, near))
                    queue.append(near)
                    group.append(near)
        if left:
            gaps = np.hypot(*(centres[:, None] - centres[None, group]).transpose(2, 0, 1)).min(axis=1)
            distance = gaps if len(connectors) == 1 else np.minimum(distance, gaps)
    return tuple(connectors), tuple(route)


def _passable(layout: SoleLayout) -> tuple[tuple[int, ...], ...]:
    edges = [set(map(frozenset, pairwise((*c, c[0])))) for c in layout.corners]

    def shared(i: int, j: int) -> float:
        ends = [layout.vertices[list(edge)] for edge in edges[i] & edges[j]]
        return to_mm(sum(float(np.hypot(*(b - a)[:2])) for a, b in ends))

    long = tuple(tuple(j for j in own if shared(i, j) >= _PASSABLE) for i, own in enumerate(layout.neighbours))
    return long if _groups(long) == _groups(layout.neighbours) else layout.neighbours


def _groups(neighbours: Sequence[Sequence[int]]) -> int:
    left = set(range(len(neighbours)))
    count = 0
    while left:
        count += 1
        queue = [left.pop()]
        while queue:
            near = left.intersection(neighbours[queue.pop()])
            left -= near
            queue += near
    return count


def mirrored_plan(plan: ShoePlan) -> ShoePlan:
    """Plan of the other shoe: y changes sign, taxel ids stay."""

    def flip(polygon: Any) -> Any:
        return shapely.geometry.polygon.orient(shapely.Polygon(ring(polygon) * np.array([1.0, -1.0])))

    layout = mirrored(plan.layout)
    return ShoePlan(
        layout.side,
        flip(plan.foot),
        flip(plan.contact),
        flip(plan.cavity),
        flip(plan.rim),
        tuple(flip(c) for c in plan.cells),
        tuple(flip(p) for p in plan.pockets),
        plan.route,
        plan.connectors,
        plan.heel.mirrored(),
        layout,
        plan.notes,
        plan.cell,
        plan.lines,
        None if plan.crossings is None else plan.crossings * np.array([1.0, -1.0]),
    )


_PLAY = 0.3  # mm between the taxels' heads and the rim
_LEAST = 2.0  # mm: a narrower rim is left out


def pad_rim(plan: ShoePlan, parameters: ShoeParameters) -> Any:
    """Gives pad rim by plan and parameters: the contact face next to taxels, shapely, possibly empty."""
    if parameters.pad_rim_height <= 0.0:
        return shapely.Polygon()
    beside = plan.contact.difference(shapely.union_all(plan.cells).buffer(_PLAY, join_style="mitre"))
    wide = beside.buffer(-0.5 * _LEAST).buffer(0.5 * _LEAST, quad_segs=2).intersection(beside)
    parts = [p for p in getattr(wide, "geoms", [wide]) if p.geom_type == "Polygon" and p.area > _LEAST**2]
    return shapely.set_precision(shapely.MultiPolygon(parts), GRID) if parts else shapely.Polygon()
