"""Coupons: small prints to try a cell's and a holder's fit. In mm."""

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.shoes.build import Progress, ShoeBuild
from plantar.shoes.papers.mesh_files import write_stl
from plantar.shoes.plan.block import Block, Step
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.solid.body import insole_steps, shoe_steps
from plantar.shoes.solid.kernel import build_solid
from plantar.shoes.solid.retention import Retention, choose_retention

_FLANGE = 2.0  # mm of plate around the cell's ribs
_SHEET = 15.0  # mm of a sheet's recess to each side of a point of its edge, and forward of it
# mm of shoe next to, within and outside of what holds it
_BESIDE = 10.0
_INWARDS = 16.0
_OUTWARDS = 30.0
_MORE = 2.0  # mm that blocks reach beyond what is kept
_NAMES = {"clips": "clip", "straps": "lug", "screws": "screw"}


@dataclass(frozen=True)
class Coupon:
    """Piece of the left shoe: "cell", "clip", "lug" or "screw", its purpose (text), outline from above (window, shapely
    in mm) and triangles (n, 3, 3) in mm.
    """

    name: str
    text: str
    window: Any
    surface: NDArray[np.float64]


def build_coupons(build: ShoeBuild, *, progress: Progress | None = None) -> tuple[Coupon, ...]:
    """Gives pieces of a build's left shoe or insole, a cell with port and a holder; progress receives fraction and
    text.
    """
    plan = build.shoes[0].plan
    p = build.parameters
    if plan.side != "left":
        raise InputError("a coupon is a piece of the left shoe, which the right one mirrors; use side left or both")
    report = progress or (lambda fraction, text: None)
    if build.kind == "insole":
        retention = Retention("none", (), 0.0, 0.0, "")
        steps = insole_steps(plan, p)
    else:
        retention = choose_retention(build.foot, plan, p)
        steps = shoe_steps(build.foot, plan, retention, p)
    windows = [("cell", _cell_text(plan), _cell_window(plan, build))]
    if retention.places:
        name = _NAMES[retention.kind]
        windows.append((name, f"the foot's edge, with its {name}: {_place_text(retention)}", _holder(plan, retention)))
    out = []
    for i, (name, text, window) in enumerate(windows):
        report(i / len(windows), f"building the coupon of a {name}")
        out.append(Coupon(name, text, window, build_solid(_limited(steps, window)).surface))
    return tuple(out)


def _cell(plan: Any) -> int:
    joined: set[int] = {i for pair in plan.route for i in pair} or set(range(len(plan.cells)))
    middle = plan.contact.centroid
    return min(joined, key=lambda i: (-round(plan.cells[i].area, 1), plan.cells[i].centroid.distance(middle)))


def _cell_text(plan: ShoePlan) -> str:
    cell = int(plan.layout.ids[_cell(plan)])
    kind = "tile" if plan.cell is None else plan.cell.kind
    if kind == "sheet":
        return "a piece of the sheet's recess with its edge: the sheet lies flat in it, level with the print around it"
    if kind == "film":
        return f"one sensor, id {cell}, with its pocket and ports: the film lies flat in it, its tail in the slot"
    return f"one cell, id {cell}, with its ribs and ports: its base goes in by hand and its head meets the groove"


def _cell_window(plan: ShoePlan, build: ShoeBuild) -> Any:
    rib = build.parameters.rib
    if plan.cell is not None and plan.cell.kind == "sheet":
        recess = plan.pockets[0]
        x, y = min(shapely.get_coordinates(recess.exterior).tolist())
        return shapely.box(x - rib - _FLANGE, y - _SHEET, x + _SHEET, y + _SHEET).intersection(
            recess.buffer(rib + _FLANGE, join_style="mitre")
        )
    at = _cell(plan)
    wider = [plan.cells[at].buffer(0.5 * rib, join_style="mitre"), plan.pockets[at].buffer(rib, join_style="mitre")]
    return shapely.union_all(wider).buffer(_FLANGE, join_style="mitre")


def _place_text(retention: Retention) -> str:
    place = retention.places[-1]
    return f"the {'left' if place.side > 0 else 'right'} one at x = {place.x:.0f} mm"


def _holder(plan: Any, retention: Retention) -> Any:
    place = retention.places[-1]
    half = 0.5 * retention.width + _BESIDE
    strip = plan.contact.intersection(shapely.box(place.x - half, -1e3, place.x + half, 1e3)).bounds
    edge = strip[3] if place.side > 0 else strip[1]
    inner, outer = sorted((edge - place.side * _INWARDS, edge + place.side * _OUTWARDS))
    return shapely.box(place.x - half, inner, place.x + half, outer)


def _limited(steps: tuple[Step, ...], window: Any) -> tuple[Step, ...]:
    """Steps within a window, and one that cuts off the rest."""
    around = window.buffer(_MORE, join_style="mitre")
    kept = []
    for step in steps:
        blocks: list[Any] = []
        for block in step.blocks:
            low = block.low if isinstance(block, Block) else block.line
            if not low.intersects(around):
                continue
            if isinstance(block, Block) and block.high is None:
                part = low.intersection(around)
                pieces = getattr(part, "geoms", [part])
                blocks += [replace(block, low=q) for q in pieces if q.geom_type == "Polygon" and q.area > 1e-6]
            else:
                blocks.append(block)
        kept.append(replace(step, blocks=tuple(blocks)))
    levels = [z for s in kept for b in s.blocks for z in (b.z_low, b.z_high)]
    low_x, low_y, high_x, high_y = around.bounds
    frame = shapely.box(low_x - 1e3, low_y - 1e3, high_x + 1e3, high_y + 1e3).difference(window)
    return (*kept, Step("cut", "around the coupon", (Block(frame, min(levels) - 1.0, max(levels) + 1.0),)))


def write_coupons(coupons: tuple[Coupon, ...], folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Write coupons into a folder as `coupon_<name>.stl`; returns file names."""
    names = []
    for coupon in coupons:
        path = Path(folder) / f"coupon_{coupon.name}.stl"
        try:
            write_stl(coupon.surface, path)
        except OSError as error:
            raise InputError(f"cannot write {path}: {error.strerror}") from None
        names.append(path.name)
    return tuple(names)
