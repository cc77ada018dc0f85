"""Where the ground is plain: one level face under and around a foot, which justifies no moved step."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import Side
from plantar.sim.terrain import Ground

__all__ = ["PlainGround"]

_LEVEL = 0.9999  # cosine of the tilt up to which a face is level


class PlainGround:
    """The true geometry of a `ground` under soles with `outlines` (k, 2) in m and `around` them, in m."""

    def __init__(self, ground: Ground, outlines: Mapping[Side, NDArray[np.float64]], around: float) -> None:
        import shapely

        self._outlines, self._around = outlines, around
        self._faces = [
            (shapely.Polygon(ring).convex_hull, s.shape == "box" and s.rotation[2, 2] > _LEVEL and not s.motions)
            for s, ring in zip(ground.solids, ground.seen_from_above(), strict=True)
        ]

    def under(self, side: Side, x: float, y: float, yaw: float) -> bool:
        """Returns whether the sole of a `side` at `x`, `y` in m and heading `yaw` in rad is on one level face."""
        import shapely

        c, s = math.cos(yaw), math.sin(yaw)
        ring = self._outlines[side] @ np.array([[c, s], [-s, c]]) + (x, y)
        area = shapely.Polygon(ring).buffer(self._around)
        near = [(face, level) for face, level in self._faces if face.intersects(area)]
        return not near or (len(near) == 1 and near[0][1] and near[0][0].contains(area))
