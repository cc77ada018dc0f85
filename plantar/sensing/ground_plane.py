"""Ground under a swinging sole as a plane."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number, positive
from plantar.common.arrays import read_only
from plantar.errors import InputError
from plantar.kernels.skin.ground import GroundFit
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_values


class GroundPlane(NamedTuple):
    """Ground z = -height + slope . (x, y) in sole frame.

    Attributes:
        height: Height in m of the sole's origin above the ground, along the sole's z.
        slope: Rise of the ground along the sole's x and y (tangent).
        residual: Root mean square distance in m, along z, of the points used.
        inliers: Taxels (n,) whose points were used.
        directions: In which the points determine a slope: 2, 1 for points in a row, 0 for one; along others it is 0.
    """

    height: float
    slope: tuple[float, float]
    residual: float
    inliers: NDArray[np.bool_]
    directions: int

    @property
    def normal(self) -> NDArray[np.float64]:
        """Unit normal (3,) of the ground in sole frame, upwards."""
        vector = np.array([-self.slope[0], -self.slope[1], 1.0])
        return np.asarray(vector / np.linalg.norm(vector))


def fit_ground_plane(
    layout: SoleLayout,
    distance: ArrayLike,
    *,
    sensing_range: float | None = None,
    tolerance: float = 2e-3,  # derived: 2 mm, the noise of a proximity reading in a scene
) -> GroundPlane | None:
    """Fit a plane to the ground under a sole.

    Least squares where every residual is within the tolerance; else around the least median of squares over fixed
    triples of taxels (Rousseeuw and Leroy 1987), which ignores up to about 40 % of outliers, e.g. an edge.

    Args:
        layout: Sole, n taxels.
        distance: Distances (n,) in m; inf out of range, NaN if dead.
        sensing_range: Largest distance in m, of either sign; layout's if None.
        tolerance: Distance in m from plane that noise explains.

    Returns plane; None where no taxel measures ground; ReadingError, InputError: distances not (taxels,).

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> plane = fit_ground_plane(layout, 0.03 - 0.1 * layout.positions[:, 0])
        >>> round(plane.height, 9), round(plane.slope[0], 9), abs(plane.slope[1]) < 1e-12, plane.directions
        (0.03, 0.1, True, 2)
    """
    readings = taxel_values(layout, distance, "distances")
    reach = checked_range(layout, sensing_range, tolerance)
    out = np.empty(4)
    inliers = np.zeros(len(layout), dtype=bool)
    directions: int = ground_fit(layout).fit(readings, reach, tolerance, out, inliers.view(np.uint8))
    if directions < 0:
        return None
    height, rise_x, rise_y, residual = out.tolist()
    return GroundPlane(height, (rise_x, rise_y), residual, read_only(inliers), directions)


def checked_range(layout: SoleLayout, sensing_range: float | None, tolerance: float) -> float:
    """Range in m of a fit, checked with its tolerance: both above 0, else InputError."""
    if not number(tolerance, "tolerance of the ground plane", nan=True) > 0.0:
        raise InputError(f"tolerance of the ground plane is {tolerance} m; allowed: above 0")
    return positive(layout.proximity_range if sensing_range is None else sensing_range, "sensing range", "m")


def ground_fit(layout: SoleLayout) -> GroundFit:
    """The kernel that fits planes to a layout's distances."""
    try:
        kernel: GroundFit = layout.__dict__["_ground_fit"]
    except KeyError:
        kernel = GroundFit(layout.positions, layout.rotations[:, :, 2])
        layout.__dict__["_ground_fit"] = kernel
    return kernel
