"""What a viewer needs of Foxglove's messages, decoded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.recordings.foxglove import frame_transform
from plantar.recordings.protobuf import Slot, Template, read_fields

__all__ = ["Entity", "Shape", "deleted_all", "entities", "transforms"]

_KINDS = {7: "arrow", 8: "cube", 9: "sphere", 10: "cylinder", 11: "line", 12: "triangles", 13: "text"}
_COLOUR_FIELD = {"arrow": 6, "cube": 3, "sphere": 3, "cylinder": 5, "line": 6, "triangles": 3, "text": 5}
_POINTS_FIELD = {"line": 5, "triangles": 2}
_WHOLE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Shape:
    """A primitive of an entity.

    Attributes:
        kind: "arrow", "cube", "sphere", "cylinder", "line", "triangles" or "text".
        pose: Position in m and quaternion (x, y, z, w) in the entity's frame.
        size: Size (x, y, z) in m of a cube, sphere or cylinder.
        colour: Red, green, blue and opacity, 0..1.
        points: Points (x, y, z) in m of a line or of triangles.
        indices: Three points of each triangle, one after the other.
    """

    kind: str
    pose: tuple[float, ...]
    size: tuple[float, ...]
    colour: tuple[float, ...]
    points: tuple[tuple[float, ...], ...] = ()
    indices: tuple[int, ...] = ()


@dataclass(frozen=True)
class Entity:
    """What is drawn in a frame.

    Attributes:
        name: Its name.
        frame: Name of the frame.
        shapes: Its primitives.
    """

    name: str
    frame: str
    shapes: tuple[Shape, ...] = field(default=())


def transforms(messages: Sequence[bytes]) -> tuple[list[str], NDArray[np.float64]]:
    """The frames of foxglove.FrameTransforms messages that have the same ones.

    Args:
        messages: At least one message, as `plantar.recordings.foxglove.frame_transform` makes them.

    Returns:
        Names of the frames of the first message, and the poses (n, k, 7) of all.

    Raises:
        ValueError: If a message has other frames.
    """
    names = []
    for _, part in read_fields(messages[0]):
        fields: dict[int, Any] = dict(read_fields(_bytes(part)))
        names.append(fields[3].decode())
    slots = [[Slot(7 * i + j) for j in range(7)] for i in range(len(names))]
    template = Template(*(frame_transform(n, s[:3], s[3:]) for n, s in zip(names, slots, strict=True)))
    return names, template.values_of(messages).reshape(len(messages), len(names), 7)


def deleted_all(message: bytes) -> bool:
    """Whether a foxglove.SceneUpdate takes away all that was drawn before."""
    return any(number == 1 and dict(read_fields(_bytes(part))).get(2) == 1 for number, part in read_fields(message))


def entities(message: bytes) -> list[Entity]:
    """The entities of a foxglove.SceneUpdate.

    Args:
        message: Its encoding.

    Returns:
        Them; of their primitives those that a viewer of walks knows.
    """
    found = []
    for number, part in read_fields(message):
        if number != 2:
            continue
        fields = list(read_fields(_bytes(part)))
        texts = {key: value.decode() for key, value in fields if key in (2, 3) and isinstance(value, bytes)}
        shapes = tuple(_shape(_KINDS[key], _bytes(value)) for key, value in fields if key in _KINDS)
        found.append(Entity(texts.get(3, ""), texts.get(2, "world"), shapes))
    return found


def _shape(kind: str, message: bytes) -> Shape:
    fields = list(read_fields(message))
    single: dict[int, Any] = dict(fields)
    pose: tuple[float, ...] = _WHOLE
    if kind != "line":
        place: dict[int, Any] = dict(read_fields(single[1]))
        pose = (*_numbers(place[1], 3), *_numbers(place[2], 4))
    points = tuple(_numbers(_bytes(v), 3) for key, v in fields if key == _POINTS_FIELD.get(kind))
    indices = np.frombuffer(single[5], dtype="<u4") if kind == "triangles" and 5 in single else ()
    sized = kind in ("cube", "sphere", "cylinder")
    return Shape(
        kind=kind,
        pose=pose,
        size=_numbers(single[2], 3) if sized else (),
        colour=_numbers(single[_COLOUR_FIELD[kind]], 4),
        points=points,
        indices=tuple(int(i) for i in indices),
    )


def _numbers(message: bytes, count: int) -> tuple[float, ...]:
    """The doubles of a message that are numbered from 1 on."""
    values: dict[int, Any] = dict(read_fields(message))
    return tuple(float(values.get(i, 0.0)) for i in range(1, count + 1))


def _bytes(value: int | float | bytes) -> bytes:
    if not isinstance(value, bytes):
        raise ValueError("a message is no message but a number")
    return value
