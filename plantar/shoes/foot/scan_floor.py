"""The floor around a scanned foot, found and left out. Triangles (n, 3, 3) in mm, z up, level."""

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.geometry.surface import convex_outline, covered_area

_BAND = 3.0  # height of what may be floor above the lowest point
_ABOVE = 6.0  # what reaches higher is the foot
_BESIDE = 3.0  # of the foot's silhouette: what lies farther out is floor
_LARGER = 1.3  # of the silhouette's hull: a floor reaches so much farther around
_COVERS = 0.25  # of the silhouette: what lies beside it is at least so large
_SHEET = 0.95  # of a floor's faces look one way; a plate has two sides

Triangles = NDArray[np.float64]


def floor_of_scan(triangles: Triangles) -> NDArray[np.bool_]:
    """Which triangles (n,) are floor around a foot: none where there is no such sheet.

    A floor is a single sheet in the lowest 3 mm, around and beyond the silhouette of what rises above it. A plate with
    two sides, such as a robot's sole, is none.
    """
    height = triangles[..., 2] - triangles[..., 2].min()
    none = np.zeros(len(triangles), dtype=bool)
    low = (height <= _BAND).all(axis=1)
    rising = height.max(axis=1) > _ABOVE
    if not low.any() or not rising.any():
        return none
    foot = covered_area(triangles[rising][..., :2])
    if foot.is_empty:
        return none
    room = shapely.union_all([shapely.Polygon(part.exterior) for part in shapely.get_parts(foot)]).buffer(_BESIDE)
    shapely.prepare(room)
    beside = ~shapely.contains_xy(room, triangles[..., 0], triangles[..., 1]).all(axis=1)
    floor = low & beside
    if not floor.any():
        return none
    # A plate's upper side may lie above the band: it is looked for in all that does not rise.
    sheet = triangles[~rising & beside][..., :2]
    a = sheet[:, 1] - sheet[:, 0]
    b = sheet[:, 2] - sheet[:, 0]
    signed = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    area = float(np.abs(signed).sum())
    around = convex_outline(sheet.reshape(-1, 2))
    hull = room.convex_hull
    is_floor = (
        area > _COVERS * hull.area
        and abs(float(signed.sum())) > _SHEET * area
        and around.area > _LARGER * hull.area
        and around.contains(hull.centroid)
    )
    return floor if is_floor else none
