"""Largest shapes inside the contact: triangle, parallelogram, circle and rectangles (T 4.2.5, T 4.4.4).

Convex polygons (k, 2) in m may turn either way and repeat vertices. Corners in m, counter-clockwise: none (0, 2) for an
empty polygon, a shape without area for one without.
"""

import heapq
import math
from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, number
from plantar.errors import InputError
from plantar.geometry.enclosing import bounding_box, convex_shapes
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import convex_ring

_QUARTER = 0.5 * math.pi  # nature: a rectangle that is turned by a right angle is the same
# intervals of a quarter turn that a scan begins with; chosen: more make the scan slower, not better: each interval is
# halved where its bound asks for it
_FIRST = 32
# local maxima of a scan that are refined; chosen: the highest may be narrow, so more than one; tests compare with a
# dense scan
_STARTS = 3
# angles that a scan measures: a rectangle changes smoothly between its edges' directions; chosen: tests hold its area
# against the scan with bounds
_LOOKS = 64
_PROVEN = 1e-6  # share of the area that is not looked for; chosen: far below what taxels see of a polygon


class Circle(NamedTuple):
    """Circle: center (2,) in m and radius in m."""

    center: NDArray[np.float64]
    radius: float


def inscribed_triangle(polygon: ArrayLike) -> NDArray[np.float64]:
    """Corners (3, 2) in m of the largest triangle in a convex polygon (k, 2) (T 4.2.5, [173]); exact.

    In O(k^2); the O(k) walk of [173] misses some.

    Example:
        >>> inscribed_triangle([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 3.0], [0.0, 1.0]]).tolist()
        [[0.0, 0.0], [4.0, 0.0], [2.0, 3.0]]
    """
    return np.asarray(convex_shapes().triangle(convex_ring(polygon)))


def inscribed_parallelogram(polygon: ArrayLike) -> NDArray[np.float64]:
    """Corners (4, 2) in m of the largest parallelogram in a convex polygon (k, 2) (T 4.2.5, [174]), exact to 1e-12.

    From every vertex one side walks once round, in O(k) pieces of parabolic area (Jin and Matulef 2011).

    Example:
        >>> inscribed_parallelogram([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]).tolist()  # half of the triangle
        [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.5]]
    """
    return np.asarray(convex_shapes().parallelogram(convex_ring(polygon)))


def inscribed_circle(polygon: ArrayLike) -> Circle | None:
    """Largest circle in a convex polygon (k, 2), or any of several, its radius exact to 1e-12.

    Returns center and radius in m; radius 0 at middle of polygon without area; None for an empty polygon.

    Example:
        >>> circle = inscribed_circle([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
        >>> circle.center.round(12).tolist(), round(circle.radius, 12), inscribed_circle([])
        ([1.0, 1.0], 1.0, None)
    """
    center, radius = convex_shapes().circle(convex_ring(polygon))
    return Circle(center[0], float(radius)) if len(center) else None


def inscribed_rectangle(polygon: ArrayLike, angle: float = 0.0) -> NDArray[np.float64]:
    """Largest rectangle in a convex polygon, at a given angle (T 4.4.4, [189]).

    Args:
        polygon: Convex polygon (k, 2) in m.
        angle: Of first side against x in rad, finite.

    Returns:
        Corners (4, 2) in m from the lower left one at angle 0; area exact to 1e-12; to 1e-8 where edges are almost
        parallel to sides.
    """
    return np.asarray(convex_shapes().rectangle(convex_ring(polygon), number(angle, "angle", finite=True)))


def inscribed_rectangle_any_angle(polygon: ArrayLike) -> NDArray[np.float64]:
    """Corners (4, 2) in m of the largest rectangle in a convex polygon (k, 2) by a scan of angles."""
    ring = np.asarray(convex_ring(polygon))
    edges = np.roll(ring, -1, axis=0) - ring
    # The edges' directions first: the best rectangle often has a side on one, and that of a needle always.
    longest = edges[np.argsort(-np.hypot(*edges.T))[:16]]
    seeds = np.arctan2(longest[:, 1], longest[:, 0])
    return _scan(lambda angle: inscribed_rectangle(ring, angle), ring, seeds)


def rectangle_in_outline(outline: Outline, angle: float = 0.0) -> NDArray[np.float64]:
    """Largest rectangle in a concave outline, at a given angle.

    `outline`: outline with islands and holes in m; `angle` of first side against x in rad, finite. Returns corners (4,
    2) in m; area exact to 1e-12; to 1e-7 where edges are almost parallel to sides. (0, 2) if empty.

    Example:
        >>> corner = Outline.of_rings([[[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]]])
        >>> rectangle_in_outline(corner).tolist()
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]]
    """
    if not len(instance(outline, Outline, "outline")):
        return np.empty((0, 2))
    turn = number(angle, "angle", finite=True)
    return np.asarray(convex_shapes().rectangle_in_outline(outline.points, outline.starts, turn))


def _scan(
    largest: Callable[[float], NDArray[np.float64]],
    points: NDArray[np.float64],
    seeds: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Scan a quarter turn's angles, seeds first, for the largest rectangle.

    A rectangle turned by t holds one of d^2 sin(2 t) / 2 less, d its diagonal; the interval of the largest bound is
    halved.
    """
    if not len(points):
        return np.empty((0, 2))
    found = [(_area(corners), angle, corners) for angle in (0.0, *seeds.tolist()) for corners in [largest(angle)]]
    best = max(size for size, _, _ in found)
    reach2 = float((np.ptp(points, axis=0) ** 2).sum())  # no diagonal is longer
    half = 0.5 * _QUARTER / _FIRST
    waiting = [(-math.inf, (2 * k + 1) * half, half) for k in range(_FIRST)]
    for _ in range(_LOOKS):
        bound, middle, half = waiting[0]
        if -bound <= best * (1.0 + _PROVEN):
            break
        trial = largest(middle)
        size = _area(trial)
        found.append((size, middle, trial))
        best = max(best, size)
        # Half of the interval to either side, each with the bound of its farther end.
        bound = max(bound, -(size + 0.5 * reach2 * math.sin(2.0 * half)))
        heapq.heapreplace(waiting, (bound, middle - 0.5 * half, 0.5 * half))
        heapq.heappush(waiting, (bound, middle + 0.5 * half, 0.5 * half))
    # nature: floating point, of which a maximum is flat to the root of a rounding (1.5e-8) in its argument
    least = 1e-7 * min(1.0, best / reach2) if reach2 else math.inf
    # The area has several local maxima, of which the highest one may be narrow: each of the best is refined.
    found.sort(key=lambda f: f[1] % _QUARTER)
    sizes = [size for size, _, _ in found]
    peaks = [
        f
        for f, one, other in zip(found, sizes[-1:] + sizes, [*sizes[1:], sizes[0]], strict=False)
        if f[0] >= max(one, other)
    ]
    starts = sorted(peaks, key=lambda f: -f[0])[:_STARTS]
    return max((_climb(largest, *start, least) for start in starts), key=lambda f: f[0])[1]


def _climb(
    largest: Callable[[float], NDArray[np.float64]],
    best: float,
    angle: float,
    corners: NDArray[np.float64],
    least: float,
) -> tuple[float, NDArray[np.float64]]:
    """Area and corners at the local maximum near an angle."""
    width = 0.25 * _QUARTER / _FIRST  # derived: half of the half interval that the scan leaves around its best look
    while width > least:
        for turned in (angle - width, angle + width):
            trial = largest(turned)
            size = _area(trial)
            if size > best:
                best = size
                angle = turned
                corners = trial
                break
        else:
            width *= 0.5
    return best, corners


def _area(corners: NDArray[np.float64]) -> float:
    first = corners[1] - corners[0]
    second = corners[2] - corners[1]
    return float(math.hypot(*first) * math.hypot(*second))


def safe_rectangle(
    polygon: ArrayLike, offset: float, method: Literal["inscribed", "bounding"] = "inscribed"
) -> NDArray[np.float64]:
    """Axis-aligned rectangle for the contact in the wrench cone (T 4.32-4.41, corrected).

    Its sides move inwards by a safety offset. The bounding box is faster and exceeds the contact (T 4.4.4).

    `polygon`: convex support polygon (k, 2) in contact frame in m; `offset`: how far each side moves inwards in m, 0 or
    more; T uses 0.01; `method`: "inscribed" or "bounding". Returns corners (4, 2) in m: row 0 is (Xmin, Ymin), row 2
    (Xmax, Ymax). Sides that would cross meet in the middle. (0, 2) if empty.

    Example:
        >>> safe_rectangle([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]], 0.01).round(9).tolist()
        [[0.01, 0.01], [0.19, 0.01], [0.19, 0.09], [0.01, 0.09]]
    """
    inwards = number(offset, "safety offset", nan=True)
    if not 0.0 <= inwards < np.inf:
        raise InputError(f"safety offset is {offset} m; allowed: finite, 0 or more")
    if method not in ("inscribed", "bounding"):
        raise InputError(f"method is {method!r}; allowed: inscribed, bounding")
    box = inscribed_rectangle(polygon) if method == "inscribed" else bounding_box(polygon)
    if len(box) == 0:
        return box
    low = box[0]
    high = box[2]
    middle = 0.5 * (low + high)
    x1, y1 = np.minimum(low + inwards, middle)
    x2, y2 = np.maximum(high - inwards, middle)
    return np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]])
