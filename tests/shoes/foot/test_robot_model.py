"""Tests of reading a robot's foot from MJCF and URDF."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot import robot_model
from plantar.shoes.foot.robot_model import read_foot_body, side_of_name
from plantar.shoes.papers.mesh_files import write_stl

Shape = Callable[..., NDArray[np.float64]]

MJCF = """<mujoco model="walker">
 <compiler angle="{angle}" meshdir="meshes"/>
 <default>
  <geom contype="1"/>
  <default class="visual"><geom type="mesh" contype="0" conaffinity="0"/></default>
 </default>
 <include file="assets.xml"/>
 <worldbody><geom type="plane" size="1 1 1"/>
  <body name="hips" pos="0 0 1" euler="0 0 {quarter}"><freejoint/>
   <body name="left_shin" pos="0 .1 -.4"><joint/>
    <body name="left_foot" pos="0 0 -.4" euler="0 0 -{quarter}"><joint/>
     <geom type="box" size=".1 .04 .02" pos=".03 0 -.08"/>
     {visual}
     <body name="left_toe" pos=".13 0 -.08"><geom type="capsule" size=".02" fromto="0 -.02 0 0 .02 0"/></body>
     <body name="sensor"><joint/><geom type="sphere" size="1"/></body>
    </body>
   </body>
  </body>
 </worldbody>
</mujoco>"""


def bounds(triangles: NDArray[np.float64]) -> list[float]:
    points = triangles.reshape(-1, 3)
    return [*points.min(axis=0).round(6).tolist(), *points.max(axis=0).round(6).tolist()]


def mjcf(folder: Path, box: Shape, visual: str = "", angle: str = "degree") -> Path:
    (folder / "meshes").mkdir(exist_ok=True)
    write_stl(box((-60, 140), (-45, 45), (-100, -40)), folder / "meshes" / "foot.stl")
    (folder / "assets.xml").write_text(
        '<mujoco><asset><mesh name="foot" file="foot.stl" scale=".001 .001 .001"/></asset></mujoco>'
    )
    quarter = "90" if angle == "degree" else str(np.pi / 2)
    path = folder / "walker.xml"
    path.write_text(MJCF.format(visual=visual, angle=angle, quarter=quarter))
    return path


@pytest.mark.parametrize("angle", ["degree", "radian"])
def test_simple_shapes_of_a_body_and_what_is_fixed_to_it(tmp_path, box, angle):
    found = read_foot_body(mjcf(tmp_path, box, angle=angle), "left_foot")
    assert found.side == "left"
    assert "2 colliding shape(s)" in found.notes[0]
    assert bounds(found.triangles) == pytest.approx([-0.07, -0.04, -0.1, 0.15, 0.04, -0.06], abs=1e-3)


@pytest.mark.long
def test_toes_that_move_are_among_what_the_shoe_must_leave_free(tmp_path, box):
    path = mjcf(tmp_path, box)
    fixed = read_foot_body(path, "left_foot")
    path.write_text(path.read_text().replace('-.08"><geom type="capsule"', '-.08"><joint/><geom type="capsule"'))
    found = read_foot_body(path, "left_foot")
    assert bounds(found.triangles) == pytest.approx([-0.07, -0.04, -0.1, 0.13, 0.04, -0.06], abs=1e-3)
    assert fixed.links is None
    assert found.links is not None
    assert found.links[:, 0].max() == pytest.approx(0.15, abs=2e-3)
    assert found.notes[0].endswith("without what moves below it")


def test_what_is_drawn_comes_before_what_collides(tmp_path, box):
    found = read_foot_body(mjcf(tmp_path, box, '<geom class="visual" mesh="foot"/>'), "left_foot")
    assert "1 drawn shape(s)" in found.notes[0]
    assert bounds(found.triangles) == pytest.approx([-0.06, -0.045, -0.1, 0.14, 0.045, -0.04], abs=1e-6)


def test_a_body_is_turned_as_in_the_zero_pose(tmp_path, box):
    shin = mjcf(tmp_path, box).read_text().replace('euler="0 0 -90"', "")
    (tmp_path / "turned.xml").write_text(shin)
    found = read_foot_body(tmp_path / "turned.xml", "left_foot")  # its x points to the world's y
    assert bounds(found.triangles) == pytest.approx([-0.04, -0.07, -0.1, 0.04, 0.15, -0.06], abs=1e-3)


URDF = """<robot name="walker">
 <link name="base"/>
 <link name="l_ankle">
  <visual><origin xyz="0.03 0 -0.08" rpy="0 0 0"/><geometry><box size="0.2 0.08 0.04"/></geometry></visual>
  <collision><geometry><sphere radius="1"/></geometry></collision>
 </link>
 <link name="l_sole"><visual><origin xyz="0 0 0"/>
  <geometry><mesh filename="package://walker/meshes/foot.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>
 <link name="r_ankle"/>
 <joint name="a" type="revolute"><parent link="base"/><child link="l_ankle"/><origin rpy="0 0 1.5707963"/></joint>
 <joint name="b" type="fixed"><parent link="l_ankle"/><child link="l_sole"/><origin xyz="0 0 -0.01"/></joint>
 <joint name="c" type="revolute"><parent link="base"/><child link="r_ankle"/></joint>
</robot>"""


def test_a_urdf_link_with_what_is_fixed_to_it(tmp_path, box):
    (tmp_path / "walker" / "meshes").mkdir(parents=True)
    (tmp_path / "walker" / "urdf").mkdir()
    write_stl(box((-60, 140), (-45, 45), (-100, -40)), tmp_path / "walker" / "meshes" / "foot.stl")
    path = tmp_path / "walker" / "urdf" / "walker.urdf"
    path.write_text(URDF)
    found = read_foot_body(path, "l_ankle")
    assert found.side == "left"
    assert bounds(found.triangles) == pytest.approx([-0.045, -0.07, -0.11, 0.045, 0.14, -0.05], abs=1e-5)
    with pytest.raises(FootError, match=r"body 'r_ankle' has no geometry; .*: l_ankle, ") as told:
        read_foot_body(path, "r_ankle")
    assert "plantar_world" not in str(told.value)


def test_bad_models_are_refused_in_one_line(tmp_path, box):
    path = mjcf(tmp_path, box)
    cases = {
        "missing": (tmp_path / "none.xml", "left_foot", "cannot be read"),
        "no body": (path, "tail", "there is no body 'tail'; allowed: left_foot, left_toe"),
        "not named": (path, None, r"name the foot's body \(--body\); allowed: left_foot"),
    }
    for name, text, reason in (
        ("empty", "", "not a readable XML file"),
        ("html", "<html/>", "allowed: <mujoco>"),
        ("cut", MJCF[:300], "not a readable XML file"),
        ("mesh", MJCF.format(visual='<geom class="visual" mesh="nose"/>', angle="degree", quarter="0"), "mesh 'nose'"),
        ("nan", MJCF.format(visual="", angle="degree", quarter="nan"), "euler is '0 0 nan'; allowed: finite"),
        (
            "size",
            MJCF.format(visual="", angle="degree", quarter="0").replace(".1 .04 .02", ".1 -4 .02"),
            "size 1 must be positive",
        ),
        ("self", '<mujoco><include file="self.xml"/></mujoco>', "includes itself"),
    ):
        (tmp_path / f"{name}.xml").write_text(text)
        cases[name] = (tmp_path / f"{name}.xml", "left_foot", reason)
    for file, body, reason in cases.values():
        with pytest.raises(FootError, match=reason) as caught:
            read_foot_body(file, body)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("leg_left_6_link", "left"),
        ("R_ANKLE_P_S", "right"),
        ("l_foot", "left"),
        ("RightFoot", "right"),
        ("rightfoot", "right"),
        ("sole", None),
        ("lower_leg", None),
        ("left_right_adapter", None),
    ],
)
def test_the_side_is_read_from_the_name(name, side):
    assert side_of_name(name) == side


@pytest.mark.parametrize(("scale", "length"), [(1e3, "200000"), (1e-3, "0.2")])
def test_a_model_in_another_unit_is_refused_before_its_links_are_swept(tmp_path, monkeypatch, scale, length):
    path = tmp_path / "walker.xml"
    foot = f"<body name='foot'><joint/><geom type='box' size='{0.1 * scale} {0.05 * scale} {0.02 * scale}'/></body>"
    path.write_text(f"<mujoco><worldbody><body><joint/><geom size='.1'/>{foot}</body></worldbody></mujoco>")
    monkeypatch.setattr(robot_model, "swept_links", None)
    with pytest.raises(FootError, match=rf"body 'foot': the foot is {length} mm long \(unit m as the file states\)"):
        read_foot_body(path, "foot")
    if scale > 1.0:
        assert read_foot_body(path, "foot", "mm").links is None


@pytest.mark.parametrize(("most", "swept"), [(30.0, "60"), (3000.0, "69")])
def test_an_ankle_that_turns_all_round_is_swept_as_one_without_limits(tmp_path, most, swept):
    path = tmp_path / "walker.xml"
    foot = f"<body name='foot'><joint range='-{most} {most}'/><geom type='box' size='.1 .05 .02'/></body>"
    path.write_text(f"<mujoco><worldbody><body><joint/><geom size='.1'/>{foot}</body></worldbody></mujoco>")
    assert f"swept over 2 joint(s), {swept}, 69 degrees" in read_foot_body(path, "foot").notes[2]


def test_the_real_robots_feet_are_those_of_its_meshes(real_data):
    model = real_data / "robots" / "jvrc1" / "xml" / "scene.xml"
    left, right = (read_foot_body(model, f"{s}_ANKLE_P_S") for s in "LR")
    assert (left.side, right.side) == ("left", "right")
    expected = [-0.0951, -0.05, -0.1077, 0.1571, 0.05, 0.007]  # feet/jvrc1.json
    assert bounds(left.triangles) == pytest.approx(expected, abs=2e-4)
    assert bounds(right.triangles) == pytest.approx(expected, abs=2e-4)


def test_links_that_are_fixed_in_a_circle_are_refused(tmp_path):
    path = tmp_path / "circle.urdf"
    joint = '<joint name="{0}{1}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint>'
    joints = joint.format("a", "b") + joint.format("b", "a")
    path.write_text(f'<robot name="c"><link name="a"/><link name="b"/>{joints}</robot>')
    with pytest.raises(FootError, match="a tree of links"):
        read_foot_body(path, "a")


def test_a_mesh_that_lies_elsewhere_is_not_read(tmp_path, box):
    (tmp_path / "robot" / "xml").mkdir(parents=True)
    (tmp_path / "other").mkdir()
    write_stl(box((-60, 140), (-45, 45), (-100, -40)), tmp_path / "other" / "foot.stl")
    geometry = '<visual><geometry><mesh filename="../../other/foot.stl"/></geometry></visual>'
    path = tmp_path / "robot" / "xml" / "robot.urdf"
    path.write_text(f'<robot name="r"><link name="foot">{geometry}</link></robot>')
    with pytest.raises(FootError, match=r"lies elsewhere; allowed: .*PLANTAR_MODEL_FOLDERS"):
        read_foot_body(path, "foot")


def test_bodies_without_telling_names_are_listed_from_the_ends_of_chains(tmp_path):
    inner = '<body name="d"><joint/><geom size="0.1"/></body>'
    for name in ("c", "b", "a"):
        inner = f'<body name="{name}"><joint/><geom size="0.1"/>{inner}</body>'
    arms = "".join(f'<body name="arm{i}"><joint/><geom size="0.1"/></body>' for i in range(20))
    path = tmp_path / "robot.xml"
    path.write_text(
        f"<mujoco><worldbody><body name='trunk'><geom size='0.1'/>{arms}{inner}</body></worldbody></mujoco>"
    )
    with pytest.raises(FootError, match=r"allowed: d, arm0, arm1, .*\.\.\."):
        read_foot_body(path, "tail")
