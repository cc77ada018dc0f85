"""The patch of a sole that contact points span."""

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.contacts.pressed_patch import patch_key
from plantar.kernels.geometry.hull import convex_hull

T = TypeVar("T")

_POINT = 2.6  # widths of a line: half width of a point's square, which spreads as the disc under a pebble does

PATCH_GRID = 1e-4
MOST_PATCHES = 256
"""Distance in m within which patches of springs are the same, and how many are kept."""


class Patches(Generic[T]):
    """Keeps results of the latest patches.

    `make`: computes it from contact points (k, 2) in m; `grid`: distance in m within which patches are the same;
    `most`: largest number kept.
    """

    def __init__(self, make: Callable[[NDArray[np.float64]], T], grid: float, most: int) -> None:
        self._make = make
        self._grid = grid
        self._most = most
        self._made: dict[tuple[tuple[int, int], ...], T] = {}

    def of(self, points: Sequence[tuple[float, float]]) -> T:
        """Result of contact `points` (k, 2) in m, in any order."""
        key = patch_key(points, self._grid)
        if key not in self._made:
            if len(self._made) >= self._most:
                self._made.pop(next(iter(self._made)))
            self._made[key] = self._make(np.array(key) * self._grid)
        return self._made[key]


def patch_polygon(points: NDArray[np.float64], half_width: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Hull of contact points, or the rectangle around a thinner one.

    Args:
        points: (k, 2) in m, at least one.
        half_width: Of a line in m; a point's is `_POINT` times that. A sole of stiffness k in Pa/m on a sphere of
            radius R carries F on a disc of radius a = (4 R F / (pi k))^(1/4); the square with the same second moments
            is a / sqrt(2) wide each way.

    Returns:
        Counter-clockwise polygon (m, 2) in m, and its half-planes (m, 3) (`half_planes_of`).
    """
    polygon = np.asarray(convex_hull(points))
    axis = np.array([1.0, 0.0])
    if len(polygon) == 1:
        half_width *= _POINT
    if len(polygon) >= 2:
        lines = half_planes_of(polygon)
        depth = (lines[:, 2] - polygon @ lines[:, :2].T).max(axis=0)
        thinnest = int(np.argmin(depth))
        if len(polygon) > 2 and depth[thinnest] >= 2.0 * half_width:
            return polygon, lines
        axis = np.array([-lines[thinnest, 1], lines[thinnest, 0]])
    across = np.array([-axis[1], axis[0]])
    along = polygon @ axis
    side = polygon @ across
    low = along.min() - half_width
    high = along.max() + half_width
    middle = 0.5 * (side.min() + side.max())
    corners = np.array([[low, -1.0], [high, -1.0], [high, 1.0], [low, 1.0]])
    rectangle = np.asarray(corners[:, :1] * axis + (middle + corners[:, 1:] * half_width) * across)
    return rectangle, half_planes_of(rectangle)


def half_planes_of(polygon: NDArray[np.float64]) -> NDArray[np.float64]:
    """Half-planes n . x <= h of the edges of a convex polygon (k, 2) in m, counter-clockwise.

    Returns outward unit normal, and h in m, of each edge (k, 3).
    """
    edge = np.concatenate([polygon[1:], polygon[:1]]) - polygon
    length = np.hypot(edge[:, 0], edge[:, 1])
    lines = np.empty((len(polygon), 3))
    lines[:, 0] = edge[:, 1] / length
    lines[:, 1] = -edge[:, 0] / length
    lines[:, 2] = lines[:, 0] * polygon[:, 0] + lines[:, 1] * polygon[:, 1]
    return lines
