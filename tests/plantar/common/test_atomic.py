"""Tests run as root too, where permissions do not protect: what cannot be written is a path below a file, or /proc."""

import os
import subprocess
import sys

import pytest

from plantar import InputError
from plantar.common.atomic import output_folder, parent_folder, replacing, write_text

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


def write_files(folder, *names, error=None, inputs=()):
    with output_folder(folder, inputs) as temporary:
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


def test_no_input_is_overwritten(tmp_path, monkeypatch):
    (tmp_path / "model.xml").write_text("the author's")
    (tmp_path / "link.xml").symlink_to(tmp_path / "model.xml")
    monkeypatch.chdir(tmp_path)
    for given in ("model.xml", tmp_path / "model.xml", "link.xml"):
        with pytest.raises(InputError, match=r"cannot write .*model\.xml: it is what this is made of; choose another"):
            write_files(".", "a.toml", "model.xml", inputs=[None, given])
    assert (tmp_path / "model.xml").read_text() == "the author's"
    assert everything(tmp_path) == ["link.xml", "model.xml"]
    with output_folder("out", ["model.xml"]) as temporary:
        (temporary / "model.xml").write_text("new")
    assert (tmp_path / "out" / "model.xml").read_text() == "new"


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


# --- what a killed process leaves -----------------------------------------------------------------------------------


def killed_in(folder):
    """Start a process that writes a file and a folder here, and kill it in the middle."""
    code = (
        "import os, signal, sys\nfrom plantar.common.atomic import output_folder, replacing\n"
        f"with output_folder({str(folder)!r}) as out, replacing({str(folder / 'table.csv')!r}) as temporary:\n"
        "    (out / 'half').write_text('half'); temporary.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == -9
    return [p for p in folder.iterdir() if p.name.startswith(".plantar-")]


@linux
@pytest.mark.parametrize("write", [lambda p: write_text(p / "a.txt", "a"), lambda p: write_files(p, "a.txt")])
def test_the_next_run_removes_what_a_killed_one_left(tmp_path, write):
    assert len(killed_in(tmp_path)) == 2
    write(tmp_path)
    assert everything(tmp_path) == ["a.txt"]


@linux
def test_what_may_be_somebody_elses_stays(tmp_path):
    left = killed_in(tmp_path)
    machine, process = left[0].name.split("-")[1:3]
    other = f"{int(machine, 16) ^ 1:08x}"
    kept = [
        f".plantar-{other}-{process}-x",  # of another machine: whether its process lives is not known here
        f".plantar-{machine}-{os.getpid()}-x",
        f".plantar-{machine}-1-x",
        ".plantar-notes",
        ".table.csv",
    ]
    for name in kept:
        (tmp_path / name).write_text("keep")
    write_text(tmp_path / "a.txt", "a")
    assert everything(tmp_path) == sorted(["a.txt", *kept])


@linux
def test_a_link_of_such_a_name_leads_to_nothing_being_removed(tmp_path):
    (name, *_) = [p.name for p in killed_in(tmp_path / "out" if (tmp_path / "out").mkdir() is None else tmp_path)]
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "keep").write_text("keep")
    (tmp_path / "out" / f"{name}2").symlink_to(tmp_path / "mine")
    write_text(tmp_path / "out" / "a.txt", "a")
    assert everything(tmp_path) == ["mine", "mine/keep", "out", "out/a.txt"]


def test_two_that_write_at_once_do_not_remove_each_others(tmp_path):
    with output_folder(tmp_path) as one, output_folder(tmp_path) as two:
        (one / "a").write_text("a")
        (two / "b").write_text("b")
    assert everything(tmp_path) == ["a", "b"]


def test_the_folder_of_a_file_is_made_and_taken_away_on_an_error(tmp_path):
    with parent_folder(tmp_path / "a" / "b" / "run.mcap"):
        assert everything(tmp_path) == ["a", "a/b"]
    with pytest.raises(Stop), parent_folder(tmp_path / "a" / "c" / "d" / "run.mcap"):
        raise Stop
    assert everything(tmp_path) == ["a", "a/b"]
    with pytest.raises(InputError, match="it is a folder"), parent_folder(tmp_path / "a"):
        pytest.fail("the run must not start")
    (tmp_path / "file").write_text("keep")
    with pytest.raises(InputError, match="cannot write"), parent_folder(tmp_path / "file" / "x" / "run.mcap"):
        pytest.fail("the run must not start")
    assert everything(tmp_path) == ["a", "a/b", "file"]
