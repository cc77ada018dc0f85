"""What `plantar sole` shows is what a percept of the same forces and distances has, at that instant."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import plantar
from plantar import InputError, Percept, Reading, hex_layout, mirrored
from plantar.recordings.recorder import Recorder

LEFT = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], cell_area=500e-6)


def forces(time: float) -> np.ndarray:
    return np.where(LEFT.positions[:, 0] > 0.05 * time, 10.0 * time, 0.0)


def distances(time: float) -> np.ndarray:
    return 0.01 * time + 0.1 * (LEFT.positions[:, 0] + 0.1)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """2 s of a left sole that is loaded more and more, and of a right one that is not; proximity only until 1 s."""
    path = tmp_path_factory.mktemp("sole") / "run.mcap"
    with Recorder(path, {}, {"left": LEFT, "right": mirrored(LEFT)}) as recorder:
        left = recorder.channel("/skin/left", [("force", len(LEFT))])
        right = recorder.channel("/skin/right", [("force", len(LEFT))])
        near = recorder.channel("/proximity/left", [("distance", len(LEFT))])
        for time in np.arange(0.0, 2.005, 0.01):
            left.write(time, forces(time))
            right.write(time, np.zeros(len(LEFT)))
            if time <= 1.0:
                near.write(time, distances(time))
    return path


def test_it_is_the_percept_of_that_instant(run):
    view = plantar.sole(run, 0.5, "left")
    same = Percept(LEFT, Reading(0.5, forces(0.5), proximity=distances(0.5)))
    found = view.as_dict()
    assert (view.side, view.time) == ("left", pytest.approx(0.5))
    assert found["cop_m"] == pytest.approx(same.position_cop_in_sole)
    assert found["wrench"] == pytest.approx(same.wrench_in_sole)
    assert found["virtual_wrench"] == pytest.approx(same.virtual_wrench_in_sole)
    assert found["convex_polygon_m"] == same.support_polygon_in_sole.tolist()
    assert found["inscribed_rectangle_m"] == same.inscribed_rectangle_in_sole.tolist()
    assert sum(len(ring) for ring in found["concave_polygon_m"]) == len(same.concave_outline_in_sole.points)
    assert [c["height_m"] for c in found["height_contours"]] == [c.height for c in same.height_contours_in_sole]


def test_by_default_the_foot_and_instant_of_the_greatest_load(run):
    loads = [forces(time).sum() for time in np.arange(0.0, 2.005, 0.01)]
    view = plantar.sole(run)
    assert view.side == "left"
    assert view.time == pytest.approx(0.01 * int(np.argmax(loads)), abs=0.006)
    assert view.percept.reading.proximity is None


def test_a_sole_without_load_has_defined_answers(run, tmp_path):
    view = plantar.sole(run, 0.5, "right")
    assert view.as_dict()["cop_m"] is None
    assert view.as_dict()["convex_polygon_m"] == []
    assert [path.name for path in view.save(tmp_path)] == ["sole_right.png", "sole_right.json"]


@pytest.mark.parametrize(
    ("asked", "words"),
    [({"at": 9.0}, "0.000 to 2.000 s"), ({"foot": "up"}, "left, right"), ({"at": float("nan")}, "time")],
)
def test_what_is_not_in_the_recording_is_refused(asked, words, run):
    with pytest.raises(InputError, match=words):
        plantar.sole(run, **asked)


def test_a_notebook_shows_a_line_and_a_figure(run):
    read = plantar.read(run)
    view = plantar.sole(read, 0.5, "left")
    time = np.arange(0.0, 10.0, 0.01)
    left = 600.0 * np.clip(np.sin(2.0 * np.pi * time) + 0.3, 0.0, None)
    walk = plantar.analyse({"left": left, "right": np.roll(left, 50), "unit": "N"}, rate_hz=100.0)
    for shown in (view, view.percept, read, walk):
        assert "\n" not in repr(shown)
        assert len(repr(shown)) < 200
        assert "object at 0x" not in repr(shown)
        assert "data:image/png;base64," in shown._repr_html_()
    assert len(repr(read.feet["left"])) < 200


def test_the_command_writes_one_picture_and_one_json(run, tmp_path):
    command = [sys.executable, "-m", "plantar", "sole", str(run), "--at", "0.5", "--json", "-o", "out"]
    done = subprocess.run(command, cwd=tmp_path, env=os.environ, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    printed = json.loads(done.stdout)
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["sole_left.json", "sole_left.png"]
    assert json.loads((tmp_path / "out" / "sole_left.json").read_text()) == {
        k: v for k, v in printed.items() if k != "files"
    }
    wrong = subprocess.run(
        [*command[:-1], "none", "--at", "9"], cwd=tmp_path, capture_output=True, text=True, timeout=600
    )
    assert (wrong.returncode, wrong.stderr.count("\n")) == (2, 1)
    assert not (tmp_path / "none").exists()
