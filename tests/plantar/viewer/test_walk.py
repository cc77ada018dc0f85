"""What is shown of a recording is what it holds, of new ones and of old."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.recordings.recorder import Recorder
from plantar.viewer.walk import read_walk

from .small_walk import SECONDS, WEIGHT, forces, soles, turned, write_walk


def test_a_recording_with_frames_is_shown_as_it_was_drawn(tmp_path: Path) -> None:
    walk = read_walk(write_walk(tmp_path / "run.mcap"))
    assert walk.name == "test, box, seed 4"
    assert walk.time == pytest.approx(np.arange(0, SECONDS + 0.01, 0.02))
    assert walk.poses["trunk"][50] == pytest.approx([0.25, 0.0, 0.8, *turned(0.2)])
    assert walk.force["left"][25] == pytest.approx(forces(0.5)["left"])
    assert walk.zmp[10] == pytest.approx([0.05, 0.02, 0.0])
    assert np.isnan(walk.zmp[60]).all()  # drawn, but with no colour: there was none
    assert walk.polygon[10, 3] == pytest.approx([0.05, 0.1, 0.0])
    assert np.isnan(walk.polygon[60]).all()
    kinds = {entity.name: [shape.kind for shape in entity.shapes] for entity in walk.shapes}
    assert kinds == {"world": ["cube"], "trunk": ["cube", "cylinder", "triangles"]}
    mesh = walk.shapes[1].shapes[2]
    assert mesh.indices == (0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3)
    assert mesh.points[3] == (0.0, 0.0, 0.6)
    assert [(time, [e.name for e in shown]) for time, shown in walk.footsteps] == [
        (0.0, ["footstep 0"]),
        (1.0, ["footstep 1"]),
        (2.0, ["footstep 2"]),
    ]
    assert [(e.time, e.level) for e in walk.events] == [(0.5, "info"), (1.5, "error")]
    assert walk.weight == pytest.approx(WEIGHT)


def test_an_old_recording_shows_its_soles_where_they_were(tmp_path: Path) -> None:
    new, old = (read_walk(write_walk(tmp_path / f"{drawn}.mcap", drawn=drawn)) for drawn in (True, False))
    assert set(old.poses) == {"sole_left", "sole_right"}
    assert old.time == pytest.approx(new.time)
    for frame in old.poses:
        assert old.poses[frame] == pytest.approx(new.poses[frame], abs=1e-9)
    assert old.shapes == old.events == old.footsteps == ()
    assert np.isnan(old.zmp).all()


def test_a_robots_own_recording_shows_its_soles_side_by_side(tmp_path: Path) -> None:
    path = tmp_path / "mine.mcap"
    with Recorder(path, {}, soles()) as recorder:
        channel = recorder.channel("/skin/right", [("force", 8)])
        for i in range(20):
            channel.write(3.0 + 0.1 * i, np.full(8, 10.0 * i))
    walk = read_walk(path)
    assert walk.name == "mine"
    assert list(walk.poses) == ["sole_right"]
    assert (walk.poses["sole_right"][:, 1] == -0.1).all()
    assert walk.force["right"][-1] == pytest.approx(np.full(8, 190.0))
    assert 0.0 < walk.weight <= 8 * 190.0  # nobody says it: nine tenths of the time the soles carry less


def test_what_has_no_soles_is_refused_in_a_line(tmp_path: Path) -> None:
    path = tmp_path / "other.mcap"
    with Recorder(path) as recorder:
        recorder.channel("/joints", [("position", 2)]).write(0.0, np.zeros(2))
    with pytest.raises(FormatError, match="no taxel forces"):
        read_walk(path)


def test_every_rotation_has_its_quaternion() -> None:
    from plantar.viewer.walk import _quaternions

    rng = np.random.default_rng(5)
    wanted = rng.normal(size=(300, 4))
    wanted[:4] = np.eye(4)  # half turns about each axis, and none
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    x, y, z, w = wanted.T
    turns = np.stack(
        [
            np.column_stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)]),
            np.column_stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)]),
            np.column_stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]),
        ],
        axis=1,
    )
    assert np.abs(np.einsum("ni,ni->n", _quaternions(turns), wanted)) == pytest.approx(1.0, abs=1e-12)
