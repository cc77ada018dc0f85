"""Whether a part prints: overhangs against 45 degrees, bridges, bed, time; and its weight. In mm."""

import math
from dataclasses import asdict, dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.solid.pad import pad_surface
from plantar.shoes.solid.polyhedron import volume_of

# Build directions that are tried: order and signs of the axes that bring the bed's normal to z
BUILD_DIRECTIONS: dict[str, tuple[tuple[int, int, int], tuple[int, int, int]]] = {
    "sole down": ((0, 1, 2), (1, 1, 1)),
    "sole up": ((0, 1, 2), (1, -1, -1)),
    "heel down": ((1, 2, 0), (1, 1, 1)),
    "side down": ((2, 0, 1), (1, 1, 1)),
}

_STEEP = math.cos(math.radians(45.0)) + 1e-3
_FLAT = 0.999
_LAYER = 0.2  # mm
_LAYER_TIME = 6.0  # s

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Printing:
    """Part on the printer's bed, in a direction.

    `overhang`: area in mm^2 facing down by over 45 degrees, bridges aside; `bridges`: ceilings in mm^2; `size`: bed
    extent (3,): longer, shorter side and height.
    """

    direction: str
    overhang: float
    bridges: float
    size: tuple[float, float, float]
    fits: bool


def choose_direction(triangles: Array, parameters: ShoeParameters) -> tuple[Printing, ...]:
    """Gives placements of closed triangles (n, 3, 3) on the bed by printer parameters, best first: fits, least
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
    triangles = triangles[keep]
    cross = cross[keep]
    double = double[keep]
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
    """Gives estimated hours to print a volume in mm^3 of a height in mm: volume over flow in mm^3/s, 6 s a layer of 0.2
    mm.

    Example:
        >>> round(print_hours(239_000.0, 28.5, 8.0), 1)
        8.5
    """
    return (volume / flow + height / _LAYER * _LAYER_TIME) / 3600.0


_FOAM_DENSITY = 0.32  # g/cm^3, of microcellular foams (PORON 4701-30, data sheet)
_BOARD_DENSITY = 1.85e-3  # g/mm^3, glass fibre and copper
BOARD_UP = 12.0  # length in mm of board above the shelf


@dataclass(frozen=True)
class Weights:
    """Shoe masses in g: print, pad, taxels (area times protrusion and pocket depth), board."""

    printed: float
    pad: float
    skin: float
    board: float

    @property
    def total(self) -> float:
        return self.printed + self.pad + self.skin + self.board

    def as_dict(self) -> dict[str, float]:
        """Masses and `total`, in g."""
        return asdict(self) | {"total": round(self.total, 2)}


def _pad_density(p: ShoeParameters) -> float:
    if p.pad_kind == "plate":
        return p.printed.density
    return _FOAM_DENSITY if p.pad_foam > 0.0 else p.pad_density


def weigh(shoe: Shoe, build: ShoeBuild, volume: float) -> Weights:
    """Gives masses of a build's shoe with a printed volume in mm^3."""
    p = build.parameters
    pad = volume_of(pad_surface(shoe.plan, p)) if p.pad_thickness > 0.0 else 0.0
    board = p.board_length * BOARD_UP * p.board_thickness * _BOARD_DENSITY if shoe.plan.heel.board else 0.0
    return Weights(
        printed=round(volume / 1000.0 * p.printed.density, 2),
        pad=round(pad / 1000.0 * _pad_density(p), 2),
        skin=round(_skin(shoe, p) / 1000.0 * p.skin_density, 2),
        board=round(board, 2),
    )


def _skin(shoe: Shoe, p: ShoeParameters) -> float:
    plan = shoe.plan
    if plan.cell is not None and plan.lands:
        return float(sum(q.area for q in plan.pockets)) * plan.cell.thickness
    heads = sum(c.area for c in plan.cells)
    bases = sum(q.area for q in plan.pockets)
    return float(heads) * p.taxel_protrusion + float(bases) * p.pocket_depth
