"""Nominal insole geometry for recordings without cell places: 99 cells, and Moticon's 16."""

import os
import re
from collections.abc import Mapping
from importlib.resources import files
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError, InputError
from plantar.formats.recorded_layouts import flat_sole
from plantar.geometry.polygon import area, centroid
from plantar.layouts.cell_layout import edge_neighbours, shared_vertices
from plantar.layouts.layout import Side, SoleLayout, mirrored
from plantar.layouts.layout_file import read_layout

ROWS: tuple[int, ...] = (5, *(7,) * 12, 6, 4)
"""Cells in each row of a regular insole, heel to toe; in a row they are counted from the medial to the lateral edge."""

WIDE_ROWS: tuple[int, ...] = (5, *(7,) * 12, 5, 5)
"""The same of a wide insole, whose published areas are those of two rows of five, large cells at the edges of one."""

# Area of each cell 1 to 99 in mm^2 by insole size, as the R package pressuRe (S. Telfer, MIT) publishes them.
_PUBLISHED = files("plantar.formats").joinpath("insole_areas.txt").read_text(encoding="utf-8")

CELL_AREAS: Mapping[str, NDArray[np.float64]] = {
    **{line.split()[0]: 1e-6 * np.array(line.split()[1:], dtype=float) for line in _PUBLISHED.splitlines()},
    "z": np.full(99, 217e-6),  # no list of its cells is published: those of one regular insole differ by 2 %
}
"""Area (99,) of each cell in m^2 by insole size; the wide sizes end in w, and their cells differ by up to 4 times."""

DEFAULT_SIZE = "x"
"""The size that is assumed where the file names none."""

_NAMED = re.compile(r"(moticon|pedar):(\w*)", re.IGNORECASE)

# Least share of a row that cells of two rows have in common to be neighbours: their areas are rounded to mm^2.
_CORNER = 0.02
_STATIONS = np.array([0.0, 0.04, 0.12, 0.22, 0.35, 0.48, 0.62, 0.72, 0.82, 0.91, 0.97, 1.0])
_WIDTH = np.array([0.130, 0.185, 0.225, 0.240, 0.235, 0.240, 0.285, 0.310, 0.300, 0.250, 0.170, 0.110])
_CENTRE = np.array([0.0, 0.0, 0.0, 0.0, -0.004, -0.008, -0.004, 0.004, 0.014, 0.024, 0.030, 0.032])


def insole_outline(length: float) -> NDArray[np.float64]:
    """Outline (k, 2) in m of a right insole of a length in m, counter-clockwise from a mid-heel-edge origin."""
    stations = np.linspace(0.0, 1.0, 41)
    half = 0.5 * np.interp(stations, _STATIONS, _WIDTH)
    centre = np.interp(stations, _STATIONS, _CENTRE)
    lateral = centre - half
    medial = centre + half
    ring = np.concatenate([np.column_stack([stations, lateral]), np.column_stack([stations, medial])[::-1]])
    return np.asarray(ring * length)


def nominal_insole(size: str, side: Side) -> SoleLayout:
    """Returns parametric insole of a side: 99 quadrilateral cells with the size's published areas (`CELL_AREAS`).

    Row heights are proportional to cell areas. Origin in the middle of the heel edge; x to the toe; ids 1 to 99.

    Example:
        >>> layout = nominal_insole("y", "left")
        >>> len(layout), round(float(layout.areas.mean()) * 1e6), round(float(layout.outline[:, 0].max()), 2)
        (99, 193, 0.28)
    """
    fine = np.linspace(0.0, 1.0, 2001)
    width = np.interp(fine, _STATIONS, _WIDTH)
    swept = np.concatenate([[0.0], np.cumsum(0.5 * (width[1:] + width[:-1]) * np.diff(fine))])
    areas = CELL_AREAS[size]
    rows = np.split(areas, np.cumsum(WIDE_ROWS if size.endswith("w") and len(size) > 1 else ROWS)[:-1])
    share = np.concatenate([[0.0], np.cumsum([row.sum() for row in rows])]) / areas.sum()
    stations = np.interp(share, swept / swept[-1], fine)
    half = 0.5 * np.interp(stations, _STATIONS, _WIDTH)
    centre = np.interp(stations, _STATIONS, _CENTRE)
    # in units of the length, y towards the medial edge
    medial = centre + half
    lateral = centre - half

    points: list[tuple[float, float]] = []
    index: dict[tuple[int, float], int] = {}

    def vertex(station: int, fraction: float) -> int:
        key = (station, round(fraction, 9))
        if key not in index:
            index[key] = len(points)
            points.append(
                (float(stations[station]), float(medial[station] + fraction * (lateral[station] - medial[station])))
            )
        return index[key]

    corners: list[tuple[int, ...]] = []
    spans: list[tuple[int, float, float]] = []
    for row, cells in enumerate(rows):
        for a, b in pairwise((np.concatenate([[0.0], np.cumsum(cells)]) / cells.sum()).tolist()):
            # counter-clockwise with y to the medial side: lateral heel, lateral toe, medial toe, medial heel
            corners.append((vertex(row, b), vertex(row + 1, b), vertex(row + 1, a), vertex(row, a)))
            spans.append((row, a, b))
    unit = np.array(points)
    scale = float(np.sqrt(areas.sum() / sum(area(unit[list(c)]) for c in corners)))
    edge = np.concatenate([np.column_stack([stations, lateral]), np.column_stack([stations, medial])[::-1]])
    places = np.array([centroid(scale * unit[list(c)]) for c in corners])
    ids = np.arange(1, len(corners) + 1)
    made = ids, places, scale * unit, corners, _neighbours(spans), areas.copy()
    name = f"nominal 99-cell insole, size {size.upper()}"
    right = flat_sole(name, "right", *made, scale * edge, cell_area=float(areas.mean()))
    return right if side == "right" else mirrored(right)  # y to the left is the medial side of a right foot


def _neighbours(spans: list[tuple[int, float, float]]) -> tuple[tuple[int, ...], ...]:
    def touch(p: tuple[int, float, float], q: tuple[int, float, float]) -> bool:
        if p[0] == q[0]:
            return abs(p[1] - q[2]) < 1e-9 or abs(p[2] - q[1]) < 1e-9
        return abs(p[0] - q[0]) == 1 and min(p[2], q[2]) - max(p[1], q[1]) > _CORNER

    return tuple(tuple(j for j, q in enumerate(spans) if j != i and touch(p, q)) for i, p in enumerate(spans))


MOTICON_LENGTH = {1: 0.217, 2: 0.230, 3: 0.243, 4: 0.257, 5: 0.270, 6: 0.283, 7: 0.297, 8: 0.310, 9: 0.323}
"""Length of the insole in m by its size, two French shoe sizes apart: nominal, the export does not state it."""

MOTICON_WIDTH = 0.31
"""Width as a share of the length (nominal)."""

# Place of each cell as a share of length (to the toes) and of width (to the medial side), and the area in cm^2 that
# it stands for on a size 7. All follow from the device's own output: its total force is the sum of pressure times
# these areas to 0.3 N, its centre of pressure their weighted mean to 1e-5.
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
_AREA_SIZE = 7


def moticon_insole(size: int | None, side: Side, areas: NDArray[np.float64] | None = None) -> SoleLayout:
    """Returns insole of a size (7 if unknown) and side, cut into the parts nearest to each cell.

    Origin in the middle of the heel edge, ids 1 to 16. Areas (16,) in m^2 are the recording's, if known.

    Example:
        >>> layout = moticon_insole(7, "left")
        >>> len(layout), round(float(layout.areas.sum()) * 1e4, 1)
        (16, 204.8)
    """
    import shapely  # 0.2 s: only where this insole is read

    length = MOTICON_LENGTH.get(size or _AREA_SIZE, MOTICON_LENGTH[_AREA_SIZE])
    usual = _CELLS[:, 2] * 1e-4 * (length / MOTICON_LENGTH[_AREA_SIZE]) ** 2
    area = usual if areas is None else np.asarray(areas, dtype=float)
    if area.shape != (len(_CELLS),) or not (area > 0.0).all():
        raise FormatError("a Moticon insole has 16 cells, each of an area above 0")
    centre = np.column_stack([(_CELLS[:, 0] + 0.5) * length, _CELLS[:, 1] * MOTICON_WIDTH * length])
    outline = insole_outline(length)
    sole = shapely.Polygon(outline)
    parts = shapely.get_parts(shapely.voronoi_polygons(shapely.MultiPoint(centre), extend_to=sole))
    points = shapely.points(centre)
    nearest = [next(p for p in parts if p.intersects(point)) for point in points]
    cells = [shapely.geometry.polygon.orient(shapely.intersection(p, sole).convex_hull) for p in nearest]
    rings = [shapely.get_coordinates(c.exterior)[:-1] for c in cells]
    neighbours = edge_neighbours(shared_vertices(rings, tolerance=1e-6)[1])
    scales = np.sqrt(area / shapely.area(cells))  # each is drawn as large as it counts
    rings = [at + scale * (ring - at) for at, scale, ring in zip(centre, scales, rings, strict=True)]
    vertices, corners = shared_vertices(rings, tolerance=1e-6)
    made = np.arange(1, len(centre) + 1), centre, vertices, corners, neighbours, area
    right = flat_sole(f"Moticon insole, size {size or _AREA_SIZE}", "right", *made, outline)
    return right if side == "right" else mirrored(right)  # y to the left is the medial side of a right foot


def named_or_read_layout(given: SoleLayout | str | os.PathLike[str]) -> SoleLayout:
    """Returns layout of a nominal insole by maker and size, such as "moticon:7" or "pedar:xw", or of a file.

    InputError for an unknown size, LayoutError for a file that is no layout.

    Example:
        >>> [len(named_or_read_layout(name)) for name in ("moticon:7", "pedar:xw")]
        [16, 99]
    """
    if isinstance(given, SoleLayout):
        return given
    match = _NAMED.fullmatch(str(given))
    if match is None or os.path.exists(given):
        return read_layout(given)
    maker, size = (part.lower() for part in match.groups())
    sizes = [str(k) for k in MOTICON_LENGTH] if maker == "moticon" else list(CELL_AREAS)
    if size not in sizes:
        raise InputError(f"unknown size {size!r} of a {maker} insole; allowed: {', '.join(sizes)}")
    return moticon_insole(int(size), "left") if maker == "moticon" else nominal_insole(size, "left")
