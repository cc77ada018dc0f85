"""Kernel of a load on a patch of an elastic sole, spanned by contact points."""

import numpy as np

from ..geometry import clean, convex
from . import foundation

__all__ = ["PressedPatch", "patch_key"]


def patch_key(points, grid):
    """The points (x, y) in m on a grid, in its unit, unique and sorted: equal for points that span the same patch."""
    places = set()
    for x, y in points:
        places.add((round(x / grid), round(y / grid)))
    return tuple(sorted(places))


class PressedPatch:
    """What does not depend on the load: m covered cells, coordinates u = (1, (x - cx)/h, (y - cy)/h).

    Args:
        cells: Index (m,) of each cell in the sole.
        centre: Place (cx, cy) in m.
        scale: h in m.
        area: Share (m,) of each cell in the covered area.
        u: Coordinates (m, 3).
        inverse: Load to field (3, 3) where every covered cell carries.
        reach: Polygon (k, 2) in scaled coordinates where the cells can carry a load.

    Attributes:
        carried: Whether each cell (m,) carried last; the search starts there.
    """

    def __init__(self, cells, centre, scale, area, u, inverse, reach):
        self.cells = cells
        self.cx, self.cy = centre
        self.scale = scale
        self.area = area
        self.u = u
        self.inverse = inverse
        self.reach = reach
        self.turn = clean.turning(reach, 0.0, 0.0, 0.0)  # which way it goes round, 0 where it has to be cleaned first
        self.carried = np.zeros(len(cells), dtype=np.uint8)
        self.x = 0.0
        self.y = 0.0

    def spread(self, force, x, y, out):
        """Spread a normal load over the cells.

        Args:
            force: Load in N.
            x: Where it acts in m; moved to where the cells can carry it; y likewise.
            out: Receives the cells' forces in N, if carried.

        Returns:
            Whether the carrying cells were found; if not, `part` may be tried from others.
        """
        self.x = (x - self.cx) / self.scale
        self.y = (y - self.cy) / self.scale
        if foundation.spread_whole(self.u, self.area, self.inverse, self.x, self.y, force, self.cells, out):
            return True
        self._to_reach()
        some = False
        for i in range(self.carried.shape[0]):
            if self.carried[i]:
                some = True
        return some and self.part(force, out)

    def _to_reach(self):
        """Move the load to where the cells can carry it."""
        if self.turn != 0:
            _margin, self.x, self.y = convex._nearest(self.reach, self.turn, self.x, self.y)
        else:
            nearest = convex.closest_point(self.reach, self.x, self.y)
            self.x, self.y = nearest[0], nearest[1]

    def part(self, force, out):
        """Spread the last load, `force` in N, from the cells of `carried` into `out`; whether they were found."""
        return foundation.spread_part(self.u, self.area, self.x, self.y, force, self.carried, self.cells, out)
