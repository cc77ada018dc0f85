"""A robot that is driven by velocities in a loop of the caller's own at 500 Hz."""

import numpy as np
import pytest

from plantar.robots.controller import load_controller
from tests.robots.foreign_loop import ForeignLoop, drawn_commands
from tests.sim.rates import check_rate, drawn_seeds


def loop_of(robot, soles="taxels", **control):
    walker = load_controller(robot, {"control": {"period": 0.002, **control}}, commanded=True, soles=soles)
    walker.count_as_checked()
    return ForeignLoop(walker, soles)


def test_it_stands_starts_walks_turns_and_stops_by_commands_at_any_tick():
    loop = loop_of("h1")
    assert loop.walk([(1.0, (0.2, 0.0, 0.0)), (1.1, None)], 3.0) == 3.0  # at most the one step that was begun
    assert abs(loop.data.qpos[0]) < 0.1
    loop = loop_of("h1")
    assert loop.walk([(1.003, (0.2, 0.0, 0.3)), (5.471, None)], 8.0) == 8.0
    assert 0.3 < np.hypot(*loop.data.qpos[:2]) < 1.2
    heading = 2.0 * np.arctan2(loop.data.qpos[6], loop.data.qpos[3])
    assert 0.4 < heading < 1.6
    assert np.abs(loop.data.qvel[:2]).max() < 0.02  # it stands


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_ten_minutes_of_commands_end_standing(robot):
    (seed,) = drawn_seeds(test_ten_minutes_of_commands_end_standing, 1, robot)
    assert loop_of(robot).walk(drawn_commands(seed, 600.0), 600.0) == 600.0


@pytest.mark.long
@pytest.mark.parametrize("soles", ["taxels", "force_torque", "torques"])
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_it_walks_by_torque_whatever_measures_its_soles(robot, soles):
    def stands(seed):
        return (
            loop_of(robot, soles, drives="torque", joint_stiffness=150).walk(drawn_commands(seed, 40.0), 40.0) == 40.0
        )

    seeds = drawn_seeds(test_it_walks_by_torque_whatever_measures_its_soles, 6, f"{robot} {soles}")
    check_rate(map(stands, seeds), least=0.95)
