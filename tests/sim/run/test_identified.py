"""What walks tell that they identified of a true plant, against that plant as MuJoCo has it."""

import mujoco
import numpy as np
import pytest

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

TRUE = ("plant.gyro_bias=[0.004, -0.003, 0.005]", "plant.com_offset=[-0.012, 0.012, 0]", "plant.mass_ratio=1.05")


def com(simulation: Simulation, model: mujoco.MjModel) -> np.ndarray:
    """Whole CoM (3,) of a model of the robot in its first pose, in the base frame in m."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    root = model.body_rootid[model.body(simulation.robot.torso_body).id]
    return data.xmat[root].reshape(3, 3).T @ (data.subtree_com[root] - data.xpos[root])


@pytest.mark.sample(1)
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_gyro_com_and_mass_are_found(robot):
    simulation = Simulation(load_scene("flat", ["walk.steps=2", *TRUE], robot), 0)
    moved = com(simulation, simulation.world.model) - com(simulation, simulation.legs.model)
    assert np.linalg.norm(moved) > 0.01  # the upper body has most of the mass
    summary = simulation.run()
    found = summary["identified"]
    assert summary["completed"], summary["reasons"]
    np.testing.assert_allclose(found["gyro_bias_rad_s"], [0.004, -0.003, 0.005], atol=8e-4)
    np.testing.assert_allclose(found["com_offset_m"][:2], moved[:2], atol=3e-3)
    assert found["mass_ratio"] == pytest.approx(1.05, abs=0.02)
    assert np.abs(found["encoder_offsets_deg"]).max() < 0.1  # by what the accelerometer's noise leaves, 0.03 (1 sigma)


def test_encoder_offsets_put_the_feet_where_they_are():
    simulation = Simulation(load_scene("flat", ["walk.steps=2", "plant.encoder_offset=0.3"], "h1"), 2)
    true = simulation.plant.encoder_offsets
    summary = simulation.run()
    found = np.radians(summary["identified"]["encoder_offsets_deg"])
    joints = simulation.world.data.qpos[simulation.world.joint_qpos]

    def apart(wrong: np.ndarray) -> float:
        """How far in m the right sole is from where it is against the left one, by joints that are read wrongly."""
        (a, b) = (simulation.legs.posture(joints + error) for error in (wrong, np.zeros(12)))
        seen, place = (p.rotations["left"].T @ (p.positions["right"] - p.positions["left"]) for p in (a, b))
        return float(np.linalg.norm(seen - place))

    assert summary["completed"], summary["reasons"]
    assert apart(true) > 5e-3
    assert apart(true - found) < 1.5e-3


def test_nothing_is_identified_where_that_is_switched_off():
    simulation = Simulation(load_scene("flat", ["walk.steps=0", "control.identify=false"], "h1"), 0)
    assert simulation.controller.estimation.body is None
    assert "identified" not in simulation.run()
