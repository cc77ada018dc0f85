"""Shoes for a foot found in a robot's model, surface in the sole frame."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES
from plantar.errors import FootError, PlantarError
from plantar.shoes.build import Progress, ShoeBuild, build_shoe
from plantar.shoes.foot.foot import Foot, foot_from_outline
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.geometry.outline import tidy
from plantar.shoes.papers.export import export_shoe
from plantar.shoes.plan.touching import observability
from plantar.shoes.units import MM_PER_M, to_m

TAXELS = 42  # taxels of the papers' soles, which a smaller sole has, too: what they measure depends on their number

_THRESHOLD = 0.146  # of the mean load of a taxel of a standing robot: 0.15 kg of the papers' 86 kg over two soles of 42
_SMALLER = 0.72  # of an area, that is tried next: 0.85 of a taxel's width
_AREAS = (100.0, 691.0)  # mm^2 of a taxel: what can be made, and what the papers have


@dataclass(frozen=True)
class FoundShoes:
    """Built shoes.

    `thickness`: contact face below the bare sole in m; `mass` of one in kg; None for layouts; `notes`: found, assumed
    and decided, failed checks included.
    """

    thickness: float
    mass: float | None
    notes: tuple[str, ...]


def taxel_area(area: float) -> float:
    """Taxel area in mm^2 for a sole area in mm^2: as many as on the papers' soles, none larger.

    Example:
        >>> taxel_area(27_791.0), taxel_area(9_900.0), taxel_area(900.0)
        (662.0, 236.0, 100.0)
    """
    least, most = _AREAS
    return float(np.clip(round(area / TAXELS), least, most))


def shoe_for_surface(
    name: str,
    triangles: NDArray[np.float64],
    folder: Path,
    mass: float,
    *,
    solid: bool = False,
    progress: Progress | None = None,
) -> FoundShoes:
    """Build and write a left foot's shoes: layouts into the folder, parts and papers into its folder "shoe".

    Args:
        name: Robot.
        triangles: Surface (n, 3, 3) in m: x forward, y left, z up, origin in the sole plane below the ankle.
        folder: Existing.
        mass: Robot's in kg.
        solid: Whether to build the printable part, if possible.
        progress: Receives fraction and text.

    Returns:
        Result.

    Raises:
        FootError: If taxels do not fit.
    """
    foot = replace(_foot(name, triangles), mass=mass)
    area, layouts = _observing_layouts(foot)
    build = _adapted(layouts, mass)
    weight = None
    notes = build.notes
    if solid:
        try:
            build = _adapted(build_shoe(foot, cell_area=area, progress=progress), mass)
            (folder / "shoe").mkdir()
            report = export_shoe(build, folder / "shoe").as_dict()
            weight = 1e-3 * float(report["worn_mass_g"])
            notes = build.notes if report["holds"] else (*build.notes, "a check of the printed shoe does not hold")
        except PlantarError as error:
            notes = (*notes, f"no printable part, only the layouts: {error}")
    if weight is None:
        export_shoe(build, folder)
    else:
        for side in SIDES:
            (folder / "shoe" / f"layout_{side}.json").replace(folder / f"layout_{side}.json")
    level = build.shoes[0].layout.force_threshold
    found = (f"{len(build.shoes[0].layout)} taxels of {area:g} mm^2, each active from {level:.2g} N on", *notes)
    return FoundShoes(to_m(build.parameters.thickness), weight, found)


def _observing_layouts(foot: Foot) -> tuple[float, ShoeBuild]:
    """Area in mm^2 and layouts of simulated taxels: `taxel_area`, or less where these would not see the center of
    pressure.
    """
    area = taxel_area(foot.sole.area)
    while True:
        smaller = round(_SMALLER * area)
        try:
            build = build_shoe(foot, cell_area=area, layout_only=True)
        except FootError:
            if smaller < _AREAS[0]:
                raise
        else:
            if smaller < _AREAS[0] or observability(build.shoes[0].plan).holds:
                return area, build
        area = smaller


def _adapted(build: ShoeBuild, mass: float) -> ShoeBuild:
    shoes = []
    for shoe in build.shoes:
        layout = shoe.layout
        wanted = _THRESHOLD * 0.5 * mass * GRAVITY / len(layout)
        level = float(f"{min(layout.force_threshold, wanted):.2g}")
        kept = replace(layout, thresholds={**layout.thresholds, "force": level})
        shoes.append(replace(shoe, plan=replace(shoe.plan, layout=kept)))
    return replace(build, shoes=tuple(shoes))


def _foot(name: str, triangles: NDArray[np.float64]) -> Foot:
    try:
        return foot_from_triangles(name, triangles, where=name, file_unit="m", up="z", forward="x", sole_z=0.0)
    except FootError as error:
        points = triangles.reshape(-1, 3) * MM_PER_M
        lowest = points[points[:, 2] <= 5.0][:, :2]
        hull = shapely.MultiPoint(lowest).convex_hull
        if not math.isfinite(hull.area) or hull.geom_type != "Polygon":
            raise
        return foot_from_outline(name, tidy(hull), (f"hull of the lowest 5 mm, because: {error}",))
