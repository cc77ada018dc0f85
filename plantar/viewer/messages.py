"""Foxglove's messages, decoded for the viewer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import count

import numpy as np

from plantar.recordings.foxglove import Slot, Template, frame_transform, read_fields

__all__ = ["Entity", "Shape", "deleted_all", "entities", "transform_template", "transforms"]

_KINDS = {7: "arrow", 8: "cube", 9: "sphere", 10: "cylinder", 11: "line", 12: "triangles", 13: "text"}
_COLOUR_FIELD = {"arrow": 6, "cube": 3, "sphere": 3, "cylinder": 5, "line": 6, "triangles": 3, "text": 5}
_POINTS_FIELD = {"line": 5, "triangles": 2}
Value = int | float | bytes
_WHOLE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Shape:
    """Primitive of an entity.

    Attributes:
        kind: "arrow", "cube", "sphere", "cylinder", "line", "triangles" or "text".
        pose: Position in m and quaternion (x, y, z, w), entity's frame.
        size: (x, y, z) in m of cube, sphere or cylinder.
        colour: Red, green, blue and opacity, 0..1.
        points: (x, y, z) in m of lines or triangles.
        indices: Three points a triangle.
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
    """Decode foxglove.FrameTransforms: yields name, parent and pose (position in m, quaternion x, y, z, w) of each
    frame.

    Raises:
        ValueError: If damaged.
    """
    for number, part in read_fields(message):
        if number == 1:
            fields = _fields(part)
            turn = _numbers(fields.get(5, b""), 4)
            yield _text(fields.get(3)), _text(fields.get(2)), (*_numbers(fields.get(4, b""), 3), *_whole_turn(turn))


def transform_template(message: bytes) -> Template:
    """Template of `plantar.recordings` with a given message's frames; slots are poses (k, 7) in sequence.

    Raises:
        ValueError: If damaged.
    """
    slots = ([Slot(7 * i + j) for j in range(7)] for i in count())
    frames = zip(transforms(message), slots, strict=False)
    return Template(*(frame_transform(name, s[:3], s[3:], parent) for (name, parent, _), s in frames))


def deleted_all(message: bytes) -> bool:
    """Whether a foxglove.SceneUpdate removes all earlier drawings."""
    return any(number == 1 and _fields(part).get(2) == 1 for number, part in read_fields(message))


def entities(message: bytes) -> list[Entity]:
    """Entities of a foxglove.SceneUpdate, with the drawn primitives.

    Raises:
        ValueError: If damaged.
    """
    found = []
    for number, part in read_fields(message):
        if number != 2:
            continue
        fields = list(read_fields(_bytes(part)))
        texts = {key: _text(value) for key, value in fields if key in (2, 3)}
        shapes = tuple(_shape(_KINDS[key], value) for key, value in fields if key in _KINDS)
        found.append(Entity(texts.get(3, ""), texts.get(2, "world"), shapes))
    return found


def _shape(kind: str, message: Value) -> Shape:
    fields = list(read_fields(_bytes(message)))
    single = dict(fields)
    pose: tuple[float, ...] = _WHOLE
    if kind != "line":
        place = _fields(single.get(1, b""))
        pose = (*_numbers(place.get(1, b""), 3), *_whole_turn(_numbers(place.get(2, b""), 4)))
    points = tuple(_numbers(v, 3) for key, v in fields if key == _POINTS_FIELD.get(kind))
    packed = _bytes(single.get(5, b"")) if kind == "triangles" else b""
    sized = kind in ("cube", "sphere", "cylinder")
    return Shape(
        kind=kind,
        pose=pose,
        size=_numbers(single.get(2, b""), 3) if sized else (),
        colour=_numbers(single.get(_COLOUR_FIELD[kind], b""), 4),
        points=points,
        indices=tuple(int(i) for i in np.frombuffer(packed, dtype="<u4")),
    )


def _numbers(message: Value, size: int) -> tuple[float, ...]:
    """Doubles of a message, field numbers 1 to `size`; all finite."""
    values = [_fields(message).get(i, 0.0) for i in range(1, size + 1)]
    if not all(isinstance(value, float) and math.isfinite(value) for value in values):
        raise ValueError("a number of a message is none")
    return tuple(float(value) for value in values)


def _whole_turn(turn: tuple[float, ...]) -> tuple[float, ...]:
    return turn if any(turn) else _WHOLE[3:]


def _fields(message: Value) -> dict[int, Value]:
    return dict(read_fields(_bytes(message)))


def _text(value: Value | None) -> str:
    return "" if value is None else _bytes(value).decode(errors="replace")


def _bytes(value: Value) -> bytes:
    if not isinstance(value, bytes):
        raise ValueError("a number where a message is due")
    return value
