"""The built-in robots against the published figures (ROBOTS facts), and what a robot file may leave out."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.errors import InputError, RobotError
from plantar.robots import load_robot
from plantar.robots.controller_settings import controller_settings
from plantar.robots.kinematics.robot_model import robot_spec
from plantar.sim.run.scene import load_scene


def test_hrp2kai_has_the_published_masses_limits_and_heights():
    robot = load_robot("hrp2kai")
    model = robot_spec(robot).compile()
    assert mujoco.mj_getTotalmass(model) == pytest.approx(65.0, abs=1e-9)
    for name, low, high in (
        ("hip_yaw", -30, 45),
        ("hip_roll", -20, 35),
        ("hip_pitch", -125, 42),
        ("knee", -2, 150),
        ("ankle_pitch", -75, 42),
        ("ankle_roll", -35, 20),
    ):
        left, right = model.joint(f"left_{name}"), model.joint(f"right_{name}")
        assert np.degrees(left.range) == pytest.approx([low, high])
        mirrored = name in ("hip_yaw", "hip_roll", "ankle_roll")
        assert np.degrees(right.range) == pytest.approx([-high, -low] if mirrored else [low, high])
        # Not published: the H1's effort scaled by mass.
        h1 = load_robot("h1")
        i = robot.legs["left"].joints.index(f"left_{name}")
        assert model.actuator(f"left_{name}").forcerange[1] == pytest.approx(
            h1.biped.effort_limits[i] * 65 / 86, abs=0.1
        )
    data = mujoco.MjData(model)
    data.qpos[7:] = [*robot.posture["left"], *robot.posture["right"]]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    sole = data.site("left_sole").xpos
    bare_sole = sole[2] + robot.shoe_thickness
    assert data.body("base").xpos[2] - bare_sole == pytest.approx(0.649, abs=1e-3)
    assert data.subtree_com[0][2] - sole[2] == pytest.approx(0.87, abs=1e-6)
    assert data.body("left_ankle").xpos[2] - bare_sole == pytest.approx(0.105)
    assert data.body("left_hip_yaw_link").xpos[1] == pytest.approx(0.060)
    assert data.body("left_ankle").xpos[1] == pytest.approx(0.095)


def test_the_hrp2kai_shoe_carries_51_taxels_and_overhangs_the_foot():
    robot = load_robot("hrp2kai")
    for side in ("left", "right"):
        layout = robot.layouts[side]
        assert len(layout) == robot.foot.taxels == 51
        # The papers' 51 whole cells, a few at the rim trimmed to 98 %: so the shoe overhangs by less than 10 mm.
        assert layout.areas.sum() == pytest.approx(35241e-6, rel=4e-3)
        size = np.ptp(layout.vertices[:, :2], axis=0)
        assert ((size - [robot.foot.length, robot.foot.width]) / 2 < 0.010).all()
        (x, y), _ = robot.sole_rectangle(side)
        assert (x, y) == pytest.approx(robot.foot.center, abs=2e-3)


def test_the_pace_of_a_robot_is_its_own_or_the_default(tmp_path):
    assert (load_robot("h1").single_support, load_robot("h1").double_support) == (0.9, 0.3)
    kai = load_robot("hrp2kai")
    assert (kai.single_support, kai.double_support) == (1.4, 0.5)
    folder = tmp_path / "kai"
    folder.mkdir()
    for path in kai.path.parent.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    file = folder / "robot.toml"
    text = file.read_text()
    file.write_text(text.replace("single_support = 1.4", "").replace("double_support = 0.5", ""))
    unsaid = load_robot(file)
    assert (unsaid.single_support, unsaid.double_support) == (0.0, 0.0)
    for leg, pace in ((0.6, (0.9, 0.3)), (0.15, (0.45, 0.15))):
        body = BodyScale(mass=65.0, leg=leg, sole=0.25, sole_width=0.15)
        timing = controller_settings(load_scene("flat"), unsaid, body, {}).timing
        assert (timing.single_support, timing.double_support) == pytest.approx(pace, rel=5e-3)
    file.write_text(text.replace("single_support = 1.4", "single_support = 0"))
    with pytest.raises(RobotError, match="single_support"):
        load_robot(file)


def test_a_robot_that_rocks_keeps_its_own_time_and_lands_without_a_slow_approach():
    h1 = load_robot("h1")
    scene = load_scene("uneven").for_body(REFERENCE_BODY)
    rocks = replace(h1, rocks=True, single_support=0.27, double_support=0.16)
    own = controller_settings(scene, rocks, REFERENCE_BODY, {})
    assert (own.timing.single_support, own.timing.double_support) == (0.27, 0.16)
    assert (own.timing.start, own.timing.end) == (pytest.approx(0.2), pytest.approx(0.2))
    assert own.outward > 0.0
    assert own.landing.approach_height == 0.0
    stated = load_scene("uneven", ["t_ss=0.9", "t_ds=0.3"]).for_body(REFERENCE_BODY)
    with pytest.raises(InputError, match="rocks from foot to foot in its own time; allowed: 0"):
        controller_settings(stated, rocks, REFERENCE_BODY, {})
    usual = controller_settings(stated, h1, REFERENCE_BODY, {})
    assert (usual.timing.single_support, usual.timing.double_support) == (0.9, 0.3)
    assert usual.outward == 0.0
    assert usual.landing.approach_height == scene.walk.approach_height > 0.0
