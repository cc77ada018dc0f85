"""Taxels on a link's surface: where they are, which way they face, and what a bad patch is told."""

import math

import mujoco
import numpy as np
import pytest

from plantar.errors import LayoutError, RobotError
from plantar.sim.body_skin.surface import skin_from_tables

BODY = """
<mujoco>
  <asset><mesh name="cube" vertex="-.1 -.1 -.1 .1 -.1 -.1 -.1 .1 -.1 .1 .1 -.1 -.1 -.1 .1 .1 -.1 .1 -.1 .1 .1 .1 .1 .1"/></asset>
  <worldbody>
    <geom name="obstacle" type="sphere" size=".05" group="3" pos="0 0 2"/>
    <body name="trunk" pos="1 2 3" euler="30 0 0">
      <freejoint/>
      <geom type="box" size=".1 .2 .3"/>
      <body name="arm" pos="0 .4 0"><joint/><geom type="capsule" size=".05" fromto="0 0 0 0 0 -.4"/></body>
      <body name="shell" pos="0 -.6 0"><joint/><geom type="mesh" mesh="cube" mass="1"/></body>
    </body>
  </worldbody>
</mujoco>"""  # noqa: E501
FRONT = {"name": "front", "link": "trunk", "position": [0.1, 0, 0], "rotation": [0, -90, 0], "size": [0.3, 0.2]}


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_string(BODY)


def test_a_flat_patch_lies_on_a_box_and_faces_into_it(model):
    patch = skin_from_tables(model, [FRONT], "m").patches[0]
    assert patch.positions[:, 0] == pytest.approx(0.1)
    assert patch.rotations[:, :, 2] == pytest.approx(np.tile([-1.0, 0.0, 0.0], (len(patch), 1)))
    assert len(patch) == pytest.approx(0.06 / 691e-6, rel=0.15)
    apart = np.linalg.norm(patch.positions[:, None] - patch.positions, axis=2) + np.eye(len(patch))
    assert apart.min() == pytest.approx(math.sqrt(2 * 691e-6 / math.sqrt(3)))


def test_a_wrapped_patch_goes_around_a_capsule(model):
    table = {
        "name": "a",
        "link": "arm",
        "position": [0, 0, -0.2],
        "rotation": [0, 90, 0],
        "size": [0.3, 0],
        "wrap": 0.05,
    }
    patch = skin_from_tables(model, [table], "m").patches[0]
    radial = patch.positions * [1, 1, 0]
    assert np.linalg.norm(radial, axis=1) == pytest.approx(0.05)
    assert patch.rotations[:, :, 2] == pytest.approx(-radial / 0.05)
    assert len(patch) == pytest.approx(2 * math.pi * 0.05 * 0.3 / 691e-6, rel=0.1)
    assert radial.mean(0) == pytest.approx(0.0, abs=0.004)


def test_a_patch_on_a_mesh_keeps_the_taxels_nearest_to_its_middle(model):
    table = {
        "name": "m",
        "link": "shell",
        "position": [0, 0, 0.1],
        "rotation": [180, 0, 0],
        "size": [1, 1],
        "taxels": 7,
    }
    patch = skin_from_tables(model, [table], "m").patches[0]
    assert len(patch) == 7
    assert patch.positions[:, 2] == pytest.approx(0.1)
    assert patch.rotations[:, :, 2] == pytest.approx(np.tile([0.0, 0.0, -1.0], (7, 1)))
    assert np.hypot(*patch.positions[:, :2].T).max() == pytest.approx(math.sqrt(2 * 691e-6 / math.sqrt(3)))


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        ({"range": -0.01}, RobotError, r"m: \[\[patch\]\] 1 'range' is -0.01; allowed: a number 0 to 5"),
        (
            {"link": "trnuk"},
            RobotError,
            "patch 'front' is on link 'trnuk', which the robot has not; allowed: trunk, arm",
        ),
        (
            {"link": "arm", "position": [0.4, 0, 0]},
            LayoutError,
            "patch 'front' meets no surface of link 'arm' within 0.1 m",
        ),
        ({"size": [0.1]}, RobotError, "patch 'front': 'size'"),
        ({"size": [0.1, 0]}, RobotError, "'size' is .* allowed: above 0"),
        ({"position": [0, 0, float("nan")]}, RobotError, "patch 'front': 'position'"),
        ({"position": "here"}, RobotError, "'position' is 'here'; allowed: a list of 3 numbers"),
        ({"pitch": 1}, RobotError, "unknown key 'pitch'"),
        ({"name": ""}, RobotError, r"\[\[patch\]\] 1 has no 'name'"),
        ({"threshold": -1.0}, RobotError, "'threshold' is -1.0"),
    ],
)
def test_a_bad_patch_is_named_in_one_line(model, change, kind, words):
    with pytest.raises(kind, match=words) as told:
        skin_from_tables(model, [{**FRONT, **change}], "m")
    assert "\n" not in str(told.value)


def test_two_patches_of_one_name_are_refused(model):
    with pytest.raises(LayoutError, match="two patches are called 'front'"):
        skin_from_tables(model, [FRONT, FRONT], "m")
