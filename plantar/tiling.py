"""Laying a hexagonal lattice over a sole: which cells fit, clipped to the outline or whole."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError, LayoutError
from plantar.hex_lattice import HexLattice
from plantar.layout import Side, SoleLayout

__all__ = ["MOST_TAXELS", "hex_layout"]

MOST_TAXELS = 100_000
"""Most taxels that `hex_layout` lays out; the papers' soles have 42 and 51."""


def hex_layout(
    outline: ArrayLike,
    *,
    name: str = "sole",
    side: Side = "left",
    cell_area: float = 691e-6,
    origin: tuple[float, float] = (0.0, 0.0),
    angle: float = 0.0,
    clip: bool = True,
    minimum_fraction: float = 0.5,
    cells: ArrayLike | None = None,
) -> SoleLayout:
    """Lay a hexagonal lattice over a sole and keep the cells that fit.

    Args:
        outline: Outline (k, 2) of the sole in m in the sole frame, either orientation, not self-crossing.
        name: Name of the sole.
        side: "left" or "right".
        cell_area: Area of a whole cell in m^2.
        origin: Centre of lattice cell (0, 0) in m.
        angle: Rotation of the lattice rows against x in rad.
        clip: Cut cells that cross the outline; False keeps whole cells inside only.
        minimum_fraction: With clip, a cut cell is kept when at least this fraction of it is inside, 0..1; slivers below
            a thousandth of a cell never are. Where an outline cuts a cell in several parts, the largest counts.
        cells: Axial coordinates (m, 2) to take instead; these are kept whole, even across the outline.

    Returns:
        The layout; a clipped cell's position is the centroid of what is left of it.

    Raises:
        LayoutError: If the outline is not a simple polygon, or no cell fits, or more than MOST_TAXELS would.
        InputError: If the cell area is not a finite value above 0, or the minimum fraction not within 0 to 1.

    Example:
        >>> layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], clip=False)
        >>> len(layout), bool(abs(layout.areas - 691e-6).max() < 1e-12)
        (33, True)
    """
    import shapely  # 0.2 s: only where a layout is made

    if not 0.0 <= minimum_fraction <= 1.0:
        raise InputError(f"minimum fraction of a cut cell is {minimum_fraction}; allowed: 0 to 1")
    try:
        ring = np.asarray(outline, dtype=float)
    except (TypeError, ValueError):
        raise LayoutError("outline is not a list of (x, y) points") from None
    if ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < 3 or not np.isfinite(ring).all():
        raise LayoutError("outline is not a list of 3 or more finite (x, y) points")
    polygon = shapely.Polygon(ring)
    if not polygon.is_valid or polygon.area <= 0.0:
        raise LayoutError("outline is not a simple polygon: it crosses itself or has no area")
    polygon = shapely.geometry.polygon.orient(polygon)
    lattice = HexLattice(cell_area, origin, angle)
    if cells is None and polygon.area > MOST_TAXELS * cell_area:
        raise LayoutError(
            f"cells of {cell_area * 1e6:.3g} mm^2 on a sole of {polygon.area * 1e6:.0f} mm^2 make more than "
            f"{MOST_TAXELS} taxels; use a larger cell area"
        )
    if cells is not None:
        axial = np.asarray(cells, dtype=np.int64).reshape(-1, 2)
        if len(np.unique(axial, axis=0)) != len(axial):
            raise LayoutError("cells holds a cell twice")
        rings = list(lattice.corners(axial))
        centres = lattice.centres(axial)
    else:
        low, high = np.array(polygon.bounds[:2]), np.array(polygon.bounds[2:])
        axial = lattice.cells_near(low, high)
        rings, kept_centres = [], []
        for centre, corner in zip(lattice.centres(axial), lattice.corners(axial), strict=True):
            hexagon = shapely.Polygon(corner)
            if polygon.covers(hexagon):
                rings.append(corner)
                kept_centres.append(centre)
            elif clip:
                # On a grid: without one GEOS may lose an intersection whose edges almost coincide.
                parts = shapely.get_parts(shapely.intersection(polygon, hexagon, grid_size=1e-6 * lattice.side))
                parts = [p for p in parts if p.geom_type == "Polygon"]
                part = max(parts, key=lambda p: float(p.area), default=shapely.Polygon())
                if part.area < max(minimum_fraction, 1e-3) * cell_area:
                    continue
                part = shapely.geometry.polygon.orient(part)
                rings.append(np.array(part.exterior.coords)[:-1])
                kept_centres.append(np.array(part.centroid.coords[0]))
        centres = np.array(kept_centres).reshape(-1, 2)
    if not len(rings):
        raise LayoutError(
            f"no cell of {cell_area * 1e6:.0f} mm^2 fits the outline ({polygon.area * 1e6:.0f} mm^2); "
            "use a smaller cell area"
        )
    vertices, corners = _shared_vertices(rings, tolerance=1e-4 * lattice.side)
    areas = np.array([shapely.Polygon(vertices[list(c)]).area for c in corners])
    n = len(corners)
    return SoleLayout(
        name=name,
        side=side,
        positions=np.column_stack([centres, np.zeros(n)]),
        rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
        vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
        corners=tuple(corners),
        neighbours=_edge_neighbours(corners),
        areas=areas,
        outline=np.array(polygon.exterior.coords)[:-1],
        ids=np.arange(n),
        cell_shape="hexagon",
        cell_area=cell_area,
    )


def _shared_vertices(rings: Sequence[ArrayLike], tolerance: float) -> tuple[NDArray[np.float64], list[tuple[int, ...]]]:
    """Give points of cell rings that agree within a tolerance one shared index."""
    points: list[NDArray[np.float64]] = []
    index: dict[tuple[int, int], int] = {}
    corners: list[tuple[int, ...]] = []
    for ring in rings:
        ids: list[int] = []
        for p in np.asarray(ring, dtype=float):
            kx, ky = math.floor(p[0] / tolerance + 0.5), math.floor(p[1] / tolerance + 0.5)
            hit = next(
                (index[k] for dx in (0, -1, 1) for dy in (0, -1, 1) if (k := (kx + dx, ky + dy)) in index),
                None,
            )
            if hit is None:
                hit = len(points)
                points.append(p)
                index[(kx, ky)] = hit
            if not ids or (hit != ids[-1] and hit != ids[0]):
                ids.append(hit)
        corners.append(tuple(ids))
    return np.array(points).reshape(-1, 2), corners


def _edge_neighbours(corners: Sequence[Sequence[int]]) -> tuple[tuple[int, ...], ...]:
    """Taxels that share an edge (two consecutive vertices)."""
    owners: dict[tuple[int, int], list[int]] = {}
    for i, ring in enumerate(corners):
        for a, b in zip(ring, [*ring[1:], ring[0]], strict=True):
            owners.setdefault((min(a, b), max(a, b)), []).append(i)
    near: list[set[int]] = [set() for _ in corners]
    for cells in owners.values():
        for a in cells:
            near[a].update(b for b in cells if b != a)
    return tuple(tuple(sorted(s)) for s in near)
