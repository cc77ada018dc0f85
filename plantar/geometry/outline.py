"""Exact concave outline of the contact: the active cells' union, with islands and holes (T 4.2.5)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import items
from plantar.common.arrays import array, integers, own, read_only
from plantar.common.lazy import lazy
from plantar.common.plane_points import plane_points
from plantar.errors import InputError
from plantar.kernels.geometry.outline import Rings, area_and_centroid
from plantar.kernels.geometry.outline import ring_areas as areas_of_rings
from plantar.layouts.cell_edges import EdgeTable, edge_table
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_mask

_BOOL = np.dtype(np.bool_)


class Outline(Rings):
    """Rings around an area, read-only: islands' rims counter-clockwise, holes' clockwise.

    `points`: vertices (k, 2) of all rings in m, in turn, no last point repeated; `starts`: offsets (r + 1) of rings in
    `points`; `ring_areas`: signed area of each ring in m^2, below 0 for a hole; `area`: area in m^2, holes left out;
    exact to 1e-12.

    Example:
        >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
        >>> outline = Outline.of_rings([square])
        >>> outline.area, outline.centroid.tolist(), len(outline), Outline.of_rings([]).area
        (2.0, [1.0, 0.5], 1, 0.0)
    """

    if TYPE_CHECKING:  # what the kernel's class brings
        points: NDArray[np.float64]
        starts: Sequence[int]
        ring_areas: Sequence[float]

        @property
        def area(self) -> float: ...

    def __init__(self, points: ArrayLike, starts: Sequence[int], ring_areas: Sequence[float]) -> None:
        # Kernels follow the offsets.
        kept = own(plane_points(points, "points of an outline"))
        offsets = tuple(integers(starts, "offsets of an outline", ("r + 1",)).tolist())
        if not offsets or offsets[0] != 0 or offsets[-1] != len(kept) or any(b - a < 3 for a, b in pairwise(offsets)):
            raise InputError(f"offsets of an outline are {_shortly(offsets)}; expected 0 to {len(kept)} by 3 or more")
        right = areas_of_rings(kept, offsets)
        given = array(ring_areas, "areas of an outline", (len(right),), finite=True).tolist()
        # nature: floating point, far above a sum's roundings
        slack = 1e-9 * float(np.ptp(kept, axis=0).max()) ** 2 if len(kept) else 0.0
        if any(not abs(a - b) <= slack or b == 0.0 for a, b in zip(given, right, strict=True)):
            raise InputError(f"areas of an outline are {_shortly(given)}; those of its rings are {_shortly(right)}")
        super().__init__(kept, offsets, tuple(given))  # type: ignore[no-untyped-call]

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles are constructed: numpy forgets what is read-only.
        return type(self), (self.points, self.starts, self.ring_areas)

    @classmethod
    def of_rings(cls, rings: Sequence[ArrayLike]) -> Outline:
        """Outline of rings (k, 2) in m, islands' rims counter-clockwise and holes' clockwise; those without area are
        left out, InputError for other shapes.
        """
        parts = [plane_points(ring, "ring") for ring in items(rings, "rings")]
        return cls._with_area(np.concatenate([np.empty((0, 2)), *parts]), [0, *accumulate(map(len, parts))])

    @classmethod
    def _with_area(cls, points: NDArray[np.float64], starts: Sequence[int]) -> Outline:
        """Outline of rings in an unshared array, less those without area."""
        areas = areas_of_rings(points, starts)
        if 0.0 in areas:
            kept = [(points[a:b], area) for (a, b), area in zip(pairwise(starts), areas, strict=True) if area != 0.0]
            points = np.concatenate([np.empty((0, 2)), *(ring for ring, _ in kept)])
            starts = [0, *accumulate(len(ring) for ring, _ in kept)]
            areas = [area for _, area in kept]
        return cls._of(points, starts, areas)

    @classmethod
    def _of(cls, points: NDArray[np.float64], starts: Sequence[int], areas: Sequence[float]) -> Outline:
        """Outline of checked values in an unshared array."""
        made = cls.__new__(cls)
        Rings.__init__(made, read_only(points), tuple(starts), tuple(areas))
        return made

    def __len__(self) -> int:
        return len(self.ring_areas)

    @property
    def rings(self) -> tuple[NDArray[np.float64], ...]:
        """Vertices (k, 2) of each ring in m."""
        return tuple(self.points[a:b] for a, b in pairwise(self.starts))

    @lazy
    def centroid(self) -> NDArray[np.float64] | None:
        """Centroid (2,) of the area in m, less holes; None if empty."""
        if not len(self):
            return None
        _, x, y = area_and_centroid(self.points, self.starts)
        return np.array([x, y])

    @lazy
    def islands(self) -> tuple[tuple[NDArray[np.float64], ...], ...]:
        """Each island: its rim (k, 2) in m, then the rims of its holes."""
        rings = self.rings
        shells = [i for i, area in enumerate(self.ring_areas) if area > 0.0]
        parts: dict[int, list[NDArray[np.float64]]] = {i: [rings[i]] for i in shells}
        for i, area in enumerate(self.ring_areas):
            if area > 0.0:
                continue
            around = [s for s in shells if self.ring_areas[s] > -area and _is_around(rings[s], rings[i])]
            if around:  # islands nest: the smallest rim around a hole is its own
                parts[min(around, key=lambda s: self.ring_areas[s])].append(rings[i])
        return tuple(tuple(part) for part in parts.values())

    def moved(self, rotation: ArrayLike, translation: ArrayLike) -> Outline:
        """Outline in another frame, seen from above.

        `rotation`: rotation (2, 2), or (3, 3), from this frame to the other; `translation`: position (2,) or (3,) of
        this frame's origin in the other frame in m.
        """
        whole = array(rotation, "rotation", ("2 or 3", "2 or 3"), finite=True)
        # nature: floating point of single precision, in which a file may hold a rotation
        if whole.shape not in ((2, 2), (3, 3)) or np.abs(whole).max() > 1.0 + 1e-6:
            raise InputError(f"rotation of shape {whole.shape} is none of the plane (2, 2) or of space (3, 3)")
        place = array(translation, "translation", ("2 or 3",), finite=True)
        if len(place) not in (2, 3):
            raise InputError(f"translation has shape {place.shape}; expected (2,) or (3,)")
        turn = whole[:2, :2]
        shift = place[:2]
        points = self.points @ turn.T + shift
        (xx, xy), (yx, yy) = turn.tolist()
        if xx * yy < xy * yx:  # seen from below
            points = np.concatenate([points, *(points[a:b][::-1] for a, b in pairwise(self.starts))])[len(points) :]
        return Outline._with_area(points, self.starts)


def concave_outline(layout: SoleLayout, active: ArrayLike) -> Outline:
    """Exact outline of one sole's contact, with islands and holes (T 4.2.5, where [172] approximates).

    Args:
        layout: Sole, n taxels.
        active: Active taxels (n,).

    Returns:
        Outline in sole frame in m, its area exact to 1e-12; empty without contact. Islands that meet in a point stay
        separate.

    Raises:
        ReadingError: Mask does not fit.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], clip=False)
        >>> whole = concave_outline(layout, np.ones(len(layout), dtype=bool))
        >>> len(whole), bool(abs(whole.area - layout.areas.sum()) < 1e-15)
        (1, True)
    """
    table: EdgeTable | None
    # What is right at a glance; the kernel counts the taxels.
    if type(active) is np.ndarray and active.dtype is _BOOL and active.ndim == 1 and type(layout) is SoleLayout:
        table = layout.__dict__.get("_edge_table")
        if table is not None:
            found: Outline | None = table.rings(active.tobytes(), Outline)
            if found is not None:
                return found
    chosen = taxel_mask(layout, active, "mask of active taxels")
    try:
        table = layout.__dict__["_edge_table"]
    except KeyError:
        table = edge_table(layout.vertices[:, :2], layout.corners)
        layout.__dict__["_edge_table"] = table
    if table is None:
        return _union([layout.cell_polygon(int(i)) for i in np.flatnonzero(chosen)])
    outline: Outline = table.rings(chosen.tobytes(), Outline)
    return outline


def _union(parts: Sequence[NDArray[np.float64] | tuple[NDArray[np.float64], ...]]) -> Outline:
    import shapely

    shapes = [shapely.Polygon(p[0], p[1:]) if isinstance(p, tuple) else shapely.Polygon(p) for p in parts]
    whole = shapely.union_all([shapely.make_valid(s) for s in shapes])
    rings: list[NDArray[np.float64]] = []
    for part in shapely.get_parts(whole):
        if part.geom_type == "Polygon":
            part = shapely.geometry.polygon.orient(part)
            rings += [np.array(r.coords)[:-1] for r in (part.exterior, *part.interiors)]
    return Outline.of_rings(rings)


def _shortly(values: Sequence[float]) -> str:
    return f"[{', '.join(f'{v:.6g}' for v in values[:6])}{', ...' if len(values) > 6 else ''}]"


def _is_around(shell: NDArray[np.float64], hole: NDArray[np.float64]) -> bool:
    """Whether a rim encloses a hole, by its first edge's middle."""
    x, y = 0.5 * (hole[0] + hole[1])
    a = shell
    b = np.roll(shell, -1, axis=0)
    crosses = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return bool((crosses & (x < at)).sum() % 2)
