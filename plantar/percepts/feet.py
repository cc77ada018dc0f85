"""Joint percept of two feet in the world frame."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, items, number
from plantar.common.lazy import lazy
from plantar.errors import InputError
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import area
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.zmp import zmp_in_plane
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose, feet_support_polygon, wrench_of_feet


class FeetPercept:
    """Percepts of the soles with their poses.

    Args:
        percepts: Each sole's.
        poses: Pose of each sole in world.
        ground_height: Height in m of ZMP's horizontal plane.

    Raises:
        InputError: Not one pose a percept.

    Example:
        >>> from plantar import Reading, hex_layout, mirrored
        >>> left = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> soles = [Percept(s, Reading(0.0, np.full(len(s), 5.0))) for s in (left, mirrored(left))]
        >>> feet = FeetPercept(soles, [SolePose.flat(0.0, 0.1), SolePose.flat(0.0, -0.1)])
        >>> bool(abs(feet.position_zmp_in_world).max() < 1e-9), round(feet.support_area, 3)
        (True, 0.06)
    """

    def __init__(self, percepts: Sequence[Percept], poses: Sequence[SolePose], ground_height: float = 0.0) -> None:
        self.percepts = tuple([instance(p, Percept, "percept") for p in items(percepts, "percepts")])
        self.poses = tuple([instance(p, SolePose, "pose") for p in items(poses, "poses")])
        if len(self.percepts) != len(self.poses) or not self.poses:
            raise InputError(f"{len(self.percepts)} percepts and {len(self.poses)} poses; expected one pose a percept")
        self.ground_height = number(ground_height, "height of the ground", finite=True)

    @lazy
    def wrench_in_world(self) -> NDArray[np.float64]:
        """Ground reaction wrench (6,) of all soles about the world's origin in N and N m."""
        return wrench_of_feet([p.wrench_in_sole for p in self.percepts], self.poses)

    @lazy
    def position_zmp_in_world(self) -> NDArray[np.float64] | None:
        """Composite ZMP (2,) in the ground plane in m, or None without load (T 4.7-4.8)."""
        return zmp_in_plane(self.wrench_in_world, self.ground_height, minimum_force=0.0)

    @lazy
    def positions_cop_in_world(self) -> tuple[NDArray[np.float64] | None, ...]:
        """Each sole's CoP (3,) on its surface, in world in m; None without load (T 4.21)."""
        return tuple(
            None if p.surface_cop_in_sole is None else pose.to_world(p.surface_cop_in_sole)
            for p, pose in zip(self.percepts, self.poses, strict=True)
        )

    @lazy
    def support_polygon_in_world(self) -> NDArray[np.float64]:
        """Convex support polygon (k, 2) of all soles from above in m; empty without contact (T 4.25)."""
        polygons = [
            pose.polygon_to_world(p.support_polygon_in_sole if p.layout.is_level else _corners(p.layout, p.active))
            for p, pose in zip(self.percepts, self.poses, strict=True)
        ]
        return feet_support_polygon(polygons)

    @lazy
    def outlines_in_world(self) -> tuple[Outline, ...]:
        """Concave outline of each sole's contact, from above in world in m (T 4.2.5)."""
        return tuple(
            pose.outline_to_world(p.concave_outline_in_sole, p.layout)
            for p, pose in zip(self.percepts, self.poses, strict=True)
        )

    @lazy
    def preemptive_polygon_in_world(self) -> NDArray[np.float64] | None:
        """Convex polygon (k, 2) of all near cells in m (T 4.2.7, Fig. 37-g); None without proximity."""
        known = [
            pose.polygon_to_world(polygon if p.layout.is_level else _corners(p.layout, p.near))
            for p, pose in zip(self.percepts, self.poses, strict=True)
            if (polygon := p.preemptive_polygon_in_sole) is not None
        ]
        return feet_support_polygon(known) if known else None

    @lazy
    def support_area(self) -> float:
        """Area in m^2 of all soles' support polygon, from above."""
        return area(self.support_polygon_in_world)

    @lazy
    def contact_area(self) -> float:
        """Area in m^2 of the active cells of all soles (T 4.22)."""
        return sum([p.contact_area for p in self.percepts])


def _corners(layout: SoleLayout, mask: NDArray[np.bool_] | None) -> NDArray[np.float64]:
    """Corners (m, 3) of cells in sole frame in m."""
    cells: list[int] = [] if mask is None else np.flatnonzero(mask).tolist()
    return layout.vertices[sorted({v for i in cells for v in layout.corners[i]})]
