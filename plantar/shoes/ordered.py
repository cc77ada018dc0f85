"""An order's shoe or insole, built, or its coupons."""

from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from plantar.errors import InputError
from plantar.shoes.build import Progress, ShoeBuild, build_insole, build_shoe
from plantar.shoes.cell_choice import choose_cell
from plantar.shoes.cells.cell import Cell, read_cell
from plantar.shoes.coupon import build_coupons, write_coupons
from plantar.shoes.foot.foot import Foot
from plantar.shoes.order import ShoeOrder
from plantar.shoes.parameters import ShoeParameters


def build_ordered(
    foot: Foot,
    order: ShoeOrder,
    parameters: ShoeParameters,
    taxels: int | None = None,
    progress: Progress | None = None,
) -> ShoeBuild:
    """Gives an order's shoe or insole for a foot, by parameters and taxels of its robot; for coupons, only layouts;
    progress receives fraction and text.
    """
    light = order.layout_only or order.coupon
    common: dict[str, Any] = {"side": order.side, "cell_area": order.cell_area, "name": order.name}
    common |= {"parameters": parameters, "layout_only": light, "progress": progress}
    common["cell"] = ordered_cell(order)
    if order.cell == "auto" and order.insole is not None:
        raise InputError("--cell auto chooses for a robot's shoe; of an insole give --cell velostat")
    if order.coupon and order.layout_only:
        raise InputError("--coupon writes prints, --layout-only none; give one of them")
    if order.coupon and order.side == "right":
        raise InputError("a coupon is a piece of the left shoe, whose mirror image the right one is; leave --side out")
    if order.insole is None:
        reasons: tuple[str, ...] = ()
        if order.cell == "auto":
            choice = choose_cell(foot, parameters)
            common["cell"] = choice.cell
            reasons = choice.notes
        rim = order.rim or "whole"
        wanted = order.taxels if order.taxels is not None or rim == "fine" or order.cell is not None else taxels
        build = build_shoe(foot, taxels=wanted, overhang=order.overhang, rim=cast(Any, rim), **common)
        return replace(build, notes=(*reasons, *build.notes))
    if order.taxels is not None or order.overhang > 0.0:
        raise InputError("an insole takes the taxels that fit in the foot's outline; leave out --taxels, --overhang")
    return build_insole(foot, order.insole, rim=cast(Any, order.rim or "fine"), **common)


def ordered_cell(order: ShoeOrder) -> Cell | None:
    """Cell of an order; None for skin hexagons, and where it is to be chosen."""
    if order.cell is None:
        return None
    if order.rim == "fine":
        raise InputError("a fine rim is made of skin; with --cell leave --rim out, or give --rim whole")
    if order.cell_area != ShoeOrder().cell_area:
        raise InputError("--cell states how large a cell is; leave --cell-area out")
    return None if order.cell == "auto" else read_cell(order.cell)


def write_ordered_coupons(build: ShoeBuild, folder: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Build a build's coupons into a folder, progress receives fraction and text; returns plain JSON values."""
    coupons = build_coupons(build, progress=progress)
    files = write_coupons(coupons, folder)
    rows = [
        {"name": c.name, "what": c.text, "size_mm": np.ptp(c.surface.reshape(-1, 3), axis=0).round(2).tolist()}
        for c in coupons
    ]
    return {"coupons": rows, "notes": list(build.notes), "files": list(files), "parameters": build.parameters.as_dict()}


def coupons_text(summary: dict[str, Any]) -> str:
    """Coupons for people."""
    lines = [f"  {note}" for note in summary["notes"]]
    for row in summary["coupons"]:
        size = " x ".join(f"{v:.1f}" for v in row["size_mm"])
        lines.append(f"coupon of a {row['name']}, {size} mm: {row['what']}")
    return "\n".join([*lines, *(f"  {name}" for name in summary["files"])])
