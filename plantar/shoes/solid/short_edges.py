"""Edges that are too short to make, contracted. In mm."""

from collections.abc import Iterator
from itertools import chain

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.solid.polyhedron import Loops, Polyhedron, flattened, triangles_of

_FLAT = 1e-6  # mm
_SLIVER = 1e-3  # mm^2
_TWIST = 0.01  # mm by which a face bends, from which it may fold
_EVEN = 0.03  # mm by which faces bend, up to which the fewest triangles count
_TINY = 0.05  # mm^2, twice the area of a triangle that may turn by up to 90 degrees
# of a unit normal downwards: at 45 degrees, and of a ceiling
_STEEP = 0.7072
_LEVEL = 0.999

Array = NDArray[np.float64]
_Face = list[list[int]]


def without_short_edges(body: Polyhedron, least: float) -> Polyhedron:
    """Contract edges below a length; bent faces are cut into triangles.

    `least`: shortest kept edge in mm; no corner moves farther. Returns solid; edges stay whose loss would make it touch
    itself, or a bent face fold or hang over.
    """
    work = _Contraction(body, least)
    corners = body.corners
    ends = np.array([e for e in body.neighbours if e[0] < e[1]])
    length = np.linalg.norm(corners[ends[:, 0]] - corners[ends[:, 1]], axis=1)
    stands = np.arange(len(corners))  # in place of those that are lost
    for k in np.argsort(length, kind="stable")[: int((length < least).sum())].tolist():
        a, b = stands[ends[k]].tolist()
        if a != b and np.linalg.norm(corners[a] - corners[b]) < least:
            kept, lost = work.contract(a, b)
            stands[np.isin(stands, lost)] = kept
    return work.solid()


class _Contraction:
    """Solid whose edges are contracted one after the other: its faces, and the faces at each corner."""

    def __init__(self, body: Polyhedron, least: float) -> None:
        self._corners = body.corners
        self._normals = body.normals
        self._least = least
        self._faces: list[_Face] = [[list(loop) for loop in face] for face in body.faces]
        self._bent: set[int] = set()
        self._at: dict[int, set[int]] = {}
        for i, face in enumerate(self._faces):
            for n in chain.from_iterable(face):
                self._at.setdefault(n, set()).add(i)

    def contract(self, a: int, b: int) -> tuple[int, tuple[int, ...]]:
        """Contract the edge of two corners in the first way that may be; gives the corner kept and those lost."""
        for kept, lost, off, bent in self._ways(a, b):
            lost, changed = self._changed(kept, lost)
            may_twist = (bent if off > _TWIST else set()) | self._bent & changed.keys()
            if self._fits(changed, may_twist) and self._is_closed(changed, (kept, *lost)):
                self._bent |= bent
                for i, face in changed.items():
                    self._faces[i] = face
                for n in lost:
                    self._at[kept] |= self._at.pop(n)
                return kept, lost
        return a, ()

    def solid(self) -> Polyhedron:
        """Gives the solid as it is, on the corners that are left."""
        left = ((i, tuple(map(tuple, face))) for i, face in enumerate(self._faces) if face)
        whole: Iterator[list[Loops]] = (
            [(tuple(t),) for t in triangles_of(self._corners, f).tolist()] if i in self._bent else [f] for i, f in left
        )
        faces = list(chain.from_iterable(whole))
        used = np.unique([n for face in faces for loop in face for n in loop])
        number = np.zeros(len(self._corners), dtype=np.int64)
        number[used] = np.arange(len(used))
        return Polyhedron(self._corners[used], tuple(tuple(tuple(number[list(q)].tolist()) for q in f) for f in faces))

    def _ways(self, a: int, b: int) -> list[tuple[int, tuple[int, ...], float, set[int]]]:
        """Corner kept, those lost, most that faces bend, and which do; of small bends fewest triangles first. One end
        goes, or else two corners of a small triangle.
        """
        ways: list[tuple[int, tuple[int, ...]]] = [(a, (b,)), (b, (a,))]
        for loop in (loop for i in self._at[a] & self._at[b] for loop in self._faces[i] if len(loop) == 3):
            ways += [(n, tuple(q for q in loop if q != n)) for n in loop]
        found = []
        for kept, lost in ways:
            moves = {n: self._corners[kept] - self._corners[n] for n in lost}
            if max(float(np.linalg.norm(move)) for move in moves.values()) < self._least:
                faces = [(n, i) for n in lost for i in self._at[n] - self._at[kept]]
                off = [(abs(float(self._normals[i] @ moves[n])), i) for n, i in faces]
                bent = {i for by, i in off if by > _FLAT}
                far = max(off, default=(0.0, 0))[0]
                cut = sum(len(loop) for i in bent for loop in self._faces[i])
                found.append((len(lost), max(far, _EVEN), cut, far, kept, lost, bent))
        return [(kept, lost, far, bent) for *_, far, kept, lost, bent in sorted(found, key=lambda way: way[:5])]

    def _changed(self, kept: int, lost: tuple[int, ...]) -> tuple[tuple[int, ...], dict[int, _Face]]:
        """Corners lost, and faces without them; what a vanished face leaves between two faces alone is no corner."""
        changed = {i: self._faces[i] for n in lost for i in self._at[n]}
        for n in lost:
            changed = {i: _contracted(face, n, kept) for i, face in changed.items()}
        between = {n for i, face in changed.items() if not face for n in chain.from_iterable(self._faces[i])}
        for n in sorted(between - {kept, *lost}):
            if sum(bool(changed.get(i, self._faces[i])) for i in self._at[n]) == 2:
                changed |= {i: _contracted(changed.get(i, self._faces[i]), n, kept) for i in self._at[n]}
                lost = (*lost, n)
        return lost, changed

    def _fits(self, changed: dict[int, _Face], may_twist: set[int]) -> bool:
        """Whether changed faces are sound and not twisted. One that was too narrow before goes by its edges one after
        the other.
        """
        left = {i: face for i, face in changed.items() if face}
        good = all(self._is_sound(i, f) or not self._is_sound(i, self._faces[i]) for i, f in left.items())
        return good and not any(self._is_twisted(i, left[i]) for i in may_twist & left.keys())

    def _is_sound(self, number: int, face: _Face) -> bool:
        """Whether a face is a polygon, and not turned over from its normal."""
        flat, up, axis = flattened(self._corners, face)
        polygon = shapely.Polygon(flat[0], flat[1:])
        return bool(polygon.is_valid and polygon.area > _SLIVER and up == (self._normals[number, axis] > 0.0))

    def _is_twisted(self, number: int, face: _Face) -> bool:
        """Whether triangles of a bent face turn by 45 degrees from its normal, as folds do, or hang over by more."""
        corners = self._corners[triangles_of(self._corners, tuple(map(tuple, face)))]
        own = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        double = np.linalg.norm(own, axis=1)
        own /= np.maximum(double, 1e-300)[:, None]
        down = -own[:, 2]
        least = np.where(double < _TINY, 0.0, _STEEP)
        return bool(((down > _STEEP) & (down < _LEVEL) | (own @ self._normals[number] < least)).any())

    def _is_closed(self, changed: dict[int, _Face], corners: tuple[int, ...]) -> bool:
        """Whether no directed edge repeats about corners, and no loop meets itself."""
        near = set[int]().union(*(self._at[n] for n in corners))
        loops = [loop for i in near for loop in changed.get(i, self._faces[i])]
        edges = [edge for loop in loops for edge in zip(loop, (*loop[1:], loop[0]), strict=True)]
        return len(set(edges)) == len(edges) and all(len(set(loop)) == len(loop) for loop in loops)


def _contracted(face: _Face, lost: int, kept: int) -> _Face:
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
