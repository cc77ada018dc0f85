"""The recorder: what it writes is MCAP that the library reads too, and a killed run keeps its chunks."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from plantar import RecordingError, hex_layout
from plantar.recordings import foxglove
from plantar.recordings.foxglove import Template, slot
from plantar.recordings.mcap_content import McapContent, message_values
from plantar.recordings.recorder import Recorder
from plantar.recordings.recording import read_mcap, take_mcap


def write_walk(path: Path, seconds: float = 2.0) -> np.ndarray:
    """Two topics at two rates; returns the forces written."""
    force = np.random.default_rng(3).normal(size=(round(seconds * 250), 42))
    with Recorder(path, {"robot": "h1", "seed": 3}) as recorder:
        skin = recorder.channel("/skin/left", [("force", 42)])
        body = recorder.channel("/truth/body", [("com", 3), ("tilt", 1)])
        for i, row in enumerate(force):
            skin.write(i * 0.004, row)
            if i % 5 == 0:
                body.write(i * 0.004, np.array([1.0, 2.0, 3.0, i]))
    return force


def test_values_and_times_come_back_exactly(tmp_path):
    force = write_walk(tmp_path / "run.mcap")
    recording = read_mcap(tmp_path / "run.mcap")
    assert recording.warnings == ()
    assert recording.metadata == {"robot": "h1", "seed": 3}
    skin = recording.topics["/skin/left"]
    assert (skin.fields["force"] == force).all()
    assert np.abs(skin.time - np.arange(500) * 0.004).max() < 1e-9
    body = recording.topics["/truth/body"]
    assert body.fields["com"].shape == (100, 3)
    assert body.fields["tilt"][:, 0].tolist() == list(range(0, 500, 5))


def test_mcap_library_reads_and_seeks_the_file(tmp_path):
    write_walk(tmp_path / "run.mcap")
    with (tmp_path / "run.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary.statistics.message_count == 600
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) >= 4
        found = list(reader.iter_messages(topics=["/skin/left"], starting_at=10**9))
    assert [message.log_time for _, _, message in found] == [10**9 + i * 4_000_000 for i in range(250)]
    schema, _, message = found[0]
    assert (schema.encoding, schema.data) == ("ros2msg", b"float64[42] force")
    assert message.data[:4] == b"\x00\x01\x00\x00"
    assert len(message.data) == 4 + 42 * 8


def test_messages_for_viewers_are_kept_beside_the_numbers_and_read_where_they_are_wanted(tmp_path):
    path = tmp_path / "run.mcap"
    said = [foxglove.log_message(0.1 * i, f"line {i}") for i in range(20)]
    ball = Template(
        foxglove.entity("ball", "world", foxglove.sphere(foxglove.pose([slot(0)] * 3), (1.0,) * 3, (1.0,) * 4))
    )
    with Recorder(path) as recorder:
        log = recorder.message_channel("/log", "foxglove.Log")
        scene = recorder.template_channel("/scene", "foxglove.SceneUpdate", ball, lambda rows: 2.0 * rows)
        numbers = recorder.channel("/numbers", [("a", 1)])
        for i, message in enumerate(said):
            log.write(0.1 * i, message)
            scene.write(0.1 * i, np.array([float(i)]))
            numbers.write(0.1 * i, np.array([float(i)]))
    plain = read_mcap(path)
    assert plain.warnings == ()
    assert list(plain.topics) == ["/numbers"]
    taken: dict[str, list[tuple[float, bytes]]] = {"/log": [], "/scene": [], "/numbers": []}
    content = McapContent({t: lambda time, data, fields, t=t: taken[t].append((time, data)) for t in taken})
    take_mcap(path, content)
    assert not content.topics
    assert [message for _, message in taken["/log"]] == said
    assert [time for time, _ in taken["/scene"]] == pytest.approx([0.1 * i for i in range(20)])
    assert [m for _, m in taken["/scene"]] == [ball.filled(0.1 * i, [2.0 * i]) for i in range(20)]
    assert [message_values(m, [("a", 1)]).tolist() for _, m in taken["/numbers"]] == [[float(i)] for i in range(20)]


def test_a_schema_that_is_unknown_and_a_topic_that_exists_are_refused(tmp_path):
    with Recorder(tmp_path / "run.mcap") as recorder:
        channel = recorder.message_channel("/log", "foxglove.Log")
        with pytest.raises(RecordingError, match=r"foxglove\.Log"):
            recorder.message_channel("/other", "foxglove.Grid")
        with pytest.raises(RecordingError, match="not new"):
            recorder.message_channel("/log", "foxglove.Log")
        with pytest.raises(RecordingError, match="allowed: 0 to"):
            channel.write(-1.0, b"")


def test_layouts_are_kept(tmp_path):
    layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
    with Recorder(tmp_path / "run.mcap", layouts={"left": layout}):
        pass
    back = read_mcap(tmp_path / "run.mcap").layouts["left"]
    assert (back.positions == layout.positions).all()
    assert back.corners == layout.corners


def test_truncated_file_reads_up_to_its_last_whole_chunk(tmp_path):
    force = write_walk(tmp_path / "run.mcap")
    whole = (tmp_path / "run.mcap").read_bytes()
    counts = []
    for fraction in (0.2, 0.5, 0.8):
        cut = tmp_path / f"cut{fraction}.mcap"
        cut.write_bytes(whole[: int(len(whole) * fraction)])
        recording = read_mcap(cut)
        assert any("cut short" in w for w in recording.warnings)
        table = recording.topics.get("/skin/left")
        n = 0 if table is None else len(table)
        if table is not None:
            assert (table.fields["force"] == force[:n]).all()
        assert abs(n - len(force) * fraction) <= 126  # one chunk of 0.5 s
        counts.append(n)
    assert counts == sorted(counts)
    assert counts[-1] > counts[0]


def test_killed_writer_leaves_a_readable_file(tmp_path):
    path = tmp_path / "killed.mcap"
    code = (
        "import sys, numpy as np\n"
        "from plantar.recordings.recorder import Recorder\n"
        "recorder = Recorder(sys.argv[1], {'robot': 'h1'})\n"
        "channel = recorder.channel('/skin/left', [('force', 42)])\n"
        "for i in range(10**9):\n"
        "    channel.write(i * 0.004, np.full(42, float(i)))\n"
        "    if i == 1000:\n"
        "        print('ready', flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.02)
    finally:
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        process.stdout.close()
    recording = read_mcap(path)
    force = recording.topics["/skin/left"].fields["force"]
    assert len(force) >= 1000 - 125
    assert (force[:, 0] == np.arange(len(force))).all()
    assert any("cut short" in w for w in recording.warnings)


def test_chunks_reach_the_disk_while_the_run_goes_on(tmp_path):
    path = tmp_path / "run.mcap"
    with Recorder(path, chunk_duration=0.5) as recorder:
        channel = recorder.channel("/a", [("x", 1)])
        for i in range(251):
            channel.write(i * 0.01, np.array([float(i)]))
        assert len(read_mcap(path).topics["/a"]) >= 200
    assert len(read_mcap(path).topics["/a"]) == 251


def test_bad_calls_name_what_is_wrong(tmp_path):
    with pytest.raises(RecordingError, match="choose a folder"):
        Recorder(tmp_path / "missing" / "run.mcap")
    with pytest.raises(RecordingError, match="JSON"):
        Recorder(tmp_path / "run.mcap", {"x": object()})
    with Recorder(tmp_path / "run.mcap") as recorder:
        channel = recorder.channel("/a", [("x", 3)])
        with pytest.raises(RecordingError, match=r"takes 3 values a message; got shape \(3, 1\)"):
            channel.write(0.0, np.zeros((3, 1)))
        with pytest.raises(RecordingError, match=r"takes 3 values a message; got shape \(2,\)"):
            channel.write(0.0, np.zeros(2))
        with pytest.raises(RecordingError, match=r"takes 3 values a message; got shape \(3, 2\)"):
            channel.write(0.0, np.zeros((3, 2)))
        parts = recorder.channel("/b", [("x", 3), ("y", 1)])
        for message in ((np.zeros(2), 1.0), (np.zeros(3), 1.0, 2.0)):
            with pytest.raises(RecordingError, match=r"topic /b takes values of 2 fields"):
                parts.write(0.0, *message)
        parts.write(0.0, np.nan, 7)
        drawn = recorder.message_channel("/c", next(iter(foxglove.SCHEMAS)))
        for many in ((), (b"a", b"b")):
            with pytest.raises(RecordingError, match=f"topic /c got {len(many)} message.*one message at a time"):
                drawn.write(0.0, *many)
        with pytest.raises(RecordingError, match="topic /b takes values of 2 fields"):
            parts.write(0.0)
        for bad in (-1.0, float("nan"), float("inf")):
            with pytest.raises(RecordingError, match="allowed: 0 to"):
                channel.write(bad, np.zeros(3))
        with pytest.raises(RecordingError, match="not new"):
            recorder.channel("/a", [("y", 1)])
        for fields in ([], [("x", 0)], [("Bad name", 1)], [("x", 1), ("x", 1)]):
            with pytest.raises(RecordingError, match=r"allowed|differ"):
                recorder.channel("/b", fields)


def test_a_full_channel_is_flushed_before_its_time(tmp_path):
    with Recorder(tmp_path / "run.mcap", chunk_duration=1e6) as recorder:
        channel = recorder.channel("/a", [("x", 1)])
        for i in range(1000):
            channel.write(i * 1e-3, np.array([float(i)]))
    assert read_mcap(tmp_path / "run.mcap").topics["/a"].fields["x"][:, 0].tolist() == list(range(1000))


def test_a_message_is_cheap(tmp_path):
    values = np.random.default_rng(0).normal(size=42)
    best = np.inf
    for _ in range(3):
        with Recorder(tmp_path / "run.mcap") as recorder:
            channel = recorder.channel("/skin/left", [("force", 42)])
            start = time.process_time()
            for i in range(5000):
                channel.write(i * 0.004, values)
            best = min(best, (time.process_time() - start) / 5000)
    assert best < 10e-6  # measured 1.5 to 3 us; 5 % of a second at six times real time is 4.9 us


def record(path: Path, messages: int, error: BaseException | None) -> None:
    """A run of so many messages of 100 values, which may end in an error."""
    with Recorder(path) as recorder:
        channel = recorder.channel("/a", [("x", 100)])
        for i in range(messages):
            channel.write(0.1 * i, np.random.default_rng(i).normal(size=100))  # which does not compress
        if error is not None:
            raise error


@pytest.mark.parametrize("old", [True, False])
@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt])
@pytest.mark.parametrize("messages", [0, 1])
def test_a_run_that_fails_keeps_what_it_recorded_and_else_leaves_what_there_was(tmp_path, messages, error, old):
    path = tmp_path / "run.mcap"
    if old:
        path.write_bytes(b"old")
    with pytest.raises(error):
        record(path, messages, error())
    assert [p.name for p in tmp_path.iterdir()] == ["run.mcap"] * (old or messages > 0)
    if messages:
        assert len(read_mcap(path).topics["/a"]) == 1
    elif old:
        assert path.read_bytes() == b"old"


def test_a_full_disk_leaves_an_old_recording_alone(tmp_path):
    resource = pytest.importorskip("resource")
    path = tmp_path / "run.mcap"
    path.write_bytes(b"old")
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, hard))
        with pytest.raises(RecordingError, match=r"run\.mcap"):
            record(path, 50, None)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, handler)
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["run.mcap"]


def test_a_folder_is_no_name_for_a_recording(tmp_path):
    with pytest.raises(RecordingError, match="it is a folder"):
        Recorder(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_chunks_are_compressed(tmp_path):
    rows = np.round(np.random.default_rng(0).normal(size=(2000, 6)), 3)
    with Recorder(tmp_path / "run.mcap") as recorder:
        channel = recorder.channel("/a", [("values", 6)])
        for k, row in enumerate(rows):
            channel.write(0.005 * k, row)
    with (tmp_path / "run.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert {c.compression for c in summary.chunk_indexes} == {"zstd"}
    sizes = np.array([(c.compressed_size, c.uncompressed_size) for c in summary.chunk_indexes]).sum(axis=0)
    assert sizes[0] < 0.75 * sizes[1]
    assert np.array_equal(read_mcap(tmp_path / "run.mcap").topics["/a"].fields["values"], rows)
