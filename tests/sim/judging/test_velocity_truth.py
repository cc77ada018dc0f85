"""The mean speed of a walk, from made-up motions of a torso."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.gait.plan.phases import Timing
from plantar.gait.propose.velocity_command import VelocityTable, table_of
from plantar.sim.judging.velocity_truth import VelocityTruth

TIMING = Timing()
STEP = TIMING.single_support + TIMING.double_support


def moved(table: VelocityTable, velocity: tuple[float, float, float], until: float = 40.0) -> VelocityTruth:
    """A torso that follows a velocity in its own heading frame, one step after the command begins."""
    com, xmat = np.zeros((1, 3)), np.zeros((1, 9))
    world: Any = SimpleNamespace(torso=0, body=REFERENCE_BODY, data=SimpleNamespace(subtree_com=com, xmat=xmat))
    truth, heading, period = VelocityTruth(world, table, TIMING), 0.0, 0.005
    for k in range(round(until / period)):
        time = k * period
        go = table.at(time - STEP) is not None
        ahead, left, turn = velocity if go else (0.0, 0.0, 0.0)
        heading += turn * period
        c, s = math.cos(heading), math.sin(heading)
        com[0, :2] += period * np.array([c * ahead - s * left, s * ahead + c * left])
        xmat[0, 0], xmat[0, 3] = c, s
        truth.update(time)
    return truth


@pytest.mark.parametrize("share", [1.0, 0.95, 0.8, 1.2])
def test_the_share_of_the_commanded_speeds_is_what_was_walked(share):
    command = (0.1, -0.05, 0.2)
    truth = moved(table_of([[1.0, *command], [30.0, "stop"]], 0.0), tuple(share * v for v in command))
    told = truth.summary([])
    assert told["speed_ratio"] == pytest.approx(share, abs=2e-3)
    assert told["turn_ratio"] == pytest.approx(share, abs=2e-3)
    assert {r["criterion"] for r in truth.reasons([])} == (
        {"speed_ratio", "turn_ratio"} if abs(share - 1) > 0.1 else set()
    )


def test_a_way_across_the_command_does_not_count():
    truth = moved(table_of([[1.0, 0.1, 0.0, 0.0], [30.0, "stop"]], 0.0), (0.0, 0.1, 0.0))
    assert truth.summary([])["speed_ratio"] == pytest.approx(0.0, abs=1e-6)


def test_more_than_two_steps_after_the_last_stop_are_too_many():
    truth = moved(table_of([[1.0, 0.1, 0.0, 0.0], [30.0, "stop"]], 0.0), (0.1, 0.0, 0.0))
    assert truth.reasons([28.0, 29.9, 30.5, 31.7]) == []
    (reason,) = truth.reasons([28.0, 30.5, 31.7, 32.9])
    assert (reason["criterion"], reason["value"]) == ("stop", 3)


def test_a_robot_that_goes_on_is_not_at_rest():
    table = table_of([[1.0, 0.1, 0.0, 0.0], [38.0, "stop"]], 0.0)
    assert {r["criterion"] for r in moved(table, (0.1, 0.0, 0.0), until=39.0).reasons([])} == {"rest"}
