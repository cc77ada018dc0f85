"""The measured soles: 51 cells with 5, 20 or all active, 1,000 small cells, random outlines."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.outline import Outline, concave_outline
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.layout import SoleLayout, mirrored
from plantar.layouts.tiling import hex_layout

SIZES: dict[str, tuple[int, int]] = {"5": (51, 5), "20": (51, 20), "51": (51, 51), "dense": (1000, 850)}
"""Of each size that is measured: taxels on the sole, and how many of them about are active."""

_CASES = 12


@dataclass(frozen=True, eq=False)
class Contact:
    """A sole with some taxels active. `active`: mask (n,); `force`: normal forces (n,) in N, 0 where not active."""

    layout: SoleLayout
    active: NDArray[np.bool_]
    force: NDArray[np.float64]

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Corners (v, 2) of active cells in m, each once."""
        used = np.unique(self.layout.corner_vertex[np.repeat(self.active, np.diff(self.layout.corner_start))])
        return np.ascontiguousarray(self.layout.vertices[used, :2])

    @cached_property
    def cells(self) -> list[NDArray[np.float64]]:
        """Corners (k, 2) of each active cell in m."""
        return [self.layout.cell_polygon(int(i)) for i in np.flatnonzero(self.active)]


def foot_outline(length: float = 0.26, width: float = 0.155) -> NDArray[np.float64]:
    """Returns an ellipse-like outline (60, 2) about the origin, of `length` and `width`, in m."""
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    x = np.cos(angle)
    y = np.sin(angle)
    return np.column_stack([0.5 * length * np.sign(x) * np.abs(x) ** 0.7, 0.5 * width * np.sign(y) * np.abs(y) ** 0.7])


def sole_of(taxels: int, side: str = "left") -> SoleLayout:
    """Returns a hexagonal sole of a `side` with so many `taxels`; 51 have 691 mm^2 each.

    Example:
        >>> len(sole_of(51)), len(sole_of(7, "right"))
        (51, 7)
    """
    area = 51 * 691e-6 / taxels
    lattice = HexLattice(area)
    cells = lattice.cells_near(np.array([-0.2, -0.12]), np.array([0.2, 0.12]))
    centres = lattice.centres(cells)
    reach = np.abs(centres[:, 0] / 0.26) ** 2.8 + np.abs(centres[:, 1] / 0.155) ** 2.8
    kept = np.argsort(reach, kind="stable")[:taxels]
    layout = hex_layout(
        foot_outline(0.27, 0.165), name=f"{taxels} hexagons", cell_area=area, cells=cells[np.sort(kept)]
    )
    return layout if side == "left" else mirrored(layout)


def contacts(size: str, seed: int = 0) -> list[Contact]:
    """Returns contacts of one `size` of SIZES: patches, and cells drawn by `seed`.

    Example:
        >>> [int(c.active.sum()) for c in contacts("5")][:3], len(contacts("dense"))
        ([5, 5, 5], 12)
    """
    taxels, count = SIZES[size]
    layout = sole_of(taxels)
    rng = np.random.default_rng(seed)
    return [_contact(layout, count, rng, scattered=case % 3 == 2) for case in range(_CASES)]


def _contact(layout: SoleLayout, count: int, rng: np.random.Generator, scattered: bool) -> Contact:
    n = len(layout)
    centre = layout.positions[rng.integers(n), :2]
    distance = np.hypot(*(layout.positions[:, :2] - centre).T)
    if n > 100:  # the whole sole without a few round places: an outline with bays and holes
        active = np.ones(n, dtype=bool)
        for _ in range(3):
            hole = layout.positions[rng.integers(n), :2]
            active &= np.hypot(*(layout.positions[:, :2] - hole).T) > rng.uniform(0.01, 0.03)
    elif scattered:
        active = np.isin(np.arange(n), rng.choice(n, count, replace=False))
    else:
        active = np.isin(np.arange(n), np.argsort(distance, kind="stable")[:count])
    return Contact(layout, active, np.where(active, rng.uniform(3.0, 60.0, n), 0.0))


_CELL = 1e-5  # m^2: area of a cell at random


@lru_cache(maxsize=4)
def _lattice(cells: int) -> SoleLayout:
    half = 0.5 * math.sqrt(0.5 * cells * _CELL)
    return hex_layout([[-2 * half, -half], [2 * half, -half], [2 * half, half], [-2 * half, half]], cell_area=_CELL)


def random_outline(active: int, share: float, seed: int) -> Outline:
    """Returns the outline of about `active` cells, a `share` of a lattice's, by `seed`.

    Example:
        >>> outline = random_outline(50, 0.6, 0)
        >>> 3e-4 < outline.area < 7e-4
        True
    """
    layout = _lattice(round(active / share))
    return concave_outline(layout, np.random.default_rng(seed).random(len(layout)) < share)
