"""Tests of a sole's pose: it is where MuJoCo has the foot's body, and where a mesh's corners are."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from plantar import read_layout
from plantar.mujoco import Skin
from plantar.shoes import build_shoe, export_shoe
from plantar.shoes.foot.robot_model import name_of_other
from plantar.shoes.foot.source import read_foot
from plantar.shoes.order import FootSource

from .foot_family import box, turned

ROBOTS = [
    ("unitree_h1/h1.xml", "left_ankle_link", "right_ankle_link"),
    ("jvrc1/xml/scene.xml", "L_ANKLE_P_S", "R_ANKLE_P_S"),
    ("robotis_op3/op3.xml", "l_ank_roll_link", "r_ank_roll_link"),
    ("booster_t1/t1.xml", "left_foot_link", "right_foot_link"),
]

TILTED = """<mujoco><asset><mesh name="sole" vertex="{corners}"/></asset><worldbody><body pos="0 0 1"><freejoint/>
<geom type="box" size=".1 .2 .1" mass="20"/>
<body name="left_foot" pos="0 .1 -.5" quat="{left}"><joint axis="0 1 0"/><geom type="mesh" mesh="sole"
quat="{left_back}"/></body>
<body name="right_foot" pos="0 -.1 -.5" quat="{right}"><joint axis="0 1 0"/><geom type="mesh" mesh="sole"
quat="{right_back}"/></body></body></worldbody></mujoco>"""


def foot_of(file: Path, body: str | None = None) -> Any:
    return read_foot(FootSource(file=file, body=body), sole_band=5.0)[0]


def in_random_pose(file: Path) -> tuple[Any, Any]:
    """A model and its data with all joints moved."""
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    chance = np.random.default_rng(2)
    for joint in range(model.njnt):
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
            data.qpos[model.jnt_qposadr[joint]] = chance.uniform(-0.5, 0.5)
    mujoco.mj_kinematics(model, data)
    return model, data


def in_world(model: Any, data: Any, body: str, pose: Any, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of the sole frame in MuJoCo's world, by the pose and the body's own."""
    at = model.body(body).id
    return np.asarray(data.xpos[at] + pose.placed(points) @ data.xmat[at].reshape(3, 3).T)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("file", "left", "right"), ROBOTS)
def test_a_sole_is_below_its_ankle_where_mujoco_has_it(real_data, file, left, right):
    path = real_data / "robots" / file
    foot = foot_of(path, left)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    assert set(foot.poses) == {"left", "right"}
    for side, body in (("left", left), ("right", right)):
        pose = foot.poses[side]
        assert pose.body == body
        origin, x, y, z = in_world(model, data, body, pose, np.vstack([np.zeros(3), np.eye(3)]))
        # These four stand level in the zero pose, toes along x.
        np.testing.assert_allclose(np.stack([x - origin, y - origin, z - origin]), np.eye(3), atol=1e-9)
        np.testing.assert_allclose(origin[:2], data.xpos[model.body(body).id][:2], atol=1e-9)
    heights = [
        float(in_world(model, data, b, foot.poses[s], np.zeros(3))[2]) for s, b in (("left", left), ("right", right))
    ]
    assert heights[0] == pytest.approx(heights[1], abs=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("file", "left", "right"), ROBOTS)
def test_a_foots_corners_are_where_mujoco_moves_them(real_data, file, left, right):
    from scipy.spatial import cKDTree

    from plantar.mujoco.mesh_surface import mesh_surface

    path = real_data / "robots" / file
    model, data = in_random_pose(path)
    foot = foot_of(path, left)
    corners = in_world(model, data, left, foot.poses["left"], 1e-3 * foot.triangles.reshape(-1, 3))
    meshes = []
    for geom in np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH).tolist():
        points = mesh_surface(model, int(model.geom_dataid[geom]))[0]
        meshes.append(points @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    gaps, _ = cKDTree(np.concatenate(meshes)).query(corners)
    assert gaps.max() < 1e-7  # MuJoCo keeps a mesh's corners as 32-bit floats, about each mesh's own middle


def test_the_pose_of_links_that_are_turned_is_exact_and_the_skin_takes_it(tmp_path):
    corners = np.unique(box((-60.0, 140.0), (-45.0, 45.0), (-100.0, -60.0)).reshape(-1, 3), axis=0) / 1000.0
    turns = {"left": np.array([0.8, 0.2, -0.4, 0.4]), "right": np.array([0.3, -0.5, 0.6, 0.2])}
    names = {}
    for side, turn in turns.items():
        unit = turn / np.linalg.norm(turn)
        names |= {side: " ".join(map(repr, unit.tolist()))}
        names |= {f"{side}_back": " ".join(map(repr, (unit * [1, -1, -1, -1]).tolist()))}
    path = tmp_path / "robot.xml"
    path.write_text(TILTED.format(corners=" ".join(map(str, corners.ravel())), **names))
    foot = foot_of(path, "left_foot")
    model = mujoco.MjModel.from_xml_path(str(path))
    plain = mujoco.MjData(model)
    mujoco.mj_kinematics(model, plain)
    for side in ("left", "right"):
        found = in_world(model, plain, f"{side}_foot", foot.poses[side], np.vstack([np.zeros(3), np.eye(3)]))
        wanted = plain.xpos[model.body(f"{side}_foot").id] - np.array([0.0, 0.0, 0.1])
        np.testing.assert_allclose(found - wanted, np.vstack([np.zeros(3), np.eye(3)]), atol=1e-8)
    build = build_shoe(foot, layout_only=True)
    for shoe in build.shoes:
        skin = Skin(shoe.layout, f"{shoe.side}_foot").bind(model)
        pose = foot.poses[shoe.side]
        np.testing.assert_allclose(skin.rotation_to_body, pose.rotation, atol=1e-9)
        np.testing.assert_allclose(skin.position_in_body, pose.position, atol=1e-7)


def test_a_mesh_that_lies_anywhere_has_its_pose(stl, tmp_path):
    foot = np.concatenate([box((-60, 140), (-45, 45), (0, 30)), box((-20, 20), (-20, 20), (30, 80))])
    lying = turned(foot, 90.0, 0.0, 90.0) + np.array([300.0, 20.0, -700.0])
    path = stl(lying, "right_foot.stl")
    found = read_foot(FootSource(file=path, up="x"), sole_band=5.0)[0]
    report = export_shoe(build_shoe(found, layout_only=True), tmp_path)
    pose = read_layout(tmp_path / "layout_right.json").pose
    assert (pose.file, pose.body) == ("right_foot.stl", None)
    assert read_layout(tmp_path / "layout_left.json").pose is None
    assert report.as_dict()["poses"]["left"] is None
    right = (1e-3 * found.triangles * [1.0, -1.0, 1.0]).reshape(-1, 3)  # the left foot is made of it
    thickness = np.array([0.0, 0.0, 1e-3 * report.build.parameters.thickness])
    placed = pose.placed(right + thickness)
    known = np.sort(np.unique((1e-3 * lying).reshape(-1, 3).round(6), axis=0), axis=0)
    np.testing.assert_allclose(np.sort(np.unique(placed.round(6), axis=0), axis=0), known, atol=2e-6)


@pytest.mark.parametrize("forward", ["x", "-y"])
def test_a_drawings_pose_is_that_of_its_axes(tmp_path, forward):
    path = tmp_path / "sole.svg"
    size = ("200", "90") if forward == "x" else ("90", "200")
    path.write_text(
        f'<svg width="300mm" viewBox="0 0 300 300"><rect x="30" y="40" width="{size[0]}" height="{size[1]}"/></svg>'
    )
    foot = read_foot(FootSource(file=path, forward=forward), sole_band=5.0)[0]
    corners = foot.poses["left"].placed(np.array([[-0.1, -0.045, 0.0], [0.1, 0.045, 0.0]]))
    low, high = np.sort(corners, axis=0)
    wide, tall = (0.001 * float(v) for v in size)
    np.testing.assert_allclose(low, [0.03, -0.04 - tall, 0.0], atol=1e-9)
    np.testing.assert_allclose(high, [0.03 + wide, -0.04, 0.0], atol=1e-9)


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("left_ankle_roll_link", "right_ankle_roll_link"),
        ("L_ANKLE_P_S", "R_ANKLE_P_S"),
        ("RightFoot", "LeftFoot"),
        ("leftfoot", "rightfoot"),
        ("leg_right_6_link", "leg_left_6_link"),
        ("foot", None),
    ],
)
def test_the_other_foots_body_is_named_as_this_one(name, other):
    assert name_of_other(name) == other
