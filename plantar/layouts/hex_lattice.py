"""Hexagonal lattice in axial coordinates, with integer vertex keys.

A cell (q, r), rows along x, has its center at

    x = w (q + r / 2)        w = flat-to-flat width
    y = 3/2 s r              s = side length = w / sqrt(3)

Shared corners have one key and identical coordinates.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number, positive
from plantar.common.arrays import array, integers
from plantar.common.plane_points import plane_point
from plantar.errors import InputError

_WIDEST = 3000  # sides: 14 million cells
_FARTHEST = 10**9  # cells from the origin: their keys fit 64 bits, their positions have digits left

# Corner offsets of a cell in (half widths, half sides), counter-clockwise from the lower right corner.
_CORNER_OFFSETS: tuple[tuple[int, int], ...] = ((1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1), (0, -2))


def hexagon_side(area: float) -> float:
    """Side s in m of a regular hexagon of an area in m^2, above 0 (else an InputError): area = 3 sqrt(3) / 2 s^2."""
    return math.sqrt(2.0 * positive(area, "cell area", "m^2") / (3.0 * math.sqrt(3.0)))


@dataclass(frozen=True)
class HexLattice:
    """A hexagonal lattice placed in the sole plane.

    `area` of one cell in m^2; `origin`: center (2,) of cell (0, 0) in m; `angle`: rotation of rows against x in rad.

    Example:
        >>> lattice = HexLattice(area=691e-6)
        >>> lattice.centres(np.array([[0, 0], [1, 0]])).round(5).tolist()
        [[0.0, 0.0], [0.02825, 0.0]]
    """

    area: float
    origin: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0

    def __post_init__(self) -> None:
        hexagon_side(self.area)  # raises on a bad area
        origin = plane_point(self.origin, "origin of a lattice")
        angle = number(self.angle, "angle of a lattice", nan=True)
        if not all(abs(v) <= LARGEST for v in (*origin, angle)):
            raise InputError(f"lattice origin {self.origin} m or angle {self.angle} rad is not finite")
        self.__dict__.update(area=float(self.area), origin=origin, angle=angle)

    @property
    def side(self) -> float:
        """Side length of a cell in m."""
        return hexagon_side(self.area)

    @property
    def width(self) -> float:
        """Flat-to-flat width of a cell in m."""
        return math.sqrt(3.0) * self.side

    def position_of_keys(self, keys: ArrayLike) -> NDArray[np.float64]:
        """Positions (..., 2) in m, sole plane, of integer keys (..., 2), multiples of (half width, half side); else an
        InputError.
        """
        whole = integers(keys, "keys", (..., 2))
        u = whole[..., 0] * (0.5 * self.width)
        v = whole[..., 1] * (0.5 * self.side)
        c = math.cos(self.angle)
        s = math.sin(self.angle)
        return np.stack([self.origin[0] + c * u - s * v, self.origin[1] + s * u + c * v], axis=-1)

    @staticmethod
    def centre_keys(axial: ArrayLike) -> NDArray[np.int64]:
        """Integer keys (n, 2) of centres of axial cells (n, 2)."""
        cells = integers(axial, "cells", (..., 2))
        if cells.size and (cells.min() < -_FARTHEST or cells.max() > _FARTHEST):
            raise InputError(f"cells are up to {np.abs(cells.astype(float)).max():.3g} from the origin; allowed: 1e9")
        return np.stack([2 * cells[..., 0] + cells[..., 1], 3 * cells[..., 1]], axis=-1)

    @classmethod
    def corner_keys(cls, axial: ArrayLike) -> NDArray[np.int64]:
        """Integer keys (n, 6, 2) of the corners of cells, counter-clockwise."""
        return np.asarray(cls.centre_keys(axial)[..., None, :] + np.array(_CORNER_OFFSETS))

    def centres(self, axial: ArrayLike) -> NDArray[np.float64]:
        """Centres (n, 2) in m of cells with axial coordinates (n, 2)."""
        return self.position_of_keys(self.centre_keys(axial))

    def corners(self, axial: ArrayLike) -> NDArray[np.float64]:
        """Corners (n, 6, 2) in m, counter-clockwise; shared corners are bit-identical."""
        return self.position_of_keys(self.corner_keys(axial))

    def cells_near(self, lower: ArrayLike, upper: ArrayLike) -> NDArray[np.int64]:
        """Returns axial coordinates (n, 2) of cells with center within a cell of a box from `lower` to `upper` (2,) in
        m, by row r, then q.

        An InputError if corners are not finite, or the box reaches over 3000 sides from its middle.
        """
        low = array(lower, "lower corner", (2,), finite=True)
        high = array(upper, "upper corner", (2,), finite=True)
        middle = 0.5 * (low + high) - np.asarray(self.origin)
        c = math.cos(self.angle)
        s = math.sin(self.angle)
        middle = np.array([c * middle[0] + s * middle[1], -s * middle[0] + c * middle[1]])
        reach = 0.5 * float(np.hypot(*(high - low))) + 2.0 * self.side
        if reach > _WIDEST * self.side or np.abs(middle).max() > _FARTHEST * self.side:
            raise InputError(
                f"box from {low.tolist()} to {high.tolist()} m is too large or too far away for cells of side "
                f"{self.side:.3g} m; allowed: {_WIDEST} sides from its middle, {_FARTHEST:g} from the origin"
            )
        r0 = middle[1] / (1.5 * self.side)
        rows = np.arange(math.floor(r0 - reach / (1.5 * self.side)), math.ceil(r0 + reach / (1.5 * self.side)) + 1)
        cells = []
        for r in rows:
            q0 = middle[0] / self.width - 0.5 * r
            q = np.arange(math.floor(q0 - reach / self.width), math.ceil(q0 + reach / self.width) + 1)
            cells.append(np.column_stack([q, np.full_like(q, r)]))
        axial = np.concatenate(cells).astype(np.int64)
        centres = self.centres(axial)
        return np.asarray(axial[np.all((centres >= low - 2 * self.side) & (centres <= high + 2 * self.side), axis=1)])
