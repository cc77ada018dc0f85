"""Messages of Foxglove's schemas, drawn without settings, as protocol buffers.

The descriptors in `schemas/` come from foxglove-schemas-protobuf (`tools/foxglove_schemas.py`, MIT licence). Positions
and sizes in m, rotations quaternions (x, y, z, w), colours red, green, blue and opacity, 0 to 1; a `place` is made by
`pose`. Messages of one length are encoded once, by a `Template` that fills in numbers and time.
"""

import re
import struct
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

SCHEMAS = ("foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.Log")
"""The schemas whose messages are written."""

LEVELS = {"info": 2, "warning": 3, "error": 4}
"""Levels of a log message."""

Message = Any
"""A message of protobuf's library, which has no types."""

Numbers = Sequence[float]
_LARGEST = 10_000_000  # bytes of a message that is read; a robot's meshes take 2 MB
_ORIGIN = (0.0, 0.0, 0.0)
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
_LINE_LOOP = 1
_ALL = 1
_SLOT = b"plant\x44"  # last six bytes of a double that no quantity has, about 1e22; its first two number the slot
_LONG = 5  # bytes of a varint that always has the same length: 35 bits
_SHIFTS = 7 * np.arange(_LONG, dtype=np.uint64)
# Time to be filled in: both whole numbers take `_LONG` bytes
_TIME = {"seconds": 2**34 + 0x2B5A3C1, "nanos": 2**30 + 0x1A2B3C5}


def descriptor(schema: str) -> bytes:
    """Encoded FileDescriptorSet of `schema`, one of SCHEMAS, with all needed files."""
    return files("plantar.recordings").joinpath("schemas", f"{schema}.bin").read_bytes()


@cache
def _classes() -> dict[str, Any]:
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory  # 0.1 s, where messages are needed

    pool = descriptor_pool.DescriptorPool()
    added = {f.name: f for s in SCHEMAS for f in descriptor_pb2.FileDescriptorSet.FromString(descriptor(s)).file}
    for file in added.values():  # each after those that it needs
        pool.Add(file)
    names = (*SCHEMAS, "foxglove.SceneEntity")
    return {name: message_factory.GetMessageClass(pool.FindMessageTypeByName(name)) for name in names}


def message_of(schema: str, encoded: bytes) -> Message:
    """Returns an `encoded` message of a `schema` of SCHEMAS; ValueError if damaged or too large."""
    from google.protobuf.message import DecodeError

    if len(encoded) > _LARGEST:
        raise ValueError(f"a message of {len(encoded)} bytes; allowed: up to {_LARGEST}")
    try:
        return _classes()[schema].FromString(encoded)
    except DecodeError as error:
        raise ValueError(f"a damaged message ({error})") from None


def slot(index: int) -> float:
    """A number that a template fills with the value of an `index`, 0 to 65535."""
    return float(struct.unpack("<d", struct.pack("<H", index) + _SLOT)[0])


class Template:
    """Message merged of `parts` of one schema, whose slots and times are filled in.

    Example:
        >>> template = Template(frame_transform("sole", (slot(0), slot(1), 0.5), (0.0, 0.0, 0.0, 1.0)))
        >>> frame = message_of("foxglove.FrameTransforms", template.filled(0.0, [7.0, 8.0])).transforms[0]
        >>> frame.translation.x, frame.translation.y, frame.translation.z
        (7.0, 8.0, 0.5)
    """

    def __init__(self, *parts: Message) -> None:
        data = b"".join(part.SerializeToString(deterministic=True) for part in parts)  # which merges them
        self._data = np.frombuffer(data, dtype=np.uint8)
        places = [(m.start(), *struct.unpack("<H", m[1])) for m in re.finditer(b"(..)" + _SLOT, data, re.DOTALL)]
        found = np.array(places, dtype=np.int64).reshape(-1, 2)
        self._where = found[:, :1] + np.arange(8)
        self._slots = found[:, 1]
        time = b"".join(bytes(_long_varints(np.array([v], np.uint64))[0]) + b"\x10" for v in _TIME.values())[:-1]
        times = np.array([m.start() for m in re.finditer(re.escape(time), data)], dtype=np.int64).reshape(-1, 1)
        self._seconds = times + np.arange(_LONG)
        self._nanoseconds = self._seconds + _LONG + 1
        self._filled_in = np.zeros(len(data), dtype=bool)
        for at in (self._where, self._seconds, self._nanoseconds):
            self._filled_in[at] = True

    def filled(self, time_s: float, values: ArrayLike = ()) -> bytes:
        """Returns encoded message at `time_s` in s, 0 or more, with the `values` of its slots."""
        return self.filled_all([round(time_s * 1e9)], np.asarray(values, dtype=float).reshape(1, -1)).tobytes()

    def filled_all(self, times: ArrayLike, values: NDArray[np.float64]) -> NDArray[np.uint8]:
        """Returns encodings (m, l) of messages at `times` (m,) in ns, with the slots' `values` (m, k)."""
        seconds, nanoseconds = np.divmod(np.asarray(times, dtype=np.uint64), np.uint64(10**9))
        out = np.tile(self._data, (len(seconds), 1))
        if len(self._slots):
            doubles = np.ascontiguousarray(values[:, self._slots], dtype="<f8")
            out[:, self._where] = doubles.view(np.uint8).reshape(len(out), -1, 8)
        out[:, self._seconds] = _long_varints(seconds)[:, None]
        out[:, self._nanoseconds] = _long_varints(nanoseconds)[:, None]
        return out

    def matches(self, message: bytes) -> bool:
        """Whether a message differs only in what is filled in."""
        if len(message) != len(self._data):
            return False
        return bool(((np.frombuffer(message, dtype=np.uint8) == self._data) | self._filled_in).all())

    def values_of(self, messages: Sequence[bytes]) -> NDArray[np.float64]:
        """Slot values (n, k) of `messages` made by `filled`; ValueError for another template's."""
        if not all(map(self.matches, messages)):
            raise ValueError("a message is of another template")
        data = np.frombuffer(b"".join(messages), dtype=np.uint8).reshape(len(messages), -1)
        out = np.empty((len(messages), int(self._slots.max(initial=-1)) + 1))
        out[:, self._slots] = np.ascontiguousarray(data[:, self._where]).view("<f8")[..., 0]
        return out


def _long_varints(values: NDArray[np.uint64]) -> NDArray[np.uint8]:
    """Each value (m,) as a varint (m, 5) of full length: leading zeros keep the message's length."""
    septets = (values[:, None] >> _SHIFTS) & np.uint64(0x7F)
    septets[:, :-1] |= np.uint64(0x80)
    return septets.astype(np.uint8)


def frame_transform(frame: str, translation: Numbers, rotation: Numbers, parent: str = "world") -> Message:
    """Returns foxglove.FrameTransforms: `translation` and `rotation` of `frame` in its `parent`."""
    own = {"parent_frame_id": parent, "child_frame_id": frame, "translation": _xyz(translation)}
    return _classes()[SCHEMAS[0]](transforms=[{**own, "timestamp": _TIME, "rotation": _xyz(rotation)}])


def entity(name: str, frame: str, *primitives: Message, locked: bool = True) -> Message:
    """Returns foxglove.SceneUpdate of an entity: `primitives` in `frame` coordinates under a `name`.

    Replaces the topic's entity of that name. A `locked` one moves with its frame.
    """
    update = _classes()[SCHEMAS[1]](entities=[{"timestamp": _TIME, "frame_id": frame, "id": name}])
    update.entities[0].frame_locked = locked
    for primitive in primitives:
        update.entities[0].MergeFrom(primitive)
    return update


def delete_all() -> Message:
    """foxglove.SceneUpdate that removes the topic's earlier entities."""
    return _classes()[SCHEMAS[1]](deletions=[{"timestamp": _TIME, "type": _ALL}])


def _xyz(values: Iterable[float], names: str = "xyzw") -> dict[str, float]:
    return dict(zip(names, values, strict=False))


def _primitive(kind: str, colour: Numbers, **fields: Any) -> Message:
    return _classes()["foxglove.SceneEntity"](**{kind: [{**fields, "color": _xyz(colour, "rgba")}]})


def pose(position: Numbers, rotation: Numbers = _UPRIGHT) -> dict[str, Any]:
    """Returns primitive's pose: `position` and `rotation`."""
    return {"position": _xyz(position), "orientation": _xyz(rotation)}


def cube(place: dict[str, Any], size: Numbers, colour: Numbers) -> Message:
    """Returns box with edges `size` (x, y, z) and `colour`, centred at `place`."""
    return _primitive("cubes", colour, pose=place, size=_xyz(size))


def sphere(place: dict[str, Any], size: Numbers, colour: Numbers) -> Message:
    """Returns sphere or ellipsoid with diameters `size` (x, y, z) and `colour` at `place`."""
    return _primitive("spheres", colour, pose=place, size=_xyz(size))


def cylinder(place: dict[str, Any], size: Numbers, colour: Numbers) -> Message:
    """Returns cylinder along z with diameters and height `size` (x, y, z) and `colour` at `place`."""
    return _primitive("cylinders", colour, pose=place, size=_xyz(size), bottom_scale=1.0, top_scale=1.0)


def arrow(place: dict[str, Any], length: float, thickness: float, colour: Numbers) -> Message:
    """Returns arrow along x from `place`: shaft `length` and `thickness`, and `colour`; its head is twice as wide."""
    sizes = {"shaft_length": length, "shaft_diameter": thickness}
    head = {"head_length": 2.0 * thickness, "head_diameter": 2.0 * thickness}
    return _primitive("arrows", colour, pose=place, **sizes, **head)


def line_loop(points: Iterable[Numbers], thickness: float, colour: Numbers) -> Message:
    """Returns closed line through `points` (x, y, z) of a `thickness` and `colour`."""
    corners = [_xyz(point) for point in points]
    return _primitive("lines", colour, type=_LINE_LOOP, pose=pose(_ORIGIN), thickness=thickness, points=corners)


def triangles(points: Iterable[Numbers], indices: ArrayLike, colour: Numbers) -> Message:
    """Returns triangles of one `colour`: three `indices` each into `points`, counter-clockwise from outside."""
    corners = [_xyz(point) for point in points]
    faces = np.ravel(indices).tolist()
    return _primitive("triangles", colour, pose=pose(_ORIGIN), points=corners, indices=faces)


def words(place: dict[str, Any], value: str, size: float, colour: Numbers) -> Message:
    """Returns text `value` at `place` facing the viewer, with letters of height `size` and `colour`."""
    return _primitive("texts", colour, pose=place, billboard=True, font_size=size, text=value)


def log_message(time_s: float, message: str, level: str = "info", name: str = "plantar") -> bytes:
    """Returns encoded foxglove.Log: `message` at `time_s` with a `level` of LEVELS, from source `name`."""
    return Template(_classes()[SCHEMAS[2]](timestamp=_TIME, level=LEVELS[level], message=message, name=name)).filled(
        time_s
    )
