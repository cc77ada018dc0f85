"""Hexagonal lattice in axial coordinates, with integer vertex keys.

A cell (q, r) of a lattice whose rows run along x has its centre at

    x = w (q + r / 2)        w = flat-to-flat width
    y = 3/2 s r              s = side length = w / sqrt(3)

so centres and corners are integer combinations of the half width w/2 and the half side s/2. Two cells that meet
share corners with the *same* integer key, hence with bit-identical coordinates: corners computed cell by cell
(centre + s cos) differ in the last bit and make polygon unions leak slivers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError

__all__ = ["AXIAL_NEIGHBOURS", "HexLattice", "hexagon_side"]

AXIAL_NEIGHBOURS: tuple[tuple[int, int], ...] = ((1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1))
"""Axial offsets of the six neighbours, counter-clockwise from +x."""

# Corner offsets of a cell in (half widths, half sides), counter-clockwise from the lower right corner.
_CORNER_OFFSETS: tuple[tuple[int, int], ...] = ((1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1), (0, -2))


def hexagon_side(area: float) -> float:
    """Side length of a regular hexagon.

    Args:
        area: Area in m^2, above 0.

    Returns:
        Side length s in m, from area = 3 sqrt(3) / 2 s^2.

    Raises:
        InputError: If the area is not a positive finite number.

    Example:
        >>> round(hexagon_side(691e-6) * 1e3, 3)
        16.308
    """
    if not (math.isfinite(area) and area > 0.0):
        raise InputError(f"cell area is {area} m^2; allowed: a finite value above 0")
    return math.sqrt(2.0 * area / (3.0 * math.sqrt(3.0)))


@dataclass(frozen=True)
class HexLattice:
    """A hexagonal lattice placed in the sole plane.

    Attributes:
        area: Area of one cell in m^2.
        origin: Position (2,) of the centre of cell (0, 0) in m.
        angle: Rotation of the rows against the x axis in rad.

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
        if not all(math.isfinite(v) for v in (*self.origin, self.angle)):
            raise InputError(f"lattice origin {self.origin} m or angle {self.angle} rad is not finite")

    @property
    def side(self) -> float:
        """Side length of a cell in m."""
        return hexagon_side(self.area)

    @property
    def width(self) -> float:
        """Flat-to-flat width of a cell in m: the distance of neighbouring centres."""
        return math.sqrt(3.0) * self.side

    def position_of_keys(self, keys: NDArray[np.int64]) -> NDArray[np.float64]:
        """Positions of lattice points given by integer keys.

        Args:
            keys: Integers (..., 2): multiples of (half width, half side).

        Returns:
            Positions (..., 2) in m in the sole plane.
        """
        u = keys[..., 0] * (0.5 * self.width)
        v = keys[..., 1] * (0.5 * self.side)
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.stack([self.origin[0] + c * u - s * v, self.origin[1] + s * u + c * v], axis=-1)

    @staticmethod
    def centre_keys(axial: NDArray[np.int64]) -> NDArray[np.int64]:
        """Integer keys (n, 2) of the centres of cells with axial coordinates (n, 2)."""
        return np.stack([2 * axial[..., 0] + axial[..., 1], 3 * axial[..., 1]], axis=-1)

    @classmethod
    def corner_keys(cls, axial: NDArray[np.int64]) -> NDArray[np.int64]:
        """Integer keys (n, 6, 2) of the corners of cells, counter-clockwise."""
        return np.asarray(cls.centre_keys(axial)[..., None, :] + np.array(_CORNER_OFFSETS))

    def centres(self, axial: NDArray[np.int64]) -> NDArray[np.float64]:
        """Centres (n, 2) in m of cells with axial coordinates (n, 2)."""
        return self.position_of_keys(self.centre_keys(np.asarray(axial, dtype=np.int64)))

    def corners(self, axial: NDArray[np.int64]) -> NDArray[np.float64]:
        """Corners (n, 6, 2) in m, counter-clockwise; shared corners are bit-identical."""
        return self.position_of_keys(self.corner_keys(np.asarray(axial, dtype=np.int64)))

    def cells_near(self, lower: NDArray[np.float64], upper: NDArray[np.float64]) -> NDArray[np.int64]:
        """Axial coordinates (n, 2) of every cell whose centre lies within one cell of a box.

        Args:
            lower: Lower corner (2,) of the box in m.
            upper: Upper corner (2,) of the box in m.

        Returns:
            Cells sorted by row r, then q.
        """
        lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
        middle = 0.5 * (lower + upper) - np.asarray(self.origin)
        c, s = math.cos(self.angle), math.sin(self.angle)
        middle = np.array([c * middle[0] + s * middle[1], -s * middle[0] + c * middle[1]])
        reach = 0.5 * float(np.hypot(*(upper - lower))) + 2.0 * self.side
        r0 = middle[1] / (1.5 * self.side)
        rows = np.arange(math.floor(r0 - reach / (1.5 * self.side)), math.ceil(r0 + reach / (1.5 * self.side)) + 1)
        cells = []
        for r in rows:
            q0 = middle[0] / self.width - 0.5 * r
            q = np.arange(math.floor(q0 - reach / self.width), math.ceil(q0 + reach / self.width) + 1)
            cells.append(np.column_stack([q, np.full_like(q, r)]))
        axial = np.concatenate(cells).astype(np.int64)
        centres = self.centres(axial)
        near = np.all((centres >= lower - 2 * self.side) & (centres <= upper + 2 * self.side), axis=1)
        return np.asarray(axial[near])
