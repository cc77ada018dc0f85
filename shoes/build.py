"""From a foot to its pair of shoes: fit, plan and solid in one call."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layout import Side, SoleLayout
from shoes.fit import LatticeFit, fit_lattice
from shoes.foot import Foot
from shoes.parameters import ShoeParameters
from shoes.plan import CORNER, ShoePlan, mirrored_plan, plan_shoe
from shoes.tray import build_tray, load_cadquery, surface_of

__all__ = ["Progress", "Shoe", "ShoeBuild", "Sides", "build_shoe"]

Sides = Literal["left", "right", "both"]
"""Which shoes to build."""

Progress = Callable[[float, str], None]
"""Receives the fraction done, 0..1, and what is being done."""


@dataclass(frozen=True)
class Shoe:
    """One shoe.

    Attributes:
        plan: Outlines seen from above in mm, and the layout.
        solid: The cadquery solid in mm in the sole frame; None where only the layout was asked for.
        surface: Its triangles (n, 3, 3) in mm; None where only the layout was asked for.
    """

    plan: ShoePlan
    solid: Any | None = None
    surface: NDArray[np.float64] | None = None

    @property
    def side(self) -> Side:
        """ "left" or "right"."""
        return self.plan.side

    @property
    def layout(self) -> SoleLayout:
        """The sole layout, in m."""
        return self.plan.layout


@dataclass(frozen=True)
class ShoeBuild:
    """The shoes of one foot.

    Attributes:
        foot: The left foot.
        fit: Placement of the cells on the left sole.
        parameters: Dimensions used.
        shoes: The shoes asked for, left first.
    """

    foot: Foot
    fit: LatticeFit
    parameters: ShoeParameters
    shoes: tuple[Shoe, ...]


def build_shoe(
    foot: Foot,
    *,
    side: Sides = "both",
    cell_area: float = 691.0,
    taxels: int | None = None,
    overhang: float = 0.0,
    parameters: ShoeParameters | None = None,
    name: str | None = None,
    layout_only: bool = False,
    progress: Progress | None = None,
) -> ShoeBuild:
    """Fit taxels to a foot's sole and build the shoe around both.

    Args:
        foot: The left foot, see `foot_from_mesh` and `foot_from_dimensions`.
        side: "left", "right" or "both"; the right shoe mirrors the left.
        cell_area: Area of a taxel in mm^2.
        taxels: Number of taxels; None takes as many whole cells as fit the sole.
        overhang: How far taxels may reach beyond the sole in mm; with `taxels` it grows as far as the shoe's greatest
            overhang (parameter overhang_max) leaves room.
        parameters: Dimensions of the shoe; None takes the defaults.
        name: Name of the layout; None takes the foot's.
        layout_only: Leave the solid out, and with it cadquery.
        progress: Receives fraction and text.

    Returns:
        The shoes with their layouts and solids.

    Raises:
        InputError: If an argument is out of its range.
        FootError: If the foot cannot carry the taxels.

    Example:
        >>> from shoes.foot import foot_from_dimensions
        >>> foot = foot_from_dimensions("a", length=0.2, width=0.1, sole_center=(0.02, 0.0), corner_radius=0.01)
        >>> build = build_shoe(foot, layout_only=True)
        >>> [(shoe.side, len(shoe.layout)) for shoe in build.shoes]
        [('left', 21), ('right', 21)]
    """
    if side not in ("left", "right", "both"):
        raise InputError(f"side is {side!r}; allowed: left, right, both")
    sides: tuple[Side, ...] = ("left", "right") if side == "both" else (side,)
    tell = progress or (lambda fraction, text: None)
    p = parameters or ShoeParameters()
    # A recess reaches beyond the corner of a cell by the clearance over sin 60 degrees.
    room = p.overhang_max - CORNER * p.border - p.pocket_clearance / math.sin(math.pi / 3)
    if overhang > max(room, 0.0):
        raise InputError(
            f"overhang of the taxels is {overhang:g} mm; allowed: 0 to {max(room, 0.0):g} mm (overhang_max)"
        )
    tell(0.0, "fitting the taxels to the sole")
    fit = fit_lattice(foot.sole, cell_area=cell_area, taxels=taxels, overhang=overhang, overhang_max=max(room, 0.0))
    left = plan_shoe(foot, fit, p, name=name)
    shoes = []
    if not layout_only:
        tell(0.1, "loading the CAD kernel")
        load_cadquery()
    for i, which in enumerate(sides):
        plan = left if which == "left" else mirrored_plan(left)
        if layout_only:
            shoes.append(Shoe(plan))
            continue
        tell(0.5 + 0.5 * i / len(sides), f"building the {which} shoe")
        solid = build_tray(plan, p)
        shoes.append(Shoe(plan, solid, surface_of(solid)))
    tell(1.0, "shoes built")
    return ShoeBuild(foot, fit, p, tuple(shoes))
