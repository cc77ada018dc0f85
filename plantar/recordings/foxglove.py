"""Messages of Foxglove's own schemas, which its 3D and log panels draw without settings.

Encoded as protocol buffers, numbered as Foxglove publishes them
(https://docs.foxglove.dev/docs/sdk/schemas); `schemas/` holds the descriptors that a recording carries with them, as
the package foxglove-schemas-protobuf has them (`tools/foxglove_schemas.py`, MIT licence).
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike

from plantar.recordings.protobuf import (
    Part,
    Slot,
    Template,
    double,
    fixed32s,
    integer,
    nested,
    numbers,
    text,
    timestamp,
)

__all__ = [
    "LEVELS",
    "SCHEMAS",
    "arrow",
    "cube",
    "cylinder",
    "delete_all",
    "descriptor",
    "entity",
    "frame_transform",
    "line_loop",
    "log_message",
    "pose",
    "sphere",
    "triangles",
    "words",
]

SCHEMAS = ("foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.Log")
"""The schemas whose messages are written."""

LEVELS = {"info": 2, "warning": 3, "error": 4}
"""Levels of a log message."""

Numbers = Sequence[float | Slot]

_ORIGIN = (0.0, 0.0, 0.0)
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
_LINE_LOOP = 1


def descriptor(schema: str) -> bytes:
    """What a recording stores about a schema.

    Args:
        schema: One of SCHEMAS.

    Returns:
        Its FileDescriptorSet, encoded, with all files that it needs.
    """
    return files("plantar.recordings").joinpath("schemas", f"{schema}.bin").read_bytes()


def frame_transform(frame: str, translation: Numbers, rotation: Numbers, parent: str = "world") -> Part:
    """Where a frame is in its parent at the time of the message: a `transforms` of foxglove.FrameTransforms.

    Args:
        frame: Its name.
        translation: Its origin (x, y, z) in m.
        rotation: Its rotation to the parent as a quaternion (x, y, z, w).
        parent: The parent's name.

    Returns:
        The field.
    """
    return nested(1, timestamp(1), text(2, parent), text(3, frame), numbers(4, translation), numbers(5, rotation))


def entity(name: str, frame: str, *primitives: Part, locked: bool = True) -> Part:
    """What is drawn in a frame under one name: an `entities` of foxglove.SceneUpdate.

    It takes the place of the one of the topic that had its name.

    Args:
        name: Its name.
        frame: The frame that its coordinates are in.
        primitives: What is drawn.
        locked: Whether it moves on with its frame; otherwise it stays where that was at the time of the message.

    Returns:
        The field.
    """
    return nested(2, timestamp(1), text(2, frame), text(3, name), integer(5, locked), *primitives)


def delete_all() -> Part:
    """Takes away all entities that the topic had before: a `deletions` of foxglove.SceneUpdate.

    Returns:
        The field.
    """
    return nested(1, timestamp(1), integer(2, 1))


def pose(position: Numbers, rotation: Numbers = _UPRIGHT) -> Part:
    """The pose of a primitive.

    Args:
        position: Its position (x, y, z) in m.
        rotation: Its rotation as a quaternion (x, y, z, w).

    Returns:
        The field.
    """
    return nested(1, numbers(1, position), numbers(2, rotation))


def cube(place: Part, size: Numbers, colour: Numbers) -> Part:
    """A box.

    Args:
        place: Where it is, by `pose`.
        size: Its edges (x, y, z) in m.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    return nested(8, place, numbers(2, size), numbers(3, colour))


def sphere(place: Part, size: Numbers, colour: Numbers) -> Part:
    """A sphere or an ellipsoid.

    Args:
        place: Where it is, by `pose`.
        size: Its diameters (x, y, z) in m.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    return nested(9, place, numbers(2, size), numbers(3, colour))


def cylinder(place: Part, size: Numbers, colour: Numbers) -> Part:
    """A cylinder along z.

    Args:
        place: Where it is, by `pose`.
        size: Its diameters and its height (x, y, z) in m.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    return nested(10, place, numbers(2, size), double(3, 1.0), double(4, 1.0), numbers(5, colour))


def arrow(place: Part, length: float | Slot, thickness: float, colour: Numbers) -> Part:
    """An arrow along x.

    Args:
        place: Where it begins, by `pose`.
        length: Length of its shaft in m.
        thickness: Diameter of its shaft in m; the head is twice as wide, and as long as wide.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    sizes = (double(2, length), double(3, thickness), double(4, 2.0 * thickness), double(5, 2.0 * thickness))
    return nested(7, place, *sizes, numbers(6, colour))


def line_loop(points: Sequence[Numbers], thickness: float, colour: Numbers) -> Part:
    """A closed line.

    Args:
        points: Its corners (x, y, z) in m.
        thickness: Its thickness in m.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    corners = [numbers(5, point) for point in points]
    place = nested(2, numbers(1, _ORIGIN), numbers(2, _UPRIGHT))
    return nested(11, integer(1, _LINE_LOOP), place, double(3, thickness), *corners, numbers(6, colour))


def triangles(points: Sequence[Numbers], indices: ArrayLike, colour: Numbers) -> Part:
    """Triangles of one colour.

    Args:
        points: Their corners (x, y, z) in m.
        indices: Three corners of each triangle, counter-clockwise from outside.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    corners = [numbers(2, point) for point in points]
    return nested(12, pose(_ORIGIN), *corners, numbers(3, colour), fixed32s(5, np.ravel(indices)))


def words(place: Part, value: str, size: float, colour: Numbers) -> Part:
    """A text that turns to the viewer.

    Args:
        place: Where it is, by `pose`.
        value: The text.
        size: Height of its letters in m.
        colour: Red, green, blue and opacity, 0..1.

    Returns:
        The field of an entity.
    """
    return nested(13, place, integer(2, True), double(3, size), numbers(5, colour), text(6, value))


def log_message(time_s: float, message: str, level: str = "info", name: str = "plantar") -> bytes:
    """A foxglove.Log.

    Args:
        time_s: When, in s.
        message: What happened.
        level: One of LEVELS.
        name: Its source.

    Returns:
        Its encoding.
    """
    return Template(timestamp(1), integer(2, LEVELS[level]), text(3, message), text(4, name)).filled(time_s)
