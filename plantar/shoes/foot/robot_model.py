"""Robot foot geometry and robot mass from MJCF or URDF."""

import itertools
import math
import os
import re
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import other_side
from plantar.errors import FootError
from plantar.layouts.source_pose import SourcePose
from plantar.shoes.foot.foot_mesh import Link, unit_scale
from plantar.shoes.foot.mesh_file import Unit
from plantar.shoes.foot.model_bodies import FARTHEST, BodyPlace, ModelBodies
from plantar.shoes.geometry.surface import surface_points, thinned

MODEL_FORMATS: tuple[str, ...] = (".xml", ".mjcf", ".urdf")  # file endings of robot models that are read

_SHOWN = 14  # names in a message
_WORDS = ("foot|feet|sole", "ank", "toe")  # in names of bodies that are a foot, or hold one
_MOST_SHAPES = 200  # of a foot's body
_APART = 0.02  # m between the origins of two feet
_UNLIKE = 2e-3  # m by which the extents of two feet may differ that are mirror images

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OtherFoot:
    """The other foot's link, and the reflection (3, 3) that turns this foot into it, about both origins."""

    link: Link
    mirror: Array

    def pose(self, pose: SourcePose, link: Link) -> SourcePose:
        """Pose of the other sole from that of this one, which is in the frame of `link`."""
        back = link.rotation.T
        flip = np.diag([1.0, -1.0, 1.0])
        position = self.link.rotation @ self.mirror @ back @ pose.position
        rotation = self.link.rotation @ self.mirror @ back @ pose.rotation @ flip
        return SourcePose(self.link.file, self.link.body, position, rotation)


@dataclass(frozen=True)
class BodyGeometry:
    """Body surface about its origin, zero pose.

    `triangles` (n, 3, 3) in m, z up; `mass`: robot's in kg, or None; `links`: points (n, 3) in m of moving links above,
    or None; `unread`: names of those that may come near and whose shape is not known; `link`: its frame; `other`: the
    other foot, where it is this one's mirror image.
    """

    triangles: Array
    side: Literal["left", "right"] | None
    mass: float | None
    notes: tuple[str, ...]
    links: Array | None = None
    unread: tuple[str, ...] = ()
    link: Link | None = None
    other: OtherFoot | None = None


def side_of_name(name: str) -> Literal["left", "right"] | None:
    """Side in a body's name.

    Example:
        >>> side_of_name("leg_left_6_link"), side_of_name("R_ANKLE_P_S"), side_of_name("LeftFoot"), side_of_name("sole")
        ('left', 'right', 'left', None)
    """
    words = [w.lower() for w in re.findall(r"[A-Z]?[a-z]+|[A-Z]+|\d+", name)]
    left, right = (s in words or name.lower().startswith(s) for s in ("left", "right"))
    if left == right:
        left = "l" in words
        right = "r" in words
    return None if left == right else "left" if left else "right"


def read_foot_body(path: str | os.PathLike[str], body: str | None, unit: Unit | None = None) -> BodyGeometry:
    """Gives geometry of a robot foot, drawn or else colliding, with what is fixed to it, from the body of an MJCF or
    URDF at a path, in m or a unit.
    """
    source = ModelBodies(Path(path))
    bodies = source.bodies()
    if body is None or body not in bodies:
        what = "name the foot's body (--body)" if body is None else f"there is no body '{body}'"
        raise FootError(f"{source.file}: {what}; allowed: {_names_shown(bodies, body or '')}")
    where = f"{source.file}: body '{body}'"
    drawn, colliding = source.shapes(body, _MOST_SHAPES)
    shapes = drawn or colliding
    if not shapes:
        raise FootError(f"{where} has no geometry; name the body that has the foot's: {_names_shown(bodies, body)}")
    triangles = _together(shapes, where)
    unit_scale(float(np.ptp(triangles, axis=(0, 1)).max()), unit, "m", where)  # sweeping one in mm takes minutes
    mass, note = source.mass(body)
    read = f"body '{body}': {len(shapes)} {'drawn' if drawn else 'colliding'} shape(s), in {unit or 'm as models are'}"
    read += ", without what moves below it" if bodies[body].carries else ""
    foreign = SweptLinks(None, ("the links above the foot are read in m alone",))
    swept = swept_links(source, body, triangles) if unit in (None, "m") else foreign
    link = Link(source.file.name, body, bodies[body].rotation.T)
    other = _other_foot(source, body, bodies, triangles)
    notes = (read, note, *swept.notes)
    return BodyGeometry(triangles, side_of_name(body), mass, notes, swept.points, swept.unread, link, other)


def name_of_other(body: str) -> str | None:
    """Name of the other foot's body; None where no word of it is a side.

    Example:
        >>> name_of_other("left_ankle_roll_link"), name_of_other("R_ANKLE_P_S"), name_of_other("RightFoot")
        ('right_ankle_roll_link', 'L_ANKLE_P_S', 'LeftFoot')
        >>> name_of_other("sole") is None
        True
    """
    side = side_of_name(body)
    if side is None:
        return None
    other = other_side(side)
    start = body[: len(side)]
    if start.lower() == side:
        return _spelled_as(other, start) + body[len(side) :]
    words = re.split(r"([A-Z]?[a-z]+|[A-Z]+|\d+)", body)
    for own, its in ((side, other), (side[0], other[0])):
        changed = [_spelled_as(its, word) if word.lower() == own else word for word in words]
        if changed != words:
            return "".join(changed)
    return None


def _spelled_as(word: str, example: str) -> str:
    if example.isupper():
        return word.upper()
    return word.capitalize() if example[0].isupper() else word


def _other_foot(source: ModelBodies, body: str, bodies: dict[str, BodyPlace], triangles: Array) -> OtherFoot | None:
    """The other foot, where the robot is its own mirror image in the zero pose."""
    name = name_of_other(body)
    if name is None or name not in bodies:
        return None
    own = bodies[body]
    its = bodies[name]
    apart = its.position - own.position
    distance = float(np.linalg.norm(apart))
    if distance < _APART:
        return None
    normal = apart / distance
    mirror = np.eye(3) - 2.0 * np.outer(normal, normal)
    try:
        drawn, colliding = source.shapes(name, _MOST_SHAPES)
    except FootError:
        return None
    shapes = drawn or colliding
    if not shapes:
        return None
    seen = np.concatenate(shapes).reshape(-1, 3)
    wanted = triangles.reshape(-1, 3) @ mirror
    off = [np.abs(limit(seen, axis=0) - limit(wanted, axis=0)).max() for limit in (np.min, np.max)]
    if max(off) > _UNLIKE:
        return None
    return OtherFoot(Link(source.file.name, name, its.rotation.T), mirror)


def _names_shown(bodies: dict[str, BodyPlace], wanted: str) -> str:
    likely = _like_feet(bodies, wanted)
    return (", ".join(likely[:_SHOWN]) + (", ..." if len(likely) > _SHOWN else "")) or "there is none"


def _like_feet(bodies: dict[str, BodyPlace], wanted: str) -> list[str]:
    shaped = [name for name, body in bodies.items() if body.shaped and name]
    alike = get_close_matches(wanted, shaped, 4, 0.75)
    called = {
        name: next((i for i, words in enumerate(_WORDS) if re.search(words, name, re.IGNORECASE)), len(_WORDS))
        for name in shaped
    }
    named = [name for name in shaped if called[name] < len(_WORDS)]

    def rank(name: str) -> tuple[int, bool, float, int]:
        return called[name], bodies[name].carries, round(float(bodies[name].position[2]), 2), -bodies[name].depth

    return [*alike, *(name for name in sorted(named or shaped, key=rank) if name not in alike)]


def _together(shapes: list[Array], where: str) -> Array:
    triangles = np.concatenate(shapes)
    if not (np.abs(triangles) < FARTHEST).all():
        raise FootError(f"{where} reaches farther than {FARTHEST:g} m")
    return triangles


_LINKS = 3  # above the foot that are looked at
_POSES = 5  # of each joint, from end to end of its range
_NEAR = 0.05  # m around the foot
_SPACING = 0.004  # m between points
_ALL = "all above the foot"  # in place of the names of links, where the model cannot be compiled


class SweptLinks(NamedTuple):
    """Points (n, 3) in m that links above a foot pass, or None; notes; names of links that may pass where no point is,
    as their shape is not known.
    """

    points: Array | None
    notes: tuple[str, ...]
    unread: tuple[str, ...] = ()


def swept_links(source: ModelBodies, name: str, surface: Array) -> SweptLinks:
    """Gives where links above a foot pass over its last two hinges' range: source is the model, name the foot's body,
    surface its triangles (k, 3, 3), near which points are kept.
    """
    try:
        links = source.links_above(name, _LINKS)
    except FootError as error:
        return SweptLinks(None, ("the robot's other links are not read: " + _reason(source, error),), (_ALL,))
    if not links.surfaces and not links.unread:
        return SweptLinks(None, ("the links above the foot have no shape",))
    clouds = [thinned(surface_points(triangles, _SPACING), _SPACING) for triangles in links.surfaces]
    low = surface.min(axis=(0, 1)) - _NEAR
    high = surface.max(axis=(0, 1)) + _NEAR
    found = [np.empty((0, 3))]
    away = dict.fromkeys(links.unread, math.inf)
    for angles in itertools.product(*(np.linspace(*span, _POSES) for span in links.ranges)):
        poses = links.poses(angles)
        for points, (turn, place) in zip(clouds, poses, strict=False):
            near = points @ turn.T + place
            found.append(near[((near > low) & (near < high)).all(axis=1)])
        for link, (_, center) in zip(links.unread, poses[len(clouds) :], strict=True):
            away[link] = min(away[link], float(np.linalg.norm(center - np.clip(center, low, high))) - link.reach)
    swept = thinned(np.concatenate(found), _SPACING)
    spans = ", ".join(f"{np.degrees(end - start):.0f}" for start, end in links.ranges)
    note = f"the links above the foot are swept over {len(links.ranges)} joint(s), {spans} degrees"
    if not len(swept):
        note = "no link above the foot passes near it"
    lacking = (
        f"the shape of link '{link.name}' is not read"
        f"{', but by its mass it passes nowhere near' if gap > 0.0 else ''}: {_reason(source, link.problem)}"
        for link, gap in away.items()
    )
    unread = tuple(link.name for link, gap in away.items() if gap <= 0.0)
    return SweptLinks(swept if len(swept) else None, (note, *lacking), unread)


def _reason(source: ModelBodies, problem: object) -> str:
    """Why links are not read, without the folder of their model, which every reader of a page would see."""
    return str(problem).removeprefix(f"{source.file}: ").replace(f"{source.file.parent.resolve()}/", "")[:120]
