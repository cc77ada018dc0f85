"""What is shown of a recording is what it holds, of new ones and of old."""

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader

from plantar import FormatError, grid_layout
from plantar.layouts.layout import mirrored
from plantar.recordings.foxglove import Template, frame_transform, log_message, message_of, slot
from plantar.recordings.recorder import Recorder
from plantar.viewer.page import write_page
from plantar.viewer.walk import read_walk

from .small_walk import SECONDS, WEIGHT, forces, soles, turned, write_walk


def test_a_recording_with_frames_is_shown_as_it_was_drawn(tmp_path):
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


def test_an_old_recording_shows_its_soles_where_they_were(tmp_path):
    new, old = (read_walk(write_walk(tmp_path / f"{drawn}.mcap", drawn=drawn)) for drawn in (True, False))
    assert set(old.poses) == {"sole_left", "sole_right"}
    assert old.time == pytest.approx(new.time)
    for frame in old.poses:
        assert old.poses[frame] == pytest.approx(new.poses[frame], abs=1e-9)
    assert old.shapes == old.events == old.footsteps == ()
    assert np.isnan(old.zmp).all()


def test_a_robots_own_recording_shows_its_soles_side_by_side(tmp_path):
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


def test_a_sole_that_sends_nothing_shows_no_force_and_the_log_leads_to_its_instants(tmp_path):
    with Recorder(tmp_path / "run.mcap", {}, soles()) as recorder:
        left, right = (recorder.channel(f"/skin/{side}", [("force", 8)]) for side in ("left", "right"))
        log = recorder.message_channel("/log", "foxglove.Log")
        for i in range(400):
            (left if i < 200 else right).write(5.0 + 0.01 * i, np.full(8, 50.0))
        log.write(7.0, log_message(7.0, "the left sole is gone"))
    walk = read_walk(tmp_path / "run.mcap")
    measured = {side: walk.time[np.isfinite(force).all(axis=1)] - 5.0 for side, force in walk.force.items()}
    assert measured["left"][[0, -1]] == pytest.approx([0.0, 2.08], abs=0.021)  # held for a dropout of 0.1 s
    assert measured["right"][[0, -1]] == pytest.approx([1.91, 3.99], abs=0.021)
    write_page([tmp_path / "run.mcap"], tmp_path / "view.html")
    assert re.findall(r'data-time="([\d.]+)">([^<]*)<', (tmp_path / "view.html").read_text()) == [("2.000", "2.00 s")]


def test_what_has_no_soles_is_refused_in_a_line(tmp_path):
    path = tmp_path / "other.mcap"
    with Recorder(path) as recorder:
        recorder.channel("/joints", [("position", 2)]).write(0.0, np.zeros(2))
    with pytest.raises(FormatError, match="no taxel forces"):
        read_walk(path)


def test_every_rotation_has_its_quaternion():
    from plantar.viewer.walk import _quaternion

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
    found = np.array([_quaternion(turn) for turn in turns])
    assert np.abs(np.einsum("ni,ni->n", found, wanted)) == pytest.approx(1.0, abs=1e-12)


def other_library(message: bytes) -> bytes:
    """Frames as other protobuf libraries write them: times as short as they can be, and zeros left out."""
    return bytes(message_of("foxglove.FrameTransforms", message).SerializeToString())


def rewritten(path: Path, change: Callable[[str, bytes], bytes]) -> Path:
    """A copy of a recording whose messages were changed."""
    out = path.with_name(f"changed-{path.name}")
    with path.open("rb") as stream, Recorder(out, {"scene": "test"}, soles()) as recorder:
        channels: dict[str, Any] = {}
        for schema, channel, message in make_reader(stream).iter_messages():
            assert schema is not None
            if channel.topic not in channels and schema.name.startswith("foxglove"):
                channels[channel.topic] = recorder.message_channel(channel.topic, schema.name)
            elif channel.topic not in channels:
                fields = [(name, int(n)) for n, name in re.findall(r"float64\[(\d+)\] (\w+)", schema.data.decode())]
                channels[channel.topic] = recorder.channel(channel.topic, fields)
            data = change(channel.topic, message.data)
            values = data if schema.name.startswith("foxglove") else np.frombuffer(data, "<f8", offset=4)
            channels[channel.topic].write(message.log_time * 1e-9, values)
    return out


def test_frames_that_another_library_wrote_are_where_they_were(tmp_path):
    path = write_walk(tmp_path / "run.mcap")
    other = rewritten(path, lambda topic, data: other_library(data) if topic == "/tf" else data)
    ours, theirs = read_walk(path), read_walk(other)
    assert theirs.warnings == ()
    assert theirs.time == pytest.approx(ours.time)
    for frame, poses in ours.poses.items():
        assert theirs.poses[frame] == pytest.approx(poses)


def test_damaged_messages_of_what_is_drawn_are_left_out_and_counted(tmp_path):
    path = write_walk(tmp_path / "run.mcap")
    for topic in ("/tf", "/scene/world", "/scene/balance", "/scene/footsteps", "/log"):
        damages = (b"\x0a\xff\xff\xff\xff\x0f", b"\x0a\x05ab", b"\x09\x00", b"\x08" + b"\xff" * 11)
        unknown = (b"\x08\x80\x80\x80\x80\x80\x40", b"\x0a\x02\x18\x05", b"")  # fields of a later schema, or none
        for damage in (*damages, *unknown):
            found = read_walk(
                rewritten(path, lambda t, data, topic=topic, damage=damage: damage if t == topic else data)
            )
            assert found.force["left"].shape[1] == 8
            assert found.warnings or damage in unknown, (topic, damage)


def test_random_changes_of_a_recording_are_shown_or_refused(tmp_path):
    rng, good = np.random.default_rng(11), write_walk(tmp_path / "run.mcap")
    for _ in range(15):
        bad = rewritten_at_random(good, rng)
        write_page([bad], tmp_path / "view.html")
        assert (tmp_path / "view.html").read_text(encoding="utf-8").count("</html>") == 1


def rewritten_at_random(path: Path, rng: np.random.Generator) -> Path:
    """A recording some of whose drawn messages have other bytes; its checksums hold."""

    def change(topic: str, data: bytes) -> bytes:
        if topic.startswith(("/skin", "/truth")) or rng.random() < 0.9:
            return data
        bytes_of = bytearray(data)
        for at in rng.integers(0, len(data), size=rng.integers(1, 4)):
            bytes_of[at] = rng.integers(0, 256)
        return bytes(bytes_of[: rng.integers(1, len(data) + 1)] if rng.random() < 0.3 else bytes_of)

    return rewritten(path, change)


def test_a_long_recording_is_shown_at_fewer_times_with_what_held_at_each(tmp_path, monkeypatch):
    path = tmp_path / "long.mcap"
    with Recorder(path, {"mass_kg": 40.0}, soles()) as recorder:
        channel = recorder.channel("/skin/left", [("force", 8)])
        for i in range(20_000):
            channel.write(0.005 * i, np.full(8, float(i % 50)))
    monkeypatch.setattr("plantar.viewer.walk._MOST", 3000)
    walk = read_walk(path)
    assert len(walk.time) == 3000
    assert (walk.force["left"][:, 0] == np.floor(walk.time / 0.005 + 1e-6) % 50).all()


@pytest.mark.long
def test_an_hour_is_shown_with_less_than_500_mb(tmp_path):
    layout = grid_layout([[-0.13, -0.05], [0.13, -0.05], [0.13, 0.05], [-0.13, 0.05]], pitch=(0.0118, 0.0118))
    path, names = tmp_path / "hour.mcap", ["sole_left", "sole_right", *(f"link_{i}" for i in range(18))]
    frames = Template(*(frame_transform(name, [slot(0)] * 3, (0.0, 0.0, 0.0, 1.0)) for name in names))
    with Recorder(path, {"mass_kg": 60.0}, {"left": layout, "right": mirrored(layout)}) as recorder:
        skin = [recorder.channel(f"/skin/{side}", [("force", len(layout))]) for side in ("left", "right")]
        tf = recorder.message_channel("/tf", "foxglove.FrameTransforms")
        force = np.random.default_rng(3).uniform(0.0, 5.0, (500, len(layout))).round(1)
        for i in range(360_000):
            for channel in skin:
                channel.write(0.01 * i, force[i % 500])
            if i % 2 == 0:
                tf.write(0.01 * i, frames.filled(0.01 * i, [1e-6 * i]))
    code = (
        "import sys; from plantar.viewer.page import write_page; write_page(sys.argv[1:2], sys.argv[2]); "
        "print(int(open('/proc/self/status').read().split('VmHWM:')[1].split()[0]) / 1e3)"  # not the parent's
    )
    command = [sys.executable, "-c", code, str(path), str(tmp_path / "view.html")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert float(done.stdout) < 500.0
    assert (tmp_path / "view.html").stat().st_size < 100e6
