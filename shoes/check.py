"""Checks of a built shoe, measured on what was exported: the STL's triangles and the solid read back from the STEP."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError
from shoes.build import Shoe
from shoes.parameters import ShoeParameters
from shoes.units import to_mm

__all__ = ["Check", "ShoeCheck", "check_shoe", "floor_thickness", "section", "thinnest_wall"]


@dataclass(frozen=True)
class Check:
    """One check: what was measured against what is allowed.

    Attributes:
        name: What is checked.
        holds: Whether it does.
        value: The measured value.
        allowed: What is allowed, in words.
    """

    name: str
    holds: bool
    value: float | bool
    allowed: str


@dataclass(frozen=True)
class ShoeCheck:
    """What was measured on one shoe.

    Attributes:
        watertight: Whether every edge of the STL has two triangles and they agree on the inside.
        volume_cm3: Volume of the solid in cm^3.
        mass_g: Its mass at the stated density in g.
        min_wall_mm: Thinnest wall or floor in mm.
        size_mm: Extent (3,) along x, y, z in mm.
        overhang_mm: How far the contact face reaches beyond the foot in mm.
        checks: The single checks.
    """

    watertight: bool
    volume_cm3: float
    mass_g: float
    min_wall_mm: float
    size_mm: tuple[float, float, float]
    overhang_mm: float
    checks: tuple[Check, ...]

    @property
    def holds(self) -> bool:
        """Whether every check holds."""
        return all(c.holds for c in self.checks)


def check_shoe(shoe: Shoe, parameters: ShoeParameters, *, surface: NDArray[np.float64], step: Any) -> ShoeCheck:
    """Measure one exported shoe.

    Args:
        shoe: The shoe as built.
        parameters: Its dimensions.
        surface: Triangles (n, 3, 3) in mm, as read back from the STL.
        step: The cadquery shape as read back from the STEP.

    Returns:
        The measures and checks; nothing is raised for a check that does not hold.
    """
    try:
        import trimesh
    except ImportError:
        raise DependencyError("trimesh", "shoes") from None
    p = parameters
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(surface))
    watertight = bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0)
    solids = step.Solids()
    volume = float(step.Volume())
    difference = 100.0 * abs(float(mesh.volume) / volume - 1.0) if volume > 0.0 else math.inf
    centres = to_mm(shoe.layout.positions[:, :2])
    walls = [
        thinnest_wall(section(surface, z))
        for z in (
            0.5 * p.patch_depth,
            p.patch_depth + 0.5 * p.pocket_depth,
            p.patch_depth + p.pocket_depth + 0.5 * p.floor,
            p.plate_thickness + 0.5 * p.rim_height,
        )
    ]
    wall = min(*walls, floor_thickness(surface, centres))
    corners = _pocket_corner_error(shoe, p, step)
    gap = _gap_to_foot(shoe, section(surface, p.plate_thickness + 0.5 * p.rim_height))
    outside = _taxels_outside(shoe)
    size = np.ptp(surface.reshape(-1, 3), axis=0)
    overhang = shoe.plan.overhang
    checks = (
        Check("solid valid", bool(step.isValid()), bool(step.isValid()), "true"),
        Check("solids", len(solids) == 1, float(len(solids)), "1"),
        Check("watertight", watertight, watertight, "true"),
        Check("separate surfaces in the STL", mesh.body_count == 1, float(mesh.body_count), "1"),
        Check("STL against STEP volume, %", difference <= 0.5, round(difference, 6), "0.5 or less"),
        Check("thinnest wall, mm", wall >= p.wall_min - 1e-3, round(wall, 3), f"{p.wall_min:g} or more"),
        Check("gap between foot and rim, mm", gap >= p.clearance - 0.02, round(gap, 3), f"{p.clearance:g} or more"),
        Check("pocket corners against the layout, mm", corners <= 0.05, round(corners, 6), "0.05 or less"),
        Check("taxels beyond the contact face", outside == 0, float(outside), "0"),
        Check("overhang, mm", overhang <= p.overhang_max + 1e-2, round(overhang, 2), f"{p.overhang_max:g} or less"),
    )
    return ShoeCheck(
        watertight=watertight,
        volume_cm3=round(volume / 1000.0, 3),
        mass_g=round(volume / 1000.0 * p.density, 2),
        min_wall_mm=round(wall, 3),
        size_mm=(round(float(size[0]), 3), round(float(size[1]), 3), round(float(size[2]), 3)),
        overhang_mm=round(overhang, 2),
        checks=checks,
    )


def section(triangles: NDArray[np.float64], height: float) -> Any:
    """The solid's cross-section at z = height.

    Args:
        triangles: Closed surface (n, 3, 3) in mm; no corner lies at the height.
        height: Height in mm.

    Returns:
        A shapely polygon or multipolygon in mm, empty where nothing is cut.
    """
    import shapely

    above = triangles[..., 2] > height
    crossing = triangles[above.any(axis=1) & ~above.all(axis=1)]
    ends = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        a, b = crossing[:, i], crossing[:, j]
        crosses = (a[:, 2] > height) != (b[:, 2] > height)
        rise = np.where(crosses, b[:, 2] - a[:, 2], 1.0)
        point = a[:, :2] + ((height - a[:, 2]) / rise)[:, None] * (b - a)[:, :2]
        ends.append(np.where(crosses[:, None], point, np.nan))
    pairs = np.stack(ends, axis=1)  # each triangle has two of three points
    segments = pairs[np.isfinite(pairs[..., 0])].reshape(-1, 2, 2).round(4)
    lines = shapely.linestrings(segments[(segments[:, 0] != segments[:, 1]).any(axis=1)])
    return shapely.build_area(shapely.union_all(lines)) if len(lines) else shapely.Polygon()


def thinnest_wall(area: Any) -> float:
    """Smallest distance in mm between two boundary rings of a section: the thinnest wall that separates two voids.

    Args:
        area: Section, a shapely polygon or multipolygon in mm.

    Returns:
        The distance; infinite for a section without holes.

    Example:
        >>> import shapely
        >>> ring = shapely.box(0, 0, 50, 50).difference(shapely.box(3, 4, 45, 45))
        >>> thinnest_wall(ring)
        3.0
    """
    import shapely

    thinnest = math.inf
    for part in getattr(area, "geoms", [area]):
        if part.is_empty:
            continue
        rings = np.array([part.exterior, *part.interiors])
        first, second = np.triu_indices(len(rings), 1)
        if len(first):
            thinnest = min(thinnest, float(shapely.distance(rings[first], rings[second]).min()))
    return thinnest


def floor_thickness(triangles: NDArray[np.float64], points: NDArray[np.float64]) -> float:
    """Smallest thickness in mm of what lies above points of the contact face.

    Args:
        triangles: Closed surface (n, 3, 3) in mm.
        points: Points (m, 2) in mm, for example the taxel centres.

    Returns:
        The smallest vertical extent of solid above one of them; 0 where a point has no solid above it.
    """
    flat = triangles[np.ptp(triangles[..., 2], axis=1) < 1e-6]
    a, b, c = flat[:, 0, :2], flat[:, 1, :2], flat[:, 2, :2]
    thinnest = math.inf
    for point in points:
        sides = np.stack([_turn(a, b, point), _turn(b, c, point), _turn(c, a, point)])
        hit = (sides >= -1e-9).all(axis=0) | (sides <= 1e-9).all(axis=0)
        heights = np.unique(flat[hit, 0, 2].round(4))
        if len(heights) < 2 or len(heights) % 2:
            return 0.0
        thinnest = min(thinnest, float((heights[1::2] - heights[::2]).min()))
    return thinnest


def _turn(a: NDArray[np.float64], b: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Twice the signed area of the triangles a, b, point."""
    return np.asarray(
        (b[:, 0] - a[:, 0]) * (point[1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (point[0] - a[:, 0]), dtype=float
    )


def _pocket_corner_error(shoe: Shoe, parameters: ShoeParameters, step: Any) -> float:
    """Largest distance in mm of pocket corners in the solid from the layout's cell corners moved in by half a rib."""
    ceiling = parameters.patch_depth + parameters.pocket_depth
    found = np.array([v.toTuple() for v in step.Vertices()])
    found = found[np.abs(found[:, 2] - ceiling) < 1e-3, :2]
    if not len(found):
        return math.inf
    worst = 0.0
    for taxel in range(len(shoe.layout)):
        cell = to_mm(shoe.layout.cell_polygon(taxel))
        centre = to_mm(shoe.layout.positions[taxel, :2])
        radius = np.hypot(*(cell - centre).T)[:, None]
        wanted = centre + (cell - centre) * (radius - parameters.rib / math.sqrt(3.0)) / radius
        gaps = np.hypot(wanted[:, None, 0] - found[None, :, 0], wanted[:, None, 1] - found[None, :, 1]).min(axis=1)
        worst = max(worst, float(gaps.max()))
    return worst


def _gap_to_foot(shoe: Shoe, cut: Any) -> float:
    """Smallest distance in mm between the foot and the rim in a section of the rim; 0 where it is not inside."""
    import shapely

    holes = [shapely.Polygon(h) for part in getattr(cut, "geoms", [cut]) for h in part.interiors]
    around = [h for h in holes if h.covers(shoe.plan.foot)]
    return float(min((h.exterior.distance(shoe.plan.foot) for h in around), default=0.0))


def _taxels_outside(shoe: Shoe) -> int:
    """Number of taxels that are not wholly inside the layout's outline."""
    import shapely

    outline = shapely.Polygon(to_mm(shoe.layout.outline)).buffer(1e-3)
    cells = [shapely.Polygon(to_mm(shoe.layout.cell_polygon(i))) for i in range(len(shoe.layout))]
    return sum(not outline.covers(c) for c in cells)
