"""Messages of Foxglove's own schemas, which its 3D and log panels draw without settings.

Encoded as protocol buffers (https://docs.foxglove.dev/docs/sdk/schemas) with the descriptors in `schemas/`, of the
package foxglove-schemas-protobuf (`tools/foxglove_schemas.py`, MIT licence). Positions and sizes are in m, rotations
quaternions (x, y, z, w), colours red, green, blue and opacity, 0 to 1; a `place` is made by `pose`.
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
    """The encoded FileDescriptorSet of `schema`, one of SCHEMAS, with all files that it needs."""
    return files("plantar.recordings").joinpath("schemas", f"{schema}.bin").read_bytes()


def frame_transform(frame: str, translation: Numbers, rotation: Numbers, parent: str = "world") -> Part:
    """Returns a `transforms` field of foxglove.FrameTransforms: `translation` and `rotation` of `frame` in its
    `parent`.
    """
    return nested(1, timestamp(1), text(2, parent), text(3, frame), numbers(4, translation), numbers(5, rotation))


def entity(name: str, frame: str, *primitives: Part, locked: bool = True) -> Part:
    """Returns an `entities` field of foxglove.SceneUpdate: `primitives` in the coordinates of `frame` under a `name`.

    It replaces the topic's entity of that name. A `locked` one moves with its frame.
    """
    return nested(2, timestamp(1), text(2, frame), text(3, name), integer(5, locked), *primitives)


def delete_all() -> Part:
    """A `deletions` field of foxglove.SceneUpdate that removes all earlier entities of the topic."""
    return nested(1, timestamp(1), integer(2, 1))


def pose(position: Numbers, rotation: Numbers = _UPRIGHT) -> Part:
    """Returns the pose of a primitive, its `position` and `rotation`."""
    return nested(1, numbers(1, position), numbers(2, rotation))


def cube(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns a box with edges `size` (x, y, z) and `colour`, centred at `place`."""
    return nested(8, place, numbers(2, size), numbers(3, colour))


def sphere(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns a sphere or an ellipsoid with diameters `size` (x, y, z) and `colour` at `place`."""
    return nested(9, place, numbers(2, size), numbers(3, colour))


def cylinder(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns a cylinder along z with diameters and height `size` (x, y, z) and `colour` at `place`."""
    return nested(10, place, numbers(2, size), double(3, 1.0), double(4, 1.0), numbers(5, colour))


def arrow(place: Part, length: float | Slot, thickness: float, colour: Numbers) -> Part:
    """Returns an arrow along x from `place`: `length` and `thickness` of its shaft, and `colour`; its head is twice as
    wide."""
    sizes = (double(2, length), double(3, thickness), double(4, 2.0 * thickness), double(5, 2.0 * thickness))
    return nested(7, place, *sizes, numbers(6, colour))


def line_loop(points: Sequence[Numbers], thickness: float, colour: Numbers) -> Part:
    """Returns a closed line through `points` (x, y, z) of a `thickness` and `colour`."""
    corners = [numbers(5, point) for point in points]
    place = nested(2, numbers(1, _ORIGIN), numbers(2, _UPRIGHT))
    return nested(11, integer(1, _LINE_LOOP), place, double(3, thickness), *corners, numbers(6, colour))


def triangles(points: Sequence[Numbers], indices: ArrayLike, colour: Numbers) -> Part:
    """Returns triangles of one `colour`: three `indices` each into `points`, counter-clockwise from outside."""
    corners = [numbers(2, point) for point in points]
    return nested(12, pose(_ORIGIN), *corners, numbers(3, colour), fixed32s(5, np.ravel(indices)))


def words(place: Part, value: str, size: float, colour: Numbers) -> Part:
    """Returns a text `value` at `place` that turns to the viewer, with letters of height `size` and `colour`."""
    return nested(13, place, integer(2, True), double(3, size), numbers(5, colour), text(6, value))


def log_message(time_s: float, message: str, level: str = "info", name: str = "plantar") -> bytes:
    """Returns an encoded foxglove.Log: a `message` at `time_s` with a `level` of LEVELS, from the source `name`."""
    return Template(timestamp(1), integer(2, LEVELS[level]), text(3, message), text(4, name)).filled(time_s)
