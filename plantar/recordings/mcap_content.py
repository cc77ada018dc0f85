"""MCAP records gathered into tables by chunk, unpacked up to the stated size."""

import json
import os
import re
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from io import BytesIO
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.structured_text import JSON_MOST
from plantar.common.files.zip_archive import ALLOWED, is_bomb
from plantar.errors import FormatError, LayoutError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import layout_from_dict
from plantar.recordings.foxglove import SCHEMAS
from plantar.recordings.frame_table import FrameTable

Sink = Callable[[float, bytes, list[tuple[str, int]] | None], None]
"""Receives a message's time in s, its encoding, and names and widths of its fields where all are float64."""

MCAP_MAGIC = bytes([137, 77, 67, 65, 80, 48, 13, 10])
"""The bytes with which an MCAP file starts, and ends where it was closed."""

_LARGEST_CHUNK = 128_000_000  # bytes, packed and unpacked
_BLOCK = 4096  # messages
_MOST_TOPICS = 4096
_FIELD = re.compile(r"float64(?:\[(\d{1,7})\])?\s+([A-Za-z]\w*)")
_OPCODES = {"schema": 0x03, "channel": 0x04, "message": 0x05, "chunk": 0x06, "attachment": 0x09, "metadata": 0x0C}
_DATA_END = 0x0F
# Largest record in bytes by its opcode; others are as large as a layout file at most.
_LARGEST = {0x05: _LARGEST_CHUNK, 0x06: _LARGEST_CHUNK}


class _Topic:
    def __init__(self, name: str, fields: list[tuple[str, int]]) -> None:
        self.name = name
        self.fields = fields
        self.lost = 0
        self._width = sum(width for _, width in fields)
        self._times = FrameTable(1, 0)
        self._values = FrameTable(self._width, 0)
        self._gathered: list[tuple[int, bytes]] = []

    def gather(self, time: int, payload: bytes) -> None:
        """Add a message; its values join the table at the next `flush`."""
        if len(payload) == 4 + 8 * self._width and payload[0] == 0 and payload[1] in (0, 1):
            self._gathered.append((time, payload))
            if len(self._gathered) == _BLOCK:
                self.flush()
        else:
            self.lost += 1

    def flush(self) -> None:
        gathered = self._gathered
        self._gathered = []
        if not gathered:
            return
        little = np.array([payload[1] == 1 for _, payload in gathered])
        data = b"".join(payload[4:] for _, payload in gathered)
        rows = np.frombuffer(data, dtype="<f8").reshape(len(gathered), self._width)
        swapped = np.frombuffer(data, dtype=">f8").reshape(len(gathered), self._width)
        self._times.add(np.array([[time] for time, _ in gathered], dtype=float))
        self._values.add(np.asarray(rows if little.all() else np.where(little[:, None], rows, swapped), dtype=float))

    def columns(self) -> tuple[NDArray[np.float64], dict[str, NDArray[np.float64]]]:
        """Times (n,) in s, in order, and each field's values (n, k)."""
        time = self._times.rows[:, 0] * 1e-9
        values = self._values.rows
        if (np.diff(time) < 0.0).any():
            order = np.argsort(time, kind="stable")
            time = time[order]
            values = values[order]
        bounds = np.cumsum([width for _, width in self.fields])[:-1]
        return time, {n: c for (n, _), c in zip(self.fields, np.split(values, bounds, axis=1), strict=True)}


class McapContent:
    """Content of an MCAP file.

    `layouts`: sole layout of each side, if any; `topics`: Float64 topics by channel number; empty with `sinks`,
    receivers of some topics; `warnings`: what was missing, damaged or skipped.
    """

    def __init__(self, sinks: Mapping[str, Sink] | None = None) -> None:
        self._sinks = sinks
        self._sunk: dict[int, tuple[Sink, list[tuple[str, int]] | None]] = {}
        self.metadata: dict[str, Any] = {}
        self.layouts: dict[str, SoleLayout] = {}
        self.topics: dict[int, _Topic] = {}
        self.warnings: list[str] = []
        self._schemas: dict[int, Any] = {}
        self._others: set[int] = set()
        self._damaged = 0
        self._undescribed = 0
        self._unpacked = 0
        self._size = 0

    def take_file(self, stream: BinaryIO) -> None:
        """Read all records of a file `stream` from its first; FormatError if it unpacks to too much."""
        self._size = os.fstat(stream.fileno()).st_size
        closed = False
        for opcode, body in self._records(stream):
            if opcode == _DATA_END:
                closed = True
                break
            try:
                self._take(opcode, body)
            except FormatError:
                raise
            except Exception:  # the library raises what its parsing happens to hit: struct, Unicode, CRC, codec errors
                self._damaged += 1
        self._flush()
        if not closed:
            self.warnings.append(
                "the file was cut short (a killed run or an incomplete copy): read up to its last whole chunk"
            )
        if self._damaged:
            self.warnings.append(f"{self._damaged} damaged part(s) of the file were left out")
        if self._undescribed:
            self.warnings.append(f"{self._undescribed} message(s) of topics that are not described were left out")
        self.warnings += [
            f"topic {t.name}: {t.lost} message(s) of another size were left out" for t in self.topics.values() if t.lost
        ]

    def _records(self, stream: BinaryIO) -> Iterator[tuple[int, bytes]]:
        """Opcode and body of each record to the first beyond the file's end."""
        while len(head := stream.read(9)) == 9:
            opcode, length = struct.unpack("<BQ", head)
            if stream.tell() + length > self._size:
                return
            if length > _LARGEST.get(opcode, 2 * JSON_MOST):
                self._damaged += opcode in _OPCODES.values()
                stream.seek(length, os.SEEK_CUR)
                continue
            yield opcode, stream.read(length)

    def _take(self, opcode: int, body: bytes) -> None:
        from mcap import records
        from mcap.data_stream import ReadDataStream

        def parsed(kind: Any) -> Any:
            return kind.read(ReadDataStream(BytesIO(body)))

        if opcode == _OPCODES["chunk"]:
            self._take_chunk(parsed(records.Chunk))
        elif opcode == _OPCODES["message"]:
            number, _, time = struct.unpack_from("<HIQ", body)
            if number in self.topics:
                self.topics[number].gather(time, body[22:])
            elif number in self._sunk:
                sink, fields = self._sunk[number]
                sink(time * 1e-9, body[22:], fields)
            else:
                self._undescribed += number not in self._others
        elif opcode == _OPCODES["schema"]:
            schema = parsed(records.Schema)
            if len(self._schemas) < _MOST_TOPICS:
                self._schemas[schema.id] = schema
        elif opcode == _OPCODES["channel"]:
            self._take_channel(parsed(records.Channel))
        elif opcode == _OPCODES["metadata"]:
            for key, text in parsed(records.Metadata).metadata.items():
                try:
                    self.metadata[key] = json.loads(text)
                except (ValueError, RecursionError):
                    self.metadata[key] = text
        elif opcode == _OPCODES["attachment"]:
            if struct.unpack_from("<I", body, len(body) - 4)[0] not in (0, zlib.crc32(body[:-4])):
                raise ValueError("attachment damaged")
            self._take_attachment(parsed(records.Attachment))

    def _take_channel(self, channel: Any) -> None:
        if channel.id in self.topics or channel.id in self._others or channel.id in self._sunk:
            return
        if len(self.topics) + len(self._others) + len(self._sunk) >= _MOST_TOPICS:
            raise ValueError("too many topics")
        schema = self._schemas.get(channel.schema_id)
        fields = _float_fields(channel, schema)
        if self._sinks is not None:
            if channel.topic in self._sinks:
                self._sunk[channel.id] = self._sinks[channel.topic], fields
            else:
                self._others.add(channel.id)
        elif fields is None:
            self._others.add(channel.id)
            kind = schema.name if schema is not None else "without a schema"
            if kind not in SCHEMAS:  # those are drawn by viewers; other topics hold their numbers
                self.warnings.append(f"topic {channel.topic} is skipped: its type {kind} is not made of float64 fields")
        else:
            self.topics[channel.id] = _Topic(channel.topic, fields)

    def _take_attachment(self, attachment: Any) -> None:
        match = re.fullmatch(r"layout_(left|right)\.json", attachment.name)
        if match is None:
            return
        try:
            layout = layout_from_dict(json.loads(attachment.data), where=attachment.name)
        except (LayoutError, ValueError, TypeError, RecursionError) as error:
            self.warnings.append(f"the layout of the {match[1]} sole cannot be read: {error}")
        else:
            self.layouts[match[1]] = layout

    def _take_chunk(self, chunk: Any) -> None:
        self._unpacked += int(chunk.uncompressed_size)
        if is_bomb(self._size, self._unpacked):
            raise FormatError(
                f"{self._size / 1e6:.3g} MB that unpack to more than {self._unpacked / 1e6:.0f} MB; allowed: {ALLOWED}"
            )
        inside = _unpacked(chunk)
        position = 0
        try:
            while position + 9 <= len(inside):
                opcode, length = struct.unpack_from("<BQ", inside, position)
                position += 9 + length
                if position > len(inside):
                    raise ValueError("chunk cut short")
                if opcode != _OPCODES["chunk"]:
                    self._take(opcode, inside[position - length : position])
            if position < len(inside):
                raise ValueError("chunk cut short")
        finally:
            self._flush()

    def _flush(self) -> None:
        for topic in self.topics.values():
            topic.flush()


def message_values(payload: bytes, fields: list[tuple[str, int]]) -> NDArray[np.float64]:
    """Returns numbers (k,) of a CDR `payload` by `fields`, names and widths; ValueError for another size."""
    if len(payload) != 4 + 8 * sum(width for _, width in fields) or payload[0] or payload[1] not in (0, 1):
        raise ValueError("a message is of another size than its fields")
    return np.frombuffer(payload, "<f8" if payload[1] else ">f8", offset=4).astype(float)


def _unpacked(chunk: Any) -> bytes:
    size = int(chunk.uncompressed_size)
    if size > _LARGEST_CHUNK:
        raise ValueError("chunk too large")
    if chunk.compression == "zstd":
        import zstandard

        with zstandard.ZstdDecompressor(max_window_size=1 << 27).stream_reader(chunk.data) as reader:
            data = reader.read(size + 1)
    elif chunk.compression == "lz4":
        lz4 = import_module("lz4.frame")
        data = lz4.LZ4FrameDecompressor().decompress(chunk.data, max_length=size + 1)
    elif chunk.compression == "":
        data = chunk.data
    else:
        raise ValueError(f"unknown compression {chunk.compression}")
    if len(data) != size or (chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc):
        raise ValueError("chunk damaged")
    return bytes(data)


def _float_fields(channel: Any, schema: Any) -> list[tuple[str, int]] | None:
    if schema is None or schema.encoding != "ros2msg" or channel.message_encoding != "cdr":
        return None
    out: list[tuple[str, int]] = []
    for line in schema.data.decode("utf-8", errors="replace").splitlines():
        text = line.split("#")[0].strip()
        if not text:
            continue
        match = _FIELD.fullmatch(text)
        if match is None:
            return None
        out.append((match[2], int(match[1] or 1)))
    return out or None
