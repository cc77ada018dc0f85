"""Kernels run all compiled or all interpreted, and each command reports which in the same line."""

import json
import os
import shutil
import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.build_stamp import STAMP, lack, write

PACKAGE = Path(kernels.__file__).resolve().parents[1]
NAMES = ["base.memoryviews", "room.one", "room.two"]
SUFFIX = EXTENSION_SUFFIXES[0]


def extension(folder: Path, name: str) -> Path:
    """Where the extension of a kernel lies."""
    return folder / f"{name.replace('.', '/')}{SUFFIX}"


@pytest.fixture
def built(tmp_path):
    """Two kernels with types, one without, and the extensions of a whole build."""
    for room in ("base", "room"):
        (tmp_path / room).mkdir()
    for name in ("one.py", "one.pxd", "two.py", "two.pxd", "plain.py"):
        (tmp_path / "room" / name).write_text(name)
    for name in NAMES:
        extension(tmp_path, name).touch()
    assert write(tmp_path, tmp_path) == []
    return tmp_path


def test_a_whole_build_lacks_nothing(built):
    assert (built / STAMP).read_text().split()[1:] == NAMES
    assert lack(built, sources_too=True) == ""


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_extension_is_named(built, name):
    extension(built, name).unlink()
    assert lack(built, sources_too=True) == f"1 of 3 compiled ones are missing: {name}"
    assert write(built, built) == [name]
    assert not (built / STAMP).exists()
    assert lack(built, sources_too=False) == "1 of 3 were not compiled"


@pytest.mark.parametrize("name", ["one.py", "two.pxd", "plain.py"])
def test_another_source_is_seen_where_sources_may_change(built, name):
    (built / "room" / name).write_text("changed")
    assert lack(built, sources_too=True) == "they were compiled from other sources"
    assert lack(built, sources_too=False) == ""


def test_extensions_without_a_stamp_do_not_count(built):
    (built / STAMP).unlink()
    assert lack(built, sources_too=False) == "the build was not finished"
    for name in NAMES:
        extension(built, name).unlink()
    assert lack(built, sources_too=False) == "none of them is compiled"


@pytest.fixture(scope="module")
def incomplete(tmp_path_factory):
    """A copy of the package without one extension."""
    folder = tmp_path_factory.mktemp("incomplete")
    shutil.copytree(PACKAGE, folder / "plantar", ignore=shutil.ignore_patterns("__pycache__"))
    (removed,) = (folder / "plantar" / "kernels" / "geometry").glob("few_points.*.so")
    removed.unlink()
    return folder


def plantar(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """A command of the copy."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "PLANTAR_KERNELS": ""}
    command = [sys.executable, "-m", "plantar", *words]
    return subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)


needs_extensions = pytest.mark.skipif(not kernels.compiled or SUFFIX.endswith(".pyd"), reason="none are compiled here")
LINE = "kernels: plain Python, slower (1 of {} compiled ones are missing: geometry.few_points); install a C compiler"


def line() -> str:
    """The line that each command reports."""
    count = len((PACKAGE / "kernels" / STAMP).read_text().split()) - 1
    return LINE.format(count)


@needs_extensions
def test_reading_and_analysing_work_interpreted(incomplete):
    rows = ["time,left_heel,left_ball,right_heel,right_ball"]
    for time in np.arange(0.0, 8.0, 0.02):
        left = 400.0 * max(0.0, np.sin(2.0 * np.pi * time))
        right = 400.0 * max(0.0, -np.sin(2.0 * np.pi * time))
        rows.append(f"{time:.2f},{left:.1f},{left:.1f},{right:.1f},{right:.1f}")
    (incomplete / "walk.csv").write_text("\n".join(rows) + "\n")
    done = plantar(incomplete, "analyze", "walk.csv", "--json", "-o", "analysis")
    assert done.returncode == 0
    assert line() in done.stderr
    feet = json.loads(done.stdout)["feet"]
    assert [feet[side]["steps"] for side in ("left", "right")] == [8, 7]
