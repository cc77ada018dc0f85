"""A recording as tables: what `Recorder` wrote, read back, and exported to NPZ or CSV."""

from __future__ import annotations

import json
import os
import re
import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.atomic import output_folder, replacing
from plantar.errors import FormatError, LayoutError
from plantar.layout import SoleLayout
from plantar.layout_file import layout_from_dict, layout_to_dict

__all__ = ["MCAP_MAGIC", "Recording", "Table", "read_mcap"]

MCAP_MAGIC = bytes([137, 77, 67, 65, 80, 48, 13, 10])
"""The bytes with which an MCAP file starts, and ends where it was closed."""

_LARGEST_CHUNK = 2**30
_FIELD = re.compile(r"float64(?:\[(\d+)\])?\s+([A-Za-z]\w*)")
_OPCODES = {"schema": 0x03, "channel": 0x04, "message": 0x05, "chunk": 0x06, "attachment": 0x09, "metadata": 0x0C}
_DATA_END, _FOOTER = 0x0F, 0x02


@dataclass(frozen=True, eq=False)
class Table:
    """The messages of one topic.

    Attributes:
        time: Times (n,) in s.
        fields: Values (n, k) of each field, in the order of the message type.
    """

    time: NDArray[np.float64]
    fields: Mapping[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.time)


@dataclass(frozen=True, eq=False)
class Recording:
    """What a recording file holds.

    Attributes:
        path: The file it was read from.
        metadata: What was stored beside the data.
        layouts: Sole layout of each side that has one.
        topics: Table of each topic.
        warnings: What was missing, damaged or skipped, one line each.
    """

    path: Path
    metadata: Mapping[str, Any] = field(default_factory=dict)
    layouts: Mapping[str, SoleLayout] = field(default_factory=dict)
    topics: Mapping[str, Table] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def to_npz(self, path: str | os.PathLike[str]) -> Path:
        """Write all tables to one compressed NPZ; it appears whole or not at all.

        Keys are "<topic>/time" and "<topic>/<field>" without the leading slash; "metadata" and "layout_<side>" hold
        JSON text.

        Args:
            path: File to write; ".npz" is added where it has no suffix.

        Returns:
            The path written.
        """
        final = Path(path)
        final = final if final.suffix else final.with_suffix(".npz")
        arrays: dict[str, Any] = {"metadata": json.dumps(dict(self.metadata))}
        for side, layout in self.layouts.items():
            arrays[f"layout_{side}"] = json.dumps(layout_to_dict(layout))
        for topic, table in self.topics.items():
            arrays[f"{topic.lstrip('/')}/time"] = table.time
            for name, values in table.fields.items():
                arrays[f"{topic.lstrip('/')}/{name}"] = values
        with replacing(final) as temporary, temporary.open("wb") as stream:
            np.savez_compressed(stream, **arrays)
        return final

    def to_csv(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Write one CSV a topic, with metadata.json and the layout files beside them.

        Columns are "time_s", then "<field>" or "<field>_<index>"; values keep all their digits.

        Args:
            folder: Output folder, made if needed.

        Returns:
            The paths written.
        """
        texts = {"metadata.json": json.dumps(dict(self.metadata), indent=1) + "\n"}
        for side, layout in self.layouts.items():
            texts[f"layout_{side}.json"] = json.dumps(layout_to_dict(layout), indent=1) + "\n"
        names = [f"{topic.strip('/').replace('/', '_')}.csv" for topic in self.topics]
        with output_folder(folder) as out:
            for name, text in texts.items():
                (out / name).write_text(text, encoding="utf-8")
            for name, table in zip(names, self.topics.values(), strict=True):
                header = ["time_s"]
                for key, values in table.fields.items():
                    wide = values.shape[1] > 1
                    header += [f"{key}_{i}" if wide else key for i in range(values.shape[1])]
                rows = np.column_stack([table.time, *table.fields.values()])
                np.savetxt(out / name, rows, fmt="%.17g", delimiter=",", header=",".join(header), comments="")
        return [Path(folder) / name for name in [*texts, *names]]


def read_mcap(path: str | os.PathLike[str]) -> Recording:
    """Read an MCAP recording whose topics are made of float64 fields.

    A file that was cut short, by a killed run or a full disk, is read up to its last whole chunk; a damaged chunk is
    left out. Both stand in `warnings`, as do topics of other message types, which are skipped.

    Args:
        path: The file.

    Returns:
        The recording.

    Raises:
        FormatError: If the file cannot be read, is not MCAP, or holds nothing that can be read.

    Example:
        >>> read_mcap("/dev/null")
        Traceback (most recent call last):
        plantar.errors.FormatError: /dev/null: the file is empty
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise FormatError(f"{path}: cannot be read ({error.strerror})") from None
    if not data:
        raise FormatError(f"{path}: the file is empty")
    if not data.startswith(MCAP_MAGIC):
        raise FormatError(f"{path}: not an MCAP recording (its first bytes are {data[:8]!r})")
    content = _Content()
    content.take_file(data)
    topics = content.tables()
    if not topics and not content.metadata and not content.layouts:
        why = f": {content.warnings[0]}" if content.warnings else ""
        raise FormatError(f"{path}: the MCAP file holds nothing that can be read{why}")
    return Recording(
        path=Path(path),
        metadata=content.metadata,
        layouts=content.layouts,
        topics=topics,
        warnings=tuple(content.warnings),
    )


def _walk(data: bytes, start: int) -> Iterator[tuple[int, int, int]]:
    """Opcode, begin and end of each record; a record that passes the end of the data is given with end -1."""
    position = start
    while position + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, position)
        begin, end = position + 9, position + 9 + length
        if end > len(data):
            yield opcode, begin, -1
            return
        yield opcode, begin, end
        position = end
    if position < len(data):
        yield 0, position, -1


class _Content:
    """Gathers the records of an MCAP file."""

    def __init__(self) -> None:
        self.metadata: dict[str, Any] = {}
        self.layouts: dict[str, SoleLayout] = {}
        self.warnings: list[str] = []
        self._schemas: dict[int, Any] = {}
        self._channels: dict[int, Any] = {}
        self._times: dict[int, list[int]] = {}
        self._payloads: dict[int, list[bytes]] = {}
        self._damaged = 0

    def take_file(self, data: bytes) -> None:
        closed = False
        for opcode, begin, end in _walk(data, len(MCAP_MAGIC)):
            if opcode == _DATA_END and end >= 0:
                closed = True
                break
            if end < 0:
                break
            try:
                self._take(opcode, data[begin:end])
            except Exception:  # the library raises what its parsing happens to hit: struct, Unicode, CRC, codec errors
                self._damaged += 1
        if not closed:
            self.warnings.append(
                "the file was cut short (a killed run or an incomplete copy): read up to its last whole chunk"
            )
        if self._damaged:
            self.warnings.append(f"{self._damaged} damaged part(s) of the file were left out")

    def _take(self, opcode: int, body: bytes) -> None:
        from mcap import records, stream_reader
        from mcap.data_stream import ReadDataStream

        def parsed(kind: Any) -> Any:
            return kind.read(ReadDataStream(BytesIO(body)))

        if opcode == _OPCODES["chunk"]:
            chunk = parsed(records.Chunk)
            if chunk.uncompressed_size > _LARGEST_CHUNK:
                raise ValueError("chunk too large")
            stream, size = stream_reader.get_chunk_data_stream(chunk, validate_crc=True)
            inside = stream.read(size)
            for code, begin, end in _walk(inside, 0):
                if end < 0:
                    raise ValueError("chunk cut short")
                if code != _OPCODES["chunk"]:
                    self._take(code, inside[begin:end])
        elif opcode == _OPCODES["message"]:
            number, _, time = struct.unpack_from("<HIQ", body)
            self._times.setdefault(number, []).append(time)
            self._payloads.setdefault(number, []).append(body[22:])
        elif opcode == _OPCODES["schema"]:
            schema = parsed(records.Schema)
            self._schemas[schema.id] = schema
        elif opcode == _OPCODES["channel"]:
            channel = parsed(records.Channel)
            self._channels[channel.id] = channel
        elif opcode == _OPCODES["metadata"]:
            for key, text in parsed(records.Metadata).metadata.items():
                try:
                    self.metadata[key] = json.loads(text)
                except ValueError:
                    self.metadata[key] = text
        elif opcode == _OPCODES["attachment"]:
            if struct.unpack_from("<I", body, len(body) - 4)[0] not in (0, zlib.crc32(body[:-4])):
                raise ValueError("attachment damaged")
            attachment = parsed(records.Attachment)
            match = re.fullmatch(r"layout_(left|right)\.json", attachment.name)
            if match:
                try:
                    layout = layout_from_dict(json.loads(attachment.data), where=attachment.name)
                except (LayoutError, ValueError, TypeError) as error:
                    self.warnings.append(f"the layout of the {match[1]} sole cannot be read: {error}")
                else:
                    self.layouts[match[1]] = layout

    def tables(self) -> dict[str, Table]:
        out: dict[str, Table] = {}
        for number, channel in self._channels.items():
            schema = self._schemas.get(channel.schema_id)
            fields = _float_fields(channel, schema)
            if fields is None:
                kind = schema.name if schema is not None else "without a schema"
                self.warnings.append(f"topic {channel.topic} is skipped: its type {kind} is not made of float64 fields")
                continue
            width = sum(k for _, k in fields)
            times = self._times.get(number, [])
            payloads = self._payloads.get(number, [])
            whole = [i for i, p in enumerate(payloads) if len(p) == 4 + 8 * width and p[0] == 0 and p[1] in (0, 1)]
            if len(whole) < len(payloads):
                lost = len(payloads) - len(whole)
                self.warnings.append(f"topic {channel.topic}: {lost} message(s) of another size were left out")
            values = np.empty((len(whole), width))
            for row, i in enumerate(whole):
                values[row] = np.frombuffer(payloads[i], dtype="<f8" if payloads[i][1] else ">f8", offset=4)
            time = np.array([times[i] for i in whole], dtype=float) * 1e-9
            order = np.argsort(time, kind="stable")
            bounds = np.cumsum([k for _, k in fields])[:-1]
            columns = np.split(values[order], bounds, axis=1)
            out[channel.topic] = Table(
                time=time[order], fields={name: c for (name, _), c in zip(fields, columns, strict=True)}
            )
        return out


def _float_fields(channel: Any, schema: Any) -> list[tuple[str, int]] | None:
    """Names and widths of the fields of a message type, None where it is not made of float64 alone."""
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
