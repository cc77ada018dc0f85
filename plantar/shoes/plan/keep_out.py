"""Ways of other robot links, and whether straps, lugs or clips block them. In mm.

Without a robot model a shank is assumed about the ankle at the origin, from the sole upwards, and on the block on top
of the foot, leaning by 20 degrees every way.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.geometry.polygon import convex_hull
from plantar.shoes.foot.foot import Foot
from plantar.shoes.foot.shank import shank_links
from plantar.shoes.geometry.surface import convex_outline, surface_points

_SPACING = 2.0  # mm between points on the foot
_ROOM = 2.0  # mm between a link and what is printed or strapped
_SHANK = 0.1  # of the foot's length: radius of a shank that is not known
# of length and height: what is shorter on top of a foot is what its shank stands on
_BLOCK = 0.6
_UPPER = 0.1
_THIN = 0.05  # height over length: up to it the upper end of a plate that is tilted a little is no shank

Array = NDArray[np.float64]


@dataclass(frozen=True)
class KeepOut:
    """Points (n, 3) in mm that other robot links pass, known from its model or not, and the foot's surface (k, 3), if
    known.
    """

    links: Array
    surface: Array | None
    known: bool

    @property
    def note(self) -> str:
        """Source of the links."""
        if self.known:
            return ""
        return "the shank is taken to stand on the ankle: no robot's model shows where it passes (or give --shank)"

    def meets(self, low: tuple[float, float, float], high: tuple[float, float, float]) -> int:
        """Gives number of points within 2 mm of a box with corners low and high (3,)."""
        a = np.array(low) - _ROOM
        b = np.array(high) + _ROOM
        return int(((self.links > a) & (self.links < b)).all(axis=1).sum())

    def strap_meets(self, x: float, width: float, lugs: tuple[float, float], slot: float, thickness: float) -> int:
        """Gives number of points below or in a strap of a width and thickness over the foot at x: lugs are y of the
        slots, right and left, slot their height.
        """
        half = 0.5 * width
        inside = (
            (np.abs(self.links[:, 0] - x) < half + _ROOM) & (self.links[:, 1] > lugs[0]) & (self.links[:, 1] < lugs[1])
        )
        near = self.links[inside]
        if self.surface is None or not len(near):
            return len(near)
        path = strap_path(self.surface, x, width, lugs, slot)
        return int((near[:, 2] < np.interp(near[:, 1], *path.T) + thickness + _ROOM).sum())


def strap_path(surface: Array | None, x: float, width: float, lugs: tuple[float, float], slot: float) -> Array:
    """Gives way (k, 2) in y, z of a strap over a surface; x, width, lugs, slot as in `KeepOut.strap_meets`."""
    ends = np.array([[lugs[0], slot], [lugs[1], slot]])
    below = np.empty((0, 2)) if surface is None else surface[np.abs(surface[:, 0] - x) < 0.5 * width, 1:]
    inside = (below[:, 0] > lugs[0]) & (below[:, 0] < lugs[1])
    hull = convex_hull(np.concatenate([below[inside], ends]))  # from the right lug below, then back above
    return np.concatenate([hull[int(hull[:, 0].argmax()) :], hull[:1]])[::-1]


def keep_out(foot: Foot) -> KeepOut:
    """Where other links pass a foot."""
    surface = None if foot.triangles is None else surface_points(foot.triangles, _SPACING)
    if foot.links is not None:
        return KeepOut(foot.links, surface, True)
    low, _, high, _ = foot.sole.bounds
    length = high - low
    top = min(foot.height, 60.0)
    ankle = shapely.Point(0.0, 0.0).buffer(_SHANK * length)
    shank = ankle
    if surface is not None and foot.height > _THIN * length:
        upper = surface[surface[:, 2] > (1.0 - _UPPER) * foot.height, :2]
        block = convex_outline(upper)
        if np.ptp(upper[:, 0]) < _BLOCK * length and block.geom_type == "Polygon":
            shank = block
    # A link may reach down beside the foot's own ankle: what is above the sole there is not taken to be free.
    return KeepOut(shank_links(ankle, shank, top), surface, False)
