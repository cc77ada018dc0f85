"""Largest shapes inside the contact: triangle, parallelogram, circle and rectangles (T 4.2.5, T 4.4.4).

The functions of a convex polygon take its vertices (k, 2) in m in either direction, with repeated or collinear
vertices; one that is not convex or not finite is refused. They return corners in m, counter-clockwise: none (0, 2)
for an empty polygon, and a shape without area within it for a polygon without area. Inside means up to
rounding: a corner may be outside by a few units in the last place of the coordinates.
"""

from __future__ import annotations

import heapq
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arguments import integer
from plantar.errors import InputError
from plantar.geometry.convex_shapes import convex_shapes
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import convex_ring

__all__ = [
    "BoundedRectangle",
    "Circle",
    "inscribed_circle",
    "inscribed_parallelogram",
    "inscribed_rectangle",
    "inscribed_rectangle_any_angle",
    "inscribed_triangle",
    "rectangle_in_outline",
    "rectangle_in_outline_any_angle",
]


_FIRST = 32  # intervals of a quarter turn that a scan begins with
_PROVEN = 1e-6  # share of the area that is not looked for


class Circle(NamedTuple):
    """A circle: centre (2,) in m and radius in m.

    Example:
        >>> Circle(np.array([0.0, 0.0]), 0.05).radius
        0.05
    """

    center: NDArray[np.float64]
    radius: float


class BoundedRectangle(NamedTuple):
    """A rectangle and how much larger any other may be: corners (4, 2) in m, none (0, 2) of an empty outline.

    No rectangle in the outline has more than (1 + gap) times its area. That is proven, up to rounding.

    Example:
        >>> BoundedRectangle(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]), 1e-6).gap
        1e-06
    """

    corners: NDArray[np.float64]
    gap: float


def inscribed_triangle(polygon: ArrayLike) -> NDArray[np.float64]:
    """Triangle of most area in a convex polygon (T 4.2.5, [173]).

    Its corners are vertices. For every first corner the third one walks on as the second does, in O(k^2); the walk in
    O(k) that [173] publishes misses the largest one on some polygons.

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Corners (3, 2) in m; exact.

    Example:
        >>> inscribed_triangle([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 3.0], [0.0, 1.0]]).tolist()
        [[0.0, 0.0], [4.0, 0.0], [2.0, 3.0]]
    """
    return np.asarray(convex_shapes().triangle(convex_ring(polygon)))


def inscribed_parallelogram(polygon: ArrayLike) -> NDArray[np.float64]:
    """Parallelogram of most area in a convex polygon (T 4.2.5, [174]).

    One corner lies on a vertex, the others on the boundary (Jin and Matulef 2011). From every vertex one side walks
    once round the boundary, in O(k) linear pieces on which the area is a parabola: exact, in O(k^2).

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Corners (4, 2) in m; its area is exact to 1e-12 of it.

    Example:
        >>> corners = inscribed_parallelogram([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
        >>> corners.tolist()  # half of the triangle
        [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.5]]
    """
    return np.asarray(convex_shapes().parallelogram(convex_ring(polygon)))


def inscribed_circle(polygon: ArrayLike) -> Circle | None:
    """Largest circle in a convex polygon.

    The least distance to an edge is concave in x and y; cuts (tangents) of its maximum over y, and of that over x, end
    on the deepest point after a few.

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Centre and radius in m, the radius exact to 1e-12 of it; where several circles fit, as in a long rectangle, one
        of them. Radius 0 at the middle of a polygon without area; None for an empty polygon.

    Example:
        >>> circle = inscribed_circle([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
        >>> circle.center.round(12).tolist(), round(circle.radius, 12)
        ([1.0, 1.0], 1.0)
        >>> inscribed_circle([]) is None
        True
    """
    center, radius = convex_shapes().circle(convex_ring(polygon))
    return Circle(center[0], float(radius)) if len(center) else None


def inscribed_rectangle(polygon: ArrayLike, angle: float = 0.0) -> NDArray[np.float64]:
    """Rectangle of most area in a convex polygon whose sides stand at a given angle (T 4.4.4, [189]).

    The height that a width allows is concave and piecewise linear in the width; both the best place of a width and
    the best width are found with cuts (tangents), which end on the exact optimum after a few.

    Args:
        polygon: Convex polygon (k, 2) in m.
        angle: Angle of the first side against x in rad; 0 for a rectangle along the axes.

    Returns:
        Corners (4, 2) in m from the lower left one at angle 0; its area is exact to 1e-12 of it, and to 1e-8 where
        edges lie within 1e-3 rad of the sides' directions without lying on them.

    Example:
        >>> inscribed_rectangle([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]).tolist()
        [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.5]]
    """
    return np.asarray(convex_shapes().rectangle(convex_ring(polygon), angle))


def inscribed_rectangle_any_angle(polygon: ArrayLike) -> NDArray[np.float64]:
    """Rectangle of most area in a convex polygon, at any angle.

    Global, not a local summit: the edges that hold the best rectangle at one angle bound those at every other angle, by
    weak duality and to second order, so that some 40 steps along the quarter turn leave nothing above the best area
    (`plantar/kernels/geometry/any_angle.py` has the proof).

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Corners (4, 2) in m; its area is within 1e-6 of the largest one.

    Example:
        >>> corners = inscribed_rectangle_any_angle([[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]])
        >>> round(float(np.linalg.norm(corners[1] - corners[0]) * np.linalg.norm(corners[2] - corners[1])), 9)
        2.0
    """
    return np.asarray(convex_shapes().rectangle_at_any_angle(convex_ring(polygon)))


def rectangle_in_outline(outline: Outline, angle: float = 0.0) -> NDArray[np.float64]:
    """Rectangle of most area in a concave outline whose sides stand at a given angle.

    Exact, not from a raster: the outline is cut into trapezoids, and branch and bound over the first and last
    trapezoid of a rectangle solves what is left as convex polygons.

    Args:
        outline: Outline with islands and holes in m.
        angle: Angle of the first side against x in rad; 0 for a rectangle along the axes.

    Returns:
        Corners (4, 2) in m; its area is exact to 1e-12 of it, and to 1e-7 where edges lie within 1e-3 rad of the sides'
        directions without lying on them. No corners (0, 2) for an empty outline.

    Example:
        >>> corner = Outline.of_rings([[[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]]])
        >>> rectangle_in_outline(corner).tolist()
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]]
    """
    if not len(outline):
        return np.empty((0, 2))
    shapes = convex_shapes()
    return np.asarray(shapes.rectangle_in_outline(outline.points, outline.starts, outline.apart, float(angle)))


def rectangle_in_outline_any_angle(outline: Outline, looks: int = 300) -> BoundedRectangle:
    """Largest rectangle in a concave outline found by a scan of its angles, and the proven bound on all others.

    A rectangle turned by t about its middle holds one of d^2 sin(2 t) / 2 less at the angle before, d its diagonal: so
    the largest rectangle at one angle bounds those near it. Intervals of angles, the one of the largest bound first,
    are looked at in their middle and halved. The best angle is refined at the end.

    Args:
        outline: Outline with islands and holes in m.
        looks: At how many angles the outline is looked at; more of them never give a larger gap.

    Returns:
        Corners (4, 2) in m and gap: no rectangle is larger by more than that share of its area. No corners (0, 2) and
        no gap for an empty outline.

    Raises:
        InputError: If there is not at least one look.

    Example:
        >>> tilted = Outline.of_rings([[[0, 0], [1, 1], [0, 2], [-1, 1]]])
        >>> corners, gap = rectangle_in_outline_any_angle(tilted)
        >>> round(float(np.linalg.norm(corners[1] - corners[0]) * np.linalg.norm(corners[2] - corners[1])), 6), gap
        (2.0, 1e-06)
    """
    most = integer(looks, "looks", 1)
    if not len(outline):
        return BoundedRectangle(np.empty((0, 2)), 0.0)
    if len(outline.rings) == 1 and _is_convex(outline.rings[0]):
        return BoundedRectangle(inscribed_rectangle_any_angle(outline.rings[0]), _PROVEN)
    reach2 = float((np.ptp(outline.points, axis=0) ** 2).sum())  # no diagonal is longer
    angle, corners = 0.0, rectangle_in_outline(outline)
    best = _area(corners)
    half = 0.25 * math.pi / _FIRST
    waiting = [(-math.inf, (2 * k + 1) * half, half) for k in range(_FIRST)]
    for _ in range(most):
        bound, middle, half = heapq.heappop(waiting)
        if -bound <= best * (1.0 + _PROVEN):
            heapq.heappush(waiting, (bound, middle, half))
            break
        found = rectangle_in_outline(outline, middle)
        if _area(found) > best:
            angle, corners, best = middle, found, _area(found)
        # Half of the interval to either side, each with the bound of its farther end.
        bound = max(bound, -(_area(found) + 0.5 * reach2 * math.sin(2.0 * half)))
        for side in (-0.5, 0.5):
            heapq.heappush(waiting, (bound, middle + side * half, 0.5 * half))
    width = 0.5 * math.pi / _FIRST
    while width > 1e-7:  # refine
        for trial in (angle - width, angle + width):
            found = rectangle_in_outline(outline, trial)
            if _area(found) > best:
                angle, corners, best = trial, found, _area(found)
                break
        else:
            width *= 0.5
    gap = max(_PROVEN, -waiting[0][0] / best - 1.0) if best > 0.0 else 0.0
    return BoundedRectangle(corners, gap)


def _area(corners: NDArray[np.float64]) -> float:
    """Area in m^2 of a rectangle's corners."""
    first, second = corners[1] - corners[0], corners[2] - corners[1]
    return float(math.hypot(*first) * math.hypot(*second))


def _is_convex(ring: NDArray[np.float64]) -> bool:
    """Whether a ring is convex, so that the rectangle at any angle is known without a scan."""
    try:
        convex_ring(ring)
    except InputError:
        return False
    return True
