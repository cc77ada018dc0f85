"""Messages of Foxglove's schemas, drawn without settings, as protocol buffers.

The descriptors in `schemas/` come from foxglove-schemas-protobuf (`tools/foxglove_schemas.py`, MIT licence). Positions
and sizes in m, rotations quaternions (x, y, z, w), colours red, green, blue and opacity, 0 to 1; a `place` is made by
`pose`. Messages of one length are encoded once (https://protobuf.dev/programming-guides/encoding/), with places for
numbers and time, whose two integers have leading zeros to keep the length. `field` is a field number.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from importlib.resources import files
from typing import NamedTuple, NewType

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "LEVELS",
    "SCHEMAS",
    "Part",
    "Slot",
    "Template",
    "arrow",
    "cube",
    "cylinder",
    "delete_all",
    "descriptor",
    "double",
    "entity",
    "fixed32s",
    "frame_transform",
    "integer",
    "joined",
    "line_loop",
    "log_message",
    "nested",
    "numbers",
    "pose",
    "raw",
    "read_fields",
    "sphere",
    "text",
    "timestamp",
    "triangles",
    "words",
]

Slot = NewType("Slot", int)
"""Index of the value that a double is filled with later."""

_VARINT, _EIGHT_BYTES, _BYTES, _FOUR_BYTES = 0, 1, 2, 5
_LONG = 5  # bytes of a varint that always has the same length: 35 bits
_SHIFTS = 7 * np.arange(_LONG, dtype=np.uint64)


class Part(NamedTuple):
    """Encoded fields `data` with places to fill: offset and value index of each double (`slots`), and offset of each
    time's seconds (`times`).
    """

    data: bytes
    slots: tuple[tuple[int, Slot], ...] = ()
    times: tuple[int, ...] = ()


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _head(field: int, kind: int) -> bytes:
    return _varint(field << 3 | kind)


def joined(*parts: Part) -> Part:
    """Fields in sequence."""
    data, slots, times = bytearray(), [], []
    for part in parts:
        start = len(data)
        slots += [(start + offset, slot) for offset, slot in part.slots]
        times += [start + offset for offset in part.times]
        data += part.data
    return Part(bytes(data), tuple(slots), tuple(times))


def nested(field: int, *parts: Part) -> Part:
    """Returns message of fields `parts` as a `field` of another."""
    inner = joined(*parts)
    return joined(Part(_head(field, _BYTES) + _varint(len(inner.data))), inner)


def double(field: int, value: float | Slot) -> Part:
    """Returns double `field`: its `value`, or the slot that fills it (an `int` is always a slot)."""
    head = _head(field, _EIGHT_BYTES)
    if isinstance(value, int):
        return Part(head + bytes(8), ((len(head), value),))
    return Part(head + struct.pack("<d", value))


def numbers(field: int, values: Sequence[float | Slot]) -> Part:
    """Returns message `field` of doubles or slots `values` numbered from 1, as in a vector or colour."""
    return nested(field, *(double(i, value) for i, value in enumerate(values, 1)))


def integer(field: int, value: int) -> Part:
    """Returns `field` of a whole number, truth value or enumeration member `value`, at least 0."""
    return Part(_head(field, _VARINT) + _varint(int(value)))


def fixed32s(field: int, values: ArrayLike) -> Part:
    """Returns whole numbers `values`, 0 to 2^32 - 1, packed into one `field`, four bytes each."""
    return raw(field, np.asarray(values, dtype="<u4").tobytes())


def raw(field: int, data: bytes) -> Part:
    """Returns `field` of bytes `data`."""
    return Part(_head(field, _BYTES) + _varint(len(data)) + data)


def text(field: int, value: str) -> Part:
    """Returns `field` of the text `value`."""
    return raw(field, value.encode())


def timestamp(field: int) -> Part:
    """Time (google.protobuf.Timestamp), filled when written."""
    inside = _head(1, _VARINT) + bytes(_LONG) + _head(2, _VARINT) + bytes(_LONG)
    return joined(Part(_head(field, _BYTES) + _varint(len(inside))), Part(inside, (), (1,)))


class Template:
    """Message of fields `parts`, whose numbers and times are filled in.

    Example:
        >>> vector = Template(double(1, Slot(0)), double(2, Slot(1)), double(3, 0.5))
        >>> [value for _, value in read_fields(vector.filled(0.0, [7.0, 8.0]))]
        [7.0, 8.0, 0.5]
    """

    def __init__(self, *parts: Part) -> None:
        whole = joined(*parts)
        self._data = np.frombuffer(whole.data, dtype=np.uint8)
        places = np.array(whole.slots, dtype=np.int64).reshape(-1, 2)
        self._where = places[:, :1] + np.arange(8)
        self._slots = places[:, 1]
        times = np.array(whole.times, dtype=np.int64).reshape(-1, 1)
        self._seconds = times + np.arange(_LONG)
        self._nanoseconds = self._seconds + _LONG + 1
        self._filled_in = np.zeros(len(self._data), dtype=bool)
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
        same = np.frombuffer(message, dtype=np.uint8) == self._data
        return bool((same | self._filled_in).all())

    def values_of(self, messages: Sequence[bytes]) -> NDArray[np.float64]:
        """Slot values (n, k) of `messages` made by `filled`; ValueError for another template's."""
        if not all(map(self.matches, messages)):
            raise ValueError("a message is of another template")
        data = np.frombuffer(b"".join(messages), dtype=np.uint8).reshape(len(messages), -1)
        out = np.empty((len(messages), int(self._slots.max(initial=-1)) + 1))
        out[:, self._slots] = np.ascontiguousarray(data[:, self._where]).view("<f8")[..., 0]
        return out


def _long_varints(values: NDArray[np.uint64]) -> NDArray[np.uint8]:
    """Each value (m,) as a varint (m, 5) of full length."""
    septets = (values[:, None] >> _SHIFTS) & np.uint64(0x7F)
    septets[:, :-1] |= np.uint64(0x80)
    return septets.astype(np.uint8)


def read_fields(message: bytes) -> Iterator[tuple[int, int | float | bytes]]:
    """Yields each field's number and value: `int` of a varint or four bytes, `float` of eight, `bytes` of the rest.

    ValueError if cut short or of an unknown wire type.
    """
    position = 0
    while position < len(message):
        head, position = _read_varint(message, position)
        field, kind = head >> 3, head & 7
        value: int | float | bytes
        if kind == _VARINT:
            value, position = _read_varint(message, position)
        elif kind in (_EIGHT_BYTES, _FOUR_BYTES):
            form, length = ("<d", 8) if kind == _EIGHT_BYTES else ("<I", 4)
            if position + length > len(message):
                raise ValueError(f"field {field} is cut short")
            (value,), position = struct.unpack_from(form, message, position), position + length
        elif kind == _BYTES:
            length, position = _read_varint(message, position)
            value, position = message[position : position + length], position + length
        else:
            raise ValueError(f"wire type {kind} of field {field} is not known; allowed: 0, 1, 2, 5")
        if position > len(message):
            raise ValueError(f"field {field} is cut short")
        yield field, value


def _read_varint(message: bytes, position: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 70, 7):
        if position >= len(message):
            raise ValueError("a number is cut short")
        byte = message[position]
        position += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, position
    raise ValueError("a number has more than ten bytes")


SCHEMAS = ("foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.Log")
"""The schemas whose messages are written."""

LEVELS = {"info": 2, "warning": 3, "error": 4}
"""Levels of a log message."""

Numbers = Sequence[float | Slot]
_ORIGIN = (0.0, 0.0, 0.0)
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
_LINE_LOOP = 1


def descriptor(schema: str) -> bytes:
    """Encoded FileDescriptorSet of `schema`, one of SCHEMAS, with all needed files."""
    return files("plantar.recordings").joinpath("schemas", f"{schema}.bin").read_bytes()


def frame_transform(frame: str, translation: Numbers, rotation: Numbers, parent: str = "world") -> Part:
    """Returns foxglove.FrameTransforms `transforms`: `translation` and `rotation` of `frame` in its `parent`."""
    return nested(1, timestamp(1), text(2, parent), text(3, frame), numbers(4, translation), numbers(5, rotation))


def entity(name: str, frame: str, *primitives: Part, locked: bool = True) -> Part:
    """Returns `entities` field of foxglove.SceneUpdate: `primitives` in `frame` coordinates under a `name`.

    Replaces the topic's entity of that name. A `locked` one moves with its frame.
    """
    return nested(2, timestamp(1), text(2, frame), text(3, name), integer(5, locked), *primitives)


def delete_all() -> Part:
    """`deletions` field of foxglove.SceneUpdate that removes the topic's earlier entities."""
    return nested(1, timestamp(1), integer(2, 1))


def pose(position: Numbers, rotation: Numbers = _UPRIGHT) -> Part:
    """Returns primitive's pose: `position` and `rotation`."""
    return nested(1, numbers(1, position), numbers(2, rotation))


def cube(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns box with edges `size` (x, y, z) and `colour`, centred at `place`."""
    return nested(8, place, numbers(2, size), numbers(3, colour))


def sphere(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns sphere or ellipsoid with diameters `size` (x, y, z) and `colour` at `place`."""
    return nested(9, place, numbers(2, size), numbers(3, colour))


def cylinder(place: Part, size: Numbers, colour: Numbers) -> Part:
    """Returns cylinder along z with diameters and height `size` (x, y, z) and `colour` at `place`."""
    return nested(10, place, numbers(2, size), double(3, 1.0), double(4, 1.0), numbers(5, colour))


def arrow(place: Part, length: float | Slot, thickness: float, colour: Numbers) -> Part:
    """Returns arrow along x from `place`: shaft `length` and `thickness`, and `colour`; its head is twice as wide."""
    sizes = (double(2, length), double(3, thickness), double(4, 2.0 * thickness), double(5, 2.0 * thickness))
    return nested(7, place, *sizes, numbers(6, colour))


def line_loop(points: Sequence[Numbers], thickness: float, colour: Numbers) -> Part:
    """Returns closed line through `points` (x, y, z) of a `thickness` and `colour`."""
    corners = [numbers(5, point) for point in points]
    place = nested(2, numbers(1, _ORIGIN), numbers(2, _UPRIGHT))
    return nested(11, integer(1, _LINE_LOOP), place, double(3, thickness), *corners, numbers(6, colour))


def triangles(points: Sequence[Numbers], indices: ArrayLike, colour: Numbers) -> Part:
    """Returns triangles of one `colour`: three `indices` each into `points`, counter-clockwise from outside."""
    corners = [numbers(2, point) for point in points]
    return nested(12, pose(_ORIGIN), *corners, numbers(3, colour), fixed32s(5, np.ravel(indices)))


def words(place: Part, value: str, size: float, colour: Numbers) -> Part:
    """Returns text `value` at `place` facing the viewer, with letters of height `size` and `colour`."""
    return nested(13, place, integer(2, True), double(3, size), numbers(5, colour), text(6, value))


def log_message(time_s: float, message: str, level: str = "info", name: str = "plantar") -> bytes:
    """Returns encoded foxglove.Log: `message` at `time_s` with a `level` of LEVELS, from source `name`."""
    return Template(timestamp(1), integer(2, LEVELS[level]), text(3, message), text(4, name)).filled(time_s)
