"""The shoe seen from above: contact face, cavity, rim, patch recess and taxel pockets, in mm."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from plantar.errors import FootError, LayoutError
from plantar.layout import Side, SoleLayout, mirrored
from plantar.tiling import hex_layout
from shoes.fit import LatticeFit
from shoes.foot import Foot
from shoes.outline import ring, single_outline, tidy
from shoes.parameters import ShoeParameters
from shoes.units import to_m

__all__ = ["CORNER", "ShoePlan", "mirrored_plan", "plan_shoe"]

CORNER = 1.2
"""How much farther than its edges the corner of a grown outline may lie."""


@dataclass(frozen=True)
class ShoePlan:
    """Outlines of one shoe in its sole frame, and its layout. Outlines are shapely polygons in mm.

    Attributes:
        side: "left" or "right".
        foot: Outline of the foot below the rim's upper edge.
        contact: Outline of the contact face and of the sole plate.
        cavity: Inside of the rim.
        rim: Outside of the rim.
        recesses: Recesses for the skin patch, one for each connected group of cells.
        pockets: Taxel pockets, in the order of the layout's taxels.
        layout: The sole layout, in m.
    """

    side: Side
    foot: Any
    contact: Any
    cavity: Any
    rim: Any
    recesses: tuple[Any, ...]
    pockets: tuple[Any, ...]
    layout: SoleLayout

    @property
    def overhang(self) -> float:
        """How far the contact face reaches beyond the foot, in mm."""
        import shapely

        return float(max(self.foot.distance(shapely.points(ring(self.contact)))))


def plan_shoe(foot: Foot, fit: LatticeFit, parameters: ShoeParameters, *, name: str | None = None) -> ShoePlan:
    """Draw the left shoe around a foot and its taxels.

    The contact face takes in the foot with clearance and rim, and the taxels with the border around them.

    Args:
        foot: The left foot.
        fit: Placement of the cells.
        parameters: Dimensions of the shoe.
        name: Name the layout takes; None takes the foot's.

    Returns:
        The plan of the left shoe.

    Raises:
        FootError: If the cells are so small that no pocket is left between the ribs.
    """
    import shapely

    outline = tidy(foot.outline_up_to(parameters.rim_height).union(foot.sole))
    cavity = tidy(_grown(outline, parameters.clearance))
    rim = tidy(_grown(outline, parameters.clearance + parameters.rim_thickness))
    hexagons = shapely.polygons(fit.lattice.corners(fit.cells))
    # Corners that cells share are bit-identical, so the union leaks no slivers.
    patch = shapely.union_all(hexagons)
    groups = list(getattr(patch, "geoms", [patch]))
    gap = parameters.pocket_clearance
    recess = shapely.union_all([g.buffer(gap, join_style="mitre") if gap else g for g in groups])
    recesses = tuple(
        shapely.Polygon(g.exterior)  # a hole in the patch is left to the pockets' floor
        for g in sorted(getattr(recess, "geoms", [recess]), key=lambda g: g.bounds)
    )
    walls = recess.convex_hull if len(groups) == 1 else recess
    shape = rim.union(_grown(walls, parameters.border))
    contact = single_outline(shape, shape.convex_hull, detail=0.0)
    pockets = tuple(h.buffer(-0.5 * parameters.rib, join_style="mitre") for h in hexagons)
    if any(p.is_empty or p.area < 0.1 * h.area for p, h in zip(pockets, hexagons, strict=True)):
        raise FootError(
            f"cells of {fit.lattice.area:g} mm^2 leave no pocket between ribs of {parameters.rib:g} mm; "
            "use larger cells or a thinner rib"
        )
    x, y = fit.lattice.origin
    try:
        layout = hex_layout(
            to_m(ring(contact)).round(6),
            name=name or foot.name,
            side="left",
            cell_area=fit.lattice.area * 1e-6,
            origin=(to_m(x), to_m(y)),
            angle=fit.lattice.angle,
            cells=fit.cells,
        )
    except LayoutError as error:
        raise FootError(f"the shoe's outline cannot carry a layout: {error}") from None
    return ShoePlan("left", outline, contact, cavity, rim, recesses, pockets, layout)


def _grown(shape: Any, distance: float) -> Any:
    """A shape with its edges moved outwards: gentle corners stay one point, sharp ones are bevelled."""
    return shape.buffer(distance, join_style="mitre", mitre_limit=CORNER - 0.05) if distance > 0.0 else shape


def mirrored_plan(plan: ShoePlan) -> ShoePlan:
    """The plan of the other foot's shoe: y changes sign, taxel ids stay."""

    def flip(polygon: Any) -> Any:
        import shapely

        return shapely.geometry.polygon.orient(shapely.Polygon(ring(polygon) * np.array([1.0, -1.0])))

    layout = mirrored(plan.layout)
    return ShoePlan(
        layout.side,
        flip(plan.foot),
        flip(plan.contact),
        flip(plan.cavity),
        flip(plan.rim),
        tuple(flip(r) for r in plan.recesses),
        tuple(flip(p) for p in plan.pockets),
        layout,
    )
