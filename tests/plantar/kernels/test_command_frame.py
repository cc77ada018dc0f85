import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.kernels import python_form
from plantar.kernels.gait import command_frame
from plantar.kernels.gait.command_frame import CommandFrame

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


def test_both_forms_agree_to_the_last_bit():
    rng = np.random.default_rng(0)
    anchor, com = rng.normal(size=(2, 3))
    one, other = (form.CommandFrame(anchor, 0.005, 0.3) for form in (command_frame, python_form("command_frame")))
    for _ in range(50):
        real, commanded, point = rng.normal(size=(3, 3))
        turn = float(rng.normal())
        for frame in (one, other):
            frame.update(commanded, real, turn)
        found = [
            (f.to_command(point[:2]), f.to_world(point), f.aligned(point, com), f.offset, f.turn) for f in (one, other)
        ]
        for mine, wanted in zip(*found, strict=True):
            assert np.array_equal(mine, wanted)


def test_a_copy_stays_where_it_was():
    frame = followed([1.02, 1.97, 0.0], 0.05, ticks=20)
    kept = frame.now()
    point = np.array([1.1, 2.1])
    before = kept.to_command(point)
    frame.update(np.array([1.0, 2.0, 0.0]), np.array([1.5, 2.5, 0.0]), 0.3)
    assert np.array_equal(kept.to_command(point), before)
    assert not np.array_equal(frame.to_command(point), before)


def test_a_point_is_turned_about_the_com_to_the_command_frames_heading():
    frame = followed([1.3, 2.2, 0.1], 0.4)
    com = np.array([1.2, 2.0, 0.8])
    point = np.array([1.0, 2.3, 0.05])
    away = frame.to_world(point) - com
    c = np.cos(frame.turn)
    s = np.sin(frame.turn)
    wanted = com + np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ away
    assert frame.aligned(point, com) == pytest.approx(wanted, abs=1e-12)


def test_following_a_sole_turns_by_its_heading_less_the_commanded_one():
    rng = np.random.default_rng(1)
    real, commanded = rng.normal(size=(2, 3))
    forms = (command_frame, python_form("command_frame"))
    for yaw, heading in ((0.3, 0.5), (3.1, -3.1)):
        rotation = np.array(
            [[np.cos(heading), -np.sin(heading), 0.0], [np.sin(heading), np.cos(heading), 0.0], [0.0, 0.0, 1.0]]
        )
        for form in forms:
            one, other = (form.CommandFrame(commanded, 0.005, 0.3) for _ in range(2))
            one.follow(commanded, yaw, real, rotation)
            other.update(commanded, real, np.remainder(heading - yaw + np.pi, 2.0 * np.pi) - np.pi)
            assert one.turn == pytest.approx(other.turn, abs=1e-15)
            assert one.offset == other.offset
