"""Repetition of cells: room of one, a union of convex parts, and lattice. In mm."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.layouts.hex_lattice import HexLattice, hexagon_side
from plantar.shoes.cells.cell import Cell
from plantar.shoes.geometry.outline import ring

Array = NDArray[np.float64]

_SIDES = 24  # corners of a circle's polygon: flats along the directions to the neighbours on both lattices
_TOUCH = 1e-6  # mm^2 that rooms may share: rounding


@dataclass(frozen=True)
class CellPattern:
    """Cells and their unplaced lattice.

    `width`: between centres in a row; `shift` of a row against the last, 0 or half of `width`; `parts`: corners (k, 2)
    of a room's convex parts about its centre, rows along x; `period`: angle in rad of rotational repetition; `hexagon`:
    cell area in mm^2 of a `HexLattice` room; else None.
    """

    width: float
    rise: float
    shift: float
    parts: tuple[Array, ...]
    period: float
    hexagon: float | None = None

    def at(self, origin: tuple[float, float], angle: float) -> "Lattice":
        """Gives lattice with cell (0, 0) at an origin, rows at an angle in rad."""
        if self.hexagon is not None:
            return HexLattice(self.hexagon, origin, angle)
        return RowLattice(self, origin, angle)

    @cached_property
    def room(self) -> Any:
        """Shapely room of a cell about its centre."""
        return joined(self.parts)

    @property
    def reach(self) -> float:
        """Farthest room point from its centre."""
        return max(float(np.hypot(*p.T).max()) for p in self.parts)

    @property
    def area(self) -> float:
        return float(self.hexagon if self.hexagon is not None else self.room.area)


@dataclass(frozen=True)
class RowLattice:
    """Placed lattice of any cells: cell (0, 0) at `origin`, rows at `angle` in rad."""

    pattern: CellPattern
    origin: tuple[float, float]
    angle: float

    def _placed(self, points: Array) -> Array:
        c = math.cos(self.angle)
        s = math.sin(self.angle)
        x = points[..., 0]
        y = points[..., 1]
        return np.stack([self.origin[0] + c * x - s * y, self.origin[1] + s * x + c * y], axis=-1)

    def _flat(self, axial: Any) -> Array:
        """Centres with rows along x; of integers, so that touching cells share corners."""
        i, j = np.asarray(axial, dtype=np.int64).reshape(-1, 2).T
        half = 2 * i + (j if self.pattern.shift else 0)
        return np.stack([half * (0.5 * self.pattern.width), 2 * j * (0.5 * self.pattern.rise)], axis=-1)

    def centres(self, axial: Any) -> Array:
        """Cell centres (n, 2) in mm."""
        return self._placed(self._flat(axial))

    def corners(self, axial: Any) -> Array:
        """Corners (n, k, 2) of cell rooms in mm."""
        return self.shapes(axial, ring(self.pattern.room))

    def shapes(self, axial: Any, shape: Array) -> Array:
        """Gives corners (n, k, 2) of a shape (k, 2) about axial cells (n, 2), rows along x."""
        return self._placed(self._flat(axial)[:, None, :] + shape)

    def cells_near(self, lower: Any, upper: Any) -> NDArray[np.int64]:
        """Gives cells (n, 2), by row, centred within about a cell of a box with corners lower (2,) and upper (2,)."""
        p = self.pattern
        box = np.array([[lower[0], lower[1]], [upper[0], lower[1]], [upper[0], upper[1]], [lower[0], upper[1]]])
        box = box - np.array(self.origin)
        c = math.cos(self.angle)
        s = math.sin(self.angle)
        along = c * box[:, 0] + s * box[:, 1]
        across = -s * box[:, 0] + c * box[:, 1]
        more = p.reach + max(p.width, p.rise)
        cells = []
        for j in range(math.floor((across.min() - more) / p.rise), math.ceil((across.max() + more) / p.rise) + 1):
            first = math.floor((along.min() - more - j * p.shift) / p.width)
            i = np.arange(first, math.ceil((along.max() + more - j * p.shift) / p.width) + 1)
            cells.append(np.column_stack([i, np.full_like(i, j)]))
        axial = np.concatenate(cells).astype(np.int64)
        centres = self.centres(axial)
        near = np.all((centres >= np.asarray(lower) - more) & (centres <= np.asarray(upper) + more), axis=1)
        return np.asarray(axial[near])


Lattice = HexLattice | RowLattice  # a placed lattice of cells


def hex_pattern(area: float) -> CellPattern:
    """Tiling hexagons of an area in mm^2.

    Example:
        >>> round(hex_pattern(691.0).width, 2)
        28.25
    """
    side = hexagon_side(area)
    width = math.sqrt(3.0) * side
    return CellPattern(width, 1.5 * side, 0.5 * width, (_hexagon(width),), math.pi / 3.0, area)


def pattern_of(cell: Cell, rib: float) -> CellPattern:
    """Gives how a tile or film cell repeats: as stated, or as near as the rib between pockets allows.

    Example:
        >>> fsr = Cell(shape="round", size=18.0, thickness=0.5, play=0.0)
        >>> pattern = pattern_of(fsr, 2.0)
        >>> round(pattern.width, 6), round(pattern.rise, 3)
        (20.0, 17.321)
    """
    parts = pocket_parts(cell, 0.5 * rib)
    points = np.concatenate(parts)
    low = points.min(axis=0)
    high = points.max(axis=0)
    width = _pitch(cell, "x", high[0] - low[0], rib)
    if cell.shape == "hex":
        if cell.kind == "tile":
            return hex_pattern(0.5 * math.sqrt(3.0) * width**2)
        return CellPattern(width, 0.5 * math.sqrt(3.0) * width, 0.5 * width, parts, math.pi / 3.0)
    shift = 0.5 * width if cell.lattice == "hex" or (cell.lattice == "auto" and cell.shape == "round") else 0.0
    rise = _pitch(cell, "y", _least_rise(parts, width, shift, high[1] - low[1]), rib)
    if cell.kind == "tile":
        parts = (_rectangle(width, rise),)
    return CellPattern(width, rise, shift, parts, _period(cell, width, rise, shift))


def _pitch(cell: Cell, axis: str, least: float, rib: float) -> float:
    stated: float = getattr(cell, f"pitch_{axis}", 0.0)
    if stated and stated < least - 1e-6:
        raise FootError(
            f"cell {cell.label}: pitch_{axis} is {stated:g} mm; allowed: {math.ceil(100 * least) / 100:g} "
            f"mm or more, which leaves a rib of {rib:g} mm between the pockets"
        )
    return float(stated or least)


def _least_rise(parts: Sequence[Array], width: float, shift: float, height: float) -> float:
    """Smallest row distance, by bisection: rooms are convex across rows."""
    if not shift:
        return float(height)
    room = shapely.union_all([shapely.Polygon(p) for p in parts])

    def apart(rise: float) -> bool:
        return all(
            room.intersection(shapely.affinity.translate(room, dx, rise)).area <= _TOUCH for dx in (-shift, shift)
        )

    # the row after the next lies right above
    low = 0.5 * height
    high = height
    if apart(low):
        return float(low)
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if apart(middle) else (middle, high)
    return float(high)


def _period(cell: Cell, width: float, rise: float, shift: float) -> float:
    if cell.tail_length:
        return 2.0 * math.pi
    if cell.shape == "round" and shift and abs(rise - 0.5 * math.sqrt(3.0) * width) < 1e-3:
        return math.pi / 3.0
    square = abs(width - rise) < 1e-6 and not shift and cell.shape != "rectangle"
    return 0.5 * math.pi if square else math.pi


def pocket_parts(cell: Cell, around: float = 0.0) -> tuple[Array, ...]:
    """Gives corners (k, 2) of convex parts, body and tail with play, of a tile or film cell, with more room around."""
    gap = cell.play + around
    along, across = cell.body
    body = _body(cell.shape, along + 2.0 * gap, across + 2.0 * gap)
    if not cell.tail_length:
        return (body,)
    half = 0.5 * cell.tail_width + gap
    tail = np.array([[-0.5 * along - cell.tail_length - gap, -half], [0.0, -half], [0.0, half]])
    return body, np.concatenate([tail, [[tail[0, 0], half]]])


def joined(parts: Sequence[Array]) -> Any:
    """Overlapping convex parts (k, 2) as one counter-clockwise shapely polygon."""
    shape = shapely.union_all([shapely.Polygon(p) for p in parts], grid_size=1e-6)
    return shapely.geometry.polygon.orient(shape.simplify(1e-6))


def active_shape(cell: Cell) -> Array:
    """Corners (k, 2) of a film's active area about its body's middle; equal area for circles."""
    along, across = cell.active_extent
    if cell.shape == "round":
        equal = math.sqrt(2.0 * math.pi / (_SIDES * math.sin(2.0 * math.pi / _SIDES))) * math.cos(math.pi / _SIDES)
        return equal * _circle(0.5 * along)
    return _body(cell.shape, along, across)


def _body(shape: str, along: float, across: float) -> Array:
    if shape == "round":
        return _circle(0.5 * along)
    return _hexagon(along) if shape == "hex" else _rectangle(along, across)


def _rectangle(along: float, across: float) -> Array:
    return 0.5 * np.array([[-along, -across], [along, -across], [along, across], [-along, across]])


def _hexagon(width: float) -> Array:
    turns = math.pi / 6.0 + np.arange(6) * math.pi / 3.0
    return width / math.sqrt(3.0) * np.column_stack([np.cos(turns), np.sin(turns)])


def _circle(radius: float) -> Array:
    turns = (np.arange(_SIDES) + 0.5) * 2.0 * math.pi / _SIDES
    return radius / math.cos(math.pi / _SIDES) * np.column_stack([np.cos(turns), np.sin(turns)])
