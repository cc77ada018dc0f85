"""What the base's distance sensors see."""

import mujoco
import numpy as np
import pytest

from plantar.sim.companion.lidar import Lidar, LidarSettings

ROOM = """
<mujoco>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body name="base"><geom type="box" size="0.3 0.3 0.3" pos="0 0 0.3" mass="1"/></body>
    <body name="post" pos="1 0 0.5"><geom type="cylinder" size="0.2 0.5"/></body>
    <body name="wall" pos="-1.5 0 0.5"><geom type="box" size="0.1 0.8 0.5"/></body>
    <body name="high" pos="0 1 1.5"><geom size="0.2"/></body>
  </worldbody>
</mujoco>
"""


def scan(**settings):
    model = mujoco.MjModel.from_xml_string(ROOM)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return Lidar(model, "base", LidarSettings(**settings), 0).scan(data)


def test_nearest_point_of_each_thing_is_returned():
    points = scan(noise=0.0)
    assert len(points) == 2  # what is above the scan is not seen, nor the ground, nor the base itself
    post, wall = points[np.argsort(-points[:, 0])]
    np.testing.assert_allclose(post, [0.8, 0.0], atol=1e-6)
    np.testing.assert_allclose(wall, [-1.4, 0.0], atol=0.02)


def test_far_things_are_not_seen():
    np.testing.assert_allclose(scan(noise=0.0, reach=1.0), [[0.8, 0.0]], atol=1e-6)
    assert scan(noise=0.0, reach=0.5).shape == (0, 2)


def test_noise_moves_points_along_their_rays():
    points = scan(noise=0.02)
    assert points[:, 0].max() == pytest.approx(0.8, abs=0.1)
    assert points[:, 0].max() != 0.8
