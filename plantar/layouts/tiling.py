"""A lattice of hexagons or rectangles over a sole, clipped or whole."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number
from plantar.common.arrays import integers
from plantar.common.plane_points import plane_point
from plantar.errors import InputError, LayoutError
from plantar.layouts.cell_layout import checked_ring, edge_neighbours, shared_vertices
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.layout import LARGEST_COORDINATE, Side, SoleLayout

MOST_TAXELS = 100_000
"""Most taxels that a lattice lays out; the papers' soles have 42 and 51."""


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
    """Lay a hexagonal lattice over a sole; keep fitting cells.

    Args:
        outline: Sole outline (k, 2) in m in sole frame, either orientation, not self-crossing.
        name: Name of sole.
        side: "left" or "right".
        cell_area: Of a whole cell in m^2.
        origin: Center of cell (0, 0) in m.
        angle: Rotation of rows against x in rad.
        clip: Cut cells that cross the outline; False keeps whole cells inside only.
        minimum_fraction: Least fraction inside of a cut cell, a thousandth to 1; the largest part of one counts.
        cells: Axial coordinates (m, 2) to use instead; kept whole, even across the outline.

    Returns:
        The layout; a clipped cell's position is its centroid.

    Raises:
        LayoutError, InputError: If an argument is invalid, no cell fits, or more than MOST_TAXELS.

    Example:
        >>> layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], clip=False)
        >>> len(layout), bool(abs(layout.areas - 691e-6).max() < 1e-12)
        (33, True)
    """
    lattice = HexLattice(cell_area, _checked_origin(origin), angle)
    cell_area = lattice.area
    polygon = _sole_polygon(outline, cell_area, minimum_fraction, limited=cells is None)
    if cells is not None:
        axial = integers(cells, "cells", ("m", 2))
        if len(np.unique(axial, axis=0)) != len(axial):
            raise LayoutError("cells holds a cell twice")
        rings = list(lattice.corners(axial))
        centres = lattice.centres(axial)
    else:
        low = np.array(polygon.bounds[:2])
        high = np.array(polygon.bounds[2:])
        axial = lattice.cells_near(low, high)
        rings, centres = _cells_within(
            polygon,
            lattice.corners(axial),
            lattice.centres(axial),
            cell_area,
            minimum_fraction if clip else None,
            lattice.side,
        )
    return _layout(polygon, rings, centres, name, side, "hexagon", cell_area, lattice.side)


def grid_layout(
    outline: ArrayLike,
    *,
    name: str = "sole",
    side: Side = "left",
    pitch: tuple[float, float] = (0.02, 0.02),
    origin: tuple[float, float] = (0.0, 0.0),
    angle: float = 0.0,
    clip: bool = True,
    minimum_fraction: float = 0.5,
) -> SoleLayout:
    """Lay a grid of rectangles over a sole; keep fitting cells.

    Args:
        outline: As in `hex_layout`.
        name: Name of sole.
        side: "left" or "right".
        pitch: Cell size along rows and across them in m.
        origin: A corner of grid in m.
        angle: Rotation of rows against x in rad.
        clip: As in `hex_layout`.
        minimum_fraction: As in `hex_layout`.

    Returns:
        The layout; a clipped cell's position is its centroid.

    Raises:
        LayoutError, InputError: If an argument is invalid.

    Example:
        >>> layout = grid_layout([[0, 0], [0.1, 0], [0.1, 0.06], [0, 0.06]], pitch=(0.02, 0.01))
        >>> len(layout), layout.neighbours[0], layout.cell_shape
        (30, (1, 5), 'rectangle')
    """
    pitch = plane_point(pitch, "grid pitch")
    if not all(0.0 < v <= LARGEST for v in pitch):
        raise InputError(f"grid pitch is {pitch} m; allowed: finite values above 0")
    origin = _checked_origin(origin)
    angle = number(angle, "angle of a grid", nan=True)
    if not abs(angle) <= LARGEST:
        raise InputError(f"grid angle is {angle} rad, which is not finite")
    cell_area = pitch[0] * pitch[1]
    polygon = _sole_polygon(outline, cell_area, minimum_fraction)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    along = (np.array(polygon.exterior.coords) - origin) @ turn / pitch  # the outline in cells of the grid
    lower = np.floor(along.min(axis=0)) - 1.0
    upper = np.ceil(along.max(axis=0)) + 1.0
    if float(np.prod(upper - lower)) > 4 * MOST_TAXELS or np.abs(along).max() > 1e15:
        raise LayoutError(f"a grid of {pitch[0]:.3g} x {pitch[1]:.3g} m over this outline makes too many cells")
    low = lower.astype(np.int64)
    high = upper.astype(np.int64)
    column, row = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    corner = np.stack([column.ravel(), row.ravel()], axis=-1)[:, None, :] + [[0, 0], [1, 0], [1, 1], [0, 1]]
    candidates = (corner * pitch) @ turn.T + origin  # of integers: cells that meet share bit-identical corners
    rings, centres = _cells_within(
        polygon, candidates, candidates.mean(axis=1), cell_area, minimum_fraction if clip else None, min(pitch)
    )
    return _layout(polygon, rings, centres, name, side, "rectangle", cell_area, min(pitch))


def _sole_polygon(outline: ArrayLike, cell_area: float, minimum_fraction: float, limited: bool = True) -> Any:
    import shapely  # 0.2 s: only where a layout is made

    if not 0.0 <= number(minimum_fraction, "minimum fraction of a cut cell", nan=True) <= 1.0:
        raise InputError(f"minimum fraction of a cut cell is {minimum_fraction}; allowed: 0 to 1")
    if not cell_area <= 1.0:
        raise InputError(f"cell area is {cell_area:.3g} m^2; allowed: above 0 and up to 1 m^2")
    ring = checked_ring(outline, "outline")
    far = float(np.abs(ring).max())
    if far > LARGEST:
        raise LayoutError(f"outline reaches {far:.3g} m; allowed: within {LARGEST_COORDINATE:.0f} m of the origin")
    polygon = shapely.Polygon(ring)
    if not polygon.is_valid or polygon.area <= 0.0:
        raise LayoutError("outline is not a simple polygon: it crosses itself or has no area")
    if limited and polygon.area > MOST_TAXELS * cell_area:
        raise LayoutError(
            f"cells of {cell_area * 1e6:.3g} mm^2 on a sole of {polygon.area * 1e6:.0f} mm^2 make more than "
            f"{MOST_TAXELS} taxels; use a larger cell area, and an outline in m"
        )
    if far > LARGEST_COORDINATE:
        raise LayoutError(f"outline reaches {far:.3g} m; allowed: within {LARGEST_COORDINATE:.0f} m of the origin")
    return shapely.geometry.polygon.orient(polygon)


def _checked_origin(origin: tuple[float, float]) -> tuple[float, float]:
    x, y = plane_point(origin, "origin")
    if not (abs(x) <= LARGEST_COORDINATE and abs(y) <= LARGEST_COORDINATE):
        raise InputError(
            f"origin is ({x}, {y}) m and not finite, or too far: allowed within {LARGEST_COORDINATE:.0f} m"
        )
    return x, y


def _cells_within(
    polygon: Any,
    candidates: NDArray[np.float64],
    centres: NDArray[np.float64],
    cell_area: float,
    minimum_fraction: float | None,
    grain: float,
) -> tuple[list[NDArray[np.float64]], NDArray[np.float64]]:
    """Rings and centers of cells inside an outline, cut ones too on request."""
    import shapely

    cells = shapely.polygons(candidates)
    shapely.prepare(polygon)
    whole = shapely.covers(polygon, cells)
    kept = np.flatnonzero(whole | (shapely.intersects(polygon, cells) & (minimum_fraction is not None)))
    rings = []
    kept_centres = []
    for i in kept.tolist():
        if whole[i]:
            rings.append(candidates[i])
            kept_centres.append(centres[i])
            continue
        # On a grid: without one GEOS may lose an intersection whose edges almost coincide.
        parts = shapely.get_parts(shapely.intersection(polygon, cells[i], grid_size=1e-6 * grain))
        parts = [p for p in parts if p.geom_type == "Polygon"]
        part = max(parts, key=lambda p: float(p.area), default=shapely.Polygon())
        if part.area >= max(minimum_fraction or 0.0, 1e-3) * cell_area:
            part = shapely.geometry.polygon.orient(part)
            rings.append(_on_lattice(np.array(part.exterior.coords)[:-1], candidates[i], 2e-6 * grain))
            kept_centres.append(np.array(part.centroid.coords[0]))
    if not rings:
        raise LayoutError(
            f"no cell of {cell_area * 1e6:.0f} mm^2 fits the outline ({polygon.area * 1e6:.0f} mm^2); "
            "use a smaller cell area"
        )
    return rings, np.array(kept_centres)


def _on_lattice(ring: NDArray[np.float64], corners: NDArray[np.float64], tolerance: float) -> NDArray[np.float64]:
    """A cut cell's corners, the whole cell's put back exactly."""
    gap = np.hypot(*(ring[:, None] - corners).transpose(2, 0, 1))
    nearest = gap.argmin(axis=1)
    return np.where(gap.min(axis=1, keepdims=True) <= tolerance, corners[nearest], ring)


def _layout(
    polygon: Any,
    rings: Sequence[ArrayLike],
    centres: NDArray[np.float64],
    name: str,
    side: Side,
    cell_shape: str,
    cell_area: float,
    grain: float,
) -> SoleLayout:
    import shapely

    vertices, corners = shared_vertices(rings, tolerance=1e-4 * grain)
    areas = np.array([shapely.Polygon(vertices[list(c)]).area for c in corners])
    n = len(corners)
    return SoleLayout(
        name=name,
        side=side,
        positions=np.column_stack([centres, np.zeros(n)]),
        rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
        vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
        corners=tuple(corners),
        neighbours=edge_neighbours(corners),
        areas=areas,
        outline=np.array(polygon.exterior.coords)[:-1],
        ids=np.arange(n),
        cell_shape=cell_shape,
        cell_area=cell_area,
    )
