"""Where an ankle bears the robot: a center of pressure x ahead takes torque m g x."""

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.polygon import area, centroid, closest_point, part_inside

_HALF = 0.5  # derived: of an ankle's torque, which the other half is to balance with


def borne_part(polygon: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
    """Returns a convex foothold's part (k, 2) that the ankle bears, or the nearest point (1, 2).

    `polygon` (k, 2) is counter-clockwise in the sole frame, `reach` from the ankle along the sole, in m.

    Example:
        >>> borne_part(np.array([[-0.1, -0.04], [0.2, -0.04], [0.2, 0.04], [-0.1, 0.04]]), 0.08)[:, 0].round(3).tolist()
        [-0.08, 0.08, 0.08, -0.08]
    """
    if bool((np.abs(polygon[:, 0]) <= reach).all()):
        return polygon
    part = part_inside(part_inside(polygon, 1.0, 0.0, reach), -1.0, 0.0, reach)
    if len(part) >= 3 and area(part) > 0.0:
        return part
    nearest = closest_point(polygon, (float(np.clip(polygon[:, 0].mean(), -reach, reach)), 0.0))
    assert nearest is not None  # a foothold has points
    return nearest[None, :]


def loaded_middle(polygon: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
    """Returns the best place (2,), sole frame, in m to load a foothold; `polygon` and `reach` as of `borne_part`.

    The centroid, or nearest place at half the ankle's torque, or the nearest that it bears.
    """
    middle = centroid(polygon)
    assert middle is not None  # a foothold has an area
    part = borne_part(polygon, reach)
    if part is polygon:
        return middle
    x, y = middle.tolist()
    midway = 0.5 * float(part[:, 0].min() + part[:, 0].max())
    x = max(midway, min(x, _HALF * reach)) if x > 0.0 else min(midway, max(x, -_HALF * reach))
    return np.array([x, y if len(part) > 2 else float(part[0, 1])])
