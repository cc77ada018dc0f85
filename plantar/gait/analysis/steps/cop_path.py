"""Path of the CoP under a foot."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint
from plantar.geometry.polygon import convex_hull
from plantar.layouts.layout import SoleLayout

CHORD = 0.05
"""Time in s of the pieces that a path's length is the sum of."""


def averaged_path(points: NDArray[np.float64], weight: NDArray[np.float64], frames: int) -> NDArray[np.float64]:
    """Returns weighted running mean (n, 2) of points over a centred window, shrinking at ends and gaps.

    `points`: positions (n, 2); NaN for none, which stays; `weight` (n,), above 0 where there is a position.
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
    first = (index - half)[known]
    last = (index + half + 1)[known]
    for axis in range(2):
        moment = np.concatenate([[0.0], np.cumsum(load * np.where(known, points[:, axis], 0.0))])
        out[known, axis] = (moment[last] - moment[first]) / (total[last] - total[first])
    return out


def cop_measures(time: NDArray[np.float64], points: NDArray[np.float64]) -> dict[str, float]:
    """Returns length, range and speed of a path by key; empty below two positions.

    `time`: times (m,) in s; `points`: positions (m, 2), forward and left in m, NaN for none.

    Example:
        >>> t = np.linspace(0.0, 0.5, 51)
        >>> m = cop_measures(t, np.column_stack([0.4 * t, 0.0 * t]))
        >>> round(m["cop_path_m"], 6), round(m["cop_velocity_m_s"], 6)
        (0.2, 0.4)
    """
    known = np.isfinite(points[:, 0])
    if known.sum() < 2:
        return {}
    points = points[known]
    time = time[known]
    pieces, seconds = chords(time, points)
    path = float(pieces.sum())
    along, across = (float(v) for v in np.ptp(points, axis=0))
    whole = seconds >= 0.5 * min(CHORD, float(seconds.max()))
    return {
        "cop_path_m": path,
        "cop_excursion_ap_m": along,
        "cop_excursion_ml_m": across,
        "cop_velocity_m_s": path / float(time[-1] - time[0]),
        "cop_velocity_max_m_s": float((pieces[whole] / seconds[whole]).max()),
    }


def chords(time: NDArray[np.float64], points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns lengths (k,) and times (k,) in s of straight path pieces up to 50 ms: between frames, noise adds length.

    `time` (m,) in s, 2 or more; `points`: positions (m, 2).
    """
    every = max(1, round(CHORD * (len(time) - 1) / float(time[-1] - time[0])))
    extremes = [*points.argmin(axis=0).tolist(), *points.argmax(axis=0).tolist()]  # no path is shorter than its range
    at = np.array(sorted({*range(0, len(time), every), *extremes, len(time) - 1}))
    return np.hypot(*np.diff(points[at], axis=0).T), np.diff(time[at])


def excursion_index(print_: Footprint, points: NDArray[np.float64]) -> float:
    """Returns CoP excursion index (Song et al. 1996) in percent; NaN short of the front third.

    Lateral distance of the path from the line between its ends at the foot's front third, over the footprint's width
    there.

    `points`: positions (m, 2) in the print's source frame, NaN for none.
    """
    path = print_.in_foot(points[np.isfinite(points[:, 0])])
    at, width = print_.front_third
    if len(path) < 3 or not path[0, 0] < at < path[-1, 0]:
        return float("nan")
    crossing = int(np.flatnonzero((path[:-1, 0] <= at) & (path[1:, 0] > at))[0])
    one = path[crossing]
    two = path[crossing + 1]
    own = one[1] + (at - one[0]) / (two[0] - one[0]) * (two[1] - one[1])
    first = path[0]
    last = path[-1]
    line = first[1] + (at - first[0]) / (last[0] - first[0]) * (last[1] - first[1])
    return float(100.0 * (line - own) / width) if width > 0.0 else float("nan")  # v runs to the medial side


def margin_to_outline(layout: SoleLayout, points: NDArray[np.float64]) -> float:
    """Returns smallest signed distance in m of points (m, 2) to a sole layout's convex outline, inside positive."""
    normal, offset = _edges(layout)
    return float((points @ normal.T - offset).min())


@lru_cache(maxsize=8)
def _edges(layout: SoleLayout) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inward normals (k, 2) and offsets (k,) of a sole's convex outline."""
    hull = convex_hull(layout.outline)
    edge = np.roll(hull, -1, axis=0) - hull
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(edge[:, 0], edge[:, 1])[:, None]
    return normal, (normal * hull).sum(axis=1)
