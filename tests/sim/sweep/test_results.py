"""A table that only grows: whole rows, each run once, whatever happened to the process that wrote it."""

import csv
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from plantar.errors import InputError
from plantar.sim.sweep.results import open_results

IDENTITY = {"scene": "flat", "axes": ["friction", "direction"]}
INPUTS = {"h1": {"plantar": "1.0", "scene file flat.toml": "9f", "layout layout_left.json": "e0"}}
AXES = ("friction", "direction")
COLUMNS = ("completed", "error")


def row(friction: str, seed: int, error: Any = "", direction: str = "left") -> dict[str, Any]:
    return {"friction": friction, "direction": direction, "seed": seed, "completed": True, "error": error}


def filled(folder: Path, count: int = 3) -> bytes:
    """Bytes of a table with some rows, the last with an error text of all that needs quoting."""
    with open_results(folder, IDENTITY, INPUTS, AXES, COLUMNS) as results:
        for seed in range(count):
            results.append(row("0.7", seed, 'said "no", twice\nand ended' if seed == count - 1 else ""))
    return (folder / "results.csv").read_bytes()


def test_rows_come_back_as_they_were_given(tmp_path):
    filled(tmp_path)
    with open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS) as results:
        assert list(results.rows) == [(("0.7", "left"), seed) for seed in range(3)]
        assert results.rows[("0.7", "left"), 2]["error"] == 'said "no", twice and ended'
    with (tmp_path / "results.csv").open(newline="") as file:
        assert [r["error"] for r in csv.DictReader(file)] == ["", "", 'said "no", twice and ended']
    assert sorted(p.name for p in tmp_path.iterdir()) == ["results.csv", "sweep.json"]


def test_a_table_that_is_cut_anywhere_keeps_its_whole_rows(tmp_path):
    """A killed writer leaves any part of its last row; no part of one counts, also none that looks whole."""
    data = filled(tmp_path)
    head = data.index(b"\n") + 1
    for length in range(head, len(data) + 1):
        for tail in (b"", b"\0\0\0"):  # after a power cut a file may be longer than what was written
            (tmp_path / "results.csv").write_bytes(data[:length] + tail)
            with open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS) as results:
                whole = data[:length].count(b"\n") - 1
                assert len(results.rows) == whole
                for seed in range(whole, 4):
                    results.append(row("0.7", seed))
            lines = (tmp_path / "results.csv").read_bytes().split(b"\n")
            assert len(lines) == 1 + 4 + 1
            assert lines[: 1 + whole] == data.split(b"\n")[: 1 + whole]


def test_a_value_is_found_however_it_is_written(tmp_path):
    filled(tmp_path)
    path = tmp_path / "results.csv"
    path.write_bytes(path.read_bytes().replace(b"0.7,left,1", b"0.70,'left',1").replace(b"\n", b"\r\n"))
    with open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS) as results:
        assert list(results.rows) == [(("0.7", "left"), seed) for seed in range(3)]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ((b"0.7,left,1,", b"0.7,left,0,"), ("line 3", "has one already")),
        ((b"0.7,left,1,", b"0.70,left,0,"), ("line 3", "has one already")),
        ((b"0.7,left,1,True,", b"0.7,left,1,True"), ("line 3", "no row")),
        ((b"0.7,left,1,", b"0.7,left,x,"), ("line 3", "no row")),
        ((b"completed,", b"finished,"), ("other columns",)),
        ((b"left", b"\xff"), ("cannot be used", "utf-8", "-o")),
    ],
)
def test_rows_that_cannot_be_are_not_dropped_in_silence(tmp_path, change, words):
    data = filled(tmp_path).replace(*change)
    (tmp_path / "results.csv").write_bytes(data)
    with pytest.raises(InputError) as caught, open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS):
        pass
    assert all(word in str(caught.value) for word in words), caught.value
    assert "\n" not in str(caught.value)
    assert (tmp_path / "results.csv").read_bytes() == data


def test_another_sweep_or_results_without_a_sweep_are_refused(tmp_path):
    data = filled(tmp_path)
    with (
        pytest.raises(InputError, match="another sweep"),
        open_results(tmp_path, {"scene": "push", "axes": []}, INPUTS, AXES, COLUMNS),
    ):
        pass
    (tmp_path / "sweep.json").unlink()
    with pytest.raises(InputError, match="is there without"), open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS):
        pass
    assert (tmp_path / "results.csv").read_bytes() == data


@pytest.mark.parametrize(
    ("now", "words"),
    [
        ({"plantar": "1.1"}, "plantar was 1.0 and is 1.1"),
        ({"scene file flat.toml": "00"}, "scene file flat.toml has changed"),
        (
            {"layout layout_left.json": "00", "plantar": "2"},
            "plantar was 1.0 and is 2, layout layout_left.json has changed",
        ),
        ({"model file knee.stl": "00"}, "model file knee.stl is new"),
    ],
)
def test_inputs_that_changed_are_named(tmp_path, now, words):
    data = filled(tmp_path)
    inputs = {"h1": INPUTS["h1"] | now, "another": {"plantar": "1.0"}}
    with pytest.raises(InputError) as caught, open_results(tmp_path, IDENTITY, inputs, AXES, COLUMNS):
        pass
    assert str(caught.value).startswith(words)
    assert str(caught.value).endswith(f" since {tmp_path} was begun; bring that back, or choose another folder with -o")
    assert (tmp_path / "results.csv").read_bytes() == data


def test_another_robot_may_join_and_is_remembered(tmp_path):
    filled(tmp_path)
    for robots in ({"nao": {"plantar": "1.0"}}, INPUTS):
        with open_results(tmp_path, IDENTITY, robots, AXES, COLUMNS) as results:
            assert len(results.rows) == 3
    changed = {"nao": {"plantar": "1.1"}}
    with (
        pytest.raises(InputError, match=r"plantar was 1\.0 and is 1\.1"),
        open_results(tmp_path, IDENTITY, changed, AXES, COLUMNS),
    ):
        pass


@pytest.mark.parametrize("text", ["", "[]", "3", '{"scene": "flat"}', '{"inputs": 3}', '{"inputs": {"h1": 3}}'])
def test_a_plan_that_is_none_is_refused(tmp_path, text):
    data = filled(tmp_path)
    (tmp_path / "sweep.json").write_text(text)
    with pytest.raises(InputError, match=r"-o|sweep\.json"), open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS):
        pass
    assert (tmp_path / "results.csv").read_bytes() == data


def test_a_full_disk_keeps_the_rows_before(tmp_path, monkeypatch):
    before = filled(tmp_path)
    write = os.write
    with open_results(tmp_path, IDENTITY, INPUTS, AXES, COLUMNS) as results:
        monkeypatch.setattr("os.write", lambda handle, data: write(handle, data[:5]))
        with pytest.raises(InputError, match=r"cannot be written .*space"):
            results.append(row("0.7", 3))
        assert (tmp_path / "results.csv").read_bytes() == before
        monkeypatch.undo()
        results.append(row("0.7", 3))
        with pytest.raises(ValueError, match="second row"):
            results.append(row("0.70", 3))
    assert (tmp_path / "results.csv").read_bytes() == before + b"0.7,left,3,True,\n"


def test_a_folder_that_cannot_be_is_one_line(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"cannot be used .*-o"), open_results(tmp_path / "file", {}, {}, (), ()):
        pass


HOLD = """
import sys
from pathlib import Path
from plantar.sim.sweep.results import open_results
with open_results(Path(sys.argv[1]), {}, {}, (), ("completed",)):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_a_second_owner_is_refused_until_the_first_has_ended(tmp_path, repository):
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=repository
    )
    assert holder.stdin is not None
    assert holder.stdout is not None
    with holder.stdin, holder.stdout:
        assert holder.stdout.readline() == b"held\n"
        with (
            pytest.raises(InputError, match=r"another process writes to .*choose another folder"),
            open_results(tmp_path, {}, {}, (), ("completed",)),
        ):
            pass
        holder.kill()
        holder.wait()
    with open_results(tmp_path, {}, {}, (), ("completed",)) as table:
        table.append({"seed": 1, "completed": True})


def test_a_sweep_that_was_killed_before_its_plan_was_written_begins_again(tmp_path):
    (tmp_path / "results.csv").write_text("seed,comp")
    with open_results(tmp_path, {}, {}, (), ("completed",)) as table:
        assert table.rows == {}
    (tmp_path / "sweep.json").unlink()
    with open_results(tmp_path, {}, {}, (), ("completed",)) as table:
        assert table.rows == {}


def test_a_folder_that_takes_no_lock_is_one_line(tmp_path, monkeypatch):
    def no_locks(*_: object) -> None:
        raise OSError(95, os.strerror(95))

    monkeypatch.setattr("fcntl.flock", no_locks)
    with (
        pytest.raises(InputError, match=r"cannot be locked .*not supported.*choose"),
        open_results(tmp_path, {}, {}, (), ()),
    ):
        pass
