"""Tests of a robot's mass against MuJoCo's own sum, and of files that do not tell it."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest

from shoes.foot.model_mass import model_mass
from shoes.foot.source import read_foot
from shoes.order import FootSource
from shoes.parameters import ShoeParameters
from shoes.plan.strength import load_case

MJCF = """<mujoco><default><geom density="700"/></default><asset><mesh name="m" file="m.stl"/></asset><worldbody>
<body name="table"><geom type="box" size="1 1 .1"/></body>
<body name="trunk"><freejoint/><geom type="box" size=".1 .2 .3"/>
<body name="foot" pos="0 0 -.5"><joint/><geom type="box" size=".12 .05 .02"/>
{inertial}{mesh}</body></body></worldbody></mujoco>"""


def test_the_mass_is_mujocos_of_the_robot_alone(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    file.write_text(MJCF.format(inertial="", mesh="").replace('<asset><mesh name="m" file="m.stl"/></asset>', ""))
    model = mujoco.MjModel.from_xml_path(str(file))
    mass, note = model_mass(file, "foot")
    assert mass == pytest.approx(model.body("trunk").subtreemass[0])
    assert mass == pytest.approx(700.0 * 8.0 * (0.1 * 0.2 * 0.3 + 0.12 * 0.05 * 0.02))
    assert "of its model" in note
    foot, _ = read_foot(FootSource(file=file, body="foot"), sole_band=5.0)
    assert load_case(foot, ShoeParameters()).mass == pytest.approx(mass)


def test_a_mesh_that_is_not_there_weighs_nothing_where_the_inertia_is_stated(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    stated = "<inertial pos='0 0 0' mass='2' diaginertia='.01 .01 .01'/>"
    file.write_text(MJCF.format(inertial=stated, mesh="<geom type='mesh' mesh='m'/>"))
    assert model_mass(file, "foot")[0] == pytest.approx(700.0 * 8.0 * 0.1 * 0.2 * 0.3 + 2.0)
    file.write_text(MJCF.format(inertial="", mesh="<geom type='mesh' mesh='m'/>"))
    assert model_mass(file, "foot")[0] is None
    assert "is not read" in model_mass(file, "foot")[1]


@pytest.mark.parametrize("path", ["jvrc1/xml/jvrc1.xml", "robotis_op3/op3.xml", "unitree_h1/h1.xml"])
def test_real_robots_weigh_what_mujoco_says(real_data: Path, path: str) -> None:
    file = real_data / "robots" / path
    model = mujoco.MjModel.from_xml_path(str(file))
    body = next(n for i in range(model.nbody) if "ank" in (n := model.body(i).name).lower())
    assert model_mass(file, body)[0] == pytest.approx(float(model.body_mass.sum()), rel=0.01)


def test_a_urdf_is_the_sum_of_its_links(tmp_path: Path) -> None:
    link = "<link name='{0}'><inertial><mass value='{1}'/></inertial></link>"
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='r'>" + link.format("a", 30.5) + link.format("b", 2) + "</robot>")
    assert model_mass(file, "b")[0] == pytest.approx(32.5)
    file.write_text("<robot name='r'>" + link.format("a", "heavy") + "</robot>")
    assert model_mass(file, "a") == (None, "the robot's model states no mass")
