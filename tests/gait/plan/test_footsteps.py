import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.sides import other_side
from plantar.errors import InputError
from plantar.gait.plan.footsteps import Footstep, straight_plan


def test_forward_walk_leads_by_one_length_and_closes():
    feet, plan = straight_plan(20, length=0.2, width=0.17)
    assert [s.side for s in plan[:4]] == ["left", "right", "left", "right"]
    assert np.allclose([s.x for s in plan[:-1]], 0.2 * np.arange(1, 20))
    assert plan[-1].x == pytest.approx(plan[-2].x)
    assert {s.y for s in plan} == {0.085, -0.085}
    assert feet["left"].y - feet["right"].y == pytest.approx(0.17)


def test_each_second_step_of_a_closing_walk_closes_the_feet():
    for steps, places in ((6, [1, 1, 2, 2, 3, 3]), (5, [1, 1, 2, 2, 2])):
        _, plan = straight_plan(steps, length=0.3, closing=True)
        assert [s.x for s in plan] == pytest.approx([0.3 * k for k in places])


@pytest.mark.parametrize(
    ("steps", "closing", "levels"),
    [
        (6, True, [1, 1, 2, 2, 1, 1]),
        (4, True, [1, 1, 0, 0]),
        (6, False, [1, 2, 3, 2, 1, 1]),
        (5, False, [1, 2, 1, 0, 0]),
    ],
)
def test_a_climb_goes_up_to_the_middle_and_down(steps: int, closing: bool, levels: list[int]) -> None:
    feet, plan = straight_plan(steps, length=0.3, height=0.5, closing=closing, climb=0.1)
    assert [s.z for s in plan] == pytest.approx([0.5 + 0.1 * k for k in levels])
    assert {foot.z for foot in feet.values()} == {0.5}


def test_sideways_walk_opens_and_closes():
    _, plan = straight_plan(6, length=0.0, sideways=0.08, width=0.17)
    left = [s.y for s in plan if s.side == "left"]
    right = [s.y for s in plan if s.side == "right"]
    assert np.allclose(np.array(left) - 0.085, [0.08, 0.16, 0.24])
    assert np.allclose(np.array(right) + 0.085, [0.08, 0.16, 0.24])


@given(
    st.integers(0, 30),
    st.floats(-0.3, 0.3),
    st.floats(-0.1, 0.1),
    st.floats(-5, 5),
    st.floats(-5, 5),
    st.floats(-math.pi, math.pi),
)
def test_plans_move_with_their_start(steps, length, sideways, x, y, yaw):
    _, here = straight_plan(steps, length=length, sideways=sideways)
    _, there = straight_plan(steps, length=length, sideways=sideways, start=(x, y, yaw))
    assert len(there) == steps
    c, s = math.cos(yaw), math.sin(yaw)
    for a, b in zip(here, there, strict=True):
        assert b.side == a.side
        assert b.x == pytest.approx(x + c * a.x - s * a.y, abs=1e-12)
        assert b.y == pytest.approx(y + s * a.x + c * a.y, abs=1e-12)
    for a, b in itertools.pairwise(there):
        assert b.side == other_side(a.side)


@pytest.mark.parametrize("arguments", [{"steps": -1}, {"steps": 2, "length": math.nan}, {"steps": 2, "width": 0.0}])
def test_bad_plans_are_refused(arguments):
    with pytest.raises(InputError):
        straight_plan(**arguments)


def test_rotation_is_a_level_heading():
    rotation = Footstep("left", 0.0, 0.0, 0.3).rotation_sole_to_world
    assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-15)
    assert math.atan2(rotation[1, 0], rotation[0, 0]) == pytest.approx(0.3)
