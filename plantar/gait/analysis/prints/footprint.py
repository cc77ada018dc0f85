"""Shape of a footprint: axis, length, width, thirds and arch index.

A set of loaded convex cells. Foot frame: origin at the back of the heel, u along the axis to the toes, v across to the
medial side.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.cell_cutting import CellCutter
from plantar.geometry.polygon import convex_hull
from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import Side, SoleLayout

# Shares of the length, toes included, in which the foot's axis halves the widths of heel and forefoot.
_BANDS = ((0.0, 0.25), (0.55, 0.80))
_ROUNDS = 4  # How often the axis is found again, in bands that turn with it


@dataclass(frozen=True, eq=False)
class Footprint:
    """Footprint in its foot frame.

    Attributes:
        side: "left" or "right".
        origin: Back of the heel on the axis, in m, cells' frame.
        axis: Unit vector (2,) from heel to toes in that frame.
        rings: Cell corners (n, c, 2) as (u, v) in m; the last repeated where fewer than c.
        areas: Cell areas (n,) in m^2.
        pressure: Largest (n,) of each cell, or 1 if unknown.
        toe_line: u in m where toes begin, as (v, u) points from lateral to medial; None where not separated.
        edge: Cells (n,) whose corners span the convex hull; None where not known.
        alike: Whether all cells have one shape and direction.
    """

    side: Side
    origin: NDArray[np.float64]
    axis: NDArray[np.float64]
    rings: NDArray[np.float64]
    areas: NDArray[np.float64]
    pressure: NDArray[np.float64]
    toe_line: NDArray[np.float64] | None = None
    edge: NDArray[np.bool_] | None = None
    alike: bool = False

    @cached_property
    def ends(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and largest (u, v) in m of each cell, (n, 2) each."""
        return extremes(self.rings, self.alike)

    @cached_property
    def centres(self) -> NDArray[np.float64]:
        """Cell centres (n, 2) as (u, v) in m."""
        low, high = self.ends
        return np.asarray(0.5 * (low + high))

    @cached_property
    def length(self) -> float:
        """Length in m, toes included."""
        return float(self.ends[1][:, 0].max())

    @property
    def width(self) -> float:
        """Largest width in m."""
        low, high = self.ends
        return float(high[:, 1].max() - low[:, 1].min())

    @cached_property
    def is_toe(self) -> NDArray[np.bool_]:
        """Which cells (n,) are toes."""
        if self.toe_line is None:
            return np.zeros(len(self.areas), dtype=bool)
        return np.asarray(self.centres[:, 0] > np.interp(self.centres[:, 1], *self.toe_line.T))

    @property
    def toeless_length(self) -> float:
        """Length in m from heel to front of the metatarsal heads."""
        return float(self.ends[1][~self.is_toe, 0].max()) if (~self.is_toe).any() else self.length

    def area_between(self, low: float, high: float) -> float:
        """Returns toeless print area in m^2 between lines across the axis at u = low and high in m."""
        first, last = (end[:, 0] for end in self.ends)
        within = (first >= low) & (last <= high) & ~self.is_toe
        met = (last > low) & (first < high) & ~self.is_toe
        total = float(self.areas[within].sum())
        if (met & ~within).any():
            cells = CellCutter.of_polygons(self.rings[met & ~within])
            whole, cut = (cells.cut(lines)[0][:, 0] for lines in ([], [[-1.0, 0.0, -low], [1.0, 0.0, high]]))
            total += float(
                self.areas[met & ~within] @ np.divide(cut, whole, out=np.zeros_like(cut), where=whole != 0.0)
            )
        return total

    def arch_index(self) -> float:
        """Middle third over all of the toeless footprint (Cavanagh & Rodgers 1987); NaN if empty."""
        third = self.toeless_length / 3.0
        whole = float(self.areas[~self.is_toe].sum())
        return self.area_between(third, 2.0 * third) / whole if whole > 0.0 else float("nan")

    @cached_property
    def _hull(self) -> NDArray[np.float64]:
        rings = self.rings if self.edge is None else self.rings[self.edge]
        return convex_hull(rings.reshape(-1, 2))

    def width_at(self, u: float) -> float:
        """Width in m of the convex hull at a line across the axis, or 0."""
        a = self._hull
        b = np.roll(self._hull, -1, axis=0)
        rise = a[:, 0] - u
        fall = b[:, 0] - u
        met = rise * fall <= 0.0
        level = rise == fall
        at = a[:, 1] + np.where(level, 0.0, rise / np.where(level, 1.0, rise - fall)) * (b[:, 1] - a[:, 1])
        return float(np.ptp(at[met])) if met.any() else 0.0

    @cached_property
    def front_third(self) -> tuple[float, float]:
        """Where the front third begins on the axis, in m, and the width in m there."""
        at = 2.0 / 3.0 * self.length
        return at, self.width_at(at)

    @cached_property
    def _axes(self) -> NDArray[np.float64]:
        """Directions of u and v in the cells' frame, as columns."""
        across = np.array([-self.axis[1], self.axis[0]]) * (1.0 if self.side == "right" else -1.0)
        return np.column_stack([self.axis, across])

    def in_foot(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (m, 2) of the cells' frame as (u, v)."""
        return np.asarray((points - self.origin) @ self._axes)

    def from_foot(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (m, 2) as (u, v) in the cells' frame."""
        return np.asarray(self.origin + points @ np.ascontiguousarray(self._axes.T))


def footprint_of_cells(
    layout: SoleLayout | CellGrid,
    pressure: NDArray[np.float64],
    loaded: NDArray[np.bool_],
    side: Side,
    forward: NDArray[np.float64] | None = None,
) -> Footprint | None:
    """Returns footprint of loaded cells; None without any.

    `pressure`: largest (n,) of each cell; `loaded`: cells (n,) of the print; `forward`: approximate direction (2,) from
    heel to toes; exactly the sole's x axis where None.
    """
    chosen = np.flatnonzero(loaded)
    if len(chosen) == 0:
        return None
    print_ = _footprint(
        layout.cell_rings(chosen), layout.areas[chosen], pressure[chosen], side, forward, isinstance(layout, CellGrid)
    )
    return replace(print_, edge=layout.ends_of_rows(chosen)) if isinstance(layout, CellGrid) else print_


def footprint_of_pixels(
    centres: NDArray[np.float64], pixel: float, side: Side, forward: NDArray[np.float64]
) -> Footprint:
    """Returns footprint of a side's pixels: centres (n, 2) in m, x and y as in the sole frame, size pixel in m.

    Direction forward (2,), heel to toes, is approximate.
    """
    box = 0.5 * pixel * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    rings = centres[:, None, :] + box
    return _footprint(rings, np.full(len(centres), pixel**2), np.ones(len(centres)), side, forward, alike=True)


def _footprint(
    rings: NDArray[np.float64],
    areas: NDArray[np.float64],
    pressure: NDArray[np.float64],
    side: Side,
    forward: NDArray[np.float64] | None,
    alike: bool,
) -> Footprint:
    axis, through = (np.array([1.0, 0.0]), np.zeros(2)) if forward is None else _axis(rings, areas, forward, alike)
    back = float((rings @ axis).min())
    origin = through + (back - float(through @ axis)) * axis
    print_ = Footprint(side, origin, axis, rings, areas, pressure, alike=alike)
    return replace(print_, rings=print_.in_foot(rings.reshape(-1, 2)).reshape(rings.shape))


def extremes(rings: NDArray[np.float64], alike: bool = False) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Least and largest coordinates (n, 2) of rings (n, c, 2): several times faster than over so short an axis.

    Of rings that are `alike`, moved and not turned, the same corners are least and largest.
    """
    if alike and len(rings):
        ends = (rings[0].argmin(axis=0), rings[0].argmax(axis=0))
        first = np.empty((len(rings), 2))
        last = np.empty((len(rings), 2))
        for out, corners in zip((first, last), ends, strict=True):
            for axis, corner in enumerate(corners.tolist()):
                out[:, axis] = rings[:, corner, axis]
        return first, last
    low = rings[:, 0]
    high = rings[:, 0]
    for corner in range(1, rings.shape[1]):
        low = np.minimum(low, rings[:, corner])
        high = np.maximum(high, rings[:, corner])
    return low, high


def _axis(
    rings: NDArray[np.float64], areas: NDArray[np.float64], forward: NDArray[np.float64], alike: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Print's axis: direction (2,) and point (2,); halves the widths of heel and forefoot."""
    axis = np.asarray(forward, dtype=float) / np.hypot(*forward)
    through = np.average(0.5 * np.add(*extremes(rings, alike)), axis=0, weights=areas)
    for _ in range(_ROUNDS):  # the bands turn with the axis
        turned = rings.reshape(-1, 2) @ np.array([[axis[0], -axis[1]], [axis[1], axis[0]]])
        first, last = extremes(turned.reshape(rings.shape), alike)
        low = float(first[:, 0].min())
        length = float(last[:, 0].max()) - low
        centre = 0.5 * (first[:, 0] + last[:, 0])
        across = first[:, 1], last[:, 1]
        heel, fore = (_middle_of_band(centre, across, axis, low + a * length, low + b * length) for a, b in _BANDS)
        if heel is None or fore is None or np.hypot(*(fore - heel)) < 0.2 * length:
            break
        step = fore - heel
        axis = step / np.hypot(*step)
        through = heel
    return axis, np.asarray(through)


def _middle_of_band(
    centre: NDArray[np.float64],
    across: tuple[NDArray[np.float64], NDArray[np.float64]],
    axis: NDArray[np.float64],
    low: float,
    high: float,
) -> NDArray[np.float64] | None:
    """Middle of the cells in a band, by the centre (n,) of each along the axis and its two ends (n,) across."""
    inside = (centre >= low) & (centre <= high)
    if not inside.any():
        return None
    middle = 0.5 * float(across[0][inside].min() + across[1][inside].max())
    return np.asarray(0.5 * (low + high) * axis + middle * np.array([-axis[1], axis[0]]))
