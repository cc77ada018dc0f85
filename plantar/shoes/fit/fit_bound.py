"""Proven upper bound on a lattice's whole cells inside an outline. In mm.

Branch and bound over offset and angle. A cell is inside the convex hull's half planes and outside the triangles that
fill its pockets; each slack changes by at most the cell's motion, in a box of placements at most `reach` = half its
diagonal + (distance of the cell's farthest point from the centre of rotation) x half its angle. Cells with slack below
-reach at the middle are outside for the whole box; the others bound it.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.fit.cell_pattern import CellPattern

_BUDGET = 40_000_000  # conditions looked at: boxes x cells x edges
_LEFT_OVER = 4000  # boxes
_APART = math.radians(0.2)  # two angles that differ
_MOST_ANGLES = 6
_AT_ONCE = 1000  # boxes
_CHUNK = 6_000_000  # numbers held at a time
_SLACK = 1e-3  # mm by which a cell may leave the outline, as in the fit
# mm of detail that is dropped, of an outline with many corners
_DETAIL = 0.01
_COARSE_DETAIL = 0.1
_MANY_CORNERS = 40

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CellBound:
    """Proven bound.

    `bound`: whole cells no placement exceeds; `best`: whole cells of the best seen placement, up to hundredths of a mm
    outside; `origin`: centre of one of its cells in mm; `angle` of its rows in rad; `angles` in rad, of boxes left
    over, where more may fit.
    """

    bound: int
    best: int
    origin: tuple[float, float]
    angle: float
    boxes: int
    angles: tuple[float, ...] = ()


def bound_whole_cells(region: Any, pattern: CellPattern, *, known: int = 0, share: float = 1.0) -> CellBound:
    """Bound the whole cells in an outline.

    `region`: Shapely polygon without holes in mm; `share`: search ends at this share of the bound. Returns bound and
    best seen placement; `best` is 0 if none beats `known`.

    Example:
        >>> import shapely
        >>> from plantar.shoes.fit.cell_pattern import hex_pattern
        >>> bound_whole_cells(shapely.box(0, 0, 57.0, 33.0), hex_pattern(691.0)).bound
        2
    """

    # Fewer corners, none of them inside the region: what is proven for the larger outline holds for the region.
    detail = _DETAIL if len(region.exterior.coords) <= _MANY_CORNERS else _COARSE_DETAIL
    larger = region.simplify(detail).buffer(detail + _SLACK, join_style="mitre", mitre_limit=2.0)
    outline = _Outline.of(larger, pattern)
    width = pattern.width
    rise = pattern.rise
    far = outline.radius + pattern.reach
    turns = max(1, math.ceil(far * 0.5 * pattern.period / (0.25 * width)))
    count = np.array([4, 4, turns])
    half = np.tile(0.5 * np.array([width, rise, pattern.period]) / count, (int(count.prod()), 1))
    axes = [h * (2.0 * np.arange(n) + 1.0) for h, n in zip(half[0], count, strict=True)]
    boxes = np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], axis=1)
    upper = np.full(len(boxes), math.floor(region.area / pattern.area + 1e-6))
    eighths = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)
    best = known
    placement = None
    looked = 0
    bound = int(upper[0])
    while len(boxes):
        inside, possible = outline.counts(boxes[:_AT_ONCE], half[:_AT_ONCE], best)
        looked += len(inside)
        top = int(inside.argmax())
        if inside[top] > best:
            best = int(inside[top])
            placement = boxes[top]
        upper[:_AT_ONCE] = np.minimum(upper[:_AT_ONCE], possible)
        bound = max(best, int(upper.max()))
        if bound <= best / share or looked * outline.conditions > _BUDGET:
            break
        halves = np.repeat(0.5 * half[:_AT_ONCE], 8, axis=0)
        eight = np.repeat(boxes[:_AT_ONCE], 8, axis=0) + np.tile(eighths, (len(inside), 1)) * halves
        boxes = np.concatenate([eight, boxes[_AT_ONCE:]])
        half = np.concatenate([halves, half[_AT_ONCE:]])
        upper = np.concatenate([np.repeat(upper[:_AT_ONCE], 8), upper[_AT_ONCE:]])
        order = np.argsort(-upper, kind="stable")  # those that may hold the most come first
        order = order[upper[order] > best]
        boxes = boxes[order]
        half = half[order]
        upper = upper[order]
    else:
        bound = best
    angles: list[float] = [] if placement is None else [float(placement[2])]
    for angle in boxes[np.argsort(-upper, kind="stable"), 2][:_LEFT_OVER].tolist() if bound > best else ():
        if all(abs(angle - a) > _APART for a in angles) and len(angles) < _MOST_ANGLES:
            angles.append(angle)
    if placement is None:
        return CellBound(bound, 0, (0.0, 0.0), 0.0, looked, tuple(angles))
    u, v, angle = (float(x) for x in placement)
    c = math.cos(angle)
    s = math.sin(angle)
    origin = (outline.centre[0] + c * u - s * v, outline.centre[1] + s * u + c * v)
    return CellBound(bound, best, origin, angle, looked, tuple(angles))


@dataclass(frozen=True)
class _Outline:
    """Outline about a rotation centre: half planes n x <= d, and forbidden triangles."""

    centre: tuple[float, float]
    radius: float
    normals: Array
    offsets: Array
    triangles: Array
    cells: Array
    parts: tuple[Array, ...]
    reach: float

    @classmethod
    def of(cls, region: Any, pattern: CellPattern) -> "_Outline":
        hull = region.convex_hull
        circle = shapely.minimum_bounding_circle(region)
        centre = circle.centroid
        points = shapely.get_coordinates(shapely.geometry.polygon.orient(hull).exterior)[:-1] - [centre.x, centre.y]
        edge = np.roll(points, -1, axis=0) - points
        length = np.hypot(*edge.T)
        points = points[length > 1e-9]
        edge = edge[length > 1e-9]
        length = length[length > 1e-9]
        normals = np.column_stack([edge[:, 1], -edge[:, 0]]) / length[:, None]
        pockets = [p for p in getattr(hull.difference(region), "geoms", [hull.difference(region)]) if p.area > 1e-2]
        triangles = [
            shapely.get_coordinates(t.exterior)[:3] - [centre.x, centre.y]
            for p in pockets
            for t in shapely.constrained_delaunay_triangles(p).geoms
            if t.area > 1e-3
        ]
        lattice = pattern.at((0.0, 0.0), 0.0)
        radius = float(np.hypot(*points.T).max())
        box = np.array([radius, radius])
        cells = lattice.centres(lattice.cells_near(-box, box))
        cells = cells[np.hypot(*cells.T) <= radius + (pattern.width + pattern.reach)]
        return cls(
            (centre.x, centre.y),
            radius,
            normals,
            np.einsum("ij,ij->i", normals, points),
            np.array(triangles).reshape(-1, 3, 2),
            cells,
            pattern.parts,
            pattern.reach,
        )

    @property
    def conditions(self) -> int:
        return len(self.cells) * (len(self.normals) + 3 * len(self.triangles))

    def counts(self, boxes: Array, half: Array, wanted: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Whole cells (b,) at the middle of boxes (b, 3) of half size (b, 3); a bound (b,) each."""
        faces = 3 + max(len(p) for p in self.parts)
        step = max(1, _CHUNK // (len(self.cells) * (len(self.normals) + faces * len(self.triangles))))
        parts = [self._counts(boxes[i : i + step], half[i : i + step], wanted) for i in range(0, len(boxes), step)]
        return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])

    def _counts(self, boxes: Array, half: Array, wanted: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        offset = boxes[:, :2]
        angle = boxes[:, 2]
        c = np.cos(angle)
        s = np.sin(angle)
        turn = np.stack([np.stack([c, s], -1), np.stack([-s, c], -1)], -2)  # to the lattice's frame
        normals = np.einsum("bij,kj->bki", turn, self.normals)
        room = self.offsets - _reach(normals, np.concatenate(self.parts)) - np.einsum("bki,bi->bk", normals, offset)
        slack = (room[:, :, None] - normals @ self.cells.T).min(axis=1)
        far = np.hypot(*np.moveaxis(self.cells[None] + offset[:, None], -1, 0)) + self.reach
        reach = np.hypot(half[:, 0], half[:, 1])[:, None] + half[:, 2, None] * far
        if len(self.triangles):
            open_boxes = np.flatnonzero((slack >= -reach).sum(axis=1) > wanted)
            if len(open_boxes):
                clear = self._clear_of_triangles(turn[open_boxes], offset[open_boxes])
                slack[open_boxes] = np.minimum(slack[open_boxes], clear)
        possible = (slack >= -reach).sum(axis=1)
        return np.where(possible > wanted, (slack >= 0.0).sum(axis=1), 0), possible

    def _clear_of_triangles(self, turn: Array, offset: Array) -> Array:
        """Clearance of cells (b, n) from triangles; negative inside (separating axes)."""
        corners = np.einsum("bij,tkj->btki", turn, self.triangles)
        edge = np.roll(corners, -1, axis=2) - corners
        first = corners[:, :, 1] - corners[:, :, 0]
        second = corners[:, :, 2] - corners[:, :, 0]
        area = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
        normal = np.stack([edge[..., 1], -edge[..., 0]], -1) / np.hypot(edge[..., 0], edge[..., 1])[..., None]
        normal = normal * np.sign(area)[..., None, None]
        at = self.cells[None] + offset[:, None]  # (b, n, 2)
        own = np.einsum("btki,bni->btkn", normal, at) - np.einsum("btki,btki->btk", normal, corners)[..., None]
        clear = np.full((len(turn), len(self.cells)), np.inf)
        for part in self.parts:  # the normals of both point outwards: a part is clear on one side of either
            along = own - _reach(-normal, part)[..., None]
            faces, offsets = _faces(part)
            nearest = np.einsum("btki,fi->btkf", corners, faces).min(axis=2)  # (b, t, f)
            across = nearest[:, :, None, :] - (at @ faces.T)[:, None] - offsets  # (b, t, n, f)
            clear = np.minimum(clear, np.maximum(along.max(axis=2), across.max(axis=3)).min(axis=1))
        return clear


def _reach(directions: Array, part: Array) -> Array:
    return np.asarray((directions @ part.T).max(axis=-1))


def _faces(part: Array) -> tuple[Array, Array]:
    edge = np.roll(part, -1, axis=0) - part
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    return normal, np.einsum("ki,ki->k", normal, part)
