"""Tests of the pose of a sole in its file: it is read as it was written, and is a rotation and a place."""

from dataclasses import replace

import numpy as np
import pytest

from plantar import hex_layout, read_layout
from plantar.errors import LayoutError
from plantar.layouts.layout import mirrored
from plantar.layouts.layout_file import layout_from_dict, layout_to_dict, write_layout
from plantar.layouts.source_pose import SourcePose

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
POSE = SourcePose("h1.xml", "left_ankle_link", np.array([0.01, 0.0, -0.07]), TURN)
LAYOUT = replace(hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], name="a"), pose=POSE)


def test_a_layout_file_keeps_the_pose(tmp_path):
    pose = read_layout(write_layout(LAYOUT, tmp_path / "a.json")).pose
    assert (pose.file, pose.body) == ("h1.xml", "left_ankle_link")
    np.testing.assert_array_equal(pose.position, POSE.position)
    np.testing.assert_array_equal(pose.rotation, TURN)


def test_a_layout_without_a_pose_and_a_mirrored_one_have_none(tmp_path):
    assert read_layout(write_layout(replace(LAYOUT, pose=None), tmp_path / "a.json")).pose is None
    assert mirrored(LAYOUT).pose is None


def test_points_are_placed_and_the_frame_is_lowered_along_its_own_z():
    np.testing.assert_allclose(POSE.placed([[0.1, 0.0, 0.0]]), [[0.01, 0.1, -0.07]])
    np.testing.assert_allclose(POSE.lowered(0.02).position, [0.01, 0.0, -0.09])


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("rotation_sole_to_source", (2.0 * TURN).tolist(), "'pose.rotation' is not a rotation"),
        ("rotation_sole_to_source", (TURN * [1, 1, -1]).tolist(), "'pose.rotation' is not a rotation"),
        ("position", [0.0, 0.0], "'pose.position'"),
        ("position", [0.0, 0.0, 1e6], "farther than 1000 m"),
        ("file", 3, "'pose.file'"),
        ("body", 3, "'pose.body'"),
    ],
)
def test_a_pose_that_is_none_is_refused(field, value, message):
    source = layout_to_dict(LAYOUT)
    source["pose"] = {**source["pose"], field: value}
    with pytest.raises(LayoutError, match=message):
        layout_from_dict(source)


@pytest.mark.parametrize(("pose", "message"), [([], "not a JSON object"), ({"file": "a"}, r"'pose\.body' is missing")])
def test_a_pose_without_its_fields_is_refused(pose, message):
    with pytest.raises(LayoutError, match=message):
        layout_from_dict(layout_to_dict(LAYOUT) | {"pose": pose})
