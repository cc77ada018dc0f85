"""Cells of shoes in the order of their cable, and their outlines as DXF. In mm."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.table_writer import csv_text
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.geometry.outline import ring
from plantar.shoes.papers.bill import WINDOW
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import cable_outlines, channel_lines, hole_outline, length_of, wire_lines
from plantar.shoes.units import to_mm

_HEADER = ("side", "cell", "patch", "x_mm", "y_mm", "area_mm2", "hop", "from_cell", "port_x_mm", "port_y_mm", "wire_mm")
_SHEET_HEADER = ("row", "column")


def wiring_text(shoes: tuple[Shoe, ...], parameters: ShoeParameters) -> str:
    """Gives cells of each of the shoes in cable order as CSV, by parameters. Wires run from the last cell's centre
    through the port; a connector's along its channel.
    """
    rows: list[list[Any]] = []
    sheet = shoes[0].plan.lines is not None
    for shoe in shoes:
        plan = shoe.plan
        ids = shoe.layout.ids.tolist()
        centres = to_mm(shoe.layout.positions[:, :2])
        patch = {c: n for n, c in enumerate(plan.connectors)}
        hop = dict.fromkeys(plan.connectors, 0)
        before: dict[int, int] = {}
        wires = wire_lines(plan)
        wires |= dict(zip(plan.connectors, channel_lines(plan, parameters), strict=True))
        for i, j in plan.route:  # a tree, from the connectors outwards
            patch[j] = patch[i]
            hop[j] = hop[i] + 1
            before[j] = i
        for j in sorted(range(len(ids)), key=lambda k: (patch.get(k, 0), hop.get(k, 0), ids[k])):
            x, y = centres[j].round(3).tolist()
            port: list[Any] = ["", "", ""]
            if j in before:
                port = [ids[before[j]], *wires[j][1].round(3).tolist()]
            wire = round(length_of(wires[j]), 1) if j in wires else ""
            lines = [] if plan.lines is None else plan.lines[j].tolist()
            area = round(1e6 * float(shoe.layout.areas[j]), 2)
            rows.append([shoe.side, ids[j], patch.get(j, ""), x, y, area, hop.get(j, ""), *port, wire, *lines])
    return csv_text((*_HEADER, *(_SHEET_HEADER if sheet else ())), rows)


def cells_dxf(shoe: Shoe, build: ShoeBuild) -> str:
    """Gives outlines for flexible boards of a build's shoe as DXF (R12, mm): layers CELLS, POCKETS, BASES, WINDOWS (pad
    holes), OUTLINE, KEEPOUT (no board), and of a sheet ROWS and COLUMNS.
    """
    p = build.parameters
    plan = shoe.plan
    flip = 1.0 if shoe.side == "left" else -1.0
    keep_out = [*cable_outlines(plan, p), hole_outline(plan, p)]
    if build.retention is not None:
        for place in build.retention.places:
            half = 0.5 * build.retention.width
            side = place.side * flip
            wall = plan.contact.difference(plan.cavity)
            keep_out.append(wall.intersection(shapely.box(place.x - half, 0.0, place.x + half, side * 1e3)))
    layers: dict[str, tuple[Any, ...]] = {"CELLS": plan.cells, "POCKETS": plan.pockets}
    layers |= {"OUTLINE": (plan.contact,), "KEEPOUT": tuple(keep_out)}
    if plan.cell is None:
        layers["BASES"] = tuple(q.buffer(-p.made_by.slide, join_style="mitre") for q in plan.pockets)
        layers["WINDOWS"] = tuple(shapely.Point(c).buffer(0.5 * WINDOW) for c in to_mm(shoe.layout.positions[:, :2]))
    if plan.lines is not None:
        layers |= _electrodes(shoe)
    parts = [(layer, q) for layer, shapes in layers.items() for s in shapes for q in getattr(s, "geoms", [s])]
    return _dxf_of_rings((k, ring(q)) for k, q in parts if q.geom_type == "Polygon" and not q.is_empty)


def _dxf_of_rings(rings: Iterable[tuple[str, NDArray[np.float64]]]) -> str:
    """Closed polylines as DXF (R12, mm), by layer and corners (k, 2) of each."""
    out = ["0", "SECTION", "2", "HEADER", "9", "$INSUNITS", "70", "4", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    for layer, corners in rings:
        out += ["0", "POLYLINE", "8", layer, "66", "1", "70", "1"]
        for x, y in corners.tolist():
            out += ["0", "VERTEX", "8", layer, "10", f"{x:.4f}", "20", f"{y:.4f}", "30", "0.0"]
        out += ["0", "SEQEND", "8", layer]
    return "\n".join([*out, "0", "ENDSEC", "0", "EOF", ""])


def _electrodes(shoe: Shoe) -> dict[str, tuple[Any, ...]]:
    plan = shoe.plan
    cell = shoe.plan.cell
    assert plan.lines is not None
    assert plan.crossings is not None
    assert cell is not None
    middles = plan.crossings
    half = 0.5 * cell.line_width
    out = {}
    for layer, axis in (("ROWS", 0), ("COLUMNS", 1)):
        on = [middles[plan.lines[:, axis] == k] for k in np.unique(plan.lines[:, axis])]
        ends = [(at.min(axis=0) - half, at.max(axis=0) + half) for at in on]
        out[layer] = tuple(shapely.box(*low, *high) for low, high in ends)
    return out
