"""Whether a part prints: overhangs against 45 degrees, bridges, the bed, and how long it takes. Lengths in mm."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.parameters import ShoeParameters

__all__ = ["BUILD_DIRECTIONS", "Printing", "choose_direction", "print_hours"]

BUILD_DIRECTIONS: dict[str, tuple[tuple[int, int, int], tuple[int, int, int]]] = {
    "sole down": ((0, 1, 2), (1, 1, 1)),
    "sole up": ((0, 1, 2), (1, -1, -1)),
    "heel down": ((1, 2, 0), (1, 1, 1)),
    "side down": ((2, 0, 1), (1, 1, 1)),
}
"""Build directions that are tried: order and signs of the axes that bring the bed's normal to z."""

_STEEP = math.cos(math.radians(45.0)) + 1e-3
_FLAT = 0.999
_LAYER = 0.2  # mm
_LAYER_TIME = 6.0  # s

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Printing:
    """A part on the printer's bed.

    Attributes:
        direction: One of BUILD_DIRECTIONS.
        overhang: Area in mm^2 that faces down by more than 45 degrees and is no bridge.
        bridges: Area in mm^2 of flat ceilings no wider than the printer bridges.
        size: Extent (3,) on the bed: longer, shorter side and height.
    """

    direction: str
    overhang: float
    bridges: float
    size: tuple[float, float, float]
    fits: bool


def choose_direction(triangles: Array, parameters: ShoeParameters) -> tuple[Printing, ...]:
    """Gives how triangles (n, 3, 3), closed, lie on the bed by the printer's parameters, the best first: fits, least
    overhang, height, bridges.
    """
    found = [_printing(name, triangles, parameters) for name in BUILD_DIRECTIONS]
    return tuple(sorted(found, key=lambda f: (not f.fits, round(f.overhang, 0), f.size[2], round(f.bridges, 0))))


def _printing(name: str, triangles: Array, p: ShoeParameters) -> Printing:
    order, signs = BUILD_DIRECTIONS[name]
    turned = triangles[..., order] * np.array(signs, dtype=float)
    overhang, bridges = _overhang(turned, p.bridge_max)
    length, width, height = (float(v) for v in np.ptp(turned.reshape(-1, 3), axis=0))
    size = (max(length, width), min(length, width), height)
    fits = size[0] <= p.bed_length and size[1] <= p.bed_width and height <= p.bed_height
    rounded = (round(size[0], 3), round(size[1], 3), round(size[2], 3))
    return Printing(name, round(overhang, 1), round(bridges, 1), rounded, fits)


def _overhang(triangles: Array, bridge_max: float) -> tuple[float, float]:
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    double = np.linalg.norm(cross, axis=1)
    keep = double > 1e-9
    triangles, cross, double = triangles[keep], cross[keep], double[keep]
    down = -cross[:, 2] / double
    on_bed = triangles[..., 2].max(axis=1) < triangles[..., 2].min() + 0.05
    overhang = float(0.5 * double[(down > _STEEP) & (down < _FLAT) & ~on_bed].sum())
    ceilings = (down >= _FLAT) & ~on_bed
    heights = triangles[:, 0, 2].round(2)
    bridges = 0.0
    for height in np.unique(heights[ceilings]):
        flat = shapely.union_all(shapely.polygons(triangles[ceilings & (heights == height), :, :2]), grid_size=1e-4)
        for part in getattr(flat, "geoms", [flat]):
            if part.geom_type != "Polygon":
                continue
            narrow = part.bounds[2] - part.bounds[0] <= bridge_max or part.bounds[3] - part.bounds[1] <= bridge_max
            if narrow or 2.0 * shapely.maximum_inscribed_circle(part, tolerance=0.1).length <= bridge_max:
                bridges += part.area
            else:
                overhang += part.area
    return overhang, bridges


def print_hours(volume: float, height: float, flow: float) -> float:
    """Gives the estimated hours to print a volume in mm^3 of a height in mm: volume over flow in mm^3/s, and 6 s for
    each layer of 0.2 mm.

    Example:
        >>> round(print_hours(239_000.0, 28.5, 8.0), 1)
        8.5
    """
    return (volume / flow + height / _LAYER * _LAYER_TIME) / 3600.0
