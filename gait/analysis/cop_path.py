"""The path of the centre of pressure under a foot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.layout import SoleLayout
from plantar.polygon import convex_hull

__all__ = ["averaged_path", "margin_to_outline"]


def averaged_path(points: NDArray[np.float64], weight: NDArray[np.float64], frames: int) -> NDArray[np.float64]:
    """Running mean of points (n, 2), weighted, over about so many frames; NaN stays NaN.

    The window is centred and shrinks towards the ends of a span of points, so that an even motion keeps its ends.

    Args:
        points: Positions (n, 2); NaN where there is none.
        weight: Weights (n,), above 0 where there is a position.
        frames: Width of the window.

    Returns:
        The averaged positions (n, 2).
    """
    known = np.isfinite(points[:, 0])
    n = len(known)
    index = np.arange(n)
    before = index - np.maximum.accumulate(np.where(known, -1, index))
    after = np.minimum.accumulate(np.where(known, n, index)[::-1])[::-1] - index
    half = np.minimum(frames // 2, np.minimum(before, after) - 1).clip(0)
    load = np.where(known, weight, 0.0)
    total = np.concatenate([[0.0], np.cumsum(load)])
    out = np.full_like(points, np.nan)
    first, last = (index - half)[known], (index + half + 1)[known]
    for axis in range(2):
        moment = np.concatenate([[0.0], np.cumsum(load * np.where(known, points[:, axis], 0.0))])
        out[known, axis] = (moment[last] - moment[first]) / (total[last] - total[first])
    return out


def margin_to_outline(layout: SoleLayout, points: NDArray[np.float64]) -> float:
    """Smallest signed distance of points to the edges of a sole's convex outline.

    Args:
        layout: The sole.
        points: Positions (m, 2) in the sole frame in m, 1 or more.

    Returns:
        The distance in m, positive where all points are inside.
    """
    hull = convex_hull(layout.outline)
    edge = np.roll(hull, -1, axis=0) - hull
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(edge[:, 0], edge[:, 1])[:, None]
    return float(((points[:, None, :] - hull) * normal).sum(axis=2).min())
