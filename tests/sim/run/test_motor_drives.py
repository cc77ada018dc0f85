import mujoco
import numpy as np
import pytest

from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene


def test_motors_exert_the_torques_of_their_gain_loop():
    run = Simulation(load_scene("flat", ["steps=0", "drives=own", "joint_stiffness=200"]))
    world, data = run.world, run.world.data
    run.sense(0)
    run.control()
    targets = run._tick[1].joints
    assert targets is not None
    for k in range(3):
        q, v = data.qpos[world.joint_qpos].copy(), data.qvel[world.joint_qvel].copy()
        run.servos.drive()
        mujoco.mj_forward(world.model, data)
        ahead = targets.angles + 0.001 * k * targets.velocities
        wanted = targets.stiffness * (ahead - q) + targets.damping * (targets.velocities - v) + targets.torques
        assert np.abs(wanted).max() > 20.0
        assert data.actuator_force[world.servos] == pytest.approx(wanted, abs=1e-9)
        mujoco.mj_step(world.model, data)


@pytest.mark.long
def test_a_robot_walks_on_soft_motors_that_follow_the_plan():
    assert run_scene(load_scene("flat", ["steps=6", "drives=own", "joint_stiffness=1000"]))["completed"]
