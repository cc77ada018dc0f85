"""Robots from model files: the H1 written out as MJCF, with parts that a walking robot does not need, and JVRC-1."""

import re
import shutil
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar.errors import RobotError, SceneError
from plantar.layouts.layout_file import read_layout, write_layout
from plantar.layouts.source_pose import SourcePose
from plantar.mechanics.rotation import rotation_from_angles
from plantar.robots import load_robot
from plantar.robots.kinematics.robot_model import build_leg_model, robot_spec
from plantar.shoes import build_shoe, export_shoe, foot_from_mesh
from plantar.sim.model.world import build_world
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene
from plantar.sim.run.servos import LegServos
from plantar.sim.terrain import Ground

ROBOT = """
name = "own"
[model]
kind = "mjcf"
file = "own.xml"
[shoe]
layout = "layout_{side}.json"
origin = [0.0, 0.0, -0.129]
thickness = 0.012
mass = 0.273
[legs.left]
joints = [JOINTS]
foot_body = "left_foot"
[legs.right]
joints = [JOINTS]
foot_body = "right_foot"
[torso]
body = "base"
imu_site = "imu"
[posture]
left = [0.0, 0.0, -20.0, 40.0, -20.0, 0.0]
right = [0.0, 0.0, -20.0, 40.0, -20.0, 0.0]
[gait]
com_height = 0.80
stance_width = 0.17
[servo]
stiffness = 8000.0
damping = 150.0
effort_limits = [51.0, 71.0, 63.0, 140.0, 92.0, 71.0]
[balance]
law = "com_admittance"
dcm_gain = 3.0
zmp_gain = 0.5
com_gain = 1.0
"""
NAMES = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")


@pytest.fixture
def own(tmp_path):
    """The H1 as somebody else would hand it over: motors, a floor, a moving arm, a keyframe; no shoes."""
    h1 = load_robot("h1")
    spec = robot_spec(h1)
    for side in ("left", "right"):
        spec.delete(spec.geom(f"{side}_sole_box"))
        spec.delete(spec.site(f"{side}_sole"))
        # The H1's foot holds its shoe; here the shoe comes as a part of its own.
        foot = spec.body(f"{side}_foot")
        foot.mass = foot.mass - h1.shoe_mass
    arm = spec.body("chest").add_body(name="arm", pos=[0.0, 0.3, 0.3])
    arm.add_joint(name="shoulder", axis=[0, 1, 0])
    arm.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.05, 0, 0], mass=0.5, contype=1, conaffinity=1)
    spec.worldbody.add_geom(name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    spec.compile()
    (tmp_path / "own.xml").write_text(spec.to_xml())
    for side in ("left", "right"):
        shutil.copy(h1.path.parent / f"layout_{side}.json", tmp_path)
    text = ROBOT
    for side in ("left", "right"):
        text = text.replace("JOINTS", ", ".join(f'"{side}_{n}"' for n in NAMES), 1)
    (tmp_path / "robot.toml").write_text(text)
    return tmp_path / "robot.toml"


def test_legs_are_kept_and_the_rest_is_welded(own):
    world = build_world(load_robot(own), Ground((), 0.0, 0.8))
    model = world.model
    assert model.nv == 18
    assert model.nu == 12
    assert mujoco.mj_getTotalmass(model) == pytest.approx(86.5, abs=0.01)
    on_the_ground = {model.geom(i).name for i in range(model.ngeom) if model.geom_contype[i] & 3}
    assert on_the_ground == {"ground", "left_sole_box", "right_sole_box"}
    mujoco.mj_kinematics(model, world.data)
    for side in ("left", "right"):
        site, box = world.data.site(f"{side}_sole").xpos, world.data.geom(f"{side}_sole_box").xpos
        assert box[2] - site[2] == pytest.approx(0.006)
        assert np.sign(site[1]) == (1 if side == "left" else -1)


def test_it_walks(own):
    summary = run_scene(load_scene("flat", ["steps=4", "settle=1.0"], robot=str(own)))
    assert summary["completed"], summary
    assert summary["robot"] == "own"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"left_knee"', '"left_knie"', ("left_knie", "left_knee")),
        ('foot_body = "left_foot"', 'foot_body = "left_hoof"', ("left_hoof", "left_foot")),
        ('body = "base"', 'body = "trunk"', ("trunk", "base")),
        ("origin = [0.0, 0.0, -0.129]\n", "", ("origin", "3")),
        ('"left_hip_roll", "left_hip_pitch", "left_knee", ', "", ("[legs.left]", "names 3", "4 or more")),
        ('"left_knee", ', "", ("[legs]", "the left leg has 5 joints")),
        ('"left_knee"', '"left_hip_yaw"', ("[legs.left]", "left_hip_yaw", "more than once")),
        ('"right_knee"', '"left_knee"', ("both legs", "left_knee")),
        ('"left_knee"', '"shoulder"', ("[legs.left]", "shoulder", "left_foot", "left_knee")),
        ('foot_body = "right_foot"', 'foot_body = "left_foot"', ("[legs.right]", "right_hip_yaw", "left_foot")),
        ('body = "base"', 'body = "world"', ("[torso] body", "world")),
        ('body = "base"', 'body = "left_shank"', ("[torso] body", "left_knee")),
        ('imu_site = "imu"', 'imu_site = "left_ankle_force_torque"', ("imu_site", "left_ankle_roll")),
        ('imu_site = "imu"', 'imu_site = "left_sole"', ("IMU", "left_sole")),
        ("layout_{side}.json", "layout_left.json", ("layout_left.json", "{side}", "right")),
        ("layout_{side}.json", "layout_{foot}.json", ("layout_{foot}.json", "cannot be read")),
        ("stiffness = 8000.0", "stiffness = 0", ("stiffness", "1 to 1e+06")),
        ("stiffness = 8000.0", "stiffness = inf", ("stiffness", "inf")),
        ("stiffness = 8000.0", "stiffness = [8000.0]", ("stiffness", "6 numbers")),
        ("thickness = 0.012", "rotation = [0.0, 20.0]\nthickness = 0.012", ("rotation", "3 numbers")),
        ("left = [0.0", "left = [1e9", ("[posture]", "left", "360")),
        ("left = [0.0", "left = [true", ("[posture]", "left", "True")),
        ("effort_limits = [51.0", "effort_limits = [-51.0", ("effort_limits", "-51")),
        ("com_height = 0.80", "com_height = 0.80\nsingle_suport = 0.5", ("[gait]", "single_suport", "single_support")),
        ('name = "own"', 'name = "own"\nservos = 1', ("servos", "servo")),
        ("dcm_gain", "dcm_gian", ("[balance]", "dcm_gian", "dcm_gain")),
        ("effort_limits = [51.0, ", "effort_limits = [", ("effort_limits", "6")),
        ("com_height = 0.80", "com_height = 1.20", ("CoM at 1.200",)),
    ],
)
def test_bad_files_say_what_is_wrong(own, old, new, words):
    text = own.read_text()
    assert old in text
    own.write_text(text.replace(old, new))
    with pytest.raises(Exception) as caught:  # noqa: PT011  RobotError or SceneError, both PlantarErrors
        run_scene(load_scene("flat", ["steps=2", "crouch=0"], robot=str(own)))
    assert all(word in str(caught.value) for word in words), caught.value
    assert "\n" not in str(caught.value)


def test_a_robot_without_an_origin_takes_the_poses_of_its_layouts(own):
    places = {side: np.array([0.01, -0.02 if side == "left" else 0.02, -0.13]) for side in ("left", "right")}
    own.write_text(own.read_text().replace("origin = [0.0, 0.0, -0.129]\n", ""))
    for side, place in places.items():
        path = own.parent / f"layout_{side}.json"
        pose = SourcePose("own.xml", f"{side}_foot", place, np.eye(3))
        write_layout(replace(read_layout(path), pose=pose), path)
    robot = load_robot(own)
    for side, place in places.items():
        np.testing.assert_array_equal(robot.sole_origins[side], place)
    pose = SourcePose("own.xml", "another", np.zeros(3), np.eye(3))
    write_layout(replace(read_layout(path), pose=pose), path)
    with pytest.raises(RobotError, match="origin"):
        load_robot(own)


def test_a_file_that_is_no_model_is_one_line(own):
    (own.parent / "own.xml").write_text("<mujoco><worldbody><body></mujoco>")
    with pytest.raises(RobotError, match=r"own\.xml") as caught:
        build_world(load_robot(own), Ground((), 0.0, 0.8))
    assert "\n" not in str(caught.value)


def test_left_and_right_are_not_mixed_up(own):
    swapped = own.read_text().replace('"left_', '"LEFT_').replace('"right_', '"left_').replace('"LEFT_', '"right_')
    own.write_text(swapped)
    with pytest.raises(RobotError, match=r"\[legs\.left\] is to the right"):
        run_scene(load_scene("flat", ["steps=2"], robot=str(own)))


def test_unstable_physics_is_an_error_that_leaves_no_log(own, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    # It stands, and the servos' set-points diverge as it walks.
    monkeypatch.setattr(LegServos, "_choose_drive", lambda servos: lambda: servos._world.data.ctrl.fill(1e11))
    with pytest.raises(SceneError, match="unstable"):
        run_scene(load_scene("flat", ["steps=2"], robot=str(own)))
    assert capfd.readouterr().err == ""
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


def test_a_model_s_own_settings_names_and_unlimited_joints_do_not_matter(own):
    model = own.parent / "own.xml"
    text = model.read_text()
    plain = build_world(load_robot(own), Ground((), 0.0, 0.8)).model
    text = text.replace("<worldbody>", '<option gravity="0 0 0"><flag contact="disable"/></option><worldbody>', 1)
    text = text.replace('name="left_foot"', 'name="left_foot" gravcomp="1"', 1)
    text = text.replace('<site name="left_ankle_force_torque"', '<site name="left_sole"/>\n\\g', 1).replace(
        "\\g", '<site name="left_ankle_force_torque"'
    )
    model.write_text(re.sub(r' range="[^"]*"', "", text))
    odd = build_world(load_robot(own), Ground((), 0.0, 0.8)).model
    assert not odd.jnt_limited.any()
    assert np.array_equal(odd.opt.gravity, plain.opt.gravity)
    assert not odd.opt.disableflags
    assert not odd.body_gravcomp.any()
    assert odd.site("left_sole").pos == pytest.approx(plain.site("left_sole").pos)
    summary = run_scene(load_scene("flat", ["steps=2", "settle=1.0"], robot=str(own)))
    assert summary["completed"], summary


def test_an_imu_may_be_mounted_any_way_round(own):
    model = own.parent / "own.xml"
    text = model.read_text()
    assert '<site name="imu"' in text
    model.write_text(text.replace('<site name="imu"', '<site name="imu" quat="0 0.6 0.8 0"'))
    # Steps where they are planned: as they go along with its sway, it tilts by up to 2.7 deg.
    summary = run_scene(load_scene("flat", ["steps=2", "settle=1.0", "step_adjustment=false"], robot=str(own)))
    assert summary["completed"], summary
    assert summary["tilt_max_deg"] < 1.5


def test_a_byte_order_mark_is_no_error(own):
    for path in (own, own.parent / "layout_left.json"):
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert load_robot(own).name == "own"


def h1_urdf() -> str:
    """The H1's legs as URDF: links with mass, revolute joints, no floating base."""
    links = ['<link name="base">' + urdf_inertial(63.5, "0 0 0.08", 1.5) + "</link>"]
    joints = []
    axes = ("0 0 1", "1 0 0", "0 1 0", "0 1 0", "0 1 0", "1 0 0")
    drops = ("-0.1435", "0", "0", "-0.3", "-0.3", "0")
    for side, y in (("left", 0.075), ("right", -0.075)):
        parent = "base"
        for i, name in enumerate(NAMES):
            link = f"{side}_foot" if i == 5 else f"{side}_{name}_link"
            links.append(f'<link name="{link}">' + urdf_inertial(1.9, "0 0 -0.05", 0.01) + "</link>")
            joints.append(
                f'<joint name="{side}_{name}" type="revolute"><parent link="{parent}"/><child link="{link}"/>'
                f'<origin xyz="0 {y if i == 0 else 0} {drops[i]}"/><axis xyz="{axes[i]}"/>'
                '<limit lower="-2.4" upper="2.4" effort="100" velocity="6"/></joint>'
            )
            parent = link
    return f'<robot name="own">{"".join(links)}{"".join(joints)}</robot>'


def urdf_inertial(mass: float, place: str, inertia: float) -> str:
    moments = f'ixx="{inertia}" iyy="{inertia}" izz="{inertia}" ixy="0" ixz="0" iyz="0"'
    return f'<inertial><origin xyz="{place}"/><mass value="{mass}"/><inertia {moments}/></inertial>'


def test_a_urdf_gets_a_floating_base_and_walks(own):
    (own.parent / "own.urdf").write_text(h1_urdf())
    text = own.read_text().replace('kind = "mjcf"', 'kind = "urdf"').replace("own.xml", "own.urdf")
    own.write_text(text.replace("com_height = 0.80", "com_height = 0.76"))
    world = build_world(load_robot(own), Ground((), 0.0, 0.8))
    assert (world.model.nv, world.model.nu) == (18, 12)
    assert mujoco.mj_getTotalmass(world.model) == pytest.approx(63.5 + 12 * 1.9 + 2 * 0.273)
    # At its own com_height: with the default crouch, 3 cm lower, it falls.
    summary = run_scene(load_scene("flat", ["steps=2", "settle=1.0", "length=0.1", "crouch=0"], robot=str(own)))
    assert summary["completed"], summary


JVRC1 = """
name = "jvrc1"
[model]
kind = "mjcf"
file = "{model}"
[shoe]
layout = "layout_{{side}}.json"
origin = [0.0, 0.0, -0.1197]
thickness = 0.012
mass = 0.219
[legs.left]
joints = ["L_HIP_P", "L_HIP_R", "L_HIP_Y", "L_KNEE", "L_ANKLE_R", "L_ANKLE_P"]
foot_body = "L_ANKLE_P_S"
[legs.right]
joints = ["R_HIP_P", "R_HIP_R", "R_HIP_Y", "R_KNEE", "R_ANKLE_R", "R_ANKLE_P"]
foot_body = "R_ANKLE_P_S"
[torso]
body = "PELVIS_S"
imu_site = "imu"
[posture]
left = [-25.0, 0.0, 0.0, 50.0, 0.0, -25.0]
right = [-25.0, 0.0, 0.0, 50.0, 0.0, -25.0]
[gait]
com_height = 0.84
stance_width = 0.192
[servo]
stiffness = 8000.0
damping = 150.0
[balance]
law = "com_admittance"
dcm_gain = 3.0
zmp_gain = 0.5
com_gain = 1.0
"""


def test_jvrc1_walks_in_a_shoe_of_its_own_foot(real_data, tmp_path, monkeypatch):
    build = build_shoe(foot_from_mesh(real_data / "feet" / "jvrc1.stl"), side="both", layout_only=True)
    export_shoe(build, tmp_path)
    path = tmp_path / "robot.toml"
    path.write_text(JVRC1.format(model=real_data / "robots" / "jvrc1" / "xml" / "jvrc1.xml"))
    with pytest.raises(RobotError, match=r"lies elsewhere; allowed: .*PLANTAR_MODEL_FOLDERS"):
        load_robot(path)
    monkeypatch.setenv("PLANTAR_MODEL_FOLDERS", str(real_data / "robots"))
    # Steps where they are planned: as they go along with its sway, it tilts by up to 2.7 deg.
    summary = run_scene(load_scene("flat", ["steps=4", "settle=1.0", "step_adjustment=false"], robot=str(path)))
    assert summary["completed"], summary
    assert summary["tilt_max_deg"] < 2.0


def test_a_leg_keeps_the_models_own_shapes_and_gets_capsules_where_it_has_none(own):
    text = (own.parent / "own.xml").read_text()
    spec = mujoco.MjSpec.from_string(text)
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    spec.body("left_shank").add_geom(
        name="calf", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.03, 0.1, 0.0], pos=[0.0, 0.0, -0.15]
    )
    spec.body("chest").add_geom(name="belly", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.3, 0.0, 0.0])
    (own.parent / "own.xml").write_text(spec.to_xml())
    model = build_world(load_robot(own), Ground((), 0.0, 0.8)).model
    for side, contype in (("left", 4), ("right", 8)):
        found = [
            (model.body(model.geom_bodyid[g]).name, int(model.geom_type[g]))
            for g in range(model.ngeom)
            if model.geom_contype[g] == contype and model.geom(g).name != f"{side}_foot_shape"
        ]
        shank = mujoco.mjtGeom.mjGEOM_CYLINDER if side == "left" else mujoco.mjtGeom.mjGEOM_CAPSULE
        assert found == [(f"{side}_thigh", int(mujoco.mjtGeom.mjGEOM_CAPSULE)), (f"{side}_shank", int(shank))]
    assert not model.geom("belly").contype


def test_a_gain_of_each_joint_reaches_its_servo(own):
    gains = [8000.0, 7000.0, 6000.0, 5000.0, 4000.0, 3000.0]
    own.write_text(own.read_text().replace("stiffness = 8000.0", f"stiffness = {gains}"))
    world = build_world(load_robot(own), Ground((), 0.0, 0.8))
    np.testing.assert_array_equal(world.stiffness, gains * 2)
    np.testing.assert_array_equal(world.damping, 150.0)


def test_set_points_lead_by_the_joints_own_damping(own):
    spec = mujoco.MjSpec.from_file(str(own.parent / "own.xml"))
    spec.joint("left_knee").damping[0] = 30.0
    (own.parent / "own.xml").write_text(spec.to_xml())
    robot = load_robot(own)
    world, legs = build_world(robot, Ground((), 0.0, 0.8)), build_leg_model(robot)
    setpoints = LegServos(world, legs, 0.005)._setpoints
    still, speed = np.zeros(12), np.full(12, 0.1)
    setpoints.hold(still, still)
    legs.joints[:] = 0.005 * speed
    setpoints.go_to()
    setpoints.load()
    # What is written follows the goal by a low pass, and lags it.
    gain = world.stiffness * (np.asarray(setpoints.goal) - 0.005 * speed) / speed
    np.testing.assert_allclose(gain - world.damping, [0, 0, 0, 30.0, *[0] * 8], atol=1e-9)


def test_a_foot_frame_that_is_turned_against_its_sole_walks_as_one_that_is_not(own):
    """The same robot, its left foot's frame turned and the right one's otherwise: the file says by how much."""
    straight = robot_spec(load_robot(own)).compile()
    spec = mujoco.MjSpec.from_file(str(own.parent / "own.xml"))
    places = {}
    for side, angles in (("left", (0.1, 0.3, -0.2)), ("right", (-0.2, 0.1, 0.35))):
        foot = spec.body(f"{side}_foot")
        turn, back, quaternion = rotation_from_angles(*angles), np.empty(4), np.empty(4)
        mujoco.mju_mat2Quat(quaternion, turn.ravel())
        mujoco.mju_negQuat(back, quaternion)
        foot.quat = quaternion
        for joint in foot.joints:
            joint.axis = turn.T @ joint.axis
        foot.ipos, inertia = turn.T @ foot.ipos, np.empty(4)
        mujoco.mju_mulQuat(inertia, back, foot.iquat)
        foot.iquat = inertia
        for element in (*foot.geoms, *foot.sites):
            element.pos = turn.T @ element.pos
        places[side] = (turn.T @ [0.0, 0.0, -0.129], np.degrees(roll_pitch_yaw(turn.T)))
    (own.parent / "own.xml").write_text(spec.to_xml())
    (left, left_turn), (right, right_turn) = places["left"], places["right"]
    own.write_text(
        own.read_text().replace(
            "origin = [0.0, 0.0, -0.129]",
            f"origin = {left.tolist()}\nrotation = {left_turn.tolist()}\n"
            f"origin_right = {right.tolist()}\nrotation_right = {right_turn.tolist()}",
        )
    )
    turned = robot_spec(load_robot(own)).compile()
    states = [mujoco.MjData(model) for model in (straight, turned)]
    for model, data in zip((straight, turned), states, strict=True):
        data.qpos[7:] = np.linspace(-0.3, 0.4, model.nq - 7)
        mujoco.mj_forward(model, data)
    for side in ("left", "right"):
        for part in ("xpos", "xmat"):
            a, b = (getattr(data.site(f"{side}_sole"), part) for data in states)
            np.testing.assert_allclose(a, b, atol=1e-6)  # the XML has six digits
    np.testing.assert_allclose(states[0].subtree_com[0], states[1].subtree_com[0], atol=1e-6)


def roll_pitch_yaw(rotation: np.ndarray) -> tuple[float, float, float]:
    """Roll, pitch and yaw in rad of a rotation."""
    pitch = float(-np.arcsin(rotation[2, 0]))
    return float(np.arctan2(rotation[2, 1], rotation[2, 2])), pitch, float(np.arctan2(rotation[1, 0], rotation[0, 0]))
