"""Bill of parts: what is printed, cut and bought, with weights."""

import math
from dataclasses import asdict, dataclass

import numpy as np

from plantar.common.table_writer import csv_text
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.cells.cell import Cell
from plantar.shoes.checks.printability import BOARD_UP, Weights
from plantar.shoes.papers.orders import (
    Order,
    board_order,
    foam_order,
    glue_order,
    nut_order,
    print_order,
    screw_length,
    screw_order,
    silicone_order,
    strap_order,
)
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import tail_lines
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.wiring import cable_ways
from plantar.shoes.wiring.nets import Wiring

WINDOW = 5.0  # diameter in mm of a hole in the pad through which a taxel's infrared sensor looks


@dataclass(frozen=True)
class Part:
    """Bill line for one shoe; mass in g of all its parts, or None; `order`: what to ask a shop or workshop for."""

    part: str
    quantity: int
    material: str
    size: str
    mass_g: float | None
    note: str
    order: str = ""
    address: str = ""


def bill_of_parts(shoe: Shoe, build: ShoeBuild, weights: Weights, wiring: Wiring | None = None) -> list[Part]:
    """Gives parts of a build's shoe with weights and wiring."""
    p = build.parameters
    plan = shoe.plan
    side = shoe.side
    low_x, low_y, high_x, high_y = plan.contact.bounds
    outline = f"{high_x - low_x:.1f} x {high_y - low_y:.1f}"
    flat = build.kind == "insole"
    size = f"{outline} x {p.thickness - p.bottom:g} mm" if flat else f"{outline} x {p.rim_top - p.bottom:g} mm and more"
    parts = [
        Part(
            f"{build.kind}, {side}", 1, p.material, size, weights.printed,
            f"printed from {build.kind}_{side}.stl, .3mf or .step",
            *print_order(f"{build.kind}_{side}.step", p),
        )
    ]  # fmt: skip
    if p.pad_thickness > 0.0:
        parts.append(
            Part(
                f"pad, {side}", 1, p.pad_material,
                f"{outline} x {p.pad_thickness + p.pad_rim_height:g} mm", weights.pad,
                f"cut or cast to pad_{side}.stl, {_window(plan)}; glued to the taxels, replaced when worn",
                *_pad_order(side, p),
            )
        )  # fmt: skip
    cut = int((build.fit.shares < 1.0 - 1e-6).sum())
    patches = f"in {len(plan.connectors)} patch(es)" if plan.connectors else "wired by themselves"
    note = patches + (f"; {cut} of them trimmed at the rim" if cut else "")
    made = p.made_by
    base = f"base {made.slide:g} mm smaller a side than its pocket, {made.sag + 2.0 * made.scatter:.2g} mm lower"
    size = f"{build.fit.cell_area:g} mm2 x {p.taxel_protrusion + p.pocket_depth:g} mm, {base}"
    cell = plan.cell
    if cell is None:
        order = "no shop sells the papers' skin; cells that can be bought: --cell auto"
        parts.append(Part("taxel", len(shoe.layout), "skin", size, weights.skin, note, order))
    elif plan.lines is not None:
        rows, columns = plan.sheet_lines
        note = f"{rows} rows x {columns} columns, tail of {tail_lines(plan)} lines; outline in cells_{side}.dxf"
        size = f"{cell.thickness:g} mm thick, cut to layer OUTLINE of cells_{side}.dxf"
        parts.append(Part(f"sheet {cell.label}", 1, "sensor sheet", size, weights.skin, note, *_ordered(cell)))
    else:
        across = " x ".join(f"{v:g}" for v in dict.fromkeys(np.round(cell.body, 2).tolist()))
        size = f"{across} mm" + (f" x {cell.thickness:g} mm" if cell.thickness else "")
        parts.append(
            Part(f"cell {cell.label}", len(shoe.layout), cell.shape, size, weights.skin, note, *_ordered(cell))
        )
    if plan.heel.board:
        size = f"{p.board_length:g} x {BOARD_UP:g} x {p.board_thickness:g} mm"
        note = "slides into the rails behind the heel"
        parts.append(Part("connection board", 1, "FR4", size, weights.board, note, *board_order(p)))
    if wiring is not None:
        parts += [
            Part(b.what, b.quantity, b.references, "", None, "read-out", f"{b.maker} {b.part}", b.address)
            for b in wiring.bought
        ]
    elif plan.connectors:
        length = f"{math.ceil(_cable(plan, p))} mm or longer"
        order = f"flat cable, {length}, as the laboratory's cells take it"
        parts.append(Part("cable", len(plan.connectors), "flat", length, None, "patch to heel, in the channel", order))
    note = "cells into their pockets, a sheet at its rim" + (", the pad" if p.pad_thickness > 0.0 else "")
    parts.append(Part("adhesive", 1, "silicone", "one tube", None, note, *glue_order()))
    return parts + _holding(build, high_y - low_y)


def _ordered(cell: Cell) -> tuple[str, str]:
    """What to ask a shop for a cell, and the address of its data sheet."""
    return f"{cell.maker} {cell.part}".strip(), cell.data_sheet


def _pad_order(side: str, p: ShoeParameters) -> Order:
    if p.pad_kind == "plate":
        return print_order(f"pad_{side}.stl", p)
    return foam_order(p) if p.pad_foam > 0.0 else silicone_order(side, p)


def _window(plan: ShoePlan) -> str:
    proximity = "proximity" in plan.layout.modalities
    return f"holes of {WINDOW:g} mm at the taxels' centres where infrared looks out" if proximity else "no holes"


def _cable(plan: ShoePlan, p: ShoeParameters) -> float:
    ways = cable_ways(plan, p)
    return max(ways[c] for c in plan.connectors) + (p.thickness - p.bottom + BOARD_UP if plan.heel.board else 0.0)


def _holding(build: ShoeBuild, width: float) -> list[Part]:
    p = build.parameters
    retention = build.retention
    if retention is None or not retention.places:
        return []
    if retention.kind == "straps":
        over = 2.5 * (width + 2.0 * min(build.foot.height, 80.0))
        size = f"{retention.width:g} x {p.strap_thickness:g} mm, {10 * math.ceil(over / 10):g} mm long"
        note = "over the instep, through the lugs"
        return [Part("strap", retention.straps, "hook and loop", size, None, note, *strap_order(retention.width))]
    if retention.kind == "screws":
        length = screw_length(p.rim_thickness + 2.0 * retention.width)
        count = len(retention.places)
        note = "through the wall, clamps the foot's sides"
        thread = f"M{retention.width:g}"
        screw = screw_order(retention.width, length)
        return [
            Part("set screw", count, "steel", f"{thread} x {length:g} mm", None, note, *screw),
            Part("nut", count, "steel", thread, None, "in the slot of the boss", *nut_order(retention.width)),
        ]
    return []


def bill_text(bills: dict[str, list[Part]]) -> str:
    """Each side's bill of parts as CSV."""
    rows = ([side, *asdict(part).values()] for side, parts in bills.items() for part in parts)
    return csv_text(["side", *Part.__dataclass_fields__], rows)
