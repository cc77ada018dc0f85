"""Tests of reading a robot's model: shapes and mass are MuJoCo's own, of whatever structure the file has."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot import model_bodies
from plantar.shoes.foot.model_bodies import ModelBodies
from plantar.shoes.foot.robot_model import read_foot_body
from plantar.shoes.foot.source import read_foot
from plantar.shoes.order import FootSource
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.strength import load_case

MJCF = """<mujoco><default><geom density="700"/></default><asset><mesh name="m" file="m.stl"/></asset><worldbody>
<body name="table"><geom type="box" size="1 1 .1"/></body>
<body name="trunk"><freejoint/><geom type="box" size=".1 .2 .3"/>
<body name="foot" pos="0 0 -.5"><joint/><geom type="box" size=".12 .05 .02"/>
{inertial}{mesh}</body></body></worldbody></mujoco>"""


def told_mass(file: Path, body: str) -> tuple[float | None, str]:
    return ModelBodies(file).mass(body)


def by_mujoco(file: Path, body: str) -> tuple[NDArray[np.float64], float]:
    """Extent (2, 3) of a body's drawn shapes and of what is fixed to it, about its origin, and the robot's mass."""
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    wanted = model.body(body).id
    found = []
    for g in range(model.ngeom):
        at = int(model.geom_bodyid[g])
        while at != wanted and at and not model.body_jntnum[at]:
            at = int(model.body_parentid[at])
        if at != wanted or model.geom_contype[g]:
            continue
        mesh = int(model.geom_dataid[g])
        turn = data.geom_xmat[g].reshape(3, 3)
        if mesh >= 0:
            start = model.mesh_vertadr[mesh]
            points = model.mesh_vert[start : start + model.mesh_vertnum[mesh]]
        else:
            points = model.geom_size[g] * np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        found.append(points @ turn.T + data.geom_xpos[g] - data.xpos[wanted])
    points = np.concatenate(found)
    mass = float(model.body_subtreemass[model.body_rootid[wanted]])
    return np.array([points.min(axis=0), points.max(axis=0)]), mass


def extent(file: Path, body: str) -> NDArray[np.float64]:
    points = read_foot_body(file, body).triangles.reshape(-1, 3)
    return np.array([points.min(axis=0), points.max(axis=0)])


STRUCTURES = {
    "classes": """<default><default class="robot"><joint axis="0 1 0"/><default class="visual"><geom type="mesh"
        contype="0" conaffinity="0" group="2" mass="0"/><mesh scale=".001 .001 .001"/></default></default></default>
        <asset><mesh class="visual" name="skew" file="skew.stl"/></asset><worldbody><body name="shin" childclass="robot"
        euler="10 20 30"><joint/><inertial pos="0 0 0" mass="3" diaginertia=".1 .1 .1"/><body name="foot"
        quat=".9 .1 .2 .3"><joint/><geom class="visual" mesh="skew" pos=".01 .02 -.03" axisangle="1 2 3 40"/>
        <geom size=".02"/></body></body></worldbody>""",
    "frames": """<asset><mesh name="skew" file="skew.stl" scale=".001 -.001 .002"/></asset><worldbody><frame
        euler="0 0 30"><body name="shin"><joint/><geom size=".1"/><frame pos="0 0 -.4" xyaxes="0 1 0 -1 0 0"><body
        name="foot"><joint/><frame zaxis="1 1 3"><geom type="mesh" mesh="skew" contype="0" conaffinity="0"/></frame>
        <frame pos="0 0 -.01"><body name="sole" pos=".1 0 0"><geom type="box" size=".1 .02 .01" contype="0"
        conaffinity="0"/></body></frame></body></frame></body></frame></worldbody>""",
    "refpos": """<compiler angle="radian" eulerseq="XYZ"/><asset><mesh name="skew" file="skew.stl" refpos="10 20 30"
        refquat="1 2 3 4" scale="-.001 .002 .001"/></asset><worldbody><body name="shin"><joint/><geom size=".1"/>
        <body name="foot" euler=".1 .2 .3"><joint/><geom type="mesh" mesh="skew" contype="0" conaffinity="0"/></body>
        </body></worldbody>""",
    "attach": """<compiler meshdir="elsewhere" strippath="true"/><asset><model name="leg" file="part/leg.xml"/></asset>
        <worldbody><body name="shin"><freejoint/><geom size=".1"/><frame pos="0 .1 -.4" euler="0 0 90"><attach
        model="leg" body="foot" prefix="left_"/></frame></body></worldbody>""",
    "fitted": """<asset><mesh name="skew" file="skew.stl" scale=".001 .001 .001"/></asset><worldbody><body name="shin">
        <joint/><geom size=".1"/><body name="foot"><joint/><geom type="box" mesh="skew" contype="0" conaffinity="0"/>
        <replicate count="3" offset=".05 0 0"><geom type="box" size=".01 .01 .02" contype="0" conaffinity="0"/>
        </replicate></body></body></worldbody>""",
    "inline": """<asset><mesh name="hull" vertex="0 0 0 .2 0 0 0 .1 0 0 0 .05"/></asset><worldbody><body name="shin">
        <joint/><geom size=".1"/><body name="foot"><joint/><geom type="mesh" mesh="hull" contype="0" conaffinity="0"/>
        </body></body></worldbody>""",
    "inertia of shapes": """<compiler inertiafromgeom="true"/><asset><mesh name="skew"
        file="skew.stl" scale=".001 .001 .001"/></asset><include file="rest.xml"/>""",
}
LEG = """<mujoco model="leg"><compiler meshdir="assets"/><asset><mesh name="skew" file="skew.stl"
    scale=".001 .001 .001"/></asset><worldbody><body name="foot" euler="5 0 0"><joint/><geom type="mesh" mesh="skew"
    contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
REST = """<mujoco><worldbody><body name="shin"><joint/><geom size=".1"/><inertial pos="0 0 0" mass="9"
    diaginertia=".1 .1 .1"/><body name="foot"><joint/><geom type="mesh" mesh="skew" contype="0" conaffinity="0"/></body>
    </body></worldbody></mujoco>"""


def skew(path: Path) -> None:
    """A body in mm without any symmetry."""
    path.parent.mkdir(exist_ok=True)
    points = [[0, 0, 0], [180, 10, 5], [20, 70, 0], [10, 5, 40], [120, 60, 30]]
    trimesh.Trimesh(points, []).convex_hull.export(path)


@pytest.mark.parametrize("name", STRUCTURES)
def test_shapes_and_mass_are_mujocos_in_every_structure(tmp_path, name):
    skew(tmp_path / "skew.stl")
    skew(tmp_path / "part" / "assets" / "skew.stl") if (tmp_path / "part").mkdir() is None else None
    (tmp_path / "part" / "leg.xml").write_text(LEG)
    (tmp_path / "rest.xml").write_text(REST)
    file = tmp_path / "robot.xml"
    file.write_text(f"<mujoco>{STRUCTURES[name]}</mujoco>")
    body = "left_foot" if name == "attach" else "foot"
    expected, mass = by_mujoco(file, body)
    np.testing.assert_allclose(extent(file, body), expected, atol=1e-6)
    assert told_mass(file, body)[0] == pytest.approx(mass, rel=1e-6)


URDF = """<robot name="r"><link name="{top}"><inertial><origin xyz="0 0 0"/><mass value="30"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="foot"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><origin xyz="0.01 0 0" rpy="0.1 0.2 0.3"/><geometry><mesh filename="package://r/meshes/visual/skew.stl"
scale="0.001 -0.001 0.001"/></geometry></visual>
<collision><geometry><mesh filename="package://r/meshes/collision/skew.stl"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="{top}"/><child link="foot"/><origin xyz="0 0 -1" rpy="0 0.1 1.2"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.mark.parametrize("top", ["pelvis", "world"])
def test_a_urdf_keeps_its_root_and_meshes_of_the_same_name(tmp_path, top):
    folder = tmp_path / "r" / "meshes"
    folder.mkdir(parents=True)
    skew(folder / "visual" / "skew.stl")
    trimesh.creation.box(extents=(1, 1, 1)).export((folder / "collision").mkdir() or folder / "collision" / "skew.stl")
    file = tmp_path / "r" / "robot.urdf"
    file.write_text(URDF.format(top=top))
    points = trimesh.load(folder / "visual" / "skew.stl").vertices * [0.001, -0.001, 0.001]

    def turn(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
        return np.asarray(trimesh.transformations.euler_matrix(roll, pitch, yaw, "sxyz")[:3, :3])

    placed = (points @ turn(0.1, 0.2, 0.3).T + [0.01, 0, 0]) @ turn(0.0, 0.1, 1.2).T
    np.testing.assert_allclose(extent(file, "foot"), [placed.min(axis=0), placed.max(axis=0)], atol=1e-6)
    assert told_mass(file, "foot")[0] == pytest.approx(32.0 if top == "pelvis" else 2.0, rel=1e-6)


def test_meshes_that_mujoco_does_not_read_are_read_here(tmp_path):
    skew(tmp_path / "skew.stl")
    file = tmp_path / "robot.xml"
    file.write_text(f"<mujoco>{STRUCTURES['refpos']}</mujoco>")
    expected = extent(file, "foot")
    mass = told_mass(file, "foot")[0]
    trimesh.load(tmp_path / "skew.stl").export(tmp_path / "skew.stl", file_type="stl_ascii")
    np.testing.assert_allclose(extent(file, "foot"), expected, atol=1e-6)
    assert told_mass(file, "foot")[0] == pytest.approx(mass, rel=1e-4)
    (tmp_path / "skew.stl").unlink()
    with pytest.raises(FootError, match=r"skew\.stl: cannot be read"):
        read_foot_body(file, "foot")


def test_the_mass_is_mujocos_of_the_robot_alone(tmp_path):
    file = tmp_path / "robot.xml"
    file.write_text(MJCF.format(inertial="", mesh="").replace('<asset><mesh name="m" file="m.stl"/></asset>', ""))
    model = mujoco.MjModel.from_xml_path(str(file))
    mass, note = told_mass(file, "foot")
    assert mass == pytest.approx(model.body("trunk").subtreemass[0])
    assert mass == pytest.approx(700.0 * 8.0 * (0.1 * 0.2 * 0.3 + 0.12 * 0.05 * 0.02))
    assert "of its model" in note
    foot, _ = read_foot(FootSource(file=file, body="foot"), sole_band=5.0)
    assert load_case(foot, ShoeParameters()).mass == pytest.approx(mass)


def test_a_mesh_that_is_not_there_weighs_nothing_where_the_inertia_is_stated(tmp_path):
    file = tmp_path / "robot.xml"
    stated = "<inertial pos='0 0 0' mass='2' diaginertia='.01 .01 .01'/>"
    file.write_text(MJCF.format(inertial=stated, mesh="<geom type='mesh' mesh='m'/>"))
    assert told_mass(file, "foot")[0] == pytest.approx(700.0 * 8.0 * 0.1 * 0.2 * 0.3 + 2.0)
    file.write_text(MJCF.format(inertial="", mesh="<geom type='mesh' mesh='m'/>"))
    assert told_mass(file, "foot")[0] is None
    assert "is not read" in told_mass(file, "foot")[1]


@pytest.mark.parametrize("path", ["jvrc1/xml/jvrc1.xml", "robotis_op3/op3.xml", "unitree_h1/h1.xml"])
def test_real_robots_weigh_what_mujoco_says(real_data, path):
    file = real_data / "robots" / path
    model = mujoco.MjModel.from_xml_path(str(file))
    body = next(n for i in range(model.nbody) if "ank" in (n := model.body(i).name).lower())
    assert told_mass(file, body)[0] == pytest.approx(float(model.body_mass.sum()), rel=0.01)


def test_a_urdf_is_the_sum_of_its_links(tmp_path):
    link = "<link name='{0}'><inertial><mass value='{1}'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    link += "</inertial></link>"
    joint = "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>"
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='r'>" + link.format("a", 30.5) + link.format("b", 2) + joint + "</robot>")
    assert told_mass(file, "b")[0] == pytest.approx(32.5)
    apart = link.format("table", 100)  # hangs on no link of the robot
    file.write_text("<robot name='r'>" + link.format("a", 30.5) + link.format("b", 2) + joint + apart + "</robot>")
    assert told_mass(file, "b")[0] == pytest.approx(32.5)
    shaped = "<collision><geometry><box size='.2 .1 .02'/></geometry></collision>"
    for inside in ("", shaped):  # as water the foot alone would be all of the robot
        file.write_text(f"<robot name='r'><link name='a'/><link name='b'>{inside}</link>{joint}</robot>")
        assert told_mass(file, "b") == (None, "the robot's model states no mass")


def test_a_model_of_too_many_triangles_is_read_once(tmp_path, monkeypatch):
    trimesh.creation.icosphere(radius=0.1).export(tmp_path / "m.stl")
    file = tmp_path / "robot.xml"
    file.write_text(MJCF.format(inertial="", mesh='<geom type="mesh" mesh="m"/>'))
    source = ModelBodies(file)
    read: list[object] = []
    own = type(source)._shapes

    def counted(self: Any, *arguments: Any, **options: Any) -> Any:
        read.append(options)
        return own(self, *arguments, **options)

    monkeypatch.setattr(model_bodies, "MOST_TRIANGLES", 1000)
    monkeypatch.setattr(type(source), "_shapes", counted)
    with pytest.raises(FootError, match="triangles; allowed: up to 1000"):
        source.shapes("foot", 20)
    assert read == [{"read_all": False}]


JOINTED = """<robot name="r"><link name="trunk"/>
<joint name="knee" type="revolute"><parent link="trunk"/><child link="shank"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<link name="shank"><visual><geometry><mesh filename="package://r/meshes/shank.stl"/></geometry></visual></link>
<joint name="ankle" type="revolute"><parent link="shank"/><child link="foot"/><origin xyz="0 0 -0.4"/>
<axis xyz="0 1 0"/>
<limit lower="-0.5" upper="0.5" effort="1" velocity="1"/></joint>
<link name="foot"><visual><geometry><mesh filename="package://r/meshes/foot.stl"/></geometry></visual></link></robot>"""


def test_a_urdf_shows_its_links_from_meshes_in_another_folder(tmp_path):
    folder = tmp_path / "r" / "meshes"
    folder.mkdir(parents=True)
    foot = trimesh.creation.box((0.2, 0.09, 0.04))
    foot.export(folder / "foot.stl")
    shank = trimesh.creation.box((0.06, 0.06, 0.4))
    shank.apply_translation([0.0, 0.0, -0.2])
    shank.export(folder / "shank.stl")
    (tmp_path / "r" / "urdf").mkdir()
    file = tmp_path / "r" / "urdf" / "robot.urdf"
    file.write_text(JOINTED)
    body = read_foot_body(file, "foot")
    assert body.links is not None
    assert body.notes[-1] == "the links above the foot are swept over 2 joint(s), 57, 115 degrees"
    assert body.links[:, 2].max() > 0.05


LEG_OF_MESHES = """<mujoco><asset><mesh name="thigh" file="thigh.stl"/><mesh name="shank" file="shank.stl"/></asset>
<worldbody><body name="hip" pos="0 0 .9"><joint axis="0 1 0" range="-60 60"/>{inertia}
<geom type="mesh" mesh="thigh"/><body name="knee" pos="0 0 -.4"><joint axis="0 1 0" range="0 120"/>
<inertial pos="0 0 -.1" mass="1.6" diaginertia=".01 .01 .001"/><geom type="mesh" mesh="shank"/>{spare}
<body name="ankle" pos="0 0 -.4"><joint axis="0 1 0" range="-30 30"/>
<body name="foot"><joint axis="1 0 0" range="-20 20"/><geom type="box" size=".1 .045 .02" pos=".03 0 -.05"/>
</body></body></body></body></worldbody></mujoco>"""
THIGH = '<inertial pos="0 0 -.05" mass="2.66" diaginertia=".027 .027 .004"/>'


def leg(tmp_path, *meshes: str, inertia: str = THIGH, spare: str = "") -> Any:
    for name in meshes:
        bar = trimesh.creation.box((0.06, 0.06, 0.36))
        bar.apply_translation([0.0, 0.0, -0.18])
        bar.export(tmp_path / f"{name}.stl")
    file = tmp_path / "leg.xml"
    file.write_text(LEG_OF_MESHES.format(inertia=inertia, spare=spare))
    return read_foot_body(file, "foot")


def test_a_link_far_from_the_foot_whose_mesh_is_missing_leaves_the_others_swept(tmp_path):
    whole = leg(tmp_path, "thigh", "shank")
    (tmp_path / "thigh.stl").unlink()
    body = leg(tmp_path, "shank")
    assert body.unread == ()
    np.testing.assert_allclose(body.links, whole.links)
    assert body.notes[-2] == whole.notes[-1] == "the links above the foot are swept over 2 joint(s), 40, 60 degrees"
    assert body.notes[-1].startswith(
        "the shape of link 'hip' is not read, but by its mass it passes nowhere near: thigh.stl: cannot be read"
    )


@pytest.mark.parametrize(("missing", "inertia"), [("shank", THIGH), ("thigh", "")])
def test_a_link_that_may_come_near_the_foot_and_cannot_be_read_is_named(tmp_path, missing, inertia):
    body = leg(tmp_path, *({"thigh", "shank"} - {missing}), inertia=inertia)
    assert body.unread == ({"shank": "knee", "thigh": "hip"}[missing],)
    assert (body.links is None) == (missing == "shank")
    assert f"link '{body.unread[0]}' is not read: {missing}.stl" in body.notes[-1]


def test_what_collides_stands_in_for_a_drawn_mesh_that_is_missing(tmp_path):
    drawn = LEG_OF_MESHES.replace('mesh="shank"/>', 'mesh="shank" contype="0" conaffinity="0"/>')
    (tmp_path / "leg.xml").write_text(drawn.format(inertia=THIGH, spare='<geom size=".03 .15" pos="0 0 -.2"/>'))
    bar = trimesh.creation.box((0.06, 0.06, 0.36))
    bar.export(tmp_path / "thigh.stl")
    body = read_foot_body(tmp_path / "leg.xml", "foot")
    assert body.unread == ()
    assert body.links is None  # a sphere of 30 mm, 200 mm above the ankle


def test_a_stated_shank_takes_the_place_of_a_link_that_cannot_be_read(tmp_path):
    leg(tmp_path, "thigh")
    source = FootSource(file=tmp_path / "leg.xml", body="foot")
    foot, _ = read_foot(source, sole_band=5.0)
    assert foot.unread == ("knee",)
    stated, _ = read_foot(FootSource(file=tmp_path / "leg.xml", body="foot", shank="0,0,60"), sole_band=5.0)
    assert stated.unread == ()
    assert stated.links is not None
