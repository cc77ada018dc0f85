"""Solid of flat faces: corners, face loops and triangles. In mm."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np
import shapely
from numpy.typing import NDArray

__all__ = ["Polyhedron", "volume_of", "without_short_edges"]

_FLAT = 1e-6  # mm
_SLIVER = 1e-3  # mm^2
_TWIST = 0.01  # mm by which a face bends, from which it may fold
_EVEN = 0.03  # mm by which faces bend, up to which the fewest triangles count
_TINY = 0.05  # mm^2, twice the area of a triangle that may turn by up to 90 degrees
_STEEP, _LEVEL = 0.7072, 0.999  # of a unit normal downwards: at 45 degrees, and of a ceiling

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
        numbers += [_triangles(self.corners, f) for f in others]
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


def _triangles(corners: Array, face: Loops) -> NDArray[np.int64]:
    if len(face) == 1 and len(face[0]) == 3:
        return np.array([face[0]])
    flat, up, _ = _flattened(corners, face)
    number = {
        tuple(q): n for loop, ring in zip(face, flat, strict=True) for n, q in zip(loop, ring.tolist(), strict=True)
    }
    parts = shapely.constrained_delaunay_triangles(shapely.Polygon(flat[0], flat[1:]))
    points = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
    u, v = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    turned = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0.0) != up
    points[turned] = points[turned, ::-1]
    return np.array([[number[q] for q in map(tuple, t)] for t in points.tolist()])


def _flattened(corners: Array, face: Sequence[Sequence[int]]) -> tuple[list[Array], bool, int]:
    """Face loops in their two largest axes, whether they turn left, and the third axis."""
    at = corners[list(face[0])]
    normal = np.cross(at - at[0], np.roll(at, -1, axis=0) - at[0]).sum(axis=0)
    axis = int(np.abs(normal).argmax())
    plane = [(axis + 1) % 3, (axis + 2) % 3]
    return [corners[list(loop)][:, plane] for loop in face], bool(normal[axis] > 0.0), axis


def without_short_edges(body: Polyhedron, least: float) -> Polyhedron:
    """Contract edges below a length; bent faces are cut into triangles.

    Args:
        body: Solid.
        least: Shortest kept edge in mm; no corner moves farther.

    Returns:
        Solid; edges stay whose loss would make it touch itself, or a bent face fold or hang over.
    """
    faces = [[list(loop) for loop in face] for face in body.faces]
    normals = body.normals
    at: dict[int, set[int]] = {}
    for i, face in enumerate(faces):
        for n in (n for loop in face for n in loop):
            at.setdefault(n, set()).add(i)
    corners = body.corners
    ends = np.array([e for e in body.neighbours if e[0] < e[1]])
    length = np.linalg.norm(corners[ends[:, 0]] - corners[ends[:, 1]], axis=1)
    bent: set[int] = set()
    stands = np.arange(len(corners))  # in place of those that are lost
    for k in np.argsort(length, kind="stable")[: int((length < least).sum())].tolist():
        a, b = stands[ends[k]].tolist()
        if a == b or np.linalg.norm(corners[a] - corners[b]) >= least:
            continue
        for kept, lost, off, now_bent in _moves(corners, normals, faces, at, (a, b), least):
            changed = {i: faces[i] for n in lost for i in at[n]}
            for n in lost:
                changed = {i: _contracted(face, n, kept) for i, face in changed.items()}
            # What a vanished face leaves between two faces alone is no corner.
            between = {n for i, face in changed.items() if not face for loop in faces[i] for n in loop}
            for n in sorted(between - {kept, *lost}):
                if sum(bool(changed.get(i, faces[i])) for i in at[n]) == 2:
                    changed |= {i: _contracted(changed.get(i, faces[i]), n, kept) for i in at[n]}
                    lost = (*lost, n)
            # A face that was too narrow before goes by its edges one after the other.
            good = all(
                _sound(corners, f, normals[i]) or not _sound(corners, faces[i], normals[i])
                for i, f in changed.items()
                if f
            )
            may_twist = (now_bent if off > _TWIST else set()) | bent & changed.keys()
            twists = (_is_twisted(corners, changed[i], normals[i]) for i in may_twist if changed[i])
            if good and not any(twists) and _closed(faces, changed, at[kept].union(*(at[n] for n in lost))):
                bent |= now_bent
                for i, face in changed.items():
                    faces[i] = face
                for n in lost:
                    at[kept] |= at.pop(n)
                    stands[stands == n] = kept
                break
    left = ((i, tuple(map(tuple, face))) for i, face in enumerate(faces) if face)
    cut = ([(tuple(t),) for t in _triangles(corners, f).tolist()] if i in bent else [f] for i, f in left)
    kept_faces: list[Loops] = list(chain.from_iterable(cut))
    used = np.unique([n for face in kept_faces for loop in face for n in loop])
    number = np.zeros(len(corners), dtype=np.int64)
    number[used] = np.arange(len(used))
    return Polyhedron(corners[used], tuple(tuple(tuple(number[list(q)].tolist()) for q in f) for f in kept_faces))


def _moves(
    corners: Array,
    normals: Array,
    faces: list[list[list[int]]],
    at: dict[int, set[int]],
    edge: tuple[int, int],
    most: float,
) -> list[tuple[int, tuple[int, ...], float, set[int]]]:
    """Ways to contract an edge, by less than a length: corner kept, those lost, most that faces bend, and which do; of
    small bends fewest triangles first. One end goes, or else two corners of a small triangle.
    """
    a, b = edge
    ways: list[tuple[int, tuple[int, ...]]] = [(a, (b,)), (b, (a,))]
    for loop in (loop for i in at[a] & at[b] for loop in faces[i] if len(loop) == 3):
        ways += [(n, tuple(q for q in loop if q != n)) for n in loop]
    found = []
    for kept, lost in ways:
        if max(float(np.linalg.norm(corners[n] - corners[kept])) for n in lost) < most:
            off = [(abs(float(normals[i] @ (corners[kept] - corners[n]))), i) for n in lost for i in at[n] - at[kept]]
            bent = {i for by, i in off if by > _FLAT}
            far = max(off, default=(0.0, 0))[0]
            cut = sum(len(loop) for i in bent for loop in faces[i])
            found.append((len(lost), max(far, _EVEN), cut, far, kept, lost, bent))
    return [(kept, lost, far, bent) for *_, far, kept, lost, bent in sorted(found, key=lambda way: way[:5])]


def _sound(corners: Array, face: list[list[int]], normal: Array) -> bool:
    """Whether a face is a polygon, and not turned over from its normal (3,)."""
    flat, up, axis = _flattened(corners, face)
    polygon = shapely.Polygon(flat[0], flat[1:])
    return bool(polygon.is_valid and polygon.area > _SLIVER and up == (normal[axis] > 0.0))


def _is_twisted(corners: Array, face: list[list[int]], normal: Array) -> bool:
    """Whether triangles of a bent face turn by 45 degrees from its normal (3,), as folds do, or hang over by more."""
    a, b, c = np.moveaxis(corners[_triangles(corners, tuple(map(tuple, face)))], 1, 0)
    own = np.cross(b - a, c - a)
    double = np.linalg.norm(own, axis=1)
    own /= np.maximum(double, 1e-300)[:, None]
    down, least = -own[:, 2], np.where(double < _TINY, 0.0, _STEEP)
    return bool(((down > _STEEP) & (down < _LEVEL) | (own @ normal < least)).any())


def _contracted(face: list[list[int]], lost: int, kept: int) -> list[list[int]]:
    out = []
    for loop in face:
        found: list[int] = []
        for n in (kept if n == lost else n for n in loop):
            if found and found[-1] == n:
                continue
            if len(found) > 1 and found[-2] == n:
                found.pop()
                continue
            found.append(n)
        while len(found) > 1 and found[0] == found[-1]:
            found.pop()
        if len(found) > 2:
            out.append(found)
    return out


def _closed(faces: list[list[list[int]]], changed: dict[int, list[list[int]]], near: set[int]) -> bool:
    """Whether no directed edge repeats, and no loop meets itself."""
    loops = [loop for i in near for loop in changed.get(i, faces[i])]
    edges = [edge for loop in loops for edge in zip(loop, (*loop[1:], loop[0]), strict=True)]
    return len(set(edges)) == len(edges) and all(len(set(loop)) == len(loop) for loop in loops)
