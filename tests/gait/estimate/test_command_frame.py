import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.gait.estimate.command_frame import CommandFrame

numbers = st.floats(-50.0, 50.0)


def followed(real: list[float], turn: float, ticks: int = 4000) -> CommandFrame:
    frame = CommandFrame(np.array([1.0, 2.0, 0.0]), 0.005, 0.3)
    for _ in range(ticks):
        frame.update(np.array([1.0, 2.0, 0.0]), np.array(real), turn)
    return frame


@given(numbers, numbers, st.floats(-3.0, 3.0), st.floats(-0.3, 0.3))
def test_there_and_back_is_the_same_point(x, y, z, turn):
    frame = followed([1.01, 1.98, 0.003], turn, ticks=50)
    world = frame.to_world(np.array([x, y, z]))
    assert frame.to_command(world[:2]) == pytest.approx([x, y], abs=1e-9)


def test_it_settles_on_the_real_foothold():
    frame = followed([1.02, 1.97, 0.004], 0.05)
    assert frame.to_world(np.array([1.0, 2.0, 0.0])) == pytest.approx([1.02, 1.97, 0.004], abs=1e-9)
    ahead = frame.to_world(np.array([2.0, 2.0, 0.0])) - frame.to_world(np.array([1.0, 2.0, 0.0]))
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(0.05, abs=1e-9)


def test_a_change_of_the_carrying_foot_does_not_jump():
    frame = followed([1.02, 1.97, 0.0], 0.05)
    point = np.array([1.1, 2.1])
    before = frame.to_command(point)
    frame.update(np.array([1.3, 1.8, 0.0]), np.array([1.31, 1.79, 0.0]), -0.03)
    assert np.abs(frame.to_command(point) - before).max() < 1e-3
