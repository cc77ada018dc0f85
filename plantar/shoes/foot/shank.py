"""Where a shank passes above a foot whose robot's model is not known, in mm: stated, or assumed by what calls it."""

import math
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import InputError

_GRID = 4.0  # mm between points
_LEANS = math.tan(math.radians(20.0))  # of a shank, every way
_TALL = 60.0
_THICKEST = 300.0  # mm across

Array = NDArray[np.float64]


def shank_links(ankle: Any, shank: Any, top: float) -> Array:
    """Points (n, 3) that a shank passes: of a shapely ankle from above the sole to a height, top, and of the shank from
    there on, leaning by 20 degrees every way.
    """
    grid = [_points_in(ankle, height) for height in np.arange(_GRID, top, _GRID).tolist()]
    leaning = np.arange(0.0, _TALL, _GRID).tolist()
    grid += [_points_in(shank.buffer(height * _LEANS), top + height) for height in leaning]
    return np.concatenate(grid)


def stated_shank(text: str) -> Any:
    """Shapely circle of a shank that is stated as X,Y,DIAMETER in mm from the foot's origin.

    Example:
        >>> stated_shank("10,0,60").bounds
        (-20.0, -30.0, 40.0, 30.0)
    """
    try:
        x, y, across = (float(value) for value in text.split(","))
    except ValueError:
        x, y, across = math.nan, math.nan, math.nan
    if not (math.isfinite(x) and math.isfinite(y) and 0.0 < across <= _THICKEST):
        raise InputError(
            f"--shank is {text!r}; allowed: X,Y,DIAMETER in mm from the foot's origin, forward and left, up to "
            f"{_THICKEST:g} mm across, as 0,0,60"
        )
    return shapely.Point(x, y).buffer(0.5 * across)


def _points_in(outline: Any, height: float) -> Array:
    """Points (n, 3) on a grid in a shapely outline, at a height."""
    x, y = (np.arange(outline.bounds[i], outline.bounds[i + 2] + _GRID, _GRID) for i in (0, 1))
    xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    kept = xy[shapely.contains_xy(outline, xy[:, 0], xy[:, 1])]
    return np.column_stack([kept, np.full(len(kept), height)])
