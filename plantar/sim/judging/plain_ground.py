"""Where the ground is plain: one level face under a foot and around it, which gives no reason to step elsewhere."""

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
    """Knows the ground's true geometry.

    Args:
        ground: The ground.
        outlines: Outline (k, 2) of each sole in its frame in m.
        around: Distance in m around a sole within which an edge may be why a step is moved.
    """

    def __init__(self, ground: Ground, outlines: Mapping[Side, NDArray[np.float64]], around: float) -> None:
        import shapely

        self._outlines, self._around = outlines, around
        self._faces = [
            (shapely.Polygon(ring).convex_hull, s.shape == "box" and s.rotation[2, 2] > _LEVEL and not s.motions)
            for s, ring in zip(ground.solids, ground.seen_from_above(), strict=True)
        ]

    def under(self, side: Side, x: float, y: float, yaw: float) -> bool:
        """Whether a sole and what is around it lie on one level face: of one solid, or of the floor.

        Args:
            side: Which sole.
            x: Its origin in m; likewise y.
            y: The same.
            yaw: Its heading in rad.

        Returns:
            Whether it does.
        """
        import shapely

        c, s = math.cos(yaw), math.sin(yaw)
        ring = self._outlines[side] @ np.array([[c, s], [-s, c]]) + (x, y)
        area = shapely.Polygon(ring).buffer(self._around)
        near = [(face, level) for face, level in self._faces if face.intersects(area)]
        return not near or (len(near) == 1 and near[0][1] and near[0][0].contains(area))
