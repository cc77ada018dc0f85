"""What a library does to a process of its own does not reach who called it."""

import os
from pathlib import Path

import numpy as np
import pytest

from plantar.common.files.confined import confined
from plantar.errors import FormatError

LIBRARY = """
import ctypes, os, sys, time
import numpy as np

def arrays(path):
    print("chatter"); os.write(1, b"more of it")
    return {"size": os.path.getsize(path), "names": np.array([path.name, "\\xe4"]), "table": np.eye(3)}

def fails(path): raise ValueError("two\\nlines of trouble")
def ends(path): os._exit(7)
def crashes(path): ctypes.string_at(0)
def aborts(path): os.abort()
def turns(path):
    while True: pass
def waits(path): time.sleep(60)
def hoards(path): return {"a": np.ones(10**9)}
def fills(path):
    import tempfile
    with open(tempfile.mktemp(), "wb") as stream:
        while True: stream.write(bytes(10**7))
def objects(path): return {"a": np.array([{}], dtype=object)}
"""


@pytest.fixture
def library(tmp_path, monkeypatch):
    (tmp_path / "library_of_test.py").write_text(LIBRARY)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    return tmp_path / "library_of_test.py"


def call(name: str, path: Path, seconds: float = 20.0) -> dict[str, np.ndarray]:
    return confined(f"library_of_test:{name}", path, FormatError, "a thing", memory=300e6, seconds=seconds)


def test_arrays_come_back_whatever_is_printed(library):
    held = call("arrays", library)
    assert int(held["size"]) == library.stat().st_size
    assert held["names"].tolist() == ["library_of_test.py", "ä"]
    assert (held["table"] == np.eye(3)).all()


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("fails", r"ValueError: two\\nlines of trouble"),
        ("ends", "the library ended with 7"),
        ("crashes", "the library ended with SIGSEGV"),
        ("aborts", "the library ended with SIGABRT"),
        ("hoards", "it asks for more than 300 MB of memory"),
        ("objects", "not a thing that can be read"),
        ("none", "no attribute 'none'|has no attribute"),
    ],
)
def test_what_goes_wrong_is_one_line(library, name, reason):
    with pytest.raises(FormatError, match=reason) as caught:
        call(name, library)
    assert str(caught.value).startswith(f"{library}: not a thing that can be read")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["turns", "waits", "fills"])
def test_what_never_ends_is_ended(library, name, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    monkeypatch.setattr("plantar.common.files.confined._LARGEST_FILE", 50_000_000)
    if name == "waits":  # nothing but the end of the time ends it
        monkeypatch.setattr("plantar.common.files.confined._STARTING", 1.0)
        monkeypatch.setattr("plantar.common.files.confined._WAITED", 2.0)
    with pytest.raises(FormatError, match=r"it takes longer than 1 s|Errno 27|SIGXFSZ"):
        call(name, library, seconds=1.0)
    assert [p for p in tmp_path.iterdir() if p.name.startswith("plantar-")] == []


def test_the_folder_one_works_in_is_no_place_for_modules(library, tmp_path, monkeypatch):
    """A folder of downloaded files may hold a numpy.py."""
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "numpy.py").write_text("raise SystemExit('taken in')")
    monkeypatch.chdir(tmp_path / "here")
    assert int(call("arrays", library)["size"]) > 0
