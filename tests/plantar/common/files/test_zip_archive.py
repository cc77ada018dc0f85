"""Archives: what they would unpack to is known before anything is unpacked."""

import io
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from plantar.common.files.zip_archive import open_archive
from plantar.errors import FormatError
from plantar.formats import ReadOptions, read_recording

SIDE = ReadOptions(side="left")


def header(shape: tuple[int, ...], kind: str = "<f8") -> bytes:
    out = io.BytesIO()
    np.lib.format.write_array_header_1_0(out, {"descr": kind, "fortran_order": False, "shape": shape})
    return out.getvalue()


def packed(path: Path, parts: dict[str, Iterator[bytes]], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method, compresslevel=1) as archive:
        for name, pieces in parts.items():
            with archive.open(name, "w", force_zip64=True) as part:
                for piece in pieces:
                    part.write(piece)
    return path


def zeros(megabytes: int) -> Iterator[bytes]:
    for _ in range(megabytes):
        yield bytes(1_000_000)


def array(shape: tuple[int, ...], megabytes: int, kind: str = "<f8") -> Iterator[bytes]:
    yield header(shape, kind)
    yield from zeros(megabytes)


BOMBS: dict[str, tuple[Callable[[], dict[str, Iterator[bytes]]], str]] = {
    "zeros": (
        lambda: {"left.npy": array((50_000, 1000), 400)},
        "unpack to 400 MB; allowed: up to 100 MB, or 100 times",
    ),
    "several": (lambda: {f"a{i}.npy": array((1000, 1000), 8) for i in range(20)}, "unpack to 160 MB"),
    "a shape of petabytes": (lambda: {"left.npy": array((10**9, 10**6), 1)}, "its 1000000 bytes are not"),
    "a negative shape": (lambda: {"left.npy": array((-5, -25_000), 1)}, "its 1000000 bytes are not"),
    "a shape that is larger": (lambda: {"left.npy": array((1000, 126), 1)}, "its 1000000 bytes are not: cut short"),
    "objects": (lambda: {"left.npy": array((1000, 125), 1, "|O")}, "are not unpickled"),
    "parts without end": (lambda: {f"{i}.npy": iter([b""]) for i in range(5000)}, "parts; allowed: up to 4096"),
    "a header without end": (lambda: {"left.npy": iter([b"\x93NUMPY\x02\x00\xff\xff\xff\x7f"])}, "cannot|can be read"),
    "a text without end": (
        lambda: {"left.npy": array((1000, 125), 1), "unit.npy": array((), 90, "<U22500000")},
        "the text 'unit' is larger than 16 MB",
    ),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_of_arrays_is_refused_unpacked(tmp_path, within, name):
    parts, words = BOMBS[name]
    path = packed(tmp_path / "bomb.npz", parts())
    assert path.stat().st_size < 6e6
    with within(megabytes=150, seconds=5.0), pytest.raises(FormatError, match=words) as caught:
        read_recording(path, "arrays", options=SIDE)
    assert "\n" not in str(caught.value)


def test_what_is_larger_than_a_reader_takes_is_refused(tmp_path):
    path = packed(tmp_path / "walk.npz", {"left.npy": array((1000, 1000), 8)}, zipfile.ZIP_STORED)
    with pytest.raises(FormatError, match="unpacks to 8 MB; allowed: up to 7 MB"), open_archive(path, FormatError, 7e6):
        pytest.fail("nothing may be unpacked")


def test_an_array_that_states_more_than_it_holds_is_refused(tmp_path, within):
    path = tmp_path / "lie.npy"
    path.write_bytes(header((100_000_000, 1000)) + bytes(800))
    with within(megabytes=50), pytest.raises(FormatError, match="its 800 bytes are not"):
        read_recording(path, options=SIDE)


def test_only_the_array_that_is_wanted_is_read(tmp_path, within):
    parts = {
        "left.npy": array((1000, 1000), 8),
        "image.npy": array((9_000_000,), 72),
        "cube.npy": array((2, 500, 500), 4),
    }
    path = packed(tmp_path / "walk.npz", parts)
    with within(megabytes=40):
        recording = read_recording(path)
    assert recording.feet["left"].force.shape == (1000, 1000)


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_packings_that_need_any_memory_are_refused(tmp_path, method):
    path = packed(tmp_path / "walk.npz", {"left.npy": array((1000, 1000), 8)}, method)
    with pytest.raises(FormatError, match="allowed: stored or deflated"):
        read_recording(path, "arrays", options=SIDE)


def test_a_large_recording_that_is_stored_is_no_bomb(tmp_path):
    path = packed(tmp_path / "walk.npz", {"left.npy": array((20_000, 1000), 160)}, zipfile.ZIP_STORED)
    with open_archive(path, FormatError, 1e9) as (archive, stream):
        assert archive.namelist() == ["left.npy"]
        assert not stream.closed
    assert stream.closed


@pytest.mark.parametrize("cut", [10, 100, 2000])
def test_a_damaged_archive_is_one_line(tmp_path, cut):
    path = packed(
        tmp_path / "walk.npz", {"left.npy": iter([header((100, 100)), np.random.default_rng(0).bytes(80_000)])}
    )
    whole = path.read_bytes()
    for data in (whole[:-cut], whole[:cut], whole[: len(whole) // 2] + bytes(cut) + whole[len(whole) // 2 + cut :]):
        path.write_bytes(data)
        with pytest.raises(FormatError, match=r"^[^\n]*$"):
            read_recording(path, "arrays", options=SIDE)
