"""Largest shapes inside the contact: triangle, parallelogram, circle and rectangles (T 4.2.5, T 4.4.4).

The functions of a convex polygon take its vertices (k, 2) in m in either direction, with repeated or collinear
vertices; one that is not convex or not finite is refused. They return corners in m, counter-clockwise: none (0, 2)
for an empty polygon, and a shape without area within it for a polygon without area. Inside means up to
rounding: a corner may be outside by a few units in the last place of the coordinates.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arguments import number
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

    No rectangle in the outline has more than (1 + gap) times its area. That is proven, up to rounding; a search that
    came to its end leaves 1e-6.

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
    (`plantar/kernels/any_angle.py` has the proof).

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


def rectangle_in_outline_any_angle(outline: Outline, budget: float = 2e7) -> BoundedRectangle:
    """Rectangle of most area in a concave outline, at any angle, and the proven bound on all others.

    Global: a rectangle turned by t about its middle is the box around one of d^2 t less at the angle before, d its
    diagonal, so the rectangles at one angle bound those near it. Intervals of angles, the one of the largest bound
    first, are cut and thrown away until nothing above the best area is left; where they are narrow a bound of second
    order does it (`plantar/kernels/turn_bound.py`). In an outline of many vertices columns tell first where, and at
    which angles, large ones may stand (`plantar/kernels/corridors.py`). The search begins with the largest rectangle
    along the axes, so it returns none that is smaller.

    Args:
        outline: Outline with islands and holes in m.
        budget: Work after which the search ends, in units of which a millisecond holds some 500,000; inf to go on until
            all is proven. What stands along the axes is found whatever the budget. It counts steps, not time: the same
            outline and budget give the same rectangle, more of it never gives a smaller one or a larger gap.

    Returns:
        Corners (4, 2) in m and gap: no rectangle is larger by more than that share of its area. 1e-6 where the search
        came to its end, which the budget lets it do in outlines of some thousand cells at random. No corners (0, 2) and
        no gap for an empty outline.

    Raises:
        InputError: If the budget is not a number of 0 or more.

    Example:
        >>> tilted = Outline.of_rings([[[0, 0], [1, 1], [0, 2], [-1, 1]]])
        >>> corners, gap = rectangle_in_outline_any_angle(tilted)
        >>> round(float(np.linalg.norm(corners[1] - corners[0]) * np.linalg.norm(corners[2] - corners[1])), 9), gap
        (2.0, 1e-06)
    """
    work = number(budget, "budget")
    if work < 0.0:
        raise InputError(f"budget is {work:g}; expected 0 or more")
    if not len(outline):
        return BoundedRectangle(np.empty((0, 2)), 0.0)
    corners, gap = convex_shapes().rectangle_in_outline_at_any_angle(
        outline.points, outline.starts, outline.apart, work
    )
    return BoundedRectangle(np.asarray(corners), float(gap))
