"""Many polygons at once, for checks that must not cost more than what they check."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

__all__ = ["Rings"]

Array = NDArray[np.float64]


class Rings:
    """Polygons (k, 2) padded to one array with their first vertex, so that what is padded closes them.

    Args:
        polygons: The polygons in m; empty ones are padded with zeros.

    Attributes:
        size: Number of vertices of each (count,).
        points: Vertices (count, most, 2).
        extent: Larger side of each one's box in m (count,).
        ulp: Unit in the last place of each one's largest coordinate (count,).
    """

    def __init__(self, polygons: Sequence[Array]) -> None:
        self.size = np.array([len(p) for p in polygons])
        most = max(1, int(self.size.max(initial=1)))
        flat = np.concatenate([np.zeros((1, 2)), *polygons])
        start = 1 + np.cumsum(self.size) - self.size
        column = np.where(np.arange(most) < self.size[:, None], np.arange(most), 0)
        self.points: Array = flat[np.where(self.size[:, None] > 0, start[:, None] + column, 0)]
        self.extent: Array = np.ptp(self.points, axis=1).max(axis=1)
        self.ulp: Array = 2.3e-16 * np.abs(self.points).max(axis=(1, 2))
        following = np.roll(self.points, -1, axis=1)
        self.edge: Array = following - self.points
        self.length: Array = np.hypot(self.edge[..., 0], self.edge[..., 1])

    @property
    def area(self) -> Array:
        """Signed areas (count,) in m^2, in extended precision where the machine has it."""
        local = (self.points - self.points[:, :1]).astype(np.longdouble)
        following = np.roll(local, -1, axis=1)
        cross = local[..., 0] * following[..., 1] - local[..., 1] * following[..., 0]
        return np.asarray(0.5 * cross.sum(axis=1), dtype=float)

    def not_convex(self) -> Array:
        """1.0 where a polygon is not strictly convex and counter-clockwise, else 0.0 (count,): exact orientations."""
        index = np.arange(self.edge.shape[1])
        real = (index < self.size[:, None]) & (self.size[:, None] >= 3)
        after = np.where(index + 1 < self.size[:, None], index + 1, 0)
        second = np.take_along_axis(self.edge, after[..., None], axis=1)
        one, two = self.edge[..., 0] * second[..., 1], self.edge[..., 1] * second[..., 0]
        lengths = np.abs(self.edge).sum(axis=2) + np.abs(second).sum(axis=2)
        doubt = 1e-15 * (np.abs(one) + np.abs(two)) + 4.0 * self.ulp[:, None] * lengths
        wrong: Array = (real & (one - two < -doubt)).any(axis=1).astype(float)
        for i, k in np.argwhere(real & (np.abs(one - two) <= doubt)).tolist():
            ring = self.points[i, [k, (k + 1) % self.size[i], (k + 2) % self.size[i]]]
            (ax, ay), (bx, by), (cx, cy) = [(Fraction(float(u)), Fraction(float(v))) for u, v in ring]
            if (bx - ax) * (cy - by) - (by - ay) * (cx - bx) <= 0:
                wrong[i] = 1.0
        return wrong

    def depth(self, points: Array) -> Array:
        """How deep points lie inside: least distance to the lines of the edges, in m.

        Args:
            points: Points (count, m, 2) in m.

        Returns:
            Depths (count, m), negative outside, inf for a polygon without edges.
        """
        least = np.full(points.shape[:2], np.inf)
        for k in range(self.points.shape[1]):
            length = self.length[:, k]
            usable = length > 0.0
            ex, ey = (self.edge[:, k] / np.where(usable, length, 1.0)[:, None]).T
            away = points - self.points[:, k : k + 1]
            across = ex[:, None] * away[..., 1] - ey[:, None] * away[..., 0]
            least = np.where(usable[:, None], np.minimum(least, across), least)
        return least

    def distance(self, points: Array) -> Array:
        """Distance (count,) in m of points (count, 2) to the boundary of each polygon: all edges, clamped."""
        away = points[:, None] - self.points
        squared = self.length**2
        share = np.clip((away * self.edge).sum(axis=-1) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
        gap = away - share[..., None] * self.edge
        return np.asarray(np.hypot(gap[..., 0], gap[..., 1]).min(axis=1))
