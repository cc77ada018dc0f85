"""Tests of rotations as models write them, against scipy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.errors import FootError
from plantar.mechanics.rotation import level_rotation
from shoes.geometry.transforms import Pose, mjcf_rotation

angles = st.floats(-3.1, 3.1)


def text(values: object) -> str:
    return " ".join(repr(float(v)) for v in np.atleast_1d(values))  # type: ignore[arg-type]


@given(angles, angles, angles)
def test_angles_give_the_rotations_of_scipy(a: float, b: float, c: float) -> None:
    for sequence in ("xyz", "ZYX", "zxy"):
        # Small letters turn with the frame: scipy's capitals.
        expected = Rotation.from_euler(sequence.swapcase(), [a, b, c]).as_matrix()
        np.testing.assert_allclose(
            mjcf_rotation({"euler": text([a, b, c])}, False, sequence, "g"), expected, atol=1e-12
        )
    quat = Rotation.from_euler("xyz", [a, b, c]).as_quat(scalar_first=True)
    expected = Rotation.from_euler("xyz", [a, b, c]).as_matrix()
    np.testing.assert_allclose(mjcf_rotation({"quat": text(3.0 * quat)}, False, "xyz", "g"), expected, atol=1e-9)
    xyaxes = text([*(2.0 * expected[:, 0]), *(expected[:, 1] + 0.5 * expected[:, 0])])
    np.testing.assert_allclose(mjcf_rotation({"xyaxes": xyaxes}, False, "xyz", "g"), expected, atol=1e-9)


@given(st.tuples(angles, angles, angles), angles)
def test_axes_are_turned_about(axis: tuple[float, float, float], angle: float) -> None:
    v = np.array(axis)
    if np.linalg.norm(v) < 0.1:
        return
    unit = v / np.linalg.norm(v)
    expected = Rotation.from_rotvec(unit * angle).as_matrix()
    found = mjcf_rotation({"axisangle": text([*v, np.degrees(angle)])}, True, "xyz", "g")
    np.testing.assert_allclose(found, expected, atol=1e-9)
    turned = mjcf_rotation({"zaxis": text(v)}, False, "xyz", "g")
    np.testing.assert_allclose(turned[:, 2], unit, atol=1e-9)
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), atol=1e-9)


def test_no_orientation_is_none_and_a_bad_one_is_refused() -> None:
    np.testing.assert_array_equal(mjcf_rotation({}, True, "xyz", "g"), np.eye(3))
    np.testing.assert_array_equal(mjcf_rotation({"quat": "2 0 0 0"}, True, "xyz", "g"), np.eye(3))
    np.testing.assert_allclose(mjcf_rotation({"zaxis": "0 0 -1"}, True, "xyz", "g")[:, 2], [0, 0, -1])
    for bad in (
        {"quat": "0 0 0 0"},
        {"zaxis": "0 0 0"},
        {"euler": "1 2"},
        {"quat": "a b c d"},
        {"axisangle": "1 0 0 inf"},
    ):
        with pytest.raises(FootError, match=r"^g: "):
            mjcf_rotation(bad, True, "xyz", "g")


def test_poses_follow_each_other() -> None:
    turn = level_rotation(np.pi / 2)
    pose = Pose(np.array([1.0, 0.0, 0.0]), turn) @ Pose(np.array([1.0, 0.0, 0.0]))
    triangle = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]])
    np.testing.assert_allclose(pose.moved(triangle)[0], [[1, 1, 0], [1, 2, 0], [0, 1, 0]], atol=1e-12)
    mirrored = Pose().moved(triangle, np.array([-1.0, 1.0, 1.0]))[0]
    a, b = mirrored[1] - mirrored[0], mirrored[2] - mirrored[0]
    assert np.cross(a, b)[2] > 0.0  # its outer side stays outside
