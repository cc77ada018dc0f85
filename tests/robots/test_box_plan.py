"""The box step: six steps a round, feet in turn that never cross, and back where it began."""

import math

import pytest

from plantar.errors import InputError
from plantar.robots.start import box_plan


@pytest.mark.parametrize("first", ["left", "right"])
def test_a_round_ends_where_it_began_and_every_step_goes_somewhere(first):
    feet, plan = box_plan(12, stride=0.05, width=0.17, first=first)
    assert [s.side for s in plan[::2]] == [first] * 6
    standing = dict(feet)
    for k, step in enumerate(plan):
        before = standing[step.side]
        assert math.dist((before.x, before.y), (step.x, step.y)) >= 0.05 - 1e-12
        standing[step.side] = step
        assert standing["left"].y - standing["right"].y >= 0.17 - 0.05 - 1e-12  # never across the other foot
        if k % 6 == 5:
            assert standing == feet


def test_the_two_sides_mirror_each_other():
    _, left = box_plan(6, stride=0.1, width=0.2, first="left")
    _, right = box_plan(6, stride=0.1, width=0.2, first="right")
    for one, other in zip(left, right, strict=True):
        assert (one.x, -one.y) == pytest.approx((other.x, other.y))


@pytest.mark.parametrize(
    ("steps", "stride", "words"), [(8, 0.05, "whole rounds"), (6, 0.0, "above 0"), (6, math.nan, "above 0")]
)
def test_what_is_no_box_is_refused(steps, stride, words):
    with pytest.raises(InputError, match=words):
        box_plan(steps, stride=stride, width=0.17)
