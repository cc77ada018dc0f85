"""A nominal geometry for 99-cell insoles, whose recordings do not say where their cells are."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import DEFAULT_RANGES, Side, SoleLayout, mirrored

__all__ = ["CELL_AREA", "DEFAULT_SIZE", "ROWS", "insole_outline", "nominal_insole"]

ROWS: tuple[int, ...] = (5, *(7,) * 12, 6, 4)
"""Cells in each row, heel to toe; in a row they are counted from the medial to the lateral edge."""

CELL_AREA: Mapping[str, float] = {
    "u": 127e-6,
    "v": 141e-6,
    "w": 157e-6,
    "x": 174e-6,
    "y": 193e-6,
    "z": 217e-6,
    "uw": 143e-6,
    "vw": 161e-6,
    "xw": 198e-6,
}
"""Mean area of a cell in m^2 by insole size (the wide sizes end in w), after the sensor areas that the R package
pressuRe (S. Telfer, MIT) lists; the cells of one regular insole differ by 2 %."""

DEFAULT_SIZE = "x"
"""The size that is assumed where the file names none."""

_STATIONS = np.array([0.0, 0.04, 0.12, 0.22, 0.35, 0.48, 0.62, 0.72, 0.82, 0.91, 0.97, 1.0])
_WIDTH = np.array([0.130, 0.185, 0.225, 0.240, 0.235, 0.240, 0.285, 0.310, 0.300, 0.250, 0.170, 0.110])
_CENTRE = np.array([0.0, 0.0, 0.0, 0.0, -0.004, -0.008, -0.004, 0.004, 0.014, 0.024, 0.030, 0.032])


def insole_outline(length: float) -> NDArray[np.float64]:
    """Outline (k, 2) in m of a right insole, counter-clockwise, with the origin in the middle of its heel edge.

    Args:
        length: Its length in m.
    """
    stations = np.linspace(0.0, 1.0, 41)
    half = 0.5 * np.interp(stations, _STATIONS, _WIDTH)
    centre = np.interp(stations, _STATIONS, _CENTRE)
    lateral, medial = centre - half, centre + half
    ring = np.concatenate([np.column_stack([stations, lateral]), np.column_stack([stations, medial])[::-1]])
    return np.asarray(ring * length)


def nominal_insole(size: str, side: Side) -> SoleLayout:
    """A parametric insole of 99 quadrilateral cells whose mean area is that of the size.

    The outline is a smooth insole shape (width and midline as fractions of its length); each row's height makes its
    area proportional to its cells, and a row is cut into cells of equal width. The length follows from the area. The
    origin lies in the middle of the heel edge; x runs to the toe.

    Args:
        size: A key of `CELL_AREA`.
        side: "left" or "right".

    Returns:
        The layout; cell ids are 1 to 99 as the insoles are numbered.

    Example:
        >>> layout = nominal_insole("y", "left")
        >>> len(layout), round(float(layout.areas.mean()) * 1e6), round(float(layout.outline[:, 0].max()), 2)
        (99, 193, 0.28)
    """
    fine = np.linspace(0.0, 1.0, 2001)
    width = np.interp(fine, _STATIONS, _WIDTH)
    swept = np.concatenate([[0.0], np.cumsum(0.5 * (width[1:] + width[:-1]) * np.diff(fine))])
    stations = np.interp(np.concatenate([[0], np.cumsum(ROWS)]) / sum(ROWS), swept / swept[-1], fine)
    half = 0.5 * np.interp(stations, _STATIONS, _WIDTH)
    centre = np.interp(stations, _STATIONS, _CENTRE)
    medial, lateral = centre + half, centre - half  # in units of the length, y towards the medial edge

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
    for row, cells in enumerate(ROWS):
        for j in range(cells):
            a, b = j / cells, (j + 1) / cells
            # counter-clockwise with y to the medial side: lateral heel, lateral toe, medial toe, medial heel
            corners.append((vertex(row, b), vertex(row + 1, b), vertex(row + 1, a), vertex(row, a)))
            spans.append((row, a, b))
    unit = np.array(points)
    areas = np.array([_area(unit[list(c)]) for c in corners])
    scale = float(np.sqrt(CELL_AREA[size] * len(corners) / areas.sum()))
    vertices = np.column_stack([unit * scale, np.zeros(len(unit))])
    edge = np.concatenate([np.column_stack([stations, lateral]), np.column_stack([stations, medial])[::-1]])
    positions = np.array([_centroid(vertices[list(c), :2]) for c in corners])
    n = len(corners)
    right = SoleLayout(  # y to the left is the medial side of a right foot
        name=f"nominal 99-cell insole, size {size.upper()}",
        side="right",
        positions=np.column_stack([positions, np.zeros(n)]),
        rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
        vertices=vertices,
        corners=tuple(corners),
        neighbours=_neighbours(spans),
        areas=areas * scale**2,
        outline=edge * scale,
        ids=np.arange(1, n + 1),
        cell_shape="polygon",
        cell_area=CELL_AREA[size],
        modalities=("force",),
        ranges={"force": DEFAULT_RANGES["force"]},
        thresholds={"force": 10e3 * CELL_AREA[size]},  # 10 kPa: below what such insoles resolve
    )
    return right if side == "right" else mirrored(right)


def _area(ring: NDArray[np.float64]) -> float:
    x, y = ring.T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _centroid(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y = ring.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    return np.asarray(((ring + np.roll(ring, -1, axis=0)) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum()))


def _neighbours(spans: list[tuple[int, float, float]]) -> tuple[tuple[int, ...], ...]:
    """Cells that share a part of an edge: next to each other in a row, or overlapping in the rows beside."""

    def touch(p: tuple[int, float, float], q: tuple[int, float, float]) -> bool:
        if p[0] == q[0]:
            return abs(p[1] - q[2]) < 1e-9 or abs(p[2] - q[1]) < 1e-9
        return abs(p[0] - q[0]) == 1 and min(p[2], q[2]) - max(p[1], q[1]) > 1e-9

    return tuple(tuple(j for j, q in enumerate(spans) if j != i and touch(p, q)) for i, p in enumerate(spans))
