"""Plan of an insole: a flat sheet with cells in a person's shoe. In mm.

Foot and shoe are soft: pressure next to cells is not measured, so cells reach the edge.
"""

from collections.abc import Iterable
from dataclasses import fields, replace
from typing import Any

import shapely

from plantar.errors import FootError, InputError
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.cell_fit import fit_cells
from plantar.shoes.fit.fine_rim import fit_fine_rim
from plantar.shoes.fit.taxels import TaxelFit, fit_taxels
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import tidy
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.shoe_plan import ShoePlan, plan_face

INSOLE_THICKNESS = (4.0, 15.0)  # least and greatest thickness of an insole in mm, with its pad

EVEN_SHARE = 0.80  # least share of an even pressure that an insole's cells carry

_SHARES = {"pad_thickness": 1 / 6, "taxel_protrusion": 1 / 6, "pocket_depth": 1 / 4}  # the rest is the floor
# mm of the foot's height, and half the width of a gap that is filled or a spur that is not
_UP_TO = 15.0
_ROUND = 8.0
# body height over foot length; kg/m^2
_STATURE = 6.6
_BODY_MASS_INDEX = 24.0


def person_mass(length: float) -> float:
    """Estimated mass in kg of a person with feet of a length in mm: 6.6 feet tall, 24 kg/m^2.

    Example:
        >>> person_mass(260.0)
        70.7
    """
    return round(_BODY_MASS_INDEX * (1e-3 * _STATURE * length) ** 2, 1)


def insole_foot(foot: Foot) -> Foot:
    """Foot whose sole outlines its lowest 15 mm, arch and toe gaps filled: the lowest 5 mm lack the arch."""
    if foot.triangles is None:
        return foot
    smooth = foot.passing(min(_UP_TO, foot.height)).buffer(_ROUND).buffer(-2.0 * _ROUND).buffer(_ROUND)
    if smooth.geom_type != "Polygon" or smooth.is_empty:
        return foot
    return replace(foot, sole=tidy(smooth.simplify(0.1)))


def insole_parameters(
    foot: Foot, thickness: float, parameters: ShoeParameters
) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives insole parameters for a foot: defaults share its thickness in mm, the floor takes the rest; and
    assumptions.

    Example:
        >>> from plantar.shoes.foot.foot import foot_from_dimensions
        >>> p, _ = insole_parameters(foot_from_dimensions("a", length=0.26, width=0.095), 6.0, ShoeParameters())
        >>> p.thickness, p.floor, p.material
        (6.0, 2.5, 'TPU')
    """
    low, high = INSOLE_THICKNESS
    if not low <= thickness <= high:
        raise InputError(f"insole is {thickness:g} mm thick; allowed: {low:g} to {high:g} mm, pad included")
    p = parameters
    defaults = {f.name: f.default for f in fields(p)}
    if p.material not in (defaults["material"], "TPU"):
        raise InputError(f"an insole of {p.material} would not bend with the foot; it is printed in TPU")
    own = {name: share * thickness for name, share in _SHARES.items() if getattr(p, name) == defaults[name]}
    taken = {name: own.get(name, getattr(p, name)) for name in _SHARES}
    floor = round(thickness - sum(taken.values()), 6)
    if floor < p.wall_min:
        raise InputError(
            f"an insole of {thickness:g} mm has a floor of {floor:g} mm left above pad, taxels and pockets; "
            f"allowed: wall_min = {p.wall_min:g} mm or more"
        )
    notes: tuple[str, ...] = ()
    mass = p.robot_mass
    if mass <= 0.0:
        box = foot.sole.bounds
        mass = min(1000.0, person_mass(box[2] - box[0])) if foot.mass is None else foot.mass
        notes = (f"the person is taken to weigh {mass:g} kg, by the foot's length; --set robot_mass=... states it",)
    deepest = floor - p.wall_min
    marked = {"mark_depth": min(p.mark_depth, deepest)} if deepest >= 0.2 else {"mark_height": 0.0}
    scribe = min(p.scribe, 0.5 * taken["pocket_depth"])
    kept: dict[str, Any] = {**own, **marked, "floor": floor, "robot_mass": mass, "scribe": scribe}
    return replace(p, **kept, material="TPU", retention="none", board_length=0.0, border=min(p.border, 1.0)), notes


def fit_insole(
    foot: Foot, parameters: ShoeParameters, *, cell_area: float, fine: bool, cell: Cell | None = None
) -> TaxelFit:
    """Gives cells up to an insole's edge, within a foot's outline by parameters: hexagons of cell_area in mm^2, fine
    rim or whole, or another cell.
    """
    room = _within(foot, parameters.clearance + parameters.border)
    if cell is not None:
        fit = fit_cells(room, cell, rib=parameters.rib, border=parameters.border)
    elif fine:
        fit = fit_fine_rim(room, cell_area=cell_area, overhang=0.0, border=parameters.border)
    else:
        fit = replace(fit_taxels(room, cell_area=cell_area), border=parameters.border)
    share = even_share(fit.cells, foot.sole)
    if share < EVEN_SHARE and cell is not None:
        smaller = "a smaller pitch" if cell.kind == "sheet" else "smaller ones, or a sheet (--cell velostat)"
        raise FootError(
            f"{foot.name}: cells {cell.label} cover {100.0 * share:.0f} % of the foot's outline; an insole needs "
            f"{100.0 * EVEN_SHARE:g} %, as it spreads no load over them: use {smaller}, or the skin's (no --cell)"
        )
    if share < EVEN_SHARE:
        what, way = ("cells with a fine rim", "") if fine else ("whole cells", "a fine rim (--rim fine) or ")
        raise FootError(
            f"{foot.name}: {what} of {cell_area:g} mm^2 cover {100.0 * share:.0f} % of the foot's outline; an insole "
            f"needs {100.0 * EVEN_SHARE:g} %, as it spreads no load over them: use {way}smaller cells (--cell-area)"
        )
    return fit


def even_share(cells: Iterable[Any], sole: Any) -> float:
    """Gives share, 0..1, of a sole covered by cells, polygons or corners (k, 2): their part of an even pressure."""
    return float(shapely.union_all([shapely.Polygon(c) for c in cells]).intersection(sole).area / sole.area)


def _within(foot: Foot, distance: float) -> Any:
    room = foot.sole.buffer(-distance, join_style="mitre", mitre_limit=2.0)
    if room.geom_type != "Polygon" or room.is_empty:
        raise FootError(f"{foot.name}: the outline is too narrow for an insole that ends {distance:g} mm within it")
    return tidy(room)


def plan_insole(foot: Foot, fit: TaxelFit, parameters: ShoeParameters, *, name: str | None = None) -> ShoePlan:
    """Gives left insole plan of a foot, fit and parameters; its layout takes a name or the foot's."""
    face = _within(foot, parameters.clearance)
    return plan_face(foot.sole, face, face, face, fit, parameters, name=name or foot.name)
