"""Sole poses in the world, and two soles' joint wrench."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, items, number
from plantar.common.arrays import array, is_finite, numbers, own
from plantar.common.lazy import lazy
from plantar.common.plane_points import plane_points
from plantar.errors import InputError
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import convex_hull
from plantar.kernels.geometry import convex as _kernel
from plantar.layouts.cell_edges import WELD
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.rotation import level_rotation


@dataclass(frozen=True, eq=False)
class SolePose:
    """Pose of a sole frame in world frame (wT_L, wT_R of T 4.25), read-only.

    Attributes:
        rotation_sole_to_world: Rotation (3, 3).
        position_in_world: Position (3,) of sole origin in m.

    Raises:
        InputError: No finite rotation and position.

    Example:
        >>> pose = SolePose.flat(0.1, 0.2, yaw=np.pi / 2)
        >>> pose.to_world([0.05, 0.0, 0.0]).round(6).tolist()
        [0.1, 0.25, 0.0]
    """

    rotation_sole_to_world: NDArray[np.float64]
    position_in_world: NDArray[np.float64]

    def __post_init__(self) -> None:
        rotation = own(numbers(self.rotation_sole_to_world, "rotation of a sole pose"))
        position = own(numbers(self.position_in_world, "position of a sole pose"))
        if rotation.shape != (3, 3) or position.shape != (3,):
            raise InputError(f"sole pose has shapes {rotation.shape} and {position.shape}; expected (3, 3) and (3,)")
        if not (is_finite(rotation) and is_finite(position)):
            raise InputError("sole pose holds a value that is not finite")
        # nature: floating point of single precision, in which a caller may hold a rotation
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-6 or np.linalg.det(rotation) < 0.0:
            raise InputError("sole pose holds a matrix that is not a rotation")
        self.__dict__.update(rotation_sole_to_world=rotation, position_in_world=position)

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles are constructed: numpy forgets what is read-only.
        return type(self), (self.rotation_sole_to_world, self.position_in_world)

    @classmethod
    def flat(cls, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> "SolePose":
        """Pose of a level sole: x forward, y left and z up in m, turned left by yaw in rad; InputError unless finite.

        Args:
            x: Position forward in m.
            y: Position to the left in m.
            z: Height in m.
            yaw: Turn to the left in rad.

        Returns:
            Pose.
        """
        turn = number(yaw, "yaw", finite=True)
        place = [number(v, f"position {axis}", finite=True) for v, axis in zip((x, y, z), "xyz", strict=True)]
        return cls(level_rotation(turn), np.array(place))

    def to_world(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (..., 3) of the sole frame in world, in m (T 4.25)."""
        given = array(points, "points", (..., 3))
        turn = self.rotation_sole_to_world.T
        with np.errstate(over="ignore", invalid="ignore"):  # of points that are not finite
            turned = given.dot(turn) if given.ndim == 1 else given @ turn  # the same, sooner for one point
            turned += self.position_in_world
        return np.asarray(turned)

    def polygon_to_world(self, polygon: ArrayLike) -> NDArray[np.float64]:
        """Polygon (k, 2) of the sole plane, or points (k, 3) of a curved sole, from above in world (k, 2) in m."""
        given = numbers(polygon, "polygon")
        if given.ndim == 2 and given.shape[1] == 3:  # nature: points of space
            return self.to_world(given)[:, :2]
        return polygon_in_world(polygon, self.rotation_sole_to_world, self.position_in_world)

    def outline_to_world(self, outline: Outline, layout: SoleLayout) -> Outline:
        """A contact's outline from above in world in m, on the sole's surface.

        Args:
            outline: Outline in sole frame in m, as of `concave_outline`.
            layout: Sole with the outline's corners.

        Returns:
            Outline.
        """
        if layout.is_level:
            return outline.moved(self.rotation_sole_to_world, self.position_in_world)
        return Outline.of_rings([self.to_world(_on_surface(ring, layout.vertices))[:, :2] for ring in outline.rings])

    def wrench_to_world(self, wrench: ArrayLike) -> NDArray[np.float64]:
        """Wrenches (..., 6) about the sole's origin as about the world's, in N and N m."""
        given = array(wrench, "wrench", (..., 6))
        turn, lever = self._wrench_maps
        with np.errstate(over="ignore", invalid="ignore"):  # of forces that are not finite
            turned: NDArray[np.float64] = given.reshape(-1, 3).dot(turn).reshape(given.shape)
            moment = turned[..., 3:]
            moment += given[..., :3].dot(lever)
        return turned

    @lazy
    def _wrench_maps(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        turn = self.rotation_sole_to_world.T
        x, y, z = self.position_in_world.tolist()
        return turn, turn @ np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


def _on_surface(ring: NDArray[np.float64], vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """A ring's corners (m, 3), with the sole's `vertices` (v, 3) on its edges."""
    height = {(x, y): z for x, y, z in vertices.tolist()}
    points = []
    for (x, y), along in zip(ring.tolist(), np.roll(ring, -1, axis=0) - ring, strict=True):
        off = (vertices[:, :2] - (x, y)) / (along @ along)
        share = off @ along
        beside = off @ (-along[1], along[0])
        between = np.flatnonzero((share > WELD) & (share < 1.0 - WELD) & (np.abs(beside) <= WELD))
        points += [(x, y, height.get((x, y), 0.0)), *vertices[between[np.argsort(share[between])]]]
    return np.array(points)


def wrench_of_feet(wrenches_in_sole: Sequence[ArrayLike], poses: Sequence[SolePose]) -> NDArray[np.float64]:
    """Sum of the soles' wrenches about the world's origin.

    `wrenches_in_sole`: wrench (6,) or (frames, 6) of each sole about its own origin in N and N m, zero in the air.
    Returns wrench (6,) or (frames, 6) in world frame in N and N m, by world on robot.
    """
    wrenches = items(wrenches_in_sole, "wrenches")
    places = items(poses, "poses")
    if len(wrenches) != len(places) or not places:
        raise InputError(f"{len(wrenches)} wrenches and {len(places)} poses; expected one pose a wrench")
    turned = [instance(p, SolePose, "pose").wrench_to_world(w) for w, p in zip(wrenches, places, strict=True)]
    if any(w.shape != turned[0].shape for w in turned):
        raise InputError(f"wrenches have shapes {', '.join(str(w.shape) for w in turned)}; expected the same")
    return np.asarray(sum(turned))


def polygon_in_world(
    polygon_in_sole: ArrayLike,
    rotation_sole_to_world: ArrayLike,
    position_sole_in_world: ArrayLike,
) -> NDArray[np.float64]:
    """Polygon of the sole plane, from above in world frame.

    `polygon_in_sole`: polygon (k, 2) in sole frame in m; `rotation_sole_to_world`: rotation (3, 3);
    `position_sole_in_world`: position (3,) of sole origin in m. Returns polygon (k, 2) in m in the world's x-y plane.
    """
    seen: NDArray[np.float64] = _kernel.seen_from_above(
        plane_points(polygon_in_sole),
        array(rotation_sole_to_world, "rotation", (3, 3), finite=True),
        array(position_sole_in_world, "position", (3,), finite=True),
    )
    return seen


def feet_support_polygon(polygons_in_world: Sequence[ArrayLike]) -> NDArray[np.float64]:
    """Convex support polygon of all feet (T 4.25).

    `polygons_in_world`: support polygon (k, 2) of each foot in world frame; empty in the air. Returns convex polygon
    (m, 2), counter-clockwise, empty without contact.

    Example:
        >>> left = np.array([[0.0, 0.1], [0.2, 0.1], [0.2, 0.2], [0.0, 0.2]])
        >>> feet_support_polygon([left, left * [1, -1]]).tolist()
        [[0.0, -0.2], [0.2, -0.2], [0.2, 0.2], [0.0, 0.2]]
    """
    parts = [p for p in map(plane_points, items(polygons_in_world, "polygons")) if len(p)]
    return convex_hull(np.concatenate(parts) if len(parts) != 1 else parts[0]) if parts else np.empty((0, 2))
