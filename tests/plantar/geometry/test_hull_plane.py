"""The plane of a hull that a body could rest on: of boxes that are turned, of balls, of flat sets of points."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.geometry.hull_plane import hull_plane

SIDES = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], dtype=float)


@pytest.mark.parametrize("angle", [0.0, 10.0, 30.0])
def test_a_tilted_box_rests_on_its_lower_face(angle):
    turned = Rotation.from_euler("x", angle, degrees=True)
    normal, area = hull_plane(SIDES @ turned.as_matrix().T, -0.7, 0.9999, 12)
    assert normal == pytest.approx(turned.apply([0.0, 0.0, -1.0]), abs=1e-9)
    assert area == pytest.approx(2.0)


def test_the_larger_of_two_faces_counts_where_both_may_be_below():
    _, area = hull_plane(SIDES @ Rotation.from_euler("x", 50.0, degrees=True).as_matrix().T, 0.0, 0.9999, 12)
    assert area == pytest.approx(6.0)


def test_a_sole_of_three_near_planes_is_larger_than_the_chamfer_beside_it():
    """Seen from behind: slopes of 3 degrees beside a level strip, and a chamfer as wide as two of them."""
    angles = np.radians([-90.0, -3.0, 0.0, 3.0, 31.0, 90.0])
    lengths = np.array([30.0, 10.0, 9.0, 10.0, 20.0, 30.0])
    corners = np.vstack([[0.0, 0.0], np.cumsum(lengths[:, None] * np.c_[np.cos(angles), np.sin(angles)], axis=0)])
    points = np.concatenate([np.c_[np.full(len(corners), x), corners] for x in (0.0, 100.0)])
    normal, area = hull_plane(points, -0.7, 0.9999, 24)
    assert np.degrees(np.arccos(-normal[2])) == pytest.approx(3.0, abs=1e-6)
    assert area == pytest.approx(1000.0)


def test_without_a_plane_it_is_straight_down():
    flat = SIDES * (1.0, 1.0, 0.0)
    for points, highest in ((flat, -0.7), (SIDES, -1.1), (SIDES[:3], -0.7)):
        normal, area = hull_plane(points, highest, 0.9999, 12)
        assert normal.tolist() == [0.0, 0.0, -1.0]
        assert area == 0.0
