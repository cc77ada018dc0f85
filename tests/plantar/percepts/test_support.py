import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.geometry.polygon import area, signed_margin
from plantar.percepts.sole_pose import feet_support_polygon, polygon_in_world

SOLE = np.array([[-0.1, -0.05], [0.15, -0.05], [0.15, 0.05], [-0.1, 0.05]])
angles = st.floats(-0.5, 0.5)


@given(angles, angles, st.floats(-3.1, 3.1), st.tuples(*[st.floats(-5, 5)] * 3))
def test_polygon_in_world_is_the_transform_seen_from_above(roll, pitch, yaw, position):
    rotation = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    got = polygon_in_world(SOLE, rotation, np.array(position))
    expected = [(rotation @ [x, y, 0.0] + position)[:2] for x, y in SOLE]
    assert got == pytest.approx(np.array(expected), abs=1e-12)


@given(st.floats(-3.1, 3.1))
def test_turning_a_level_sole_keeps_its_area(yaw):
    rotation = Rotation.from_euler("z", yaw).as_matrix()
    assert area(polygon_in_world(SOLE, rotation, np.ones(3))) == pytest.approx(area(SOLE))


def test_empty_polygon_in_world():
    assert polygon_in_world(np.empty((0, 2)), np.eye(3), np.ones(3)).shape == (0, 2)


@given(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), st.floats(0, 1), st.floats(0, 1), st.floats(0, 1))
def test_double_support_holds_every_blend_of_the_feet(offset, u, v, blend):
    left, right = SOLE, SOLE + np.array(offset)
    both = feet_support_polygon([left, right])

    def inside(foot):
        return foot[0] + u * (foot[1] - foot[0]) + v * (foot[3] - foot[0])

    assert signed_margin(both, (1 - blend) * inside(left) + blend * inside(right)) >= -1e-9


def test_one_foot_or_none():
    empty = np.empty((0, 2))
    assert {tuple(p) for p in feet_support_polygon([SOLE, empty])} == {tuple(p) for p in SOLE}
    assert feet_support_polygon([empty, empty]).shape == (0, 2)
    assert feet_support_polygon([]).shape == (0, 2)
