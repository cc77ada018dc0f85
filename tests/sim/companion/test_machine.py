"""Machines from an MJCF and a TOML."""

import mujoco
import numpy as np
import pytest

from plantar.errors import RobotError
from plantar.mujoco import FoamSkins
from plantar.sim.body_skin.surface import OBSTACLE_GROUP, skin_from_tables
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import builtin_machines, load_machine

ARM = """
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body name="one"><joint name="a" axis="0 0 1"/><geom size="0.1" mass="1"/>
      <body name="two" pos="0.3 0 0"><joint name="b" type="slide" axis="1 0 0"/><geom size="0.05" mass="0.5"/></body>
    </body>
    <body name="loose" pos="0 0 3"><geom size="0.1"/></body>
  </worldbody>
  <actuator><position joint="a"/></actuator>
</mujoco>
"""


def machine(folder, text="", model=ARM):
    (folder / "arm.xml").write_text(model)
    (folder / "foreign.toml").write_text(f'[model]\nfile = "arm.xml"\n{text}')
    return load_machine(folder / "foreign.toml")


def test_built_in_machines_stand_in_their_posture():
    for name in builtin_machines():
        found = load_machine(name)
        model = found.spec().compile()
        assert model.nu == len(found.joints) == len(found.posture)
        assert np.isfinite(found.efforts).all()
        assert list(MujocoDynamics(model).joints) == list(range(model.nv - model.nu, model.nv))


def test_hand_of_the_mobile_arm_faces_forward_and_its_x_axis_up():
    found = load_machine("mobile-arm")
    robot = MujocoDynamics(found.spec().compile())
    robot.update(found.posture, np.zeros(9), 0.0)
    position, rotation = robot.pose("hand")
    np.testing.assert_allclose(rotation[:, 2], [1.0, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(rotation[:, 0], [0.0, 0.0, 1.0], atol=1e-6)
    assert position[0] > 0.7


def test_ur5_reaches_as_far_as_its_published_parameters_say():
    """All joints 0: the wrist's centre is d4 beside and a2 + a3 before the shoulder, at its height."""
    found = load_machine("mobile-arm")
    robot = MujocoDynamics(found.spec().compile())
    robot.update(np.zeros(9), np.zeros(9), 0.0)
    position = robot.pose("wrist2")[0] - robot.pose("shoulder")[0]
    np.testing.assert_allclose(position, [0.425 + 0.39225, 0.10915, 0.0], atol=1e-9)


def test_foreign_arm_needs_a_toml_alone(tmp_path):
    found = machine(tmp_path, "[joint_defaults]\neffort = 5.0\n[joints.b]\nvelocity = 0.2\nposture = 0.1\n")
    model = found.spec().compile()
    assert list(found.joints) == ["a", "b"]
    assert found.name == "foreign"
    np.testing.assert_allclose(found.efforts, 5.0)
    np.testing.assert_allclose(found.posture, [0.0, 0.1])
    assert found.velocities.tolist() == [np.inf, 0.2]
    assert [model.actuator(i).name for i in range(model.nu)] == ["a", "b"]
    assert model.geom_bodyid.min() > 0  # its floor is gone
    np.testing.assert_allclose(model.actuator_gainprm[:, 0], 1.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[joints.c]\neffort = 1", "no joint 'c'; it has a, b"),
        ("[joints.a]\nefort = 1", "[joints.a] has an unknown key 'efort'; nearest: effort"),
        ("[joints.a]\neffort = -1", "'effort' is -1"),
        ("[[patch]]\nname = 'p'\nlink = 'tow'", "patch 'p': the model has no link 'tow'; nearest: two"),
        ("[base]\nkind = 'floating'", "no free joint"),
        ("[base]\nkind = 'mobile'", "must slide along x, y and turn about z"),
        ("[base]\nlink = 'three'", "no link 'three'"),
        ("[base]\nfootprint = [[0, 1], [1, 0]]", "three or more corners"),
        ("[servo]\nkind = 'hydraulic'", "allowed: torque, velocity, position"),
        ("[motors]", "unknown key 'motors'"),
        ("joints = 3", "[model] has an unknown key 'joints'"),
    ],
)
def test_bad_files_are_refused_in_a_line(tmp_path, text, words):
    with pytest.raises(RobotError) as error:
        machine(tmp_path, text)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_model_that_mujoco_refuses_is_an_error_of_one_line(tmp_path):
    with pytest.raises(RobotError, match="cannot be read"):
        machine(tmp_path, model="<mujoco><worldbody><bodi/></worldbody></mujoco>")
    with pytest.raises(RobotError, match="ball joint"):
        machine(tmp_path, model=ARM.replace('type="slide" axis="1 0 0"', 'type="ball"'))


def test_unknown_machine_is_refused_with_the_known_ones():
    with pytest.raises(RobotError, match=r"allowed: .*mobile-arm, planar-arm, table-arm"):
        load_machine("mobile-amr")


def test_ranges_are_infinite_where_a_joint_has_no_stop(tmp_path):
    stopped = ARM.replace('type="slide"', 'type="slide" range="-0.1 0.3"')
    found = machine(tmp_path, model=stopped)
    low, high = found.ranges(found.spec().compile())
    np.testing.assert_allclose(low, [-np.inf, -0.1])
    np.testing.assert_allclose(high, [np.inf, 0.3])


def test_motors_are_limited_as_the_joints_are():
    model = load_machine("mobile-arm").spec().compile()
    data = mujoco.MjData(model)
    data.ctrl[:] = 1e4
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_actuator, load_machine("mobile-arm").efforts)


@pytest.mark.parametrize("group", range(6))
def test_skin_is_laid_on_geoms_of_any_group_and_sees_obstacles_alone(tmp_path, group):
    """Public models keep their collision shapes in a group of their own, often that of the obstacles here."""
    arm = f"""<mujoco><worldbody><body name="arm"><joint name="a"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.04" mass="1" group="{group}"/>
        </body></worldbody></mujoco>"""
    patch = "[[patch]]\nname = 'p'\nlink = 'arm'\nposition = [0.15, 0, 0]\nsize = [0.2, 0]\nwrap = 0.04\n"
    found = machine(tmp_path, patch, model=arm)
    spec = found.spec()
    spec.worldbody.add_geom(size=[0.03, 0, 0], pos=[0.15, 0.0, 0.08], group=OBSTACLE_GROUP)
    model = spec.compile()
    skin = skin_from_tables(found.spec().compile(), found.patches, found.name)
    data = mujoco.MjData(model)
    sensor = FoamSkins(model, skin, np.flatnonzero(model.geom_group == OBSTACLE_GROUP).tolist())
    mujoco.mj_forward(model, data)
    sensor.press(data)
    assert len(skin) > 20
    assert np.isfinite(sensor.distance).sum() > 0
    assert sensor.distance.min() == pytest.approx(0.01, abs=0.008)
