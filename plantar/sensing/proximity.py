"""Proximity before touchdown: inverse measure, near taxels, contours of height.

Distances along a taxel's -z axis in m; inf beyond the range, NaN if dead.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number, positive
from plantar.common.arrays import array, numbers, read_only
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_mask, taxel_values


class HeightContour(NamedTuple):
    """Ground nearer to the sole than a height.

    `height`: height in m; `taxels`: taxels (n,) nearer than the height; `polygon_in_sole`: convex polygon (k, 2) of
    their cells in the sole frame in m, counter-clockwise; empty where there is none.
    """

    height: float
    taxels: NDArray[np.bool_]
    polygon_in_sole: NDArray[np.float64]


def proximity_measure(distance: ArrayLike, sensing_range: float) -> NDArray[np.float64]:
    """Inverse measure rho = d_range - d, saturated at both ends (T 3.30, T 4.2.6).

    `distance`: distances (..., n) in m; `sensing_range`: range d_range of sensors in m, above 0. Returns measures (...,
    n) in m: 0 out of range and for a dead taxel, `sensing_range` at contact (d <= 0), never NaN.
    """
    reach = positive(sensing_range, "sensing range", "m")
    measured = np.asarray(reach - numbers(distance, "distances"))
    # fmax drops NaN, so that a dead taxel reads as one that sees nothing.
    np.fmax(measured, 0.0, out=measured)
    return np.minimum(measured, reach, out=measured)


def near_taxels(distance: ArrayLike, threshold: float) -> NDArray[np.bool_]:
    """Mask (..., n) of taxels nearer than a threshold: d < epsilon_p (T 4.2.7 corrected; printed d > epsilon_p).

    `distance`: distances (..., n) in m; `threshold`: threshold epsilon_p in m.
    """
    return np.asarray(numbers(distance, "distances") < number(threshold, "threshold of proximity"))


def cells_polygon(layout: SoleLayout, taxels: ArrayLike) -> NDArray[np.float64]:
    """Convex polygon of a sole's cells (T 4.24). `taxels`: mask (n,) of cells.

    Returns polygon (k, 2) in sole frame in m, counter-clockwise; empty without cells; ReadingError: mask does
    not fit.
    """
    polygon: NDArray[np.float64] = layout.kernel.hull(taxel_mask(layout, taxels))[0]
    return polygon


def preemptive_polygon(layout: SoleLayout, distance: ArrayLike, threshold: float) -> NDArray[np.float64]:
    """Preemptive support polygon (k, 2) in sole frame in m: hull of near cells (T 4.2.7 corrected).

    `distance`: distances (n,) in m; `threshold`: threshold epsilon_p in m.

    Returns polygon, counter-clockwise; empty if none is near; ReadingError, InputError: distances do not fit.
    """
    return cells_polygon(layout, near_taxels(taxel_values(layout, distance, "distances"), threshold))


def contour_levels(heights: Sequence[float]) -> tuple[float, ...]:
    """Heights of contours in m, lowest first. `heights`: thresholds epsilon_p in m, any order; else InputError."""
    levels: list[float] = sorted(array(heights, "heights of contours", ("m",)).tolist())
    if any(map(math.isnan, levels)):
        raise InputError("heights of contours hold NaN")
    return tuple(levels)


def height_contours(layout: SoleLayout, distance: ArrayLike, heights: Sequence[float]) -> tuple[HeightContour, ...]:
    """Contours of the ground under a swinging sole (T 4.2.7 corrected, Fig. 39-b).

    `distance`: distances (n,) in m; `heights`: thresholds epsilon_p in m, in any order.

    Returns one per height, lowest first, each including lower ones; read-only; ReadingError, InputError:
    distances do not fit.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], clip=False)
        >>> [int(c.taxels.sum()) for c in height_contours(layout, 0.1 * layout.positions[:, 0], [0.005, 0.01, 0.02])]
        [5, 11, 20]
    """
    levels = contour_levels(heights)
    readings = taxel_values(layout, distance, "distances")
    stack: list[HeightContour] = []
    polygon = read_only(np.empty((0, 2)))
    before = b""
    for height, taxels in zip(levels, read_only(readings < np.array(levels)[:, None]), strict=True):
        cells = taxels.tobytes()  # the quickest way to compare two masks
        if cells != before:
            polygon = read_only(layout.kernel.hull(taxels)[0])
            before = cells
        stack.append(HeightContour(height, taxels, polygon))
    return tuple(stack)
