import shutil

import mujoco
import numpy as np
import pytest

from plantar.errors import RobotError
from plantar.mechanics.rotation import rotation_from_vector
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.run.servos import LegServos


@pytest.fixture
def standing():
    return Simulation(load_scene("flat", ["steps=0"]))


def test_a_held_posture_carries_its_feed_forward_torque(standing):
    world = standing.world
    data = world.data
    mujoco.mj_step(world.model, data, 300)
    error = data.qpos[world.joint_qpos] - np.asarray(standing.servos._setpoints.reference)
    # With the expected torque fed forward, the spring of the servo is left with next to nothing to do.
    assert np.abs(np.degrees(error)).max() < 0.02
    expected = world.stiffness * (
        np.asarray(standing.servos._setpoints.setpoint) - np.asarray(standing.servos._setpoints.reference)
    )
    assert data.actuator_force[world.servos] == pytest.approx(expected, abs=2.0)


def test_setpoints_move_on_between_ticks_without_a_step_at_the_next(standing):
    """A reference that moves at constant speed gives set-points on a straight line, not stairs."""

    world, servos = standing.world, standing.servos
    command = standing.controller.step(_sensors(standing))
    setpoints = []
    for k in range(30):
        servos.command(command.changed(com=command.com + np.array([0.0, 0.0, -2e-5 * k])))
        for _ in range(5):
            servos.drive()
            setpoints.append(world.data.ctrl[world.servos].copy())
    knee = np.array(setpoints)[80:, 3]  # the low pass has forgotten the start
    steps = np.diff(knee)
    assert steps.std() < 0.02 * abs(steps.mean())


def test_setpoints_lead_by_the_friction_of_a_joint_that_moves(standing):
    """Both knees bend at a constant speed; those that rub are asked for their friction more, the way they go."""

    world = standing.world
    knees = [3, 9]
    command = standing.controller.step(_sensors(standing))
    asked = []
    for friction in (0.0, 6.0):
        world.joint_friction[knees] = friction
        servos = LegServos(world, standing.legs, 0.005)
        stand = standing.legs.configuration
        for k in range(12):
            joints = servos.command(command.changed(com=command.com + np.array([0.0, 0.0, -1e-3 * k])))
        standing.legs.set_configuration(stand[:3], stand[3:7], stand[7:])
        asked.append(world.stiffness * (np.asarray(servos._setpoints.goal) - joints))
    more = asked[1] - asked[0]
    assert more[knees] == pytest.approx(6.0, rel=0.01)
    assert np.delete(more, knees) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_no_tick_moves_a_joint_by_more_than_a_tenth_of_a_radian(standing, seed):
    """Whatever is asked of legs that have no speed limits: places far away, feet turned over, a CoM that jumps."""
    from dataclasses import replace

    world = replace(standing.world, robot=replace(standing.robot, velocity_limits=()))
    servos, rng = LegServos(world, standing.legs, 0.005), np.random.default_rng(seed)
    command = standing.controller.step(_sensors(standing))
    last = servos.command(command).copy()
    for _ in range(40):
        feet = {
            side: foot.changed(
                position=foot.position + rng.uniform(-0.6, 0.6, 3),
                rotation=rotation_from_vector(rng.uniform(-1.0, 1.0, 3)),
            )
            for side, foot in command.feet.items()
        }
        joints = servos.command(command.changed(com=command.com + rng.uniform(-0.5, 0.5, 3), feet=feet)).copy()
        assert np.abs(joints - last).max() <= 0.1 + 1e-12
        last = joints


def _sensors(simulation: Simulation):
    simulation.sensors.read_skins()
    return simulation.sensors.read_body()


def test_setpoints_keep_the_joints_speed_limits_and_the_pose_between_them(standing):
    """A target that jumps: all joints go the same way as fast as the one that is at its limit allows, and arrive."""

    servos, robot = standing.servos, standing.robot
    command = standing.controller.step(_sensors(standing))
    start = servos.command(command)
    lower = command.changed(com=command.com + np.array([0.0, 0.0, -0.03]))
    limits = np.array([*robot.velocity_limits] * 2)
    standing.legs.follow(
        lower.com,
        lower.rotation_torso,
        {s: lower.feet[s].position for s in lower.feet},
        {s: lower.feet[s].rotation for s in lower.feet},
        20,
    )
    before, end = start, standing.legs.joints.copy()
    shares = []
    for _ in range(60):
        joints = servos.command(lower)
        shares.append(float(np.abs((joints - before) / 0.005 / limits).max()))
        way = np.abs(end - start) > 0.01
        if shares[-1] > 0.5:  # in the same proportion for all
            done = ((joints - start) / (end - start))[way]
            assert done == pytest.approx(np.full(len(done), done[0]), abs=0.02)
        before = joints
    assert max(shares) == pytest.approx(0.9, abs=1e-6)
    assert joints == pytest.approx(end, abs=1e-4)


def test_a_robot_without_speed_limits_is_not_held_back(standing):
    from dataclasses import replace

    from plantar.sim.run.servos import LegServos

    world = replace(standing.world, robot=replace(standing.robot, velocity_limits=()))
    servos = LegServos(world, standing.legs, 0.005)
    command = standing.controller.step(_sensors(standing))
    start = servos.command(command)
    jumped = servos.command(command.changed(com=command.com + np.array([0.0, 0.0, -0.03])))
    assert np.abs((jumped - start) / 0.005).max() > 6.0


def test_speed_limits_of_a_model_file_come_from_its_servo_table(tmp_path):
    from plantar.robots import load_robot

    h1 = load_robot("h1")
    text = h1.path.read_text().replace("damping = 150.0", "damping = 150.0\nvelocity_limits = [1, 2, 3, 4, 5, 6]")
    for side in ("left", "right"):
        shutil.copy(h1.path.parent / f"layout_{side}.json", tmp_path)
    (tmp_path / "robot.toml").write_text(text)
    assert load_robot(tmp_path / "robot.toml").velocity_limits == (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    assert h1.velocity_limits == (2.74, 3.94, 6.0, 4.25, 4.0, 3.94)
    (tmp_path / "robot.toml").write_text(text.replace("[1, 2, 3, 4, 5, 6]", "[1, 2, 0, 4, 5, 6]"))
    with pytest.raises(RobotError, match=r"\[servo\].*velocity_limits.*0.001 to 1000"):
        load_robot(tmp_path / "robot.toml")
