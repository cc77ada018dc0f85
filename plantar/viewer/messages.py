"""Foxglove's messages, decoded for the viewer."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import count

from plantar.recordings.foxglove import Message, Template, frame_transform, message_of, slot

_KINDS = ("arrow", "cube", "sphere", "cylinder", "line", "triangles", "text")
_SCENE = "foxglove.SceneUpdate"


@dataclass(frozen=True)
class Shape:
    """Primitive of an entity.

    `kind`: "arrow", "cube", "sphere", "cylinder", "line", "triangles" or "text"; `pose`: position in m and quaternion
    (x, y, z, w), entity's frame; `size` (x, y, z) in m of cube, sphere or cylinder; `colour`: red, green, blue and
    opacity, 0..1; `points` (x, y, z) in m of lines or triangles; `indices`: three points a triangle.
    """

    kind: str
    pose: tuple[float, ...]
    size: tuple[float, ...]
    colour: tuple[float, ...]
    points: tuple[tuple[float, ...], ...] = ()
    indices: tuple[int, ...] = ()


@dataclass(frozen=True)
class Entity:
    """Shapes in a named frame."""

    name: str
    frame: str
    shapes: tuple[Shape, ...] = field(default=())


def transforms(message: bytes) -> Iterator[tuple[str, str, tuple[float, ...]]]:
    """Yields each frame's name, parent and pose (position in m, quaternion x, y, z, w) of a foxglove.FrameTransforms;
    ValueError if damaged.
    """
    for frame in message_of("foxglove.FrameTransforms", message).transforms:
        yield frame.child_frame_id, frame.parent_frame_id, _pose(frame.translation, frame.rotation)


def transform_template(message: bytes) -> Template:
    """Template of `plantar.recordings` with a message's frames, slots their poses (k, 7); ValueError if damaged."""
    frames = zip(transforms(message), ([slot(7 * i + j) for j in range(7)] for i in count()), strict=False)
    return Template(*(frame_transform(name, s[:3], s[3:], parent) for (name, parent, _), s in frames))


def deleted_all(message: bytes) -> bool:
    """Whether a foxglove.SceneUpdate removes all earlier drawings."""
    return any(deletion.type == 1 for deletion in message_of(_SCENE, message).deletions)


def entities(message: bytes) -> list[Entity]:
    """Entities of a foxglove.SceneUpdate, with the drawn primitives; ValueError if damaged."""
    found = []
    for entity in message_of(_SCENE, message).entities:
        lists = (getattr(entity, kind if kind == "triangles" else f"{kind}s") for kind in _KINDS)
        shapes = tuple(_shape(kind, shape) for kind, own in zip(_KINDS, lists, strict=True) for shape in own)
        found.append(Entity(entity.id, entity.frame_id or "world", shapes))
    return found


def _shape(kind: str, shape: Message) -> Shape:
    return Shape(
        kind=kind,
        pose=_pose(shape.pose.position, shape.pose.orientation),
        size=_numbers(shape.size, "xyz") if kind in ("cube", "sphere", "cylinder") else (),
        colour=_numbers(shape.color, "rgba"),
        points=tuple(_numbers(p, "xyz") for p in shape.points) if kind in ("line", "triangles") else (),
        indices=tuple(shape.indices) if kind == "triangles" else (),
    )


def _pose(position: Message, turn: Message) -> tuple[float, ...]:
    quaternion = _numbers(turn, "xyzw")
    return (*_numbers(position, "xyz"), *(quaternion if any(quaternion) else (0.0, 0.0, 0.0, 1.0)))


def _numbers(message: Message, names: str) -> tuple[float, ...]:
    values = tuple(getattr(message, name) for name in names)
    if not all(map(math.isfinite, values)):
        raise ValueError("a number of a message is none")
    return values
