"""The sole of a foot: the plane it rests on, and its frame."""

import math
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from plantar.errors import RobotError
from plantar.robots.survey.body_surface import convex_surface, geom_triangles, resting_plane, shapes_of
from plantar.robots.survey.leg_chains import Leg

_RESTS = 0.25  # share of the silhouette that a plane must have to be what the foot rests on
_LEVEL = math.radians(0.2)  # a sole that is tilted by less is taken as level: rounding of the model's numbers
_BAND = 0.005  # m: the lowest part of a foot, which is its sole
_COVERED = 0.4  # of the silhouette by the lowest band; less are balls, bars or a rounded sole
# m: of a sole that a shoe is built for
_LEAST_LENGTH = 0.06
_LEAST_WIDTH = 0.015
_TOED_OUT = math.radians(8.0)  # between the foot's long side and the robot's forward direction
_ACROSS = 1.5  # width over length of a sole at most
_SLENDER = 1.3  # length over width of a foot whose long side is given

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sole:
    """A bare sole. Frame: x forward, y left, z up, origin on the sole plane below the ankle.

    Attributes:
        origin: (3,) in the foot body's frame in m.
        rotation: Rotation (3, 3) from sole frame to the foot body's.
        triangles: The foot's surface (n, 3, 3) in sole frame in m.
        low: Least x and y (2,) of sole in m; `high` the greatest.
        turn: Angle in rad from the sole's normal to the nearest body axis.
        area: Of the outline's convex hull in m^2.
        notes: How it was found.
    """

    origin: Array
    rotation: Array
    triangles: Array
    low: Array
    high: Array
    turn: float
    area: float
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Rested:
    """The shapes of a foot that it stands on.

    `kind`: "drawn" or "colliding"; `surface`: triangles (n, 3, 3) in m, in wanted axes; `normal`: outward normal (3,)
    of plane that they rest on; `share`: that plane's area over silhouette from above.
    """

    kind: str
    surface: Array
    normal: Array
    share: float


def rested(model: Any, data: Any, parts: Collection[int], rotation: Array) -> Rested | None:
    """Returns the resting plane of a foot of bodies `parts` of `model` in state `data`; None without shapes.

    Drawn shapes count, or colliding ones where only these are flat below. `rotation` (3, 3) is from the model's world
    to axes with z up.
    """
    found = []
    drawn, colliding = shapes_of(model, parts)
    for kind, first, second in (("drawn", drawn, colliding), ("colliding", colliding, drawn)):
        bodies = {int(model.geom_bodyid[g]) for g in first}  # one without shapes of the kind has those of the other
        shapes = [*first, *(g for g in second if int(model.geom_bodyid[g]) not in bodies)]
        if shapes:
            surface = np.concatenate([geom_triangles(model, data, g) for g in shapes]) @ rotation.T
            found.append(Rested(kind, surface, *resting_plane(surface.reshape(-1, 3))))
    if not found:
        return None
    return found[0] if found[0].share >= _RESTS else max(found, key=lambda r: r.share)


def find_sole(model: Any, data: Any, leg: Leg, rotation: Array, where: str) -> Sole:
    """Returns the sole of a `leg` of `model` in state `data`, the posture of the file `where`.

    `rotation` (3, 3) is from the model's world to x forward, y left, z up.
    """
    name = model.body(leg.foot).name
    found = rested(model, data, leg.parts, rotation)
    if found is None:
        raise RobotError(f"{where}: foot '{name}' has no shape to stand on; give its body a mesh, box or sphere")
    surface = found.surface
    normal = found.normal
    share = 100.0 * min(found.share, 1.0)
    notes = [f"sole plane: that of the {found.kind} shapes of '{name}', {share:.0f} % of their silhouette"]
    if found.share < _RESTS:
        normal = np.array([0.0, 0.0, -1.0])
        notes[0] = f"'{name}' has no flat sole: its lowest point in the model's posture is taken, level"
    elif math.acos(min(1.0, -float(normal[2]))) < _LEVEL:
        normal = np.array([0.0, 0.0, -1.0])
    sole_to_robot, toe_out = _axes(surface, normal)
    if toe_out:
        notes.append(f"the foot's long side is turned by {math.degrees(toe_out):.0f} degrees: the sole frame is, too")
    local = surface @ sole_to_robot
    plane = float(local[..., 2].min())
    points = local.reshape(-1, 3) - (0.0, 0.0, plane)
    band = points[points[:, 2] <= _BAND]
    ankle = sole_to_robot.T @ rotation @ leg.ankle
    origin = np.array([*np.clip(ankle[:2], band[:, :2].min(axis=0), band[:, :2].max(axis=0)), plane])
    if float(np.abs(origin[:2] - ankle[:2]).max()) > 1e-3:
        notes.append("the ankle is not above the sole: the origin is the sole's nearest point")
    triangles = local - origin
    if _covered(triangles) < _COVERED:
        triangles = convex_surface(triangles.reshape(-1, 3))
        notes.append("the foot stands on balls, bars or a rounded sole: its convex hull is the sole")
    to_body = data.xmat[leg.foot].reshape(3, 3).T @ rotation.T
    body_origin = to_body @ (sole_to_robot @ origin) - data.xmat[leg.foot].reshape(3, 3).T @ data.xpos[leg.foot]
    in_body = to_body @ sole_to_robot
    outline = triangles.reshape(-1, 3)
    outline = outline[outline[:, 2] <= _BAND][:, :2]
    low = outline.min(axis=0)
    high = outline.max(axis=0)
    length, width = (high - low).tolist()
    if min(length, width) < _LEAST_WIDTH or max(length, width) < _LEAST_LENGTH:
        raise RobotError(
            f"{where}: foot '{name}' is a point: {1e3 * length:.0f} x {1e3 * width:.0f} mm of it are "
            f"within {1e3 * _BAND:g} mm of the ground; allowed: {1e3 * _LEAST_LENGTH:g} x {1e3 * _LEAST_WIDTH:g} mm "
            "or more, on which its taxels are and its ankle pushes"
        )
    if width > _ACROSS * length:
        raise RobotError(
            f"{where}: foot '{name}' lies across: {1e3 * length:.0f} mm of it are along the robot's way and "
            f"{1e3 * width:.0f} mm across; allowed: {_ACROSS:g} times as wide as long at most; turn its shape"
        )
    return Sole(
        origin=body_origin,
        rotation=in_body,
        triangles=triangles,
        low=low,
        high=high,
        turn=math.acos(min(1.0, float(np.abs(in_body[:, 2]).max()))),
        area=_hull_area(outline),
        notes=tuple(notes),
    )


def level_axes(normal: Array) -> Array:
    """Axes (3, 3), as columns, on a plane with an outward `normal` (3,): forward, left and up."""
    forward = np.array([1.0, 0.0, 0.0]) - normal[0] * normal
    forward /= float(np.linalg.norm(forward))
    return np.stack([forward, np.cross(forward, normal), -normal], axis=1)


def _axes(surface: Array, normal: Array) -> tuple[Array, float]:
    """Rotation (3, 3) from sole axes to the robot's, and long side's turn in rad."""
    level = level_axes(normal)
    points = surface.reshape(-1, 3) @ level
    flat = points[points[:, 2] <= points[:, 2].min() + _BAND][:, :2]
    angle = _long_side(flat)
    if not _TOED_OUT < abs(angle) < math.radians(50.0):
        return level, 0.0
    c = math.cos(angle)
    s = math.sin(angle)
    return np.asarray(level @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])), angle


def _long_side(points: Array) -> float:
    """Long side's angle in rad, within a quarter turn, of points' (n, 2) least rectangle."""
    try:
        corners = points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        return 0.0
    sides = np.roll(corners, -1, axis=0) - corners
    best = math.inf
    angle = 0.0
    size = (1.0, 1.0)
    for a in np.arctan2(sides[:, 1], sides[:, 0]).tolist():
        turned = corners @ np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
        length, width = np.ptp(turned, axis=0).tolist()
        if length * width < best:
            best = length * width
            angle = a
            size = (length, width)
    if size[1] > size[0]:
        angle += 0.5 * math.pi
    return 0.0 if max(size) < _SLENDER * min(size) else math.remainder(angle, math.pi)


def _covered(triangles: Array) -> float:
    """Share of the silhouette under lowest faces: small for balls, 1 for a plate."""
    flat = triangles[(triangles[..., 2] <= _BAND).all(axis=1)][..., :2]
    a = flat[:, 1] - flat[:, 0]
    b = flat[:, 2] - flat[:, 0]
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    down = 0.5 * float(-cross[cross < 0.0].sum())
    up = 0.5 * float(np.abs(cross).sum()) - down
    return max(down, up) / max(_hull_area(triangles.reshape(-1, 3)[:, :2]), 1e-12)


def _hull_area(points: Array) -> float:
    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0
