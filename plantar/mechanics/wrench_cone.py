"""Wrenches of a rectangular contact without slipping, tipping or twisting (T 4.32-4.41, corrected)."""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import positive
from plantar.errors import InputError


class Rectangle(NamedTuple):
    """Axis-aligned rectangle in contact frame: rear, front, right and left edge, signed coordinates in m."""

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @property
    def center(self) -> tuple[float, float]:
        """Its middle (x, y) in m."""
        return 0.5 * (self.x_min + self.x_max), 0.5 * (self.y_min + self.y_max)


def wrench_cone(rectangle: Rectangle, friction: float) -> NDArray[np.float64]:
    """Facets of a rectangle's contact wrench cone (T 4.32-4.41, corrected).

    The wrench w = [fx, fy, fz, tx, ty, tz] is by the world on the robot, about the contact frame's origin. The cone is
    the span of a friction pyramid at each corner: |fx| <= mu fz, |fy| <= mu fz, the center of pressure inside, and
    eight limits of the yaw moment (printed 4.40-4.41 mix the edges' signs).

    `rectangle`: contact, anywhere, possibly a line or a point; `friction`: coefficient mu of each corner's friction
    pyramid, above 0. Returns matrix (16, 6); w is in cone where C w <= 0 in every row. Rows: fx, fy, tx, ty (two each),
    tz (eight).

    Example:
        >>> cone = wrench_cone(Rectangle(-0.1, 0.1, -0.05, 0.05), 0.6)
        >>> [bool((cone @ [0.0, 0.0, 100.0, tx, 0.0, 0.0] <= 0.0).all()) for tx in (4.0, 6.0)]
        [True, False]
    """
    x0, x1, y0, y1 = rectangle
    if not (all(map(math.isfinite, rectangle)) and x0 <= x1 and y0 <= y1):
        raise InputError(f"contact rectangle is {tuple(rectangle)}; allowed: finite, x_min <= x_max, y_min <= y_max")
    return cone_rows(rectangle, positive(friction, "friction coefficient"))


def cone_rows(rectangle: Rectangle, friction: float) -> NDArray[np.float64]:
    """Rows (16, 6) of `wrench_cone`, unchecked, for a control loop.

    `rectangle`: contact; swapped edges allow no wrench but 0. Returns matrix (16, 6).
    """
    x0, x1, y0, y1 = rectangle
    mu = friction
    rows = _rows_of_friction(mu).copy()
    # One flat list: a nested one takes numpy three times as long, and control loops call this.
    # fmt: off
    rows[4:, :3] = np.array([
        0.0, 0.0, -y1,
        0.0, 0.0, y0,
        0.0, 0.0, x0,
        0.0, 0.0, -x1,
        -y1, x0, -mu * (y1 - x0),
        -y1, x1, -mu * (y1 + x1),
        -y0, x0, mu * (y0 + x0),
        -y0, x1, -mu * (x1 - y0),
        y0, -x1, -mu * (x1 - y0),
        y0, -x0, mu * (x0 + y0),
        y1, -x1, -mu * (x1 + y1),
        y1, -x0, -mu * (y1 - x0),
    ]).reshape(12, 3)
    # fmt: on
    return rows


@lru_cache(maxsize=16)
def _rows_of_friction(mu: float) -> NDArray[np.float64]:
    """`cone_rows` (16, 6) for a friction; the rectangle fills its first three columns from the fifth row."""
    return np.array(
        [
            [1.0, 0.0, -mu, 0.0, 0.0, 0.0],
            [-1.0, 0.0, -mu, 0.0, 0.0, 0.0],
            [0.0, 1.0, -mu, 0.0, 0.0, 0.0],
            [0.0, -1.0, -mu, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0, mu, mu, -1.0],
            [0.0, 0.0, 0.0, mu, -mu, -1.0],
            [0.0, 0.0, 0.0, -mu, mu, -1.0],
            [0.0, 0.0, 0.0, -mu, -mu, -1.0],
            [0.0, 0.0, 0.0, -mu, -mu, 1.0],
            [0.0, 0.0, 0.0, -mu, mu, 1.0],
            [0.0, 0.0, 0.0, mu, -mu, 1.0],
            [0.0, 0.0, 0.0, mu, mu, 1.0],
        ]
    )
