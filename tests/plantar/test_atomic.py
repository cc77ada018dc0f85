"""Tests run as root too, where permissions do not protect: what cannot be written is a path below a file, or /proc."""

import os
import sys

import pytest

from plantar import InputError
from plantar.atomic import output_folder, replacing, write_text

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is Linux")


def everything(folder):
    """All paths below a folder, hidden ones too."""
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*"))


class Stop(Exception):
    """An error of the caller's own."""


# --- replacing ----------------------------------------------------------------------------------------------------


def test_the_file_appears_when_it_is_whole(tmp_path):
    path = tmp_path / "table.csv"
    with replacing(path) as temporary:
        temporary.write_text("half")
        assert not path.exists()
        assert (temporary.parent, temporary.suffix) == (tmp_path, ".csv")
    assert path.read_text() == "half"
    assert everything(tmp_path) == ["table.csv"]


def write_half(path, error):
    with replacing(path) as temporary:
        temporary.write_text("new")
        raise error


@pytest.mark.parametrize("error", [Stop, KeyboardInterrupt, ValueError])
def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path, error):
    path = write_text(tmp_path / "table.csv", "old")
    with pytest.raises(error):
        write_half(path, error)
    assert path.read_text() == "old"
    assert everything(tmp_path) == ["table.csv"]


def test_a_full_disk_is_one_line(tmp_path):
    path = tmp_path / "table.csv"
    with pytest.raises(InputError, match=r"cannot write .*table\.csv: No space left on device"), replacing(path):
        raise OSError(28, "No space left on device")
    assert everything(tmp_path) == []


def test_a_file_has_the_permissions_of_any_other_new_file(tmp_path):
    plain = tmp_path / "plain"
    plain.write_text("")
    path = write_text(tmp_path / "atomic", "")
    assert path.stat().st_mode == plain.stat().st_mode


def test_text_is_utf8_to_the_byte(tmp_path):
    text = "pression plantaire: 12 N/cm² – été\n"
    assert write_text(tmp_path / "note.txt", text).read_bytes() == text.encode()


def test_below_a_file_nothing_can_be_written(tmp_path):
    (tmp_path / "file").write_text("keep")
    with pytest.raises(InputError, match=r"cannot write .*choose a folder that exists"):
        write_text(tmp_path / "file" / "note.txt", "x")
    with pytest.raises(InputError, match="cannot write"):
        write_text(tmp_path / "missing" / "note.txt", "x")
    assert everything(tmp_path) == ["file"]


def test_a_folder_in_the_way(tmp_path):
    (tmp_path / "note.txt").mkdir()
    with pytest.raises(InputError, match="cannot write"):
        write_text(tmp_path / "note.txt", "x")
    assert everything(tmp_path) == ["note.txt"]


@linux
def test_a_file_system_that_takes_no_files():
    with pytest.raises(InputError, match="cannot write /proc/note"):
        write_text("/proc/note.txt", "x")


# --- output_folder ------------------------------------------------------------------------------------------------


def write_files(folder, *names, error=None):
    with output_folder(folder) as temporary:
        for name in names:
            (temporary / name).parent.mkdir(exist_ok=True)
            (temporary / name).write_text(name)
        if error:
            raise error


def test_files_appear_together_and_others_stay(tmp_path):
    out = tmp_path / "a" / "b"
    out.mkdir(parents=True)
    (out / "mine.txt").write_text("mine")
    (out / "metrics.json").write_text("old")
    with output_folder(out) as temporary:
        (temporary / "metrics.json").write_text("new")
        (temporary / "figures").mkdir()
        (temporary / "figures" / "cop.png").write_text("png")
        assert (out / "metrics.json").read_text() == "old"
    assert (out / "metrics.json").read_text() == "new"
    assert everything(out) == ["figures", "figures/cop.png", "metrics.json", "mine.txt"]


@pytest.mark.parametrize("error", [Stop, KeyboardInterrupt])
@pytest.mark.parametrize("existing", ["", "a", "a/b"])
def test_an_error_leaves_the_folders_that_were_there(tmp_path, error, existing):
    (tmp_path / existing).mkdir(parents=True, exist_ok=True)
    before = everything(tmp_path)
    with pytest.raises(error):
        write_files(tmp_path / "a" / "b", "half", error=error)
    assert everything(tmp_path) == before


def test_a_file_in_the_place_of_the_folder(tmp_path):
    (tmp_path / "out").write_text("keep")
    with pytest.raises(InputError, match=r"output folder .*out is a file"), output_folder(tmp_path / "out"):
        pytest.fail("the run must not start")
    with pytest.raises(InputError, match="cannot be written to"), output_folder(tmp_path / "out" / "deep" / "er"):
        pytest.fail("the run must not start")
    assert everything(tmp_path) == ["out"]


def test_a_folder_in_the_place_of_a_file_moves_nothing(tmp_path):
    (tmp_path / "out" / "z.csv").mkdir(parents=True)
    with pytest.raises(InputError, match=r"z\.csv: a folder of this name"):
        write_files(tmp_path / "out", "a.csv", "z.csv")
    assert everything(tmp_path) == ["out", "out/z.csv"]


def test_a_file_in_the_place_of_a_subfolder(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "figures").write_text("keep")
    with pytest.raises(InputError, match="cannot be written to"):
        write_files(out, "figures/a.png")
    assert everything(out) == ["figures"]
    assert (out / "figures").read_text() == "keep"


def test_a_name_that_is_too_long(tmp_path):
    with pytest.raises(InputError, match="cannot be written to"), output_folder(tmp_path / ("x" * 300)):
        pytest.fail("the run must not start")
    assert everything(tmp_path) == []


@linux
def test_a_folder_where_none_can_be_made():
    with pytest.raises(InputError, match=r"cannot be written to .* choose one with -o"), output_folder("/proc/out"):
        pytest.fail("the run must not start")


def test_relative_paths_and_the_working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with output_folder("out") as temporary:
        (temporary / "a").write_text("a")
    with output_folder(os.curdir) as temporary:
        (temporary / "b").write_text("b")
    assert everything(tmp_path) == ["b", "out", "out/a"]
