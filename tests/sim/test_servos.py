import mujoco
import numpy as np
import pytest

from sim.runner import Simulation
from sim.scene import load_scene


@pytest.fixture
def standing() -> Simulation:
    return Simulation(load_scene("flat", ["steps=0"]))


def test_a_held_posture_carries_its_feed_forward_torque(standing: Simulation) -> None:
    world = standing.world
    data = world.data
    mujoco.mj_step(world.model, data, 300)
    error = data.qpos[world.joint_qpos] - standing.servos._last
    # With the expected torque fed forward, the spring of the servo is left with next to nothing to do.
    assert np.abs(np.degrees(error)).max() < 0.02
    expected = world.stiffness * (standing.servos._setpoint - standing.servos._last)
    assert data.actuator_force[world.servos] == pytest.approx(expected, abs=2.0)


def test_setpoints_move_on_between_ticks_without_a_step_at_the_next(standing: Simulation) -> None:
    """A reference that moves at constant speed gives set-points on a straight line, not stairs."""
    from dataclasses import replace

    world, servos = standing.world, standing.servos
    command = standing.controller.step(_sensors(standing))
    setpoints = []
    for k in range(12):
        servos.command(replace(command, com=command.com + np.array([0.0, 0.0, -2e-5 * k])))
        for _ in range(5):
            servos.drive()
            setpoints.append(world.data.ctrl[world.servos].copy())
    knee = np.array(setpoints)[10:, 3]
    steps = np.diff(knee)
    assert steps.std() < 0.02 * abs(steps.mean())


def _sensors(simulation: Simulation):  # type: ignore[no-untyped-def]
    simulation.sensors.sample_skin()
    return simulation.sensors.sample_body()
