"""Make the two recordings of `plantar demo --small`: a few steps of a robot, thinned, and a made-up walk on insoles.

    python tools/small_demo.py

They lie in plantar/commands/small_demo, and in each wheel. Of the walk of the robot the skins are kept 50 times a
second, its poses 25 times, and of each number the seven digits of a float32, which halves the file.
"""

import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

import plantar
from plantar.recordings.foxglove import Message, message_of

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "plantar" / "commands" / "small_demo"
BEGIN = 5.0  # s of the walk, which takes about 20 steps in 29 s
END = 13.0
SKINS = ("/skin/left", "/skin/right")
POSES = ("/tf", "/truth/body", "/truth/left", "/truth/right")
RATE = {**dict.fromkeys(SKINS, 50.0), **dict.fromkeys(POSES, 25.0)}  # Hz


def short(data: bytes, encoding: str, schema: str) -> bytes:
    """A message whose floating-point numbers have the digits of a float32, and zeros after them, which compress."""
    if encoding == "cdr":  # of four bytes and float64 alone, as skins and true poses are recorded
        return data[:4] + np.frombuffer(data[4:]).astype(np.float32).astype(np.float64).tobytes()
    for number in _numbers(message_of(schema, data)):  # in place, as the page's templates know their length
        data = data.replace(struct.pack("<d", number), struct.pack("<d", np.float32(number)))
    return data


def _numbers(message: Message) -> Iterator[float]:
    for field, value in message.ListFields():
        if field.type == field.TYPE_DOUBLE:
            yield value
        elif field.type == field.TYPE_MESSAGE:
            for part in value if hasattr(value, "append") else [value]:
                yield from _numbers(part)


def thin(source: Path, target: Path) -> None:
    """Write what the demo shows of a recording: part of its time and topics, and all that is stated once."""
    with open(source, "rb") as stream, open(target, "wb") as out:
        reader = make_reader(stream)
        writer = Writer(out, compression=CompressionType.ZSTD)
        writer.start(profile=reader.get_header().profile, library="plantar")
        schemas: dict[int, int] = {}
        channels: dict[int, int] = {}
        latest: dict[str, float] = {}
        for schema, channel, message in reader.iter_messages():
            time = 1e-9 * message.log_time
            once = channel.topic == "/scene/world"
            if not once and (channel.topic not in RATE or not BEGIN <= time < END):
                continue
            if not once and time - latest.get(channel.topic, -1.0) < 1.0 / RATE[channel.topic] - 1e-6:
                continue
            latest[channel.topic] = time
            if schema is not None and schema.id not in schemas:
                schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
            if channel.id not in channels:
                schema_id = schemas[schema.id] if schema is not None else 0
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, schema_id, channel.metadata
                )
            stamp = int(1e9 * BEGIN) if once else message.log_time
            data = message.data if once else short(message.data, channel.message_encoding, schema.name)
            writer.add_message(channels[channel.id], stamp, data, stamp, message.sequence)
        for entry in reader.iter_metadata():
            writer.add_metadata(entry.name, entry.metadata)
        for entry in reader.iter_attachments():
            writer.add_attachment(entry.create_time, entry.log_time, entry.name, entry.media_type, entry.data)
        writer.finish()


def main() -> None:
    """Walk, thin the recording, write the insole's walk, and print what both take."""
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        walk = Path(folder, "walk.mcap")
        plantar.run("flat", record=walk)
        thin(walk, FOLDER / "robot.mcap")
    subprocess.run([sys.executable, ROOT / "examples" / "insole_walk.py", FOLDER / "insole.asc"], check=True)
    for path in sorted(FOLDER.iterdir()):
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
