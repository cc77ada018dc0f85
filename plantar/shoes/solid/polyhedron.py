"""Solid of flat faces: corners, face loops and triangles. In mm."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Corner numbers around a face, counter-clockwise from outside; the outer loop first, holes clockwise
Loops = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Polyhedron:
    """Closed solid of flat faces sharing edges: corners (n, 3) in mm, and face loops."""

    corners: Array
    faces: tuple[Loops, ...]

    @cached_property
    def surface(self) -> Array:
        """Triangles (k, 3, 3) in mm, outward counter-clockwise, on the solid's corners alone."""
        quads = [f[0] for f in self.faces if len(f) == 1 and len(f[0]) == 4]
        others = [f for f in self.faces if len(f) > 1 or len(f[0]) != 4]
        numbers = [np.array(_of_quads(self.corners, np.array(quads, dtype=np.int64).reshape(-1, 4)))]
        numbers += [triangles_of(self.corners, f) for f in others]
        return np.asarray(self.corners[np.concatenate(numbers)])

    @cached_property
    def volume(self) -> float:
        return volume_of(self.surface)

    @cached_property
    def neighbours(self) -> dict[tuple[int, int], int]:
        """Face to the left of each directed edge."""
        return {
            (a, b): i
            for i, face in enumerate(self.faces)
            for loop in face
            for a, b in zip(loop, (*loop[1:], loop[0]), strict=True)
        }

    @cached_property
    def normals(self) -> Array:
        """Unit normals (faces, 3), outwards, by Newell's method."""
        outer = [f[0] for f in self.faces]
        first = np.cumsum([0, *map(len, outer[:-1])])
        at = self.corners[np.concatenate([np.array(loop) for loop in outer])]
        after = self.corners[np.concatenate([np.array((*loop[1:], loop[0])) for loop in outer])]
        start = np.repeat(at[first], [len(loop) for loop in outer], axis=0)
        out = np.add.reduceat(np.cross(at - start, after - start), first)
        return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1), 1e-300)[:, None])


def volume_of(surface: Array) -> float:
    """Volume in mm^3 enclosed by a closed surface (n, 3, 3) in mm."""
    a, b, c = np.moveaxis(surface, 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _of_quads(corners: Array, quads: NDArray[np.int64]) -> NDArray[np.int64]:
    """Two triangles of each quadrangle, cut at the diagonal with left turns on both sides."""
    at = corners[quads]
    whole = np.cross(at[:, 2] - at[:, 0], at[:, 3] - at[:, 1])
    first = np.einsum("ij,ij->i", np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]), whole)
    second = np.einsum("ij,ij->i", np.cross(at[:, 2] - at[:, 0], at[:, 3] - at[:, 0]), whole)
    good = (first > 0.0) & (second > 0.0)
    ways = np.where(good[:, None, None], [[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]])
    return np.take_along_axis(quads[:, None, :], ways, axis=2).reshape(-1, 3)


def triangles_of(corners: Array, face: Loops) -> NDArray[np.int64]:
    """Gives corner numbers (k, 3) of triangles of a face of corners (n, 3)."""
    if len(face) == 1 and len(face[0]) == 3:
        return np.array([face[0]])
    flat, up, _ = flattened(corners, face)
    number = {
        tuple(q): n for loop, ring in zip(face, flat, strict=True) for n, q in zip(loop, ring.tolist(), strict=True)
    }
    parts = shapely.constrained_delaunay_triangles(shapely.Polygon(flat[0], flat[1:]))
    points = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
    u = points[:, 1] - points[:, 0]
    v = points[:, 2] - points[:, 0]
    turned = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0.0) != up
    points[turned] = points[turned, ::-1]
    return np.array([[number[q] for q in map(tuple, t)] for t in points.tolist()])


def flattened(corners: Array, face: Sequence[Sequence[int]]) -> tuple[list[Array], bool, int]:
    """Gives face loops in the two axes of corners (n, 3) in which they are largest, whether they turn left, and the
    third axis.
    """
    at = corners[list(face[0])]
    normal = np.cross(at - at[0], np.roll(at, -1, axis=0) - at[0]).sum(axis=0)
    axis = int(np.abs(normal).argmax())
    plane = [(axis + 1) % 3, (axis + 2) % 3]
    return [corners[list(loop)][:, plane] for loop in face], bool(normal[axis] > 0.0), axis
