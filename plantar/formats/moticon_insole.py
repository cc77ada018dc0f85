"""The 16 cells of a Moticon insole: their places and areas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.nominal_insole import insole_outline
from plantar.layouts.cell_layout import edge_neighbours, shared_vertices
from plantar.layouts.layout import DEFAULT_RANGES, Side, SoleLayout, mirrored

__all__ = ["LENGTH", "WIDTH", "moticon_insole"]

LENGTH = {1: 0.217, 2: 0.230, 3: 0.243, 4: 0.257, 5: 0.270, 6: 0.283, 7: 0.297, 8: 0.310, 9: 0.323}
"""Length of the insole in m by its size, two French shoe sizes apart: nominal, the export does not state it."""

WIDTH = 0.31
"""Width as a share of the length (nominal)."""

_CELLS = np.array(
    [
        [-0.404, 0.109, 12.35],
        [-0.416, -0.166, 11.05],
        [-0.266, 0.089, 13.37],
        [-0.288, -0.225, 13.12],
        [-0.125, 0.061, 13.13],
        [-0.152, -0.273, 13.01],
        [0.080, 0.242, 17.98],
        [-0.012, -0.392, 18.22],
        [0.256, 0.274, 15.66],
        [0.241, 0.064, 12.43],
        [0.226, -0.116, 12.51],
        [0.207, -0.294, 12.68],
        [0.170, -0.463, 10.22],
        [0.413, 0.178, 10.13],
        [0.408, -0.082, 12.50],
        [0.359, -0.313, 6.48],
    ]
)
"""Place of each cell as a share of length (to the toes) and of width (to the medial side), and the area in cm^2 that it
stands for on a size 7. All follow from the device's own output: its total force is the sum of pressure times these
areas to 0.3 N, its centre of pressure their weighted mean to 1e-5."""

_AREA_SIZE = 7


def moticon_insole(size: int | None, side: Side, areas: NDArray[np.float64] | None = None) -> SoleLayout:
    """Returns the insole cut into the parts that are nearest to each cell.

    The origin is in the middle of the heel edge, ids are 1 to 16. Its areas differ a little from those of the drawn
    parts.

    Args:
        size: Size of the insole; 7 is assumed where None or unknown.
        side: "left" or "right".
        areas: Area (16,) in m^2 of each cell, where the recording gives it.

    Example:
        >>> layout = moticon_insole(7, "left")
        >>> len(layout), round(float(layout.areas.sum()) * 1e4, 1)
        (16, 204.8)
    """
    import shapely  # 0.2 s: only where this insole is read

    length = LENGTH.get(size or _AREA_SIZE, LENGTH[_AREA_SIZE])
    area = _CELLS[:, 2] * 1e-4 * (length / LENGTH[_AREA_SIZE]) ** 2 if areas is None else np.asarray(areas, dtype=float)
    if area.shape != (len(_CELLS),) or not (area > 0.0).all():
        raise FormatError("a Moticon insole has 16 cells, each of an area above 0")
    centre = np.column_stack([(_CELLS[:, 0] + 0.5) * length, _CELLS[:, 1] * WIDTH * length])
    outline = insole_outline(length)
    sole = shapely.Polygon(outline)
    parts = shapely.get_parts(shapely.voronoi_polygons(shapely.MultiPoint(centre), extend_to=sole))
    points = shapely.points(centre)
    nearest = [next(p for p in parts if p.intersects(point)) for point in points]
    cells = [shapely.geometry.polygon.orient(shapely.intersection(p, sole)) for p in nearest]
    rings = [shapely.get_coordinates(c.convex_hull.exterior)[-2::-1][::-1] for c in cells]
    vertices, corners = shared_vertices(rings, tolerance=1e-6)
    n = len(centre)
    right = SoleLayout(  # y to the left is the medial side of a right foot
        name=f"Moticon insole, size {size or _AREA_SIZE}",
        side="right",
        positions=np.column_stack([centre, np.zeros(n)]),
        rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
        vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
        corners=tuple(corners),
        neighbours=edge_neighbours(corners),
        areas=area,
        outline=outline,
        ids=np.arange(1, n + 1),
        cell_shape="polygon",
        cell_area=float(np.median(area)),
        modalities=("force",),
        ranges={"force": DEFAULT_RANGES["force"]},
        thresholds={"force": 10e3 * float(np.median(area))},
    )
    return right if side == "right" else mirrored(right)
