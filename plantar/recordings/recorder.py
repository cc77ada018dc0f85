"""Write recordings: append-only, crash-safe MCAP for Foxglove and `read_mcap`.

Profile "ros2": each number topic has one message type of float64 fields, encoded as CDR (4-byte header, little-endian
values) by chunk. Viewer topics carry encoded Foxglove messages.
"""

import json
import math
import os
import re
import struct
import zlib
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import SpooledTemporaryFile
from types import TracebackType
from typing import IO, Any, Generic, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import temporary_beside
from plantar.errors import InputError, RecordingError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import layout_to_dict
from plantar.recordings.foxglove import SCHEMAS, Template, descriptor
from plantar.recordings.mcap_content import MCAP_MAGIC

_INDEX_ENTRY = np.dtype([("log_time", "<u8"), ("offset", "<u8")])
_MESSAGE = 0x05
_CHUNK = 0x06
_MESSAGE_INDEX = 0x07
_CHUNK_HEAD = struct.Struct("<BQQQQII4sQ")  # opcode, length, first and last time, size, CRC, compression, packed size
_INDEX_HEAD = struct.Struct("<BQHI")  # opcode, length, channel, bytes of entries
_COMPRESSION = b"zstd"
_CDR_LITTLE_ENDIAN = np.array([[0, 1, 0, 0]], dtype=np.uint8)
_FIELD_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*")
_MESSAGE_HEAD = np.dtype(
    [
        ("opcode", "u1"),
        ("length", "<u8"),
        ("channel", "<u2"),
        ("sequence", "<u4"),
        ("log_time", "<u8"),
        ("publish_time", "<u8"),
    ]
)
_MOST = 256  # messages of a topic that are gathered before they are written
_MOST_INDEXES = 1 << 16  # bytes of the chunks' indexes that are kept in memory: of 4 minutes
_Message = TypeVar("_Message")
_Encode = Callable[[list[int], list[_Message]], "Sequence[bytes] | NDArray[np.uint8]"]


class _Gathered(NamedTuple):
    """Topic's messages for a chunk: m records in sequence."""

    times: NDArray[np.uint64]
    offsets: NDArray[np.int64]
    data: bytes


class Channel(Generic[_Message]):
    """One recorded `topic`, such as "/skin/left", made by a `Recorder`."""

    def __init__(self, recorder: "Recorder", number: int, topic: str, encode: _Encode[_Message]) -> None:
        self.topic = topic
        self._recorder = recorder
        self._number = number
        self._encode = encode
        self._times: list[int] = []
        self._messages: list[_Message] = []
        self._written = 0

    def write(self, time_s: float, *message: Any) -> None:
        """Append a `message`, unchanged until the next flush, at `time_s` in s.

        A message is bytes, or a flat array of all fields' values, or a value for each field, which one number fills.
        RecordingError for times outside 0 to 1e9 s, or a wrong number of values.
        """
        if not 0.0 <= time_s < 1e9 or len(message) != 1:
            got = f"topic {self.topic} got {len(message)} message(s) at the time {time_s} s"
            raise RecordingError(f"{got}; allowed: 0 to 1e9 s, one message at a time")
        recorder = self._recorder
        if time_s >= recorder._flush_at or len(self._times) == _MOST:
            recorder.flush()
            recorder._flush_at = time_s + recorder.chunk_duration
        self._times.append(round(time_s * 1e9))
        self._messages.append(message[0])

    def _take_messages(self) -> _Gathered:
        times = self._times
        messages = self._messages
        self._times = []
        self._messages = []
        encoded = self._encode(times, messages)
        count = len(times)
        size = _MESSAGE_HEAD.itemsize
        lengths = np.array([len(message) for message in encoded]) + size
        heads = np.empty(count, dtype=_MESSAGE_HEAD)
        heads["opcode"] = _MESSAGE
        heads["length"] = lengths - 9
        heads["channel"] = self._number
        heads["sequence"] = (self._written + np.arange(count)) % 2**32
        heads["log_time"] = times
        heads["publish_time"] = times
        self._written += count
        if isinstance(encoded, np.ndarray):
            data = np.hstack([heads.view(np.uint8).reshape(count, size), encoded]).tobytes()
        else:
            data = b"".join(head.tobytes() + message for head, message in zip(heads, encoded, strict=True))
        return _Gathered(heads["log_time"], np.cumsum(lengths) - lengths, data)


class _NumbersChannel(Channel[NDArray[np.float64]]):
    def __init__(self, recorder: "Recorder", number: int, topic: str, widths: Sequence[int]) -> None:
        super().__init__(recorder, number, topic, _as_cdr)
        ends = np.cumsum(widths).tolist()
        self._spans = [slice(end - width, end) for end, width in zip(ends, widths, strict=True)]
        self._width = ends[-1]

    def write(self, time_s: float, *message: Any) -> None:
        row = np.array(message[0], dtype="<f8") if len(message) == 1 else np.empty(self._width)
        try:
            for span, value in zip(self._spans, message, strict=True) if len(message) != 1 else ():
                row[span] = value
        except ValueError as error:
            raise RecordingError(f"topic {self.topic} takes values of {len(self._spans)} fields: {error}") from None
        if row.shape != (self._width,):
            raise RecordingError(f"topic {self.topic} takes {self._width} values a message; got shape {row.shape}")
        super().write(time_s, row)


def _as_cdr(times: list[int], rows: list[NDArray[np.float64]]) -> NDArray[np.uint8]:
    return np.hstack([_CDR_LITTLE_ENDIAN.repeat(len(rows), axis=0), np.array(rows).view(np.uint8)])


def _json_texts(metadata: Mapping[str, object]) -> dict[str, str]:
    try:
        return {key: json.dumps(value) for key, value in metadata.items()}
    except (TypeError, ValueError) as error:
        raise RecordingError(f"recording metadata cannot be stored as JSON: {error}") from None


class Recorder:
    """Writes one recording; a context manager.

    A killed process loses at most one chunk; the file reads up to its last whole one. A clean exit appends the index.

    Args:
        path: Replaced if it exists.
        metadata: JSON values.
        layouts: Each side's sole layout.
        chunk_duration: In s, above 0.

    Raises:
        RecordingError: If unwritable, or not JSON.

    Example:
        >>> import tempfile
        >>> from plantar.recordings.recording import read_mcap
        >>> path = Path(tempfile.mkdtemp()) / "run.mcap"
        >>> with Recorder(path, {"robot": "h1"}) as recorder:
        ...     channel = recorder.channel("/estimate", [("com", 3), ("tilt", 1)])
        ...     channel.write(0.005, np.array([0.0, 0.0, 0.8, 0.01]))
        >>> read_mcap(path).topics["/estimate"].fields["com"].tolist()
        [[0.0, 0.0, 0.8]]
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        metadata: Mapping[str, object] | None = None,
        layouts: Mapping[str, SoleLayout] | None = None,
        chunk_duration: float = 0.5,
    ) -> None:
        from mcap import records  # here, so that reading other formats does not need it
        from mcap.data_stream import RecordBuilder
        from zstandard import ZstdCompressor  # which mcap brings

        if not (math.isfinite(chunk_duration) and chunk_duration > 0.0):
            raise RecordingError(f"chunk duration is {chunk_duration} s; allowed: above 0")
        texts = _json_texts(metadata or {})
        documents = {f"layout_{s}.json": json.dumps(layout_to_dict(own)).encode() for s, own in (layouts or {}).items()}
        self.path = Path(path)
        self.chunk_duration = chunk_duration
        self._records: Any = records
        self._builder_type: Any = RecordBuilder
        self._compress = ZstdCompressor(level=1).compress  # a third less, in 1 us a message
        self._channels: list[Channel[Any]] = []
        self._definitions: list[Any] = []  # schema and channel records that no chunk holds yet
        self._summary: list[Any] = []
        self._chunks = 0
        self._metadata_indexes: list[Any] = []
        self._layout_indexes: list[Any] = []
        self._time_range: tuple[int, int] | None = None
        self._flush_at = math.inf
        if self.path.is_dir():
            raise RecordingError(f"cannot write recording {self.path}: it is a folder; give the name of a file")
        try:  # under another name until a message is there: a run that never begins leaves an old recording alone
            self._temporary: Path | None = temporary_beside(self.path)
        except InputError as error:
            raise RecordingError(str(error).replace("cannot write", "cannot write recording", 1)) from None
        self._file: IO[bytes] = open(self._temporary, "wb")  # noqa: SIM115  closed by close()
        self._chunk_indexes = SpooledTemporaryFile(_MOST_INDEXES)  # noqa: SIM115  closed by close()
        self._put(MCAP_MAGIC)
        self._put(self._encoded(records.Header(profile="ros2", library="plantar")))
        self._put_metadata(texts)
        for name, data in documents.items():
            about: dict[str, Any] = {"log_time": 0, "create_time": 0, "name": name, "media_type": "application/json"}
            record = self._encoded(records.Attachment(data=data, **about))
            about |= {"length": len(record), "data_size": len(data)}
            self._layout_indexes.append(records.AttachmentIndex(offset=self._put(record), **about))
        self._file.flush()
        self._flush_at = 0.0

    def channel(self, topic: str, fields: Sequence[tuple[str, int]]) -> Channel[NDArray[np.float64]]:
        """Returns channel of a new number `topic`; RecordingError if it exists or lacks "/", or a field is invalid.

        Names of `fields` are lower case, as in ROS 2, 1 value or more each; messages are copied.
        """
        names = [name for name, _ in fields]
        if not names or len(set(names)) != len(names):
            raise RecordingError(f"topic {topic} needs one or more fields with names that differ; got {names}")
        for name, width in fields:
            if not _FIELD_NAME.fullmatch(name) or width < 1:
                raise RecordingError(
                    f"field {name!r} of topic {topic} with {width} values is not valid; "
                    "allowed: lower-case names of letters, digits and single underscores, 1 value or more"
                )
        channel = _NumbersChannel(self, len(self._channels) + 1, topic, [width for _, width in fields])
        lines = [f"float64 {n}" if width == 1 else f"float64[{width}] {n}" for n, width in fields]
        kind = "".join(part[:1].upper() + part[1:] for part in re.split(r"[^A-Za-z0-9]+", topic))
        self._declare(channel, f"plantar_msgs/msg/{kind}", "ros2msg", "\n".join(lines).encode(), "cdr")
        return channel

    def message_channel(self, topic: str, schema: str) -> Channel[bytes]:
        """Returns channel of a new `topic` of encoded messages of a `schema` of `foxglove.SCHEMAS`, else
        RecordingError.
        """
        return self._drawn(topic, schema, lambda times, messages: messages)

    def template_channel(
        self,
        topic: str,
        schema: str,
        template: Template,
        values: Callable[[NDArray[np.float64]], NDArray[np.float64]] = np.asarray,
    ) -> Channel[NDArray[np.float64]]:
        """Returns channel of a new `topic` whose `schema` messages fill a `template`, encoded by chunk.

        `values` maps written rows (m, j) to slot values (m, k). Errors as of `message_channel`.
        """
        return self._drawn(topic, schema, lambda times, rows: template.filled_all(times, values(np.array(rows))))

    def _drawn(self, topic: str, schema: str, encode: _Encode[_Message]) -> Channel[_Message]:
        if schema not in SCHEMAS:
            raise RecordingError(f"schema {schema!r} of topic {topic} is unknown; allowed: {', '.join(SCHEMAS)}")
        channel = Channel(self, len(self._channels) + 1, topic, encode)
        self._declare(channel, schema, "protobuf", descriptor(schema), "protobuf")
        return channel

    def _declare(self, channel: Channel[Any], schema: str, language: str, text: bytes, encoding: str) -> None:
        topic = channel.topic
        number = channel._number
        if not topic.startswith("/") or any(c.topic == topic for c in self._channels):
            raise RecordingError(f"topic {topic!r} is not new or does not start with '/'")
        described = self._records.Schema(id=number, name=schema, encoding=language, data=text)
        entry = self._records.Channel(id=number, topic=topic, message_encoding=encoding, metadata={}, schema_id=number)
        self._definitions += [described, entry]
        self._summary += [described, entry]
        self._channels.append(channel)

    def flush(self) -> None:
        """Write gathered messages as one chunk; RecordingError if the disk is full or unwritable."""
        full = [channel for channel in self._channels if channel._times]
        if not full:
            return
        parts = [self._encoded(*self._definitions)]
        self._definitions = []
        offset = len(parts[0])
        indexes: list[tuple[int, bytes]] = []
        low = 2**63
        high = 0
        for channel in full:
            messages = channel._take_messages()
            times = messages.times
            low = min(low, int(times.min()))
            high = max(high, int(times.max()))
            entries = np.empty(len(times), dtype=_INDEX_ENTRY)
            entries["log_time"] = times
            entries["offset"] = offset + messages.offsets
            entries = entries[np.argsort(times, kind="stable")]
            head = _INDEX_HEAD.pack(_MESSAGE_INDEX, 6 + entries.nbytes, channel._number, entries.nbytes)
            indexes.append((channel._number, head + entries.tobytes()))
            parts.append(messages.data)
            offset += len(messages.data)
        data = b"".join(parts)
        packed = self._compress(data)
        about = (low, high, offset, zlib.crc32(data), len(_COMPRESSION), _COMPRESSION, len(packed))
        start = self._put(_CHUNK_HEAD.pack(_CHUNK, _CHUNK_HEAD.size - 9 + len(packed), *about))
        self._put(packed)
        self._chunks += 1
        self._keep_index(
            self._records.ChunkIndex(
                chunk_start_offset=start,
                chunk_length=_CHUNK_HEAD.size + len(packed),
                message_index_offsets={number: self._put(index) for number, index in indexes},
                message_index_length=sum(len(index) for _, index in indexes),
                message_start_time=low,
                message_end_time=high,
                compression=_COMPRESSION.decode(),
                compressed_size=len(packed),
                uncompressed_size=offset,
            )
        )
        first, last = self._time_range or (low, high)
        self._time_range = min(first, low), max(last, high)
        try:
            self._file.flush()
            self._take_name()
        except OSError as error:
            raise self._write_error(error) from None

    def note(self, **metadata: object) -> None:
        """Add `metadata`, JSON values by name, to what the recording began with; a later value of a name counts.

        RecordingError if it is not JSON, or the disk is full or unwritable.
        """
        self._put_metadata(_json_texts(metadata))

    def _put_metadata(self, texts: dict[str, str]) -> None:
        record = self._encoded(self._records.Metadata(name="plantar", metadata=texts))
        index = self._records.MetadataIndex(offset=self._put(record), length=len(record), name="plantar")
        self._metadata_indexes.append(index)

    def _keep_index(self, index: Any) -> None:
        """Keep a chunk's index for the file's end, in a file of its own once they are many."""
        try:
            self._chunk_indexes.write(self._encoded(index))
        except OSError as error:
            raise self._write_error(error) from None

    def _take_name(self) -> None:
        if self._temporary is not None:
            os.replace(self._temporary, self.path)
            self._temporary = None

    def close(self) -> None:
        """Write the last chunk and index, and close the file, once; raises as `flush` does."""
        if self._file.closed:
            return
        try:
            self.flush()
            self._put_summary()
            self._file.close()
            self._take_name()
        except OSError as error:
            raise self._write_error(error) from None
        finally:
            with suppress(OSError):  # given above already where it matters
                self._file.close()
            self._chunk_indexes.close()
            if self._temporary is not None:  # not a single message was written: an old recording stays
                self._temporary.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is not None and self._temporary is not None and not any(c._times for c in self._channels):
            with suppress(OSError):  # nothing was recorded: leave nothing behind
                self._file.close()
            self._chunk_indexes.close()
            self._temporary.unlink(missing_ok=True)
            return
        self.close()

    def _put_summary(self) -> None:
        records = self._records
        if self._definitions:  # topics without a message: known to readers all the same
            self._put(self._encoded(*self._definitions))
            self._definitions = []
        self._put(self._encoded(records.DataEnd(data_section_crc=0)))
        low, high = self._time_range or (0, 0)
        counts = {channel._number: channel._written for channel in self._channels}
        statistics = records.Statistics(
            message_count=sum(counts.values()),
            schema_count=len(counts),
            channel_count=len(counts),
            attachment_count=len(self._layout_indexes),
            metadata_count=len(self._metadata_indexes),
            chunk_count=self._chunks,
            message_start_time=low,
            message_end_time=high,
            channel_message_counts=counts,
        )
        start = self._put(self._encoded(*self._summary, statistics))
        self._chunk_indexes.seek(0)
        while indexes := self._chunk_indexes.read(_MOST_INDEXES):
            self._put(indexes)
        self._put(self._encoded(*self._metadata_indexes, *self._layout_indexes))
        self._put(self._encoded(records.Footer(summary_start=start, summary_offset_start=0, summary_crc=0)))
        self._put(MCAP_MAGIC)

    def _encoded(self, *records: Any) -> bytes:
        builder = self._builder_type()
        for record in records:
            record.write(builder)
        return bytes(builder.end())

    def _put(self, data: bytes) -> int:
        try:
            offset = self._file.tell()
            self._file.write(data)
        except OSError as error:
            raise self._write_error(error) from None
        return offset

    def _write_error(self, error: OSError) -> RecordingError:
        kept = "; the part before it is kept" if self._temporary is None else ""
        return RecordingError(f"cannot write recording {self.path}: {error.strerror}{kept}")
