"""The ground under a swinging sole as a plane: how high, how steep, how well it fits."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError, ReadingError
from plantar.layout import SoleLayout

__all__ = ["GroundPlane", "fit_ground_plane", "ground_points"]

_DRAWS = 80
"""Triples of taxels that a robust fit tries: with 40 % outliers all but one fit in 10^8 holds a clean one."""


class GroundPlane(NamedTuple):
    """Ground z = -height + slope . (x, y) in the sole frame."""

    height: float
    """Height in m of the sole frame's origin above the ground, along the sole's z; negative below it."""
    slope: tuple[float, float]
    """Rise of the ground along the sole's x and y, as a ratio (tangent)."""
    residual: float
    """Root mean square distance in m, along z, of the points used."""
    inliers: NDArray[np.bool_]
    """Taxels (n,) whose points were used."""
    directions: int
    """Directions in which the points determine a slope: 2, or 1 for points in a row, 0 for one point. The slope along
    the others is taken as 0."""

    @property
    def normal(self) -> NDArray[np.float64]:
        """Unit normal (3,) of the ground in the sole frame, upwards."""
        vector = np.array([-self.slope[0], -self.slope[1], 1.0])
        return np.asarray(vector / np.linalg.norm(vector))

    def height_at(self, points: ArrayLike) -> NDArray[np.float64]:
        """Height (...) in m above the ground of points (..., 2) of the sole plane, along the sole's z."""
        return np.asarray(self.height - np.asarray(points, dtype=float) @ np.array(self.slope))


def ground_points(layout: SoleLayout, distance: ArrayLike) -> NDArray[np.float64]:
    """Points of the ground that the taxels see: r_i - d_i z_i.

    Args:
        layout: The sole, n taxels.
        distance: Distances (n,) or (frames, n) in m; inf where nothing is in range, NaN for a dead taxel.

    Returns:
        Points (n, 3) or (frames, n, 3) in the sole frame in m; NaN where nothing is seen.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> ground_points(layout, np.full(len(layout), 0.03))[:, 2].max().item()
        -0.03
    """
    reach = np.asarray(distance, dtype=np.float64)
    reach = np.where(np.isfinite(reach), reach, np.nan)
    return np.asarray(layout.positions - reach[..., None] * layout.rotations[:, :, 2])


def fit_ground_plane(
    layout: SoleLayout, distance: ArrayLike, *, sensing_range: float | None = None, tolerance: float = 2e-3
) -> GroundPlane | None:
    """Fit a plane to the ground under a sole.

    A least-squares fit where every residual is within the tolerance. Otherwise a few taxels see something else, an edge
    or a cable: the least median of squares over triples of taxels, always the same ones, finds the plane most of them
    agree on, and a least-squares fit to those that lie within the tolerance of it, or within 2.5 robust standard
    deviations, gives the result (Rousseeuw and Leroy 1987). Up to about 40 % of outliers are thrown out.

    Args:
        layout: The sole, n taxels.
        distance: Distances (n,) in m; inf where nothing is in range, NaN for a dead taxel. Noise may make one negative.
        sensing_range: Distance in m from which a reading, also a negative one, counts as out of range; that of the
            layout where None.
        tolerance: Distance in m from the plane that noise and rough ground explain.

    Returns:
        The plane; None where no taxel sees the ground.

    Raises:
        ReadingError: If the number of distances is not that of the taxels.
        InputError: If the tolerance is not above 0, or the range not a finite value above 0.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> plane = fit_ground_plane(layout, 0.03 - 0.1 * layout.positions[:, 0])
        >>> round(plane.height, 9), round(plane.slope[0], 9), abs(plane.slope[1]) < 1e-12, plane.directions
        (0.03, 0.1, True, 2)
    """
    readings = np.asarray(distance, dtype=np.float64)
    if readings.shape != (len(layout),):
        raise ReadingError(f"distances have shape {readings.shape}; layout '{layout.name}' has {len(layout)} taxels")
    if not tolerance > 0.0:
        raise InputError(f"tolerance of the ground plane is {tolerance} m; allowed: above 0")
    reach = layout.proximity_range if sensing_range is None else sensing_range
    if not 0.0 < reach < math.inf:
        raise InputError(f"sensing range is {reach} m; allowed: a finite value above 0")
    seen = np.flatnonzero(np.abs(readings) < reach)
    if not len(seen):
        return None
    points = layout.positions[seen] - readings[seen, None] * layout.rotations[seen, :, 2]
    kept = np.ones(len(seen), dtype=bool)
    plane, directions = _least_squares(points)
    residual = _residuals(points, plane)
    if len(seen) > 3 and float(np.abs(residual).max()) > tolerance:
        kept = _agreeing(points, tolerance)
        plane, directions = _least_squares(points[kept])
        residual = _residuals(points[kept], plane)
    inliers = np.zeros(len(layout), dtype=bool)
    inliers[seen[kept]] = True
    return GroundPlane(
        height=-float(plane[0]),
        slope=(float(plane[1]), float(plane[2])),
        residual=float(np.sqrt(residual @ residual / len(residual))),
        inliers=inliers,
        directions=directions,
    )


def _residuals(points: NDArray[np.float64], plane: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(points[:, 2] - plane[0] - points[:, :2] @ plane[1:])


def _least_squares(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """Plane (z0, dz/dx, dz/dy) and the directions it is determined in; the flattest plane where that is not both."""
    centre = points.mean(axis=0)
    local = points - centre
    (xx, xy), (_, yy) = (local[:, :2].T @ local[:, :2]).tolist()
    xz, yz = (local[:, 2] @ local[:, :2]).tolist()
    # Eigenvalues of the 2 x 2 scatter; a direction with less than 1e-9 of the extent's square says nothing.
    middle, spread = 0.5 * (xx + yy), float(np.hypot(0.5 * (xx - yy), xy))
    large, small = middle + spread, middle - spread
    if not large > 1e-18 * len(points):  # one place: 1 nm
        slope, directions = (0.0, 0.0), 0
    elif small <= 1e-9 * large:
        angle = 0.5 * float(np.arctan2(2.0 * xy, xx - yy))
        c, s = float(np.cos(angle)), float(np.sin(angle))
        rise = (c * xz + s * yz) / large
        slope, directions = (c * rise, s * rise), 1
    else:
        determinant = xx * yy - xy * xy
        slope, directions = ((yy * xz - xy * yz) / determinant, (xx * yz - xy * xz) / determinant), 2
    z0 = float(centre[2]) - slope[0] * float(centre[0]) - slope[1] * float(centre[1])
    return np.array([z0, *slope]), directions


def _agreeing(points: NDArray[np.float64], tolerance: float) -> NDArray[np.bool_]:
    """Mask of the points that agree with the plane of least median of squares through three of them."""
    x, y, z = np.ascontiguousarray(points.T)
    a, b, c = _triples(len(points))
    xa, ya, za = x[a], y[a], z[a]
    ux, uy, uz = x[b] - xa, y[b] - ya, z[b] - za
    vx, vy, vz = x[c] - xa, y[c] - ya, z[c] - za
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    # Neither flat triangles nor planes steeper than 60 degrees or so, which no foot steps on.
    usable = (np.abs(nz) > 0.5 * np.hypot(nx, ny)) & (np.abs(nz) > 1e-6 * (ux * ux + uy * uy + vx * vx + vy * vy))
    if not usable.any():
        return np.ones(len(points), dtype=bool)
    if not usable.all():
        xa, ya, za, nx, ny, nz = (v[usable] for v in (xa, ya, za, nx, ny, nz))
    rise_x, rise_y = -nx / nz, -ny / nz
    level = za - rise_x * xa - rise_y * ya
    miss = np.abs(z - np.stack([level, rise_x, rise_y], axis=1) @ np.stack([np.ones(len(x)), x, y]))
    half = (len(points) + 3) // 2 - 1  # the median of Rousseeuw: with three parameters, breakdown of one half
    median = np.partition(miss, half, axis=1)[:, half]
    best = int(np.argmin(median))
    scale = 1.4826 * (1.0 + 5.0 / max(len(points) - 3, 1)) * float(median[best])
    return np.asarray(miss[best] <= max(tolerance, 2.5 * scale))


@lru_cache(maxsize=64)
def _triples(n: int) -> NDArray[np.int64]:
    """Index triples (3, m) of n points: all of them where they are few, else the same random ones each time."""
    if n * (n - 1) * (n - 2) <= 6 * _DRAWS:
        a, b, c = np.meshgrid(*[np.arange(n)] * 3, indexing="ij")
        ordered = (a < b) & (b < c)
        return np.stack([a[ordered], b[ordered], c[ordered]])
    rng = np.random.default_rng(0)
    return np.ascontiguousarray(np.array([rng.choice(n, 3, replace=False) for _ in range(_DRAWS)]).T)
