"""How a foot stands: which way is up, whether its sole is tilted, and where the toes are. Triangles (n, 3, 3) in mm."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plantar.optional_library import optional_library

__all__ = ["AXES", "Axis", "flat_share", "forward_axis", "levelled", "rotation_forward", "rotation_up"]

Axis = Literal["x", "-x", "y", "-y", "z", "-z"]
"""An axis of a mesh, with its direction."""

AXES: tuple[Axis, ...] = ("x", "-x", "y", "-y", "z", "-z")
"""All axes."""

_TILT_LEAST = math.radians(1.0)
_TILT_MOST = math.radians(25.0)
_SAME_PLANE = math.cos(math.radians(0.5))
_NEAR = 1.0  # mm
_RESTS = 0.3  # share of the silhouette that one plane of the hull must have to be what the foot rests on
_LONGER = 1.05  # of the other side: what counts as the long side

Array = NDArray[np.float64]


def _direction(axis: Axis) -> Array:
    out = np.zeros(3)
    out["xyz".index(axis[-1])] = -1.0 if axis[0] == "-" else 1.0
    return out


def rotation_up(up: Axis) -> Array:
    """Rotation (3, 3) that turns an axis of the mesh up, to +z; x stays where it can."""
    z = _direction(up)
    x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
    return np.stack([x, np.cross(z, x), z])


def rotation_forward(forward: Axis) -> Array:
    """Rotation (3, 3) about z that turns a horizontal axis of the mesh forward, to +x."""
    x, z = _direction(forward), np.array([0.0, 0.0, 1.0])
    return np.stack([x, np.cross(z, x), z])


def _resting_plane(triangles: Array) -> tuple[Array, float]:
    """Normal of the largest plane of the convex hull's lower side, and its share of the silhouette."""
    with optional_library("scipy", "shoes"):
        from scipy.spatial import ConvexHull, QhullError

    points = np.unique(triangles.reshape(-1, 3).round(6), axis=0)
    try:
        hull = ConvexHull(points)
        silhouette = ConvexHull(points[:, :2]).volume
    except (QhullError, ValueError):
        return np.array([0.0, 0.0, -1.0]), 0.0
    corners = points[hull.simplices]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    normal = hull.equations[:, :3]
    below = normal[:, 2] < -math.cos(_TILT_MOST)
    if not below.any():
        return np.array([0.0, 0.0, -1.0]), 0.0
    normal, area = normal[below], area[below]
    best, share = normal[int(area.argmax())], 0.0
    for i in np.argsort(-area, kind="stable")[:12]:
        same = normal @ normal[i] > _SAME_PLANE
        if area[same].sum() > share:
            share = float(area[same].sum())
            mean = (area[same, None] * normal[same]).sum(axis=0)
            best = mean / np.linalg.norm(mean)
    return best, share / silhouette


def _flat_area(triangles: Array, normal: Array) -> float:
    """Share of the silhouette that faces of the mesh have in its outermost plane with a normal."""
    with optional_library("scipy", "shoes"):
        from scipy.spatial import ConvexHull

    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    double = np.linalg.norm(cross, axis=1)
    depth = triangles @ normal
    near = (depth.max() - depth.min(axis=1) < _NEAR) & (np.abs(cross @ normal) > _SAME_PLANE * double)
    silhouette = ConvexHull(np.unique(triangles.reshape(-1, 3)[:, :2].round(6), axis=0)).volume
    return float(0.5 * double[near].sum() / silhouette)


def flat_share(triangles: Array) -> float:
    """Share of the silhouette from above, 0..1, that the plane has on which the foot would come to rest."""
    return _resting_plane(triangles)[1]


def levelled(triangles: Array) -> tuple[Array, float]:
    """A foot turned so that the plane it would rest on is level.

    Args:
        triangles: Triangles with z about up.

    Returns:
        The triangles, and the tilt in degrees that was taken out: 0 below 1 degree, or where no plane is large enough.
    """
    normal, share = _resting_plane(triangles)
    tilt = math.acos(min(1.0, -float(normal[2])))
    if share < _RESTS or tilt < _TILT_LEAST or _flat_area(triangles, normal) < _RESTS * share:
        return triangles, 0.0
    down = np.array([0.0, 0.0, -1.0])
    axis = np.cross(normal, down)
    axis /= np.linalg.norm(axis)
    k = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    turn = np.eye(3) + math.sin(tilt) * k + (1.0 - math.cos(tilt)) * k @ k
    return np.asarray(triangles @ turn.T), math.degrees(tilt)


def forward_axis(triangles: Array) -> tuple[Axis, str]:
    """Which horizontal axis points to the toes: x, or y where the foot is longer along y.

    Along y the ankle tells the direction: it is nearer to the heel. It is the mesh's origin where that lies within the
    foot, otherwise the middle of the foot's uppermost part.

    Args:
        triangles: Triangles with z up.

    Returns:
        The axis, and a note on how it was found.
    """
    points = triangles.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    size = high - low
    if size[1] <= _LONGER * size[0]:
        return "x", "x points to the toes, as usual"
    middle = 0.5 * (low + high)
    within = bool((low[:2] <= 0.0).all() and (high[:2] >= 0.0).all())
    if within and abs(middle[1]) > 0.03 * size[1]:
        ahead, how = middle[1], "the origin lies nearer to the heel"
    else:
        upper = points[points[:, 2] > high[2] - 0.15 * size[2]]
        ahead, how = (
            middle[1] - 0.5 * (upper[:, 1].min() + upper[:, 1].max()),
            "its uppermost part lies nearer to the heel",
        )
    if abs(ahead) <= 0.01 * size[1]:
        return "y", "the foot is longer along y, taken to point to the toes (or give the forward axis)"
    axis: Axis = "y" if ahead > 0.0 else "-y"
    return axis, f"the foot is longer along y, and {how}: {axis} points to the toes"
