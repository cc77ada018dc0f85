"""The dimensioned drawing of a shoe: the contact face from below seen through, and a section along x."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, new_figure, save_figure
from shoes.build import Shoe, ShoeBuild
from shoes.check import section
from shoes.outline import ring
from shoes.units import to_mm

__all__ = ["draw_shoe", "section_along_x"]


def section_along_x(triangles: NDArray[np.float64], y: float) -> Any:
    """The solid's cross-section in the plane of a given y.

    Args:
        triangles: Closed surface (n, 3, 3) in mm.
        y: Where to cut, in mm.

    Returns:
        A shapely polygon or multipolygon over (x, z) in mm.
    """
    return section(triangles[..., [0, 2, 1]], y)


def draw_shoe(shoe: Shoe, build: ShoeBuild, triangles: NDArray[np.float64], path: str | os.PathLike[str]) -> Path:
    """Draw one shoe with its dimensions in mm.

    Args:
        shoe: The shoe.
        build: What it belongs to.
        triangles: Its surface (n, 3, 3) in mm.
        path: Where to write; the ending gives the format.

    Returns:
        The path.
    """
    plan, p = shoe.plan, build.parameters
    figure, (top, side) = new_figure(10.0, 9.0, rows=2, height_ratios=[3.2, 1.0])
    colour = COLOURS[shoe.side]
    for polygon, style in (
        (plan.contact, {"color": colour, "lw": 2.0, "label": "contact face"}),
        (plan.cavity, {"color": COLOURS["reference"], "lw": 1.0, "ls": "--", "label": "inside of the rim"}),
    ):
        _line(top, ring(polygon), **style)
    sole = ring(build.foot.sole) * (1.0 if shoe.side == "left" else np.array([1.0, -1.0]))
    _line(top, sole, color=COLOURS["truth"], lw=1.0, ls=":", label="sole of the foot")
    for i, pocket in enumerate(plan.pockets):
        cell = to_mm(shoe.layout.cell_polygon(i))
        top.fill(*cell.T, facecolor=COLOURS["cell"], edgecolor=COLOURS["edge"], lw=0.8)
        _line(top, ring(pocket), color=COLOURS["edge"], lw=0.4)
        x, y = to_mm(shoe.layout.positions[i, :2])
        top.text(x, y, str(int(shoe.layout.ids[i])), ha="center", va="center", fontsize=7)
    top.plot(0.0, 0.0, "+", color=COLOURS["truth"], ms=12, label="origin, below the ankle")
    low_x, low_y, high_x, high_y = plan.contact.bounds
    _dimension(top, (low_x, low_y - 12), (high_x, low_y - 12), f"{high_x - low_x:.1f}")
    _dimension(top, (low_x - 12, low_y), (low_x - 12, high_y), f"{high_y - low_y:.1f}")
    top.set_title(
        f"{shoe.layout.name}, {shoe.side} shoe, seen from above: {len(shoe.layout)} taxels of "
        f"{build.fit.lattice.area:g} mm², {100 * build.fit.covered_area_ratio:.0f} % of the sole covered, "
        f"overhang {plan.overhang:.1f} mm",
        fontsize=10,
    )
    top.set(
        xlabel="x, forward (mm)", ylabel="y, left (mm)", xlim=(low_x - 32, high_x + 10), ylim=(low_y - 24, high_y + 8)
    )
    top.set_aspect("equal")
    top.legend(loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=4, fontsize=8, frameon=False)
    cut_y = float(to_mm(shoe.layout.positions[np.argmin(np.abs(shoe.layout.positions[:, 1])), 1])) + 1e-3
    cut = section_along_x(triangles, cut_y)
    for part in getattr(cut, "geoms", [cut]):
        side.fill(*np.array(part.exterior.coords).T, facecolor=colour, alpha=0.6, edgecolor=COLOURS["truth"], lw=0.6)
        for hole in part.interiors:
            side.fill(*np.array(hole.coords).T, facecolor="white", edgecolor=COLOURS["truth"], lw=0.6)
    _dimension(side, (low_x - 8, 0.0), (low_x - 8, p.plate_thickness), f"{p.plate_thickness:g}")
    _dimension(side, (high_x + 8, 0.0), (high_x + 8, p.height), f"{p.height:g}")
    side.set_title(
        f"Section at y = {cut_y:.1f} mm: recess {p.patch_depth:g}, pockets {p.pocket_depth:g}, floor {p.floor:g}, "
        f"rim {p.rim_thickness:g}, clearance {p.clearance:g} mm",
        fontsize=10,
    )
    side.set(xlabel="x (mm)", ylabel="z (mm)", xlim=(low_x - 25, high_x + 25), ylim=(-4, p.height + 4))
    side.set_aspect("equal")
    return save_figure(figure, path)


def _line(axes: Any, points: NDArray[np.float64], **style: Any) -> None:
    axes.plot(*np.concatenate([points, points[:1]]).T, **style)


def _dimension(axes: Any, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension line with arrows at both ends and its figure in the middle."""
    axes.annotate("", xy=start, xytext=end, arrowprops={"arrowstyle": "<->", "lw": 0.8, "shrinkA": 0, "shrinkB": 0})
    upright = abs(start[0] - end[0]) < 1e-9
    axes.text(
        0.5 * (start[0] + end[0]) - (2.0 if upright else 0.0),
        0.5 * (start[1] + end[1]) - (0.0 if upright else 2.0),
        text,
        ha="right" if upright else "center",
        va="center" if upright else "top",
        fontsize=9,
    )
