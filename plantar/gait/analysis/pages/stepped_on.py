"""The part of a platform that a picture shows: the cells that are stepped on, with a frame around."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout

__all__ = ["stepped_on"]

_FRAME = 0.01
"""Width in m of the frame around the cells."""


def stepped_on(layout: SoleLayout, hit: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Returns the indices (m,) of stepped-on cells and their neighbours, and the corners (4, 2) in m around them.

    Args:
        layout: A platform, k cells.
        hit: Which cells (k,) are stepped on; all are returned where none is.
    """
    beside = np.array([any(hit[j] for j in near) for near in layout.neighbours])
    chosen = np.flatnonzero(hit | beside) if hit.any() else np.arange(len(layout))
    points = np.vstack([layout.cell_polygon(int(c)) for c in chosen])
    (x0, y0), (x1, y1) = points.min(axis=0) - _FRAME, points.max(axis=0) + _FRAME
    return chosen, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
