"""What is no regular file, or too large, is refused in one line before it is read."""

import os
import socket
import sys

import pytest

from plantar.common.files.input_file import check_input, is_file, open_input, read_input
from plantar.errors import FootError, FormatError, PlantarError

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="pipes, devices and /proc as on Linux")


@pytest.fixture
def strange(tmp_path):
    """Names of things that are no regular files, by what they are."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "folder").mkdir()
    (tmp_path / "linked").symlink_to("pipe")
    (tmp_path / "file").write_text("x")
    return {name: str(tmp_path / name) for name in ("pipe", "loop", "folder", "linked", "none")} | {
        "device": "/dev/zero",
        "long": str(tmp_path / ("x" * 300)),
        "empty": "",
        "null": "a\0b",
        "below": str(tmp_path / "file" / "below"),
        "newline": str(tmp_path / "no\nsuch"),
    }


@linux
@pytest.mark.parametrize(
    ("what", "reason"),
    [
        ("pipe", "it is a pipe"),
        ("linked", "it is a pipe"),
        ("device", "it is a device"),
        ("folder", "Is a directory"),
        ("loop", "Too many levels of symbolic links"),
        ("none", "No such file"),
        ("long", "File name too long"),
        ("empty", "its name is empty"),
        ("null", "null byte"),
        ("below", "Not a directory"),
        ("newline", "No such file"),
    ],
)
def test_what_is_no_regular_file_is_refused_at_once(strange, what, reason):
    for read in (check_input, open_input, lambda path, error: read_input(path, error, 10)):
        with pytest.raises(FormatError, match=reason):
            read(strange[what], FormatError)
    assert not is_file(strange[what])


@linux
def test_a_socket_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a socket's name is short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("s")
        with pytest.raises(FormatError, match="it is a socket"):
            check_input("s", FormatError)


def test_a_regular_file_is_read_whatever_its_name(tmp_path):
    for name in ("a b", "zwei\nzeilen", "größe", os.fsdecode(b"\xff\xfe")):
        path = tmp_path / name
        path.write_bytes(b"text")
        assert is_file(path)
        assert check_input(path, FormatError) == 4
        assert read_input(path, FormatError, 4) == b"text"
        with open_input(path, FormatError) as stream:
            assert stream.read() == b"text"


def test_what_is_too_large_is_refused_unread(tmp_path):
    path = tmp_path / "sparse.stl"
    with path.open("wb") as stream:
        stream.truncate(10**12)  # takes no room on the disk
    for read in (check_input, open_input, read_input):
        with pytest.raises(FootError, match=r"sparse\.stl: holds 1e\+03 GB; allowed: up to 200 MB"):
            read(path, FootError, 200e6)


@linux
def test_a_file_that_holds_more_than_it_states_is_refused():
    assert os.stat("/proc/cpuinfo").st_size == 0
    with pytest.raises(PlantarError, match="holds more than 100 bytes"):
        read_input("/proc/cpuinfo", PlantarError, 100)


def test_the_message_begins_as_told():
    with pytest.raises(FootError, match=r"^parameter file none cannot be read \(No such file"):
        check_input("none", FootError, where="parameter file none")
