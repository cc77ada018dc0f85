"""What a model's file holds beside the robot, and joints of a URDF that cannot turn."""

import itertools
import re
import warnings
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar import RobotError
from plantar.robots.survey.body_surface import shapes_of
from plantar.robots.survey.stated_model import read_stated_model
from plantar.robots.survey.surface_file import stl_bytes
from plantar.robots.survey.survey import NO_SPEED, survey_model

from .random_biped import random_biped

THINGS = """
<body name="table" pos="1 0 0.2"><geom type="box" size="0.2 0.2 0.2" mass="50"/></body>
<body name="ball" pos="0 0 -3"><freejoint/><geom size="0.05" mass="2"/><site name="inside"/></body>
<body name="door" pos="2 0 0"><joint type="hinge" axis="0 0 1"/><geom type="box" size="0.4 0.02 1" mass="20"/></body>
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(6))
def test_what_else_is_in_a_scene_is_no_part_of_the_robot(seed, tmp_path):
    truth = random_biped(seed, tmp_path)
    alone = survey_model(truth.file, tmp_path)
    text = truth.file.read_text().replace("</worldbody>", f"{THINGS}</worldbody>")
    posture = " ".join(["0.3"] * (alone.source.model.nq + 8))
    sensor = f'<sensor><gyro site="inside"/></sensor><keyframe><key qpos="{posture}"/></keyframe>'
    truth.file.write_text(text.replace("</mujoco>", f"{sensor}</mujoco>"))
    found = survey_model(truth.file, tmp_path)
    assert set(found.held.values()) == {0.3}
    assert found.mass == pytest.approx(alone.mass, rel=1e-12)
    assert found.joint_names("left") == alone.joint_names("left")
    assert (found.legs.rotation == alone.legs.rotation).all()
    assert found.imu == alone.imu
    assert any("no part of the robot: table, ball, door" in note for note in found.notes)
    missing = ", ".join(found.joint_names("left"))
    assert any(note.endswith(f"(put the motors' in effort_limits): {missing}") for note in found.notes)


def urdf(limit: str, kind: str = "revolute") -> str:
    inertia = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    links = "".join(f'<link name="{name}">{inertia}</link>' for name in ("base", "arm"))
    joint = f'<joint name="elbow" type="{kind}"><parent link="base"/><child link="arm"/>{limit}</joint>'
    return f'<robot name="r">{links}{joint}</robot>'


@pytest.mark.parametrize("limit", ['<limit effort="5" velocity="1"/>', '<limit lower="0" upper="0" effort="5"/>'])
def test_a_joint_whose_limits_leave_no_range_is_held_and_reported(tmp_path, limit):
    file = tmp_path / "robot.urdf"
    file.write_text(urdf(limit))
    source = read_stated_model(file, tmp_path)
    assert source.model.njnt == 0
    assert any(note.startswith("held, as their limits leave no range") for note in source.notes)
    with pytest.raises(RobotError, match=r"no chain of 4 hinges.*; held, as their limits leave no range.*: elbow"):
        survey_model(file, tmp_path)


@pytest.mark.parametrize("most", ["1", "10", "12.6", "1e16", ""])
def test_a_joint_with_a_range_or_without_limits_turns(tmp_path, most):
    file = tmp_path / "robot.urdf"
    limit = f'<limit lower="-{most}" upper="{most}" effort="5"/>' if most else ""
    file.write_text(urdf(limit, "revolute" if limit else "continuous"))
    source = read_stated_model(file, tmp_path)
    assert source.model.njnt == 1
    assert bool(source.model.jnt_limited[0]) == bool(limit)


@pytest.mark.parametrize(
    ("lower", "upper", "words"),
    [
        *((lower, upper, "; allowed: lower below upper, or") for lower, upper in ((1, -1), (0.3, 0.3), ("nan", 1))),
        ("-inf", "inf", "; allowed: lower below upper, or .* continuous"),
        (-90, 90, "rad, which look like degrees; allowed: 20 rad"),
        (0, 45, "rad, which look like degrees; allowed: 20 rad"),
    ],
)
def test_limits_that_contradict_each_other_or_are_in_degrees_are_refused(tmp_path, lower, upper, words):
    file = tmp_path / "robot.urdf"
    file.write_text(urdf(f'<limit lower="{lower}" upper="{upper}"/>'))
    with pytest.raises(RobotError, match=f"joint 'elbow' has limits from {lower} to {upper}.*{words}"):
        read_stated_model(file, tmp_path)


@pytest.mark.parametrize(
    ("joint", "motor", "words"),
    [
        ("range='90 -90'", "", "joint 'a' has limits from 90 to -90; allowed: finite"),
        ("actuatorfrcrange='9 -9'", "", "joint 'a' has torque limits from 9 to -9; allowed"),
        ("", "forcerange='9 -9'", "motor 'a' has force limits from 9 to -9; allowed"),
        ("", "ctrlrange='9 -9'", "motor 'a' has control limits from 9 to -9; allowed"),
    ],
)
def test_swapped_limits_which_mujoco_ignores_are_refused(tmp_path, joint, motor, words):
    file = tmp_path / "swapped.xml"
    body = f"<body><joint name='a' {joint}/><geom size='.1'/></body>"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody><actuator><motor joint='a' {motor}/></actuator></mujoco>")
    with pytest.raises(RobotError, match=words):
        read_stated_model(file, tmp_path)


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("name", "imu"),
    [
        *((name, True) for name in ("imu", "base_imu_link", "TorsoIMULink", "ImuTorso_frame", "IMU_2", "trunkImu")),
        *((name, False) for name in ("simulated_link", "maximum", "MAXIMUM", "SIMULATED_LINK", "stimulus")),
    ],
)
def test_what_is_called_an_imu_is_one(tmp_path, name, imu):
    file = tmp_path / "named.xml"
    body = f"<body name='b'><site name='{name}'/><geom size='.1'/></body>"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    assert read_stated_model(file, tmp_path).imus == ((("site", name),) if imu else ())


def test_a_joint_that_follows_another_is_reported_once(tmp_path):
    truth = random_biped(10, tmp_path)
    follower, leader = truth.joints["left"][3:5]
    coupled = f'<equality>{2 * f"""<joint joint1="{follower}" joint2="{leader}"/>"""}</equality>'
    truth.file.write_text(truth.file.read_text().replace("</mujoco>", f"{coupled}</mujoco>"))
    assert sum("follows" in note for note in survey_model(truth.file, tmp_path).notes) == 1


def test_links_of_a_urdf_that_are_weighed_by_their_shapes_are_named(tmp_path):
    file = tmp_path / "robot.urdf"
    box = '<collision><geometry><box size=".1 .1 .1"/></geometry></collision>'
    file.write_text(
        urdf("")
        .replace('type="revolute"', 'type="fixed"')
        .replace(
            "</robot>",
            f"""<link name="toe">{box}
        </link><joint name="j" type="fixed"><parent link="arm"/><child link="toe"/></joint></robot>""",
        )
    )
    notes = read_stated_model(file, tmp_path).notes
    assert notes == ["without an inertial, weighed by their shapes as water: 1 kg: toe"]


@pytest.mark.parametrize(
    ("mass", "inertia", "words"),
    [
        (1e3, 1e3, r"weighs 6.3e\+04 kg, and '.*; allowed: 0.1 to 1000 kg, .* inertias in kg m"),
        (1e-3, 1e-3, "weighs 0.063"),
        (1.0, 1e3, "weighs 63 kg, and 'trunk' turns as if its mass were .* m off; allowed: .* kg, .* m "),
    ],
)
def test_masses_and_inertias_in_other_units_are_refused(tmp_path, mass, inertia, words):
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    for body in spec.bodies[1:]:
        body.mass, body.inertia = mass * body.mass, inertia * body.inertia
    truth.file.write_text(spec.to_xml())
    with pytest.raises(RobotError, match=words):
        survey_model(truth.file, tmp_path)


def test_a_robot_whose_feet_alone_have_a_mass_is_refused(tmp_path):
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    for body in spec.bodies[1:]:
        body.mass, body.inertia = (1.0, [0.001] * 3) if body.name in truth.feet.values() else (1e-6, [1e-9] * 3)
    truth.file.write_text(spec.to_xml())
    with pytest.raises(RobotError, match="100 % of the robot's 2 kg are in its feet; allowed: half at most"):
        survey_model(truth.file, tmp_path)


def test_torque_limits_in_other_units_are_noted(tmp_path):
    truth = random_biped(10, tmp_path)
    knee = truth.joints["left"][3]
    plain = truth.file.read_text()
    for most, noted in ((200, False), (200_000, True)):
        limit = f'<actuator><motor joint="{knee}" ctrlrange="{-most} {most}"/></actuator>'
        truth.file.write_text(plain.replace("</mujoco>", f"{limit}</mujoco>"))
        notes = survey_model(truth.file, tmp_path).notes
        assert any(note.endswith(f"limit nothing (N m are read, not N mm): {knee} 200000") for note in notes) == noted


def test_springs_of_legs_are_left_out_with_a_note(tmp_path):
    truth = random_biped(10, tmp_path)
    knee = truth.joints["left"][3]
    truth.file.write_text(truth.file.read_text().replace(f'name="{knee}"', f'name="{knee}" stiffness="9"'))
    assert f"the joints' springs are left out: {knee}" in survey_model(truth.file, tmp_path).notes


MARKED = """
<body name="marked" pos="0 0 1"><joint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<geom type="box" size=".1 .05 .02" contype="0" conaffinity="0"/>
<geom size="0.02" pos="0 0 -0.1" contype="0" conaffinity="0"/><geom size="0" pos="0 0 -0.2"/>
<geom type="mesh" mesh="open" contype="0" conaffinity="0"/></body>
"""


def test_markers_shapes_without_a_size_and_the_authors_inertia_are_no_obstacles(tmp_path):
    file = tmp_path / "marked.xml"
    open_box = 'name="open" inertia="shell" vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1" face="0 1 2 0 1 3"'
    file.write_text(f"<mujoco><asset><mesh {open_box}/></asset><worldbody>{MARKED}</worldbody></mujoco>")
    source = read_stated_model(file, tmp_path)
    assert any("1 shapes without a size" in note for note in source.notes)
    body = source.model.body("marked").id
    drawn, colliding = shapes_of(source.model, (body,))
    assert [int(source.model.geom_type[g]) for g in drawn] == [mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH]
    assert not colliding


@pytest.mark.parametrize(
    ("motors", "gains"),
    [
        ("<position joint='a' kp='30' kv='2' gear='2'/>", (120.0, 8.0)),
        ("<position joint='a' kp='30' dampratio='1' gear='2'/>", (120.0, -1.0)),  # a ratio of critical
        ("<velocity joint='a' kv='2' gear='2'/><position joint='a' kp='30' gear='2'/>", (120.0, 8.0)),
        ("<position joint='a' kp='30' kv='2' gear='2'/><position joint='a' kp='7' kv='1'/>", (127.0, 9.0)),
        ("<position joint='a' kp='7' kv='1'/><position joint='a' kp='30' kv='2' gear='2'/>", (127.0, 9.0)),
        ("<position joint='a' kp='7' kv='1'/><position joint='a' kp='30' dampratio='1' gear='2'/>", (127.0, -1.0)),
        ("<position joint='a' kp='7' dampratio='1'/><position joint='a' kp='9' dampratio='1'/>", (16.0, -1.0)),
    ],
)
def test_gains_of_position_servos_are_read(tmp_path, motors, gains):
    file = tmp_path / "servo.xml"
    body = "<body><joint name='a'/><geom size='.1'/></body>"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody><actuator>{motors}</actuator></mujoco>")
    assert read_stated_model(file, tmp_path).gains == {"a": gains}


@pytest.mark.parametrize(
    ("motor", "effort"),
    [
        ("<motor joint='a' ctrlrange='-2 2' gear='-50'/>", 100.0),
        ("<motor joint='a' ctrlrange='-80 20'/>", 20.0),  # of the weaker direction
        ("<motor joint='a' ctrlrange='0 80'/>", 80.0),
        ("<position joint='a' kp='9' forcerange='-30 40' gear='2' ctrlrange='-1 1'/>", 60.0),
        ("<position joint='a' kp='9' ctrlrange='-1 1'/>", 90.0),
        ("<motor joint='a' ctrlrange='-30 30'/><motor joint='a' ctrlrange='-40 50'/>", 70.0),  # they add
        ("<position joint='a' forcerange='-30 30'/><velocity joint='a' kv='1' forcerange='-30 30'/>", 30.0),
        ("<motor tendon='t' ctrlrange='-3000 3000' gear='2'/>", 50.0),
        ("<motor tendon='t' ctrlrange='-9000 9000'/><motor joint='a' ctrlrange='-2 2'/>", 52.0),
    ],
)
def test_torque_limits_are_those_of_joint_and_motor(tmp_path, motor, effort):
    file = tmp_path / "motor.xml"
    body = "<body><joint name='a' actuatorfrcrange='-90 110'/><geom size='.1'/></body>"
    tendon = "<tendon><fixed name='t' actuatorfrcrange='-7000 5000'><joint joint='a' coef='-.01'/></fixed></tendon>"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody>{tendon}<actuator>{motor}</actuator></mujoco>")
    assert read_stated_model(file, tmp_path).efforts == {"a": min(effort, 90.0)}


@pytest.mark.sample(4)
@pytest.mark.parametrize("seed", range(12))
def test_torque_limits_of_several_motors_are_what_mujoco_lets_them_reach(tmp_path, seed):
    """Motors at a joint at rest in every corner of their controls; gears and coefficients of either sign."""
    random = np.random.default_rng(seed)
    motors = ""
    for _ in range(int(random.integers(1, 4))):
        low = random.uniform(-9.0, 0.0) * (random.random() < 0.6)
        high = random.uniform(1.0, 9.0)
        place = "joint='a'" if random.random() < 0.6 else "tendon='t'"
        gear = f"gear='{random.choice([-1, 1]) * random.uniform(1.0, 30.0)}'"
        damped = f"<general {place} {gear} gainprm='1' biastype='affine' biasprm='0 0 -3' ctrlrange='{low} {high}'/>"
        clamped = f"forcerange='{0.5 * low - 0.1} {0.7 * high}'" if random.random() < 0.5 else ""
        plain = f"<motor {place} {gear} {clamped} ctrlrange='{low} {high}'/>"
        motors += damped if random.random() < 0.3 else plain
    body = "<body><joint name='a'/><geom size='.1'/></body>"
    tendon = "<tendon><fixed name='t'><joint joint='a' coef='-.7'/></fixed></tendon>"
    file = tmp_path / "motors.xml"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody>{tendon}<actuator>{motors}</actuator></mujoco>")
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    reached = []
    for corner in itertools.product(*model.actuator_ctrlrange):
        data.ctrl[:] = corner
        mujoco.mj_forward(model, data)
        reached.append(float(data.qfrc_actuator[0]))
    one_way = max(reached) <= 0.0 or min(reached) >= 0.0
    found = read_stated_model(file, tmp_path)
    limit = max(map(abs, reached)) if one_way else min(max(reached), -min(reached))
    assert found.efforts["a"] == pytest.approx(limit)
    assert any("push one way only" in note for note in found.notes) == one_way


def test_what_a_motor_on_a_tendon_and_gravity_compensation_were_is_said(tmp_path):
    body = "<body name='b' gravcomp='1'><joint name='a'/><geom size='.1'/></body>"
    tendon = "<tendon><fixed name='t'><joint joint='a' coef='1'/></fixed></tendon>"
    motor = "<actuator><position tendon='t' kp='9'/></actuator>"
    file = tmp_path / "tendon.xml"
    file.write_text(f"<mujoco><worldbody>{body}</worldbody>{tendon}{motor}</mujoco>")
    found = read_stated_model(file, tmp_path)
    assert "servos on tendons are replaced by one a joint: a" in found.notes
    assert "gravity compensation is left out: b" in found.notes
    assert found.gains == {}


def test_what_mujoco_warns_of_is_a_note(tmp_path):
    file = tmp_path / "heavy.xml"
    body = "<body><joint/><geom size='.1'/></body>"
    file.write_text(f"<mujoco><compiler settotalmass='30'/><worldbody>{body}</worldbody></mujoco>")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = read_stated_model(file, tmp_path)
    assert mujoco.mj_getTotalmass(found.model) == pytest.approx(30.0)
    assert any("settotalmass" in note for note in found.notes)


@pytest.mark.parametrize("odd", [0.0, 0.2, 500.0])
def test_speed_limits_and_gains_are_those_of_each_joint_on_the_weaker_side(tmp_path, monkeypatch, odd):
    truth = random_biped(10, tmp_path)
    left = truth.joints["left"]
    right = truth.joints["right"]
    source = read_stated_model(truth.file, tmp_path)
    speeds = dict.fromkeys((*left, *right), 9.0) | {left[2]: 4.0, left[-1]: odd, right[-1]: odd}
    gains = dict.fromkeys(left, (900.0, 9.0)) | dict.fromkeys(right, (300.0, 30.0))
    stated = replace(source, speeds={k: v for k, v in speeds.items() if v > 0.0}, gains=gains)
    monkeypatch.setattr("plantar.robots.survey.survey.read_stated_model", lambda *_: stated)
    found = survey_model(truth.file, tmp_path)
    assert found.speeds == (9.0, 9.0, 4.0, *(9.0,) * (len(left) - 4), NO_SPEED)
    assert found.gains == ((300.0, 30.0),) * len(left)
    assert any(f"are left out: {left[-1]} {odd:g}" in note for note in found.notes) == (odd > 0.0)
    assert any("own servos differ" in note for note in found.notes)


def test_a_mesh_is_found_and_weighs_as_in_mujoco(tmp_path):
    """Of two tetrahedra at a corner, whose hull weighs more; MuJoCo strips the folder."""
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in np.array([[0, 0, 0], *np.eye(3), *-np.eye(3)]))
    (tmp_path / "two.obj").write_text(
        f"{corners}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 5 6\nf 1 7 5\nf 1 6 7\nf 5 7 6\n"
    )
    file = tmp_path / "meshes.xml"
    body = "<body><joint/><geom type='mesh' mesh='two'/></body>"
    head = "<compiler strippath='true'/><asset><mesh name='two' file='cad/two.obj'/></asset>"
    file.write_text(f"<mujoco>{head}<worldbody>{body}</worldbody></mujoco>")
    mass = mujoco.mj_getTotalmass(read_stated_model(file, tmp_path).model)
    assert mass == pytest.approx(mujoco.mj_getTotalmass(mujoco.MjModel.from_xml_path(str(file))))


@pytest.mark.parametrize(("stated", "joints"), [("", 8), ('lower="-1" upper="1"', 1)])
def test_joints_of_a_urdf_that_states_no_range_at_all_turn(tmp_path, stated, joints):
    """As of a CAD export that writes efforts and speeds only; where one has a range, the others are held."""
    inertia = re.search("<inertial>.*?</inertial>", urdf(""))[0]
    links = "".join(f'<link name="link{k}">{inertia}</link>' for k in range(9))
    hinges = "".join(
        f'<joint name="joint{k}" type="revolute"><parent link="link{k}"/><child link="link{k + 1}"/>'
        f'<limit effort="3" velocity="5" {stated if k == 0 else ""}/></joint>'
        for k in range(8)
    )
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{links}{hinges}</robot>')
    source = read_stated_model(file, tmp_path)
    assert source.model.njnt == joints
    assert int(source.model.jnt_limited.sum()) == (joints == 1)
    assert any(note.startswith("no joint's range is stated: all turn") for note in source.notes) == (joints == 8)


def test_a_leg_ends_where_the_other_one_does(tmp_path):
    """One ankle is drawn as low as the foot below it, as on the right of GR3."""
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    expected = survey_model(truth.file, tmp_path)
    model = expected.source.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    above = int(model.body_parentid[model.body(truth.feet["right"]).id])
    turn = data.xmat[above].reshape(3, 3).T
    foot = data.geom_xpos[model.body(truth.feet["right"]).geomadr[0]] - data.xpos[above]
    spec.body(model.body(above).name).add_geom(size=[0.03], pos=turn @ foot, mass=0.0)
    spec.compile()
    truth.file.write_text(spec.to_xml())
    found = survey_model(truth.file, tmp_path)
    assert found.foot_name("right") == truth.feet["right"]
    assert found.joint_names("right") == expected.joint_names("right")


def test_settings_of_another_mujoco_are_no_obstacle(tmp_path):
    """MuJoCo 4 has no flag "sensornoise" any more, with which XBot-L ships; an unknown joint is refused as before."""
    truth = random_biped(10, tmp_path)
    expected = survey_model(truth.file, tmp_path)
    text = truth.file.read_text()
    old = '<option timestep="0.001"><flag sensornoise="enable"/></option><worldbody>'
    truth.file.write_text(text.replace("<worldbody>", old))
    found = survey_model(truth.file, tmp_path)
    assert found.joint_names("left") == expected.joint_names("left")
    assert found.mass == expected.mass
    truth.file.write_text(text.replace("<worldbody>", '<worldbody><body><joint knee="1"/></body>'))
    with pytest.raises(RobotError, match="Schema violation: unrecognized attribute: 'knee'"):
        survey_model(truth.file, tmp_path)


def test_meshes_of_a_ros_package_are_those_of_its_manifests_name(tmp_path):
    """The folder has another name, as that of a checkout has, and the mesh lies in another folder than the URDF."""
    folder = tmp_path / "checkout" / "urdf"
    meshes = folder.parent / "meshes"
    folder.mkdir(parents=True)
    meshes.mkdir()
    (folder.parent / "package.xml").write_text("<package><name>my_robot</name></package>")
    corners = np.array([[0, 0, 0], *np.eye(3)])
    (meshes / "arm.stl").write_bytes(stl_bytes(corners[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]))
    mesh = '<visual><geometry><mesh filename="package://my_robot/meshes/arm.stl"/></geometry></visual>'
    file = folder / "robot.urdf"
    file.write_text(urdf('<limit lower="-1" upper="1"/>').replace('<link name="arm">', f'<link name="arm">{mesh}'))
    source = read_stated_model(file, tmp_path)
    assert source.model.nmesh == 1
    assert source.notes == []


def test_a_box_by_mass_and_inertia_stands_for_a_missing_mesh_and_is_said_first(tmp_path):
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    half = np.array([0.1, 0.05, 0.03])
    for name in truth.feet.values():
        foot = spec.body(name)
        for geom in foot.geoms:
            spec.delete(geom)
        foot.mass = 2.0
        foot.inertia = 2.0 / 3.0 * ((half**2).sum() - half**2)
    spec.compile()
    meshes = "<asset><mesh name='foot' file='foot.stl'/></asset></mujoco>"
    text = spec.to_xml().replace("</mujoco>", meshes)
    for name in truth.feet.values():
        text = re.sub(rf'(<body name="{name}"[^>]*>)', r"\1<geom type='mesh' mesh='foot'/>", text)
    truth.file.write_text(text)
    found = read_stated_model(truth.file, tmp_path)
    assert found.notes[0].startswith("meshes are missing: boxes by mass and inertia stand for them: ")
    assert found.notes[0].count("(foot.stl) 200 x 100 x 60 mm") == 2
    for name in truth.feet.values():
        body = found.model.body(name)
        np.testing.assert_allclose(found.model.geom_size[body.geomadr[0]], half, rtol=1e-4)
    assert found.model.body(name).mass[0] == pytest.approx(2.0)


def test_an_attached_model_keeps_its_own_angles_and_folder_of_meshes(tmp_path):
    (tmp_path / "robot" / "cad").mkdir(parents=True)
    (tmp_path / "robot" / "cad" / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    body = "<body name='b'><joint name='j' range='-90 90'/><geom type='mesh' mesh='a'/></body>"
    head = "<compiler angle='degree' meshdir='cad'/><asset><mesh name='a' file='a.obj'/></asset>"
    (tmp_path / "robot" / "r.xml").write_text(f"<mujoco>{head}<worldbody>{body}</worldbody></mujoco>")
    attached = "<asset><model name='r' file='robot/r.xml'/></asset><worldbody><attach model='r' body='b' prefix='c_'/>"
    file = tmp_path / "scene.xml"
    file.write_text(f"<mujoco><compiler angle='radian'/>{attached}</worldbody></mujoco>")
    source = read_stated_model(file, tmp_path)
    assert source.notes == []
    assert source.model.nmesh == 1
    np.testing.assert_allclose(source.model.jnt_range[0], [-0.5 * np.pi, 0.5 * np.pi])


def test_many_meshes_that_cannot_be_read_are_one_note(tmp_path):
    truth = random_biped(10, tmp_path)
    meshes = "".join(f"<mesh name='m{k}' file='m{k}.stl'/>" for k in range(5))
    shapes = "".join(f"<geom type='mesh' mesh='m{k}'/>" for k in range(5))
    text = truth.file.read_text().replace("</mujoco>", f"<asset>{meshes}</asset></mujoco>")
    truth.file.write_text(text.replace("<joint", f"{shapes}<joint", 1))
    notes = [note for note in read_stated_model(truth.file, tmp_path).notes if "cannot be read" in note]
    assert notes == ["meshes cannot be read; the 5 shapes made of them are left out: m0.stl, m1.stl, m2.stl and 2 more"]


def test_a_foot_without_a_shape_is_refused_by_its_name(tmp_path):
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    for foot in map(spec.body, truth.feet.values()):
        for geom in foot.geoms:
            spec.delete(geom)
        foot.parent.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.05, 0.02], mass=0.0)
    spec.compile()
    missing = "<asset><mesh name='foot' file='foot.stl'/></asset></mujoco>"
    truth.file.write_text(spec.to_xml().replace("</mujoco>", missing))
    with pytest.raises(
        RobotError, match=r": mesh foot.stl cannot be read; .*; '.*', which moves below .* has no shape"
    ) as caught:
        survey_model(truth.file, tmp_path)
    assert any(f"'{name}', which moves" in str(caught.value) for name in truth.feet.values())
