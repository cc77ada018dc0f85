"""A shoe's wiring: a list of the cells, and a drawing of their boards as DXF. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely

from plantar.csv_table import csv_text
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.geometry.outline import ring
from plantar.shoes.papers.bill import WINDOW
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import cable_outlines, channel_lines, hole_outline, length_of, wire_lines
from plantar.shoes.units import to_mm

__all__ = ["cells_dxf", "wiring_text"]

_HEADER = ("side", "cell", "patch", "x_mm", "y_mm", "area_mm2", "hop", "from_cell", "port_x_mm", "port_y_mm", "wire_mm")
_SHEET_HEADER = ("row", "column")


def wiring_text(shoes: tuple[Shoe, ...], parameters: ShoeParameters) -> str:
    """The cells of each shoe in the order of the cable, as CSV.

    Args:
        shoes: The shoes.
        parameters: Dimensions as used.

    Returns:
        The text, a header first. A wire runs from the centre of the cell before it through the port to its own; of a
        connector along its channel. Without ways for a cable only place and area.
    """
    rows: list[list[Any]] = []
    sheet = shoes[0].plan.lines is not None
    for shoe in shoes:
        plan, ids = shoe.plan, shoe.layout.ids.tolist()
        centres = to_mm(shoe.layout.positions[:, :2])
        patch = {c: n for n, c in enumerate(plan.connectors)}
        hop = dict.fromkeys(plan.connectors, 0)
        before: dict[int, int] = {}
        wires = wire_lines(plan)
        wires |= dict(zip(plan.connectors, channel_lines(plan, parameters), strict=True))
        for i, j in plan.route:  # a tree, from the connectors outwards
            patch[j], hop[j], before[j] = patch[i], hop[i] + 1, i
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
    """Outlines for flexible boards as DXF (R12, mm), seen from above.

    Args:
        shoe: The shoe.
        build: Its build.

    Returns:
        The text; layers CELLS (heads), POCKETS, BASES, WINDOWS (holes of the pad), OUTLINE (contact face), KEEPOUT
        (where no board may be), and of a sheet ROWS and COLUMNS.
    """
    p, plan = build.parameters, shoe.plan
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
    lines = ["0", "SECTION", "2", "HEADER", "9", "$INSUNITS", "70", "4", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    for layer, shapes in layers.items():
        for shape in shapes:
            for part in getattr(shape, "geoms", [shape]):
                if part.geom_type == "Polygon" and not part.is_empty:
                    lines += _polyline(np.asarray(ring(part)), layer)
    return "\n".join([*lines, "0", "ENDSEC", "0", "EOF", ""])


def _electrodes(shoe: Shoe) -> dict[str, tuple[Any, ...]]:
    """A sheet's electrodes, each from its first crossing to its last."""
    plan, cell = shoe.plan, shoe.plan.cell
    assert plan.lines is not None
    assert plan.crossings is not None
    assert cell is not None
    middles = plan.crossings
    half, out = 0.5 * cell.line_width, {}
    for layer, axis in (("ROWS", 0), ("COLUMNS", 1)):
        on = [middles[plan.lines[:, axis] == k] for k in np.unique(plan.lines[:, axis])]
        ends = [(at.min(axis=0) - half, at.max(axis=0) + half) for at in on]
        out[layer] = tuple(shapely.box(*low, *high) for low, high in ends)
    return out


def _polyline(points: Any, layer: str) -> Iterator[str]:
    yield from ("0", "POLYLINE", "8", layer, "66", "1", "70", "1")
    for x, y in points.tolist():
        yield from ("0", "VERTEX", "8", layer, "10", f"{x:.4f}", "20", f"{y:.4f}", "30", "0.0")
    yield from ("0", "SEQEND", "8", layer)
