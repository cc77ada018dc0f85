"""Many polygons at once, for checks that must not cost more than what they check."""

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

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
        self.size = np.fromiter(map(len, polygons), dtype=np.intp, count=len(polygons))
        most = max(1, int(self.size.max(initial=1)))
        flat = np.concatenate([np.zeros((1, 2)), *polygons])
        start = 1 + np.cumsum(self.size) - self.size
        # Polygon beside polygon (2, most, count), which numpy adds and compares fastest; seen as (count, most, 2).
        column = np.arange(most)[:, None]
        row = start + np.where(column < self.size, column, 0)
        place = np.take(flat.T, np.where(self.size > 0, row, 0), axis=1)
        low, high = place.min(axis=1), place.max(axis=1)
        edge = np.concatenate([place[:, 1:], place[:, :1]], axis=1) - place
        self.points: Array = place.T
        self.edge: Array = edge.T
        self.length: Array = np.hypot(*edge).T
        self.extent: Array = (high - low).max(axis=0)
        self.ulp: Array = 2.3e-16 * np.maximum(np.abs(low), np.abs(high)).max(axis=0)

    @cached_property
    def area(self) -> Array:
        """Signed areas (count,) in m^2, in extended precision where the machine has it."""
        local = (self.points - self.points[:, :1]).astype(np.longdouble, order="C")
        x, y = local[..., 0], local[..., 1]  # the last edge ends at the first vertex, which is 0 here
        cross = x[:, :-1] * y[:, 1:] - y[:, :-1] * x[:, 1:]
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
        ex, ey, x, y, blocked, order, real = self._edges
        px, py = (np.ascontiguousarray(points[order, :, axis].T) for axis in (0, 1))
        least = np.full(px.shape, np.inf)
        for k, (n, barred) in enumerate(zip(real, blocked, strict=True)):
            across = py[:, :n] - y[k, :n]
            across *= ex[k, :n]
            away = px[:, :n] - x[k, :n]
            away *= ey[k, :n]
            across -= away
            if barred is not None:
                across += barred
            np.minimum(least[:, :n], across, out=least[:, :n])
        back = np.empty(points.shape[:2])
        back[order] = least.T
        return back

    @cached_property
    def _edges(self) -> tuple[Array, Array, Array, Array, list[Array | None], NDArray[np.intp], list[int]]:
        """Edge by edge, the polygons with most of them first: direction, start, inf where it has no length, None where
        all have one; which polygon stands where, and how many have so many edges."""
        order = np.argsort(-self.size, kind="stable")
        length, edge, points = self.length[order].T, self.edge[order].T, self.points[order].T
        usable = length > 0.0
        direction = edge / np.where(usable, length, 1.0)
        real = (self.size > np.arange(len(length))[:, None]).sum(axis=1).tolist()
        blocked = [None if u[:n].all() else np.where(u[:n], 0.0, np.inf) for u, n in zip(usable, real, strict=True)]
        ex, ey, x, y = (np.ascontiguousarray(a) for a in (*direction, *points))
        return ex, ey, x, y, blocked, order, real

    def distance(self, points: Array) -> Array:
        """Distance (count,) in m of points (count, 2) to the boundary of each polygon: all edges, clamped."""
        away = points[:, None] - self.points
        squared = self.length**2
        share = np.clip((away * self.edge).sum(axis=-1) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
        gap = away - share[..., None] * self.edge
        return np.asarray(np.hypot(gap[..., 0], gap[..., 1]).min(axis=1))
