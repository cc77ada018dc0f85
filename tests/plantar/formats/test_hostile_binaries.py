"""Binary files that announce, unpack to or lead to any amount of memory or time are refused in one line."""

import os
import struct
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from plantar.common.files.image_size import ImageSize, stated_size
from plantar.errors import FormatError
from plantar.formats import ReadOptions, formats, read_recording
from plantar.formats.footprint_image import read_footprints
from plantar.recordings.recording import read_mcap

pytestmark = pytest.mark.apart

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="pipes and devices as on Linux")

# --- what is no file ------------------------------------------------------------------------------------------------


@linux
@pytest.mark.parametrize("name", [None, *formats()])
def test_a_pipe_does_not_hang_whatever_it_is_taken_for(tmp_path, name):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero"), tmp_path / ("x" * 300), tmp_path / "none"):
        with pytest.raises(FormatError, match=r"cannot be read") as caught:
            read_recording(path, name)
        assert "\n" not in str(caught.value)
    with pytest.raises(FormatError, match="it is a pipe"):
        read_footprints(tmp_path / "pipe")
    with pytest.raises(FormatError, match="it is a pipe"):
        read_mcap(tmp_path / "pipe")


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", formats())
def test_any_bytes_are_one_line_for_every_reader(tmp_path, name):
    path = tmp_path / "zwei\nzeilen"
    random = np.random.default_rng(0)
    for data in (b"", b"\0" * 3000, random.bytes(3000), b"1" * 5000, b"a,b\n" * 900, b'{"a":' * 900, b"\xff\xfe\0\0"):
        path.write_bytes(data)
        with pytest.raises(FormatError) as caught:
            read_recording(path, name, options=ReadOptions(side="left"))
        assert str(caught.value).count("\n") == 1  # the one in the file's own name


# --- images ---------------------------------------------------------------------------------------------------------


def png(width: int, height: int, bits: int = 8, kind: int = 2) -> bytes:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    body = zlib.compress(bytes(10_000_000), 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def jpeg(width: int, height: int, scans: int = 1) -> bytes:
    frame = struct.pack(">BHHB", 8, height, width, 3) + b"\x01\x11\0\x02\x11\0\x03\x11\0"
    exif = b"\xff\xe1" + struct.pack(">H", 102) + bytes(100)
    return b"\xff\xd8" + exif + b"\xff\xc2" + struct.pack(">H", 2 + len(frame)) + frame + b"\xff\xda\0\x02" * scans


def tiff(width: int, height: int, order: str = "<") -> bytes:
    short = 0 if order == "<" else 16  # a number of two bytes stands at the beginning of its four
    tags = [(256, 4, width), (257, 4, height), (258, 3, 16 << short), (277, 3, 3 << short)]
    head = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(f"{order}I", 8)
    body = b"".join(struct.pack(f"{order}HHII", tag, kind, 1, value) for tag, kind, value in tags)
    return head + struct.pack(f"{order}H", len(tags)) + body + bytes(4)


def bmp(width: int, height: int) -> bytes:
    return b"BM" + bytes(12) + struct.pack("<IiiHH", 40, width, -height, 1, 24) + bytes(100)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (png(30_000, 30_000), "30000 x 30000 pixels takes 2700 MB; allowed: up to 250 MB"),
        (png(2**31 - 1, 2**31 - 1), "allowed: up to 250 MB"),
        (png(7000, 7000, bits=16, kind=6), "takes 392 MB"),
        (png(0, 100), "not an image"),
        (png(100, 100)[:20], "not an image"),
        (jpeg(65_500, 65_500), "allowed: up to 250 MB"),
        (jpeg(5000, 5000, scans=500), "takes too long"),
        (jpeg(5000, 5000)[:100], "not an image"),
        (tiff(10**9, 10**9), "allowed: up to 250 MB"),
        (tiff(60_000, 60_000, ">"), "allowed: up to 250 MB"),
        (bmp(2**30, 2**30), "allowed: up to 250 MB"),
        (b"BM" + bytes(100), "not an image"),
        (b"II*\0\xff\xff\xff\xff", "not an image"),
        (b"RIFF\0\0\0\0WEBPVP8 ", "not an image"),
    ],
)
def test_an_image_that_announces_too_much_is_not_decoded(tmp_path, within, data, words):
    pytest.importorskip("cv2")
    path = tmp_path / "scan"
    path.write_bytes(data)
    with within(megabytes=60), pytest.raises(FormatError, match=words):
        read_footprints(path)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".bmp"])
@pytest.mark.parametrize("channels", [1, 3])
def test_the_stated_size_is_that_of_the_decoded_image(tmp_path, suffix, channels):
    cv2: Any = pytest.importorskip("cv2")
    image = np.zeros((37, 53, channels), dtype=np.uint8)
    path = tmp_path / f"image{suffix}"
    cv2.imwrite(str(path), image)
    size = stated_size(path.read_bytes())
    assert (size.width, size.height) == (53, 37)
    assert size.memory >= image.nbytes


def test_an_image_of_usual_size_fits():
    assert ImageSize(7016, 9933, 3).memory < 250e6  # A3 at 600 dpi


# --- MCAP -----------------------------------------------------------------------------------------------------------


def mcap_of(path: Path, compression: CompressionType, rows: int, width: int, chunk: int = 1 << 20) -> Path:
    with path.open("wb") as stream:
        writer = Writer(stream, compression=compression, chunk_size=chunk)
        writer.start("ros2")
        schema = writer.register_schema("a/msg/B", "ros2msg", f"float64[{width}] force".encode())
        channel = writer.register_channel("/skin/left", "cdr", schema)
        for i in range(rows):
            writer.add_message(channel, i * 10**7, b"\0\1\0\0" + bytes(8 * width), i * 10**7)
        writer.finish()
    return path


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4])
def test_a_bomb_of_chunks_is_refused(tmp_path, within, compression):
    path = mcap_of(tmp_path / "bomb.mcap", compression, 400, 100_000, 100_000_000)
    with within(megabytes=450), pytest.raises(FormatError, match=r"unpack to more than .* allowed: up to 100 MB"):
        read_mcap(path)


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4])
@pytest.mark.parametrize("stated", [0, 1, 10**4, 10**8, 2**62])
def test_a_chunk_that_lies_about_its_size_is_left_out(tmp_path, within, compression, stated):
    path = mcap_of(tmp_path / "lie.mcap", compression, 50, 1000)
    data = bytearray(path.read_bytes())
    at = data.index(b"\x06", data.index(b"\x01") + 20)
    while struct.unpack_from("<Q", data, at + 1)[0] > len(data) or data[at] != 6:
        at = data.index(b"\x06", at + 1)
    struct.pack_into("<Q", data, at + 9 + 16, stated)
    path.write_bytes(data)
    with within(megabytes=150):
        try:
            recording = read_mcap(path)
        except FormatError as error:
            assert "\n" not in str(error)  # noqa: PT017  nothing else is in the file
        else:
            assert recording.warnings


def test_a_recording_is_read_chunk_by_chunk(tmp_path, within):
    path = mcap_of(tmp_path / "run.mcap", CompressionType.NONE, 20_000, 200)
    with within(megabytes=1.6 * 32 + 25, seconds=30.0):
        recording = read_mcap(path)
    assert recording.topics["/skin/left"].fields["force"].shape == (20_000, 200)


@pytest.mark.parametrize("opcode", [0x03, 0x04, 0x05, 0x06, 0x09, 0x0C, 0x55])
def test_a_record_of_any_length_is_not_taken_into_memory(tmp_path, within, opcode):
    path = mcap_of(tmp_path / "run.mcap", CompressionType.NONE, 20, 5)
    data = path.read_bytes()
    with path.open("wb") as stream:
        stream.write(data[:8] + struct.pack("<BQ", opcode, 10**9))
        stream.seek(10**9, os.SEEK_CUR)  # a hole, which takes no room on the disk
        stream.write(data[8:])
    with within(megabytes=60):
        recording = read_mcap(path)
    assert len(recording.topics["/skin/left"]) == 20


# --- libraries in a process of their own ------------------------------------------------------------------------------


def test_a_crash_of_the_c3d_library_is_one_line(tmp_path):
    pytest.importorskip("ezc3d")
    data = bytearray(6000)
    data[0:2] = b"\x02\x50"
    struct.pack_into("<HHHHHfHHf", data, 2, 65535, 65535, 1, 65534, 0, -1.0, 3, 1, 100.0)
    data[512:516] = b"\x01\x50\xff\x54"
    random = np.random.default_rng(1)
    path = tmp_path / "file.c3d"
    for _ in range(3):
        data[516:] = random.bytes(len(data) - 516)
        path.write_bytes(data)
        with pytest.raises(FormatError, match="not a C3D file that can be read") as caught:
            read_recording(path, "c3d")
        assert "\n" not in str(caught.value)


def test_pictures_in_a_bag_are_no_soles():
    from plantar.formats.ros_bag import _arrays

    class Picture:
        __dataclass_fields__ = {"data": None}  # noqa: RUF012
        data = np.zeros(640 * 480, dtype=np.uint8)

    assert list(_arrays(Picture(), 3)) == []
