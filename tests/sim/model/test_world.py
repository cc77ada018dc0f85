"""The compiled model against the robot's published figures (ROBOTS facts) and basic mechanics."""

import mujoco
import numpy as np
import pytest

from plantar.robots.kinematics.robot_model import build_leg_model, robot_spec
from plantar.sim.model.world import PHYSICS_PERIOD


def test_masses_limits_and_heights_are_the_published_ones(h1):
    model = robot_spec(h1).compile()
    assert mujoco.mj_getTotalmass(model) == pytest.approx(86.0, abs=1e-9)
    assert model.nv == 18
    assert model.nu == 12
    for name, low, high, effort in (
        ("hip_yaw", -45, 30, 51),
        ("hip_roll", -15, 30, 71),
        ("hip_pitch", -100, 45, 63),
        ("knee", 0, 150, 140),
        ("ankle_pitch", -75, 45, 92),
        ("ankle_roll", -30, 15, 71),
    ):
        left, right = model.joint(f"left_{name}"), model.joint(f"right_{name}")
        assert np.degrees(left.range) == pytest.approx([low, high])
        mirrored = name in ("hip_yaw", "hip_roll", "ankle_roll")
        assert np.degrees(right.range) == pytest.approx([-high, -low] if mirrored else [low, high])
        assert model.actuator(f"left_{name}").forcerange == pytest.approx([-effort, effort])
    data = mujoco.MjData(model)
    data.qpos[7:] = [*h1.posture["left"], *h1.posture["right"]]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    sole = data.site("left_sole").xpos
    assert data.subtree_com[0][2] - sole[2] == pytest.approx(0.80, abs=1e-6)  # the MJCF text holds six digits
    hip, ankle = data.body("left_hip_yaw_link").xpos, data.body("left_ankle").xpos
    assert ankle[2] - sole[2] == pytest.approx(0.117 + h1.shoe_thickness)
    assert hip[1] == pytest.approx(0.075)
    mujoco.mj_resetData(model, data)
    mujoco.mj_kinematics(model, data)
    assert data.body("left_hip_yaw_link").xpos[2] - data.body("left_ankle").xpos[2] == pytest.approx(0.6)


def test_left_and_right_mirror_each_other(h1):
    model = robot_spec(h1).compile()
    for body in ("hip_yaw_link", "hip_roll_link", "thigh", "shank", "ankle", "foot"):
        left, right = model.body(f"left_{body}"), model.body(f"right_{body}")
        assert left.mass == pytest.approx(right.mass)
        assert left.pos * [1, -1, 1] == pytest.approx(right.pos)
        assert left.ipos * [1, -1, 1] == pytest.approx(right.ipos)
        assert left.inertia == pytest.approx(right.inertia)


def test_the_sole_box_is_the_outline_s_rectangle_with_its_face_in_the_sole_plane(world):
    model, data = world.model, world.data
    mujoco.mj_kinematics(model, data)
    for side in ("left", "right"):
        geom = model.geom(f"{side}_sole_box")
        center, half = world.robot.sole_rectangle(side)
        assert geom.size[:2] == pytest.approx(half)
        site = data.site(world.sole_sites[side]).xpos
        box = data.geom(f"{side}_sole_box").xpos
        assert (box - site)[:2] == pytest.approx(center)
        assert box[2] - geom.size[2] == pytest.approx(site[2])


def test_only_soles_meet_the_ground(world):
    model = world.model
    names = {model.geom(i).name for i in range(model.ngeom) if model.geom(i).contype[0] & 3}
    assert names == {"ground", "left_sole_box", "right_sole_box"}


def test_a_standing_robot_weighs_what_it_weighs(h1, world):
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    simulation = Simulation(load_scene("flat", ["steps=0"]))
    w = simulation.world
    mujoco.mj_step(w.model, w.data, round(0.2 / PHYSICS_PERIOD))
    force = sum(float(w.data.sensordata[a]) for a in w.touch.values())
    assert force == pytest.approx(86.0 * 9.81, rel=2e-3)
    assert build_leg_model(h1).mass == pytest.approx(86.0)
