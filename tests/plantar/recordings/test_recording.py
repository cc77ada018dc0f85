"""Recordings read back, exported, and damaged."""

import json
from io import BytesIO

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from plantar import FormatError, InputError, hex_layout, read_layout
from plantar.recordings.recorder import Recorder
from plantar.recordings.recording import read_mcap


@pytest.fixture
def run(tmp_path):
    """A small recording with a layout and two topics."""
    layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
    path = tmp_path / "run.mcap"
    with Recorder(path, {"robot": "h1"}, {"left": layout}) as recorder:
        skin = recorder.channel("/skin/left", [("force", len(layout)), ("proximity", len(layout))])
        body = recorder.channel("/truth/body", [("com", 3), ("tilt", 1)])
        for i in range(400):
            skin.write(i * 0.004, np.arange(2.0 * len(layout)) + i / 3)
            body.write(i * 0.004, np.array([0.1, 0.2, 0.8, 1e-3 * i]))
    return path


def test_npz_export_holds_every_table(run, tmp_path):
    recording = read_mcap(run)
    out = recording.to_npz(tmp_path / "run")
    assert out == tmp_path / "run.npz"
    with np.load(out) as arrays:
        assert (arrays["skin/left/force"] == recording.topics["/skin/left"].fields["force"]).all()
        assert (arrays["truth/body/time"] == recording.topics["/truth/body"].time).all()
        assert json.loads(str(arrays["metadata"])) == {"robot": "h1"}
        assert json.loads(str(arrays["layout_left"]))["side"] == "left"


def test_csv_export_keeps_all_digits_and_the_layout(run, tmp_path):
    recording = read_mcap(run)
    names = {p.name for p in recording.to_csv(tmp_path / "csv")}
    assert names == {"metadata.json", "layout_left.json", "skin_left.csv", "truth_body.csv"}
    text = (tmp_path / "csv" / "truth_body.csv").read_text()
    assert text.splitlines()[0] == "time_s,com_0,com_1,com_2,tilt"
    back = np.loadtxt(tmp_path / "csv" / "skin_left.csv", delimiter=",", skiprows=1)
    n = len(recording.layouts["left"])
    assert (back[:, 1 : 1 + n] == recording.topics["/skin/left"].fields["force"]).all()
    assert len(read_layout(tmp_path / "csv" / "layout_left.json")) == n


def test_an_export_that_would_lose_a_table_is_refused(tmp_path):
    with Recorder(tmp_path / "run.mcap") as recorder:
        for topic, field in (("/arm/left", "q"), ("/arm_left", "q"), ("/clock", "time")):
            recorder.channel(topic, [(field, 1)]).write(0.0, np.ones(1))
    with pytest.raises(InputError, match="topics /arm/left, /arm_left would be one CSV file"):
        read_mcap(tmp_path / "run.mcap").to_csv(tmp_path / "csv")
    with pytest.raises(InputError, match="topic /clock has a field 'time'"):
        read_mcap(tmp_path / "run.mcap").to_npz(tmp_path / "run.npz")
    assert {path.name for path in tmp_path.iterdir()} == {"run.mcap"}


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"", "empty"),
        (b"hello, world\n" * 40, "not an MCAP"),
        (bytes([137, 77, 67, 65, 80, 48, 13, 10]), "holds nothing"),
        (bytes([137, 77, 67, 65, 80, 48, 13, 10]) + b"\xff" * 100, "holds nothing"),
    ],
)
def test_foreign_and_empty_files_are_named(tmp_path, content, text):
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    with pytest.raises(FormatError, match=text) as caught:
        read_mcap(path)
    assert "\n" not in str(caught.value)


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    for path in (tmp_path / "none.mcap", tmp_path):
        with pytest.raises(FormatError, match="cannot be read"):
            read_mcap(path)


def test_random_corruption_never_gives_anything_but_a_format_error(run, tmp_path):
    whole = run.read_bytes()
    truth = read_mcap(run).topics["/skin/left"].fields["force"]
    random = np.random.default_rng(11)
    read = 0
    for trial in range(50):
        data = bytearray(whole)
        for at in random.integers(0, len(data) if trial % 2 else 3000, size=random.integers(1, 20)):
            data[at] = random.integers(0, 256)
        path = tmp_path / "bad.mcap"
        path.write_bytes(bytes(data))
        try:
            recording = read_mcap(path)
        except FormatError:
            continue
        read += 1
        table = recording.topics.get("/skin/left")
        if table is None or len(table) < len(truth):
            assert recording.warnings
        elif "force" in table.fields:  # a damaged chunk is left out, never passed on as data
            assert (table.fields["force"] == truth).all()
    assert read > 25


@pytest.mark.parametrize("compression", list(CompressionType))
def test_files_of_other_writers_are_read(tmp_path, compression):
    path = tmp_path / "other.mcap"
    stream = BytesIO()
    writer = Writer(stream, compression=compression)
    writer.start("ros2")
    floats = writer.register_schema("a/msg/B", "ros2msg", b"# comment\nfloat64 x # metres\nfloat64[2] y\n")
    text = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
    a = writer.register_channel("/a", "cdr", floats)
    b = writer.register_channel("/b", "cdr", text)
    for i in range(5):
        header = b"\x00\x00\x00\x00" if i == 3 else b"\x00\x01\x00\x00"
        values = np.array([i, 2.0, 3.0], dtype=">f8" if i == 3 else "<f8")
        writer.add_message(a, i * 10**7, header + values.tobytes(), i * 10**7)
        writer.add_message(b, i * 10**7, b"\x00\x01\x00\x00text", i * 10**7)
    writer.add_message(a, 10**9, b"\x00\x01\x00\x00short", 10**9)
    writer.finish()
    path.write_bytes(stream.getvalue())
    recording = read_mcap(path)
    assert list(recording.topics) == ["/a"]
    assert recording.topics["/a"].fields["x"][:, 0].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert recording.topics["/a"].fields["y"].shape == (5, 2)
    assert any("/b is skipped" in w and "std_msgs/msg/String" in w for w in recording.warnings)
    assert any("1 message(s) of another size" in w for w in recording.warnings)
