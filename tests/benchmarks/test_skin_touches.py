"""Patches on public robots agree with the count that knows nothing of the kernel."""

import os
from pathlib import Path

import mujoco
import pytest
from skin_touches import counted, models_below

ROBOTS = Path(os.environ.get("PLANTAR_REAL_DATA", "none")) / "robots"
LIMB = """<mujoco><worldbody><body name="limb"><freejoint/><geom type="capsule" size=".05 .1"/>
  <geom type="box" size=".03 .06 .03" pos="0 0 .1"/></body></worldbody></mujoco>"""


def check(count):
    assert count.touches > 5
    assert count.taxel_error < 1e-9
    assert count.sum_error < 1e-12
    assert count.phantom == 0.0
    assert count.farthest < 1.3


PLATES = """<mujoco><worldbody><body name="plates"><freejoint/>
  <geom type="box" size=".0368 .1049 .0034" pos="-.0217 .0012 .0775" euler="175 139.1 82.6"/>
  <geom type="box" size=".0037 .1195 .0162" pos="-.0482 -.0148 .0048" euler="-148.9 -28 172.4"/>
  </body></worldbody></mujoco>"""


def test_a_limb_agrees_with_the_count():
    check(counted("limb", mujoco.MjSpec.from_string(LIMB), 1))


def test_the_rim_of_a_plate_lights_the_nearest_cell():
    """No cell near there faces the touch: the plate is thinner than a cell."""
    count = counted("plates", mujoco.MjSpec.from_string(PLATES), 1, seed=12)
    assert count.farthest < 1.3
    assert count.taxel_error < 1e-9


@pytest.mark.long
@pytest.mark.skipif(not ROBOTS.exists(), reason="needs PLANTAR_REAL_DATA")
@pytest.mark.parametrize("robot", ["robotis_op3/op3.xml"])
def test_a_public_robot_agrees_with_the_count(robot):
    ((name, spec),) = models_below(ROBOTS / robot)
    check(counted(name, spec, 2))


@pytest.mark.long
@pytest.mark.skipif(not ROBOTS.exists(), reason="needs PLANTAR_REAL_DATA")
@pytest.mark.parametrize("robot", ["unitree_h1/h1.xml", "booster_t1/t1.xml", "jvrc1/xml/jvrc1.xml"])
def test_other_public_robots_agree_with_the_count(robot):
    ((name, spec),) = models_below(ROBOTS / robot)
    check(counted(name, spec, 6))


def test_a_model_without_a_body_that_moves_is_left_out():
    still = mujoco.MjSpec.from_string('<mujoco><worldbody><geom type="box" size="1 1 1"/></worldbody></mujoco>')
    assert counted("still", still) is None
