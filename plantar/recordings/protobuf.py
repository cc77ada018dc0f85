"""Protocol buffer messages, as far as recordings need them: written from a template, and read field by field.

What a recording draws again and again are messages of one length whose numbers alone change. They are encoded once,
with places for the numbers and the time, which are then filled in.

The encoding is that of https://protobuf.dev/programming-guides/encoding/. A time's two integers are written with all
the bytes that they may take, leading zeros included, which every decoder reads: so a message keeps its length.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import NamedTuple, NewType

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Part",
    "Slot",
    "Template",
    "double",
    "fixed32s",
    "integer",
    "joined",
    "nested",
    "numbers",
    "raw",
    "read_fields",
    "text",
    "timestamp",
]

Slot = NewType("Slot", int)
"""Index of the value that a double is filled with later."""

_VARINT, _EIGHT_BYTES, _BYTES, _FOUR_BYTES = 0, 1, 2, 5
_LONG = 5  # bytes of a varint that always has the same length: 35 bits
_SHIFTS = 7 * np.arange(_LONG, dtype=np.uint64)


class Part(NamedTuple):
    """Encoded fields, with the places that are filled later.

    Attributes:
        data: The bytes; zeros at the places.
        slots: Offset of each double that is filled, and the index of its value.
        times: Offset of the seconds of each time that is filled.
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
    """Fields one after the other.

    Args:
        parts: The fields.

    Returns:
        All of them.
    """
    data, slots, times = bytearray(), [], []
    for part in parts:
        start = len(data)
        slots += [(start + offset, slot) for offset, slot in part.slots]
        times += [start + offset for offset in part.times]
        data += part.data
    return Part(bytes(data), tuple(slots), tuple(times))


def nested(field: int, *parts: Part) -> Part:
    """A message as a field of another one.

    Args:
        field: Number of the field.
        parts: The message's own fields.

    Returns:
        The field.
    """
    inner = joined(*parts)
    return joined(Part(_head(field, _BYTES) + _varint(len(inner.data))), inner)


def double(field: int, value: float | Slot) -> Part:
    """A number of type double.

    Args:
        field: Number of the field.
        value: The number, or the slot from which it is filled: an `int` is always a slot.

    Returns:
        The field.
    """
    head = _head(field, _EIGHT_BYTES)
    if isinstance(value, int):
        return Part(head + bytes(8), ((len(head), value),))
    return Part(head + struct.pack("<d", value))


def numbers(field: int, values: Sequence[float | Slot]) -> Part:
    """A message of doubles whose fields are numbered from 1, such as a vector or a colour.

    Args:
        field: Number of the field.
        values: The doubles, or slots.

    Returns:
        The field.
    """
    return nested(field, *(double(i, value) for i, value in enumerate(values, 1)))


def integer(field: int, value: int) -> Part:
    """A whole number, a truth value or a member of an enumeration.

    Args:
        field: Number of the field.
        value: The number, 0 or more.

    Returns:
        The field.
    """
    return Part(_head(field, _VARINT) + _varint(int(value)))


def fixed32s(field: int, values: ArrayLike) -> Part:
    """Whole numbers of four bytes each, packed into one field.

    Args:
        field: Number of the field.
        values: The numbers, 0 to 2^32 - 1.

    Returns:
        The field.
    """
    return raw(field, np.asarray(values, dtype="<u4").tobytes())


def raw(field: int, data: bytes) -> Part:
    """Bytes as they are.

    Args:
        field: Number of the field.
        data: The bytes.

    Returns:
        The field.
    """
    return Part(_head(field, _BYTES) + _varint(len(data)) + data)


def text(field: int, value: str) -> Part:
    """A text.

    Args:
        field: Number of the field.
        value: The text.

    Returns:
        The field.
    """
    return raw(field, value.encode())


def timestamp(field: int) -> Part:
    """A time (google.protobuf.Timestamp), filled when the message is written.

    Args:
        field: Number of the field.

    Returns:
        The field.
    """
    inside = _head(1, _VARINT) + bytes(_LONG) + _head(2, _VARINT) + bytes(_LONG)
    return joined(Part(_head(field, _BYTES) + _varint(len(inside))), Part(inside, (), (1,)))


class Template:
    """A message whose numbers and times are filled in.

    Args:
        parts: Its fields.

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
        """The message at a time.

        Args:
            time_s: Time in s, 0 or more.
            values: The values that its slots name.

        Returns:
            Its encoding.
        """
        return self.filled_all([round(time_s * 1e9)], np.asarray(values, dtype=float).reshape(1, -1)).tobytes()

    def filled_all(self, times: ArrayLike, values: NDArray[np.float64]) -> NDArray[np.uint8]:
        """The messages at several times, which costs little more than one.

        Args:
            times: Times (m,) in ns, 0 or more.
            values: The values (m, k) that its slots name.

        Returns:
            Their encodings (m, l), all of the same length.
        """
        seconds, nanoseconds = np.divmod(np.asarray(times, dtype=np.uint64), np.uint64(10**9))
        out = np.tile(self._data, (len(seconds), 1))
        if len(self._slots):
            doubles = np.ascontiguousarray(values[:, self._slots], dtype="<f8")
            out[:, self._where] = doubles.view(np.uint8).reshape(len(out), -1, 8)
        out[:, self._seconds] = _long_varints(seconds)[:, None]
        out[:, self._nanoseconds] = _long_varints(nanoseconds)[:, None]
        return out

    def matches(self, message: bytes) -> bool:
        """Whether a message differs from this template only in the values and times that are filled in.

        Args:
            message: The message.

        Returns:
            Whether it does.
        """
        if len(message) != len(self._data):
            return False
        same = np.frombuffer(message, dtype=np.uint8) == self._data
        return bool((same | self._filled_in).all())

    def values_of(self, messages: Sequence[bytes]) -> NDArray[np.float64]:
        """The values with which messages were filled.

        Args:
            messages: n messages that `filled` made.

        Returns:
            The values (n, k) of the slots 0 to k - 1.

        Raises:
            ValueError: If a message is not of this template.
        """
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
    """The fields of a message in their order.

    Args:
        message: Its encoding.

    Yields:
        Number and value of each field: an `int` of a varint or four bytes, a `float` of eight, `bytes` of a text,
        of packed numbers or of a message.

    Raises:
        ValueError: If it is cut short or of no known wire type.
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
    """A varint, and where it ends."""
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
