"""How a robot file states a rotation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.robots.survey.robot_text import roll_pitch_yaw


@pytest.mark.parametrize("pitch", [-90.0, 90.0, 90.0 - 1e-6, None])
def test_the_stated_angles_are_the_rotation_also_where_a_body_points_straight_down(pitch):
    for roll, turned, yaw in np.random.default_rng(4).uniform(-180.0, 180.0, (50, 3)):
        angles = [roll, turned / 2.0 if pitch is None else pitch, yaw]
        rotation = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
        stated = Rotation.from_euler("xyz", roll_pitch_yaw(rotation), degrees=True).as_matrix()
        np.testing.assert_allclose(stated, rotation, atol=1e-5)  # files state four decimals of a degree
