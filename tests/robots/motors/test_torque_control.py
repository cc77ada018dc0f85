from typing import Any

import numpy as np
import pytest

from plantar.robots.motors.torque_control import TorqueControl
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene


@pytest.fixture(scope="module")
def stood():
    """h1 after the first tick with feedback."""
    run = Simulation(load_scene("flat", ["steps=2", "drives=torque", "joint_stiffness=150"]))
    for k in range(600):
        run.sense(k)
        if k % 5 == 0:
            run.control()
        run.advance()
        if k % 5 == 0:
            run.after_tick()
    return run


def motors_of(run: Simulation) -> TorqueControl:
    assert isinstance(run.motors, TorqueControl)
    return run.motors


def ask(run: Simulation, **changes: Any) -> np.ndarray:
    reading, command, _ = run._tick
    return motors_of(run).torques(command, reading.changed(**changes))


def test_a_standing_robot_is_carried(stood):
    motors = motors_of(stood)
    assert motors.unsolved == 0
    planned = super(TorqueControl, motors).torques(stood._tick[1], stood._tick[0])
    assert ask(stood) == pytest.approx(planned, abs=12.0)
    assert motors.unsolved == 0


def test_a_base_that_turns_is_braked(stood):
    """Pitching forward asks both ankles to push the toes down."""
    still, turning = ask(stood), ask(stood, gyro=np.array([0.0, 0.5, 0.0]))
    hips = [2, 8]
    assert (turning - still)[hips].sum() > 20.0


def test_without_a_solution_torques_are_the_planned_ones(stood):
    motors = motors_of(stood)
    before = motors.unsolved
    found = ask(stood, gyro=np.full(3, np.nan))
    assert motors.unsolved == before + 1
    planned = super(TorqueControl, motors).torques(stood._tick[1], stood._tick[0])
    assert found == pytest.approx(planned, abs=1e-9)


def with_loads(run: Simulation, left: float, right: float) -> np.ndarray:
    """Torques by soles that carry shares of the weight."""
    reading, command, _ = run._tick
    weight = motors_of(run)._weight
    state = command.state.changed(loads={"left": left * weight, "right": right * weight})
    return motors_of(run).torques(command.changed(state=state), reading)


def test_a_load_that_is_gone_for_a_tick_moves_no_weight(stood):
    """Else the weight goes from sole to sole and back at each tick."""
    for _ in range(100):
        shared = with_loads(stood, 0.5, 0.5)
    gone = with_loads(stood, 0.0, 1.0)
    assert np.abs(gone - shared).max() < 0.1 * np.abs(shared).max()


def test_a_sole_that_carries_nothing_is_not_held_where_the_plan_has_it_stand(stood):
    motors = motors_of(stood)
    planned = {"left": np.ones(6), "right": np.ones(6)}
    weight = motors._weight
    for _ in range(100):
        motors._on_ground(planned, {"left": 0.5 * weight, "right": 0.5 * weight})
    late = {"left": 0.0, "right": weight}
    assert set(motors._on_ground(planned, late)) == {"left", "right"}  # it may have bounced
    for _ in range(100):
        found = motors._on_ground(planned, late)
    assert set(found) == {"right"}
    assert set(motors._on_ground({"left": np.ones(6)}, late)) == {"left"}  # something has to carry


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_robot_walks_by_torque(robot):
    summary = run_scene(load_scene("flat", ["steps=6", "drives=torque", "joint_stiffness=150"], robot))
    assert summary["completed"], summary["reasons"]
