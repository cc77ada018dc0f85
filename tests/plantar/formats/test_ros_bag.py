"""Bags with arrays, as ROS 2 writes them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar import FormatError, hex_layout
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions

from .corruption import refusals

pytest.importorskip("rosbags", reason="rosbags is not installed: pip install '.[formats]'")


@pytest.fixture(scope="module")
def layout():
    return hex_layout([[0, -0.04], [0.2, -0.04], [0.2, 0.04], [0, 0.04]], name="mine", cell_area=691e-6)


def write_bag(path: Path, topics: dict[str, np.ndarray], kind: str = "sqlite3", rate: float = 200.0) -> None:
    """A ROS 2 bag of std_msgs/Float64MultiArray."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    array: Any = store.types["std_msgs/msg/Float64MultiArray"]
    shape: Any = store.types["std_msgs/msg/MultiArrayLayout"]
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        for topic, values in topics.items():
            connection = writer.add_connection(topic, array.__msgtype__, typestore=store)
            for i, row in enumerate(values):
                if np.isnan(row).all():
                    continue  # no message then
                message = array(layout=shape(dim=[], data_offset=0), data=np.asarray(row, dtype=np.float64))
                stamp = 1_700_000_000_000_000_000 + round(i / rate * 1e9)
                writer.write(connection, stamp, store.serialize_cdr(message, array.__msgtype__))


@pytest.mark.parametrize("kind", ["sqlite3", "mcap"])
def test_a_bag_of_two_feet(tmp_path, layout, kind):
    values = np.random.default_rng(3).uniform(0.0, 90.0, size=(80, len(layout)))
    write_bag(tmp_path / "bag", {"/left_foot/forces": values, "/right_foot/forces": 2 * values}, kind)
    assert detect_format(tmp_path / "bag").name == "rosbag"
    file = next(p for p in (tmp_path / "bag").iterdir() if p.suffix in (".db3", ".mcap"))
    for path in (tmp_path / "bag", file):
        recording = read_recording(path, layout=layout)
        assert (recording.kind, recording.raw) == ("robot", False)
        assert recording.rate_hz == pytest.approx(200.0)
        assert recording.feet["left"].force == pytest.approx(values)
        assert recording.feet["right"].force == pytest.approx(2 * values)
        assert any("N is assumed from their names" in w for w in recording.warnings)
    raw = read_recording(tmp_path / "bag", options=ReadOptions(layout=layout, unit="raw"))
    assert raw.raw


def test_a_foot_that_pauses_was_not_measured_then(tmp_path):
    values = np.full((80, 8), 5.0)
    part = np.where((np.arange(80) // 20 == 1)[:, None], np.nan, values)
    write_bag(tmp_path / "bag", {"/left_foot/forces": values, "/right_foot/forces": part})
    recording = read_recording(tmp_path / "bag")
    assert np.isnan(recording.feet["right"].force).sum() == 20 * 8
    assert np.isfinite(recording.feet["left"].force).all()


def test_names_that_say_nothing_are_raw(tmp_path):
    write_bag(tmp_path / "bag", {"/cells": np.ones((20, 8)), "/few": np.ones((20, 2))})
    recording = read_recording(tmp_path / "bag")
    assert recording.raw
    assert any("raw counts" in w for w in recording.warnings)
    assert recording.feet["left"].force.shape == (20, 8)


def test_what_is_no_bag(tmp_path):
    write_bag(tmp_path / "bag", {"/few": np.ones((20, 2))})
    with pytest.raises(FormatError, match="no topic of the bag carries an array"):
        read_recording(tmp_path / "bag")
    (tmp_path / "empty").mkdir()
    with pytest.raises(FormatError, match="cannot be read"):
        detect_format(tmp_path / "empty")
    (tmp_path / "empty" / "metadata.yaml").write_text("nonsense: [")
    with pytest.raises(FormatError, match="not a ROS bag that can be read"):
        read_recording(tmp_path / "empty")


@pytest.mark.parametrize("trials", [3, pytest.param(40, marks=pytest.mark.long)])
def test_a_damaged_bag_is_one_line(tmp_path, trials):
    write_bag(tmp_path / "whole", {"/left/force": np.ones((30, 8))})
    (file,) = (tmp_path / "whole").glob("*.db3")
    refusals(file, trials, read=lambda _: read_recording(tmp_path / "whole"))
