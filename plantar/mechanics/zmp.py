"""Zero moment point and centroidal moment pivot.

A wrench is [fx, fy, fz, tx, ty, tz] in N and N m about the frame's origin, BY the world ON the robot, z up.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import items, number
from plantar.common.arrays import array
from plantar.common.plane_points import plane_point
from plantar.errors import InputError


def zmp_in_plane(wrench: ArrayLike, height: float = 0.0, minimum_force: float = 0.0) -> NDArray[np.float64] | None:
    """Zero moment point in a plane z = height (T 4.5-4.6): p = [(h fx - ty) / fz, (h fy + tx) / fz].

    `wrench`: wrench (6,) about frame's origin; `height`: height h of plane above frame's origin in m; `minimum_force`:
    vertical force in N below which there is no ZMP; any load counts by default. Returns position (2,) in m, or None
    where vertical force is below `minimum_force`, not above 0, or NaN.

    Example:
        >>> zmp_in_plane([10.0, 0.0, 100.0, 5.0, -2.0, 0.0], height=0.1).tolist()
        [0.03, 0.05]
    """
    point = _zero_moment_point(array(wrench, "wrench", (6,)).tolist(), height, minimum_force)
    return None if point is None else np.array(point)


def _zero_moment_point(wrench: list[float], height: float, minimum_force: float) -> tuple[float, float] | None:
    fx, fy, fz, tx, ty, _ = wrench
    height, minimum_force = _levels(height, minimum_force)
    if not (fz >= minimum_force and 0.0 < fz < math.inf):
        return None
    x = (height * fx - ty) / fz
    y = (height * fy + tx) / fz
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None


def _levels(height: float, minimum_force: float) -> tuple[float, float]:
    return number(height, "height of the plane", finite=True), number(minimum_force, "minimum force")


def zero_moment_wrench(
    wrench: ArrayLike, height: float = 0.0, minimum_force: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Wrench transferred to its ZMP (T 4.2.4, after 4.23).

    Returns point (3,) in m and wrench (6,) about it: same force, moment only about z; None without load.

    Example:
        >>> point, moved = zero_moment_wrench([10.0, 0.0, 100.0, 5.0, -2.0, 0.3])
        >>> point.tolist(), moved.tolist()
        ([0.02, 0.05, 0.0], [10.0, 0.0, 100.0, 0.0, 0.0, 0.8])
    """
    given: list[float] = array(wrench, "wrench", (6,)).tolist()
    at = _zero_moment_point(given, height, minimum_force)
    if at is None:
        return None
    x, y = at
    fx, fy, fz, _, _, tz = given
    return np.array([x, y, height]), np.array([fx, fy, fz, 0.0, 0.0, tz - (x * fy - y * fx)])


def centroidal_moment_pivot(
    force: ArrayLike, com: ArrayLike, height: float = 0.0, minimum_force: float = 0.0
) -> NDArray[np.float64] | None:
    """Where the ground reaction force's line through the CoM meets the ground (Popovic, Goswami and Herr 2005).

    It is the ZMP where the wrench has no tipping moment about the CoM.

    `force`: ground reaction force (3,) or wrench (6,) of all feet in N; `com`: CoM position (3,) in m; `height`: height
    of ground in m; `minimum_force`: vertical force in N below which there is none. Returns position (2,) in m, or None
    without load.
    """
    given = array(force, "force", ("3 or 6",))
    if len(given) not in (3, 6):
        raise InputError(f"force has shape {given.shape}; expected (3,) or (6,)")
    fx, fy, fz = given[:3].tolist()
    x, y, z = array(com, "CoM", (3,)).tolist()
    height, minimum_force = _levels(height, minimum_force)
    if not (fz >= minimum_force and 0.0 < fz < math.inf):
        return None
    pivot = (x - fx / fz * (z - height), y - fy / fz * (z - height))
    return np.array(pivot) if math.isfinite(pivot[0]) and math.isfinite(pivot[1]) else None


def zmp_of_feet(points: Sequence[ArrayLike | None], vertical_forces: Sequence[float]) -> NDArray[np.float64] | None:
    """Composite ZMP of the feet (T 4.7-4.8).

    `points`: ZMP (2,) of each foot in a common frame in m, None for a foot without load; `vertical_forces`: vertical
    force of each foot in N. Returns position (2,) in common frame in m, or None without load; feet with force NaN, 0 or
    less are left out.

    Example:
        >>> zmp_of_feet([np.array([0.0, 0.1]), np.array([0.0, -0.1])], [300.0, 100.0]).tolist()
        [0.0, 0.05]
    """
    places = items(points, "points")
    forces = items(vertical_forces, "vertical forces")
    if len(places) != len(forces):
        raise InputError(f"{len(places)} points and {len(forces)} vertical forces; expected one force a point")
    total = 0.0
    sum_x = 0.0
    sum_y = 0.0
    for point, given in zip(places, forces, strict=True):
        force = number(given, "vertical force", nan=True)
        if force > 0.0:
            if point is None:
                raise InputError(f"a foot carries {force:.3g} N and has no point; allowed: None with a force of 0")
            x, y = plane_point(point)
            total += force
            sum_x += force * x
            sum_y += force * y
    if not total > 0.0:
        return None
    at = sum_x / total, sum_y / total
    if not (math.isfinite(at[0]) and math.isfinite(at[1])):
        raise InputError("the ZMP or the vertical force of a foot is not finite")
    return np.array(at)
