"""Steps are counted by side, order and place: walks that are made up, honest ones and others."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.plan_change import MovedStep
from plantar.sim.judging.step_count import StepCount
from plantar.sim.judging.walk_goal import WalkGoal

FEET, STEPS = straight_plan(6, length=0.2)
WEIGHT = 800.0


class Walk:
    """Feet that are put down somewhere, a second after each other."""

    def __init__(self, steps=STEPS, feet=FEET, justified=True):
        self.goal = WalkGoal(feet, steps)
        self.count = StepCount(self.goal, WEIGHT, float, lambda stand, way, before: justified)
        self.time = 0.0

    def land(self, step: Footstep, force: float = WEIGHT, dx: float = 0.0, dyaw: float = 0.0) -> None:
        self.time += 1.0
        self.count.watch.begin(SIDES.index(step.side), round(self.time))
        self.count.watch.carry(SIDES.index(step.side), force, step.x + dx, step.y, step.yaw + dyaw)

    def report(self, *moved: MovedStep) -> None:
        self.goal.move(self.time, moved)

    @property
    def taken(self) -> int:
        return self.count.count().taken


def test_a_walk_as_planned_counts_every_step():
    walk = Walk()
    for k, step in enumerate(STEPS):
        assert walk.taken == k
        walk.land(step)
    counted = walk.count.count()
    assert (counted.taken, counted.missed) == (6, "")
    assert (*counted.drift, counted.turned) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize(("off", "turn", "counts"), [(0.049, 0.0, 6), (0.051, 0.0, 2), (0.0, 4.9, 6), (0.0, 5.1, 2)])
def test_a_place_is_5_cm_and_5_degrees_wide(off, turn, counts):
    walk = Walk()
    for k, step in enumerate(STEPS):
        walk.land(step, dx=off if k == 2 else 0.0, dyaw=math.radians(turn) if k == 2 else 0.0)
    counted = walk.count.count()
    assert counted.taken == counts
    assert (f"{1e3 * off:.0f} mm and {turn:.1f} deg" in counted.missed) == (counts < 6)


def test_tapping_one_foot_is_one_step_at_most():
    walk = Walk(*straight_plan(6, length=0.0)[::-1])
    for _ in range(6):
        walk.land(walk.goal.steps[0])
    assert walk.taken == 1


def test_bounces_and_taps_that_carry_nothing_are_no_steps():
    steps = straight_plan(6, length=0.0)[1]
    walk = Walk(steps)
    for step in steps:
        walk.land(step, force=0.2 * WEIGHT)
    assert walk.taken == 0
    missed = walk.count.count().missed
    assert "left foot did not land" in missed


def test_a_foot_that_is_lifted_again_is_where_it_stands_in_the_end():
    walk = Walk()
    walk.land(STEPS[0], dx=0.2)  # a probe that carries
    walk.land(STEPS[0])
    for step in STEPS[1:]:
        walk.land(step)
    assert walk.taken == 6
    walk = Walk()
    walk.land(STEPS[0])
    walk.land(STEPS[0], dx=0.2)  # and elsewhere for good
    for step in STEPS[1:]:
        walk.land(step)
    assert walk.taken == 0


def test_a_foot_that_slides_away_while_it_stands_has_not_stayed():
    walk = Walk()
    for step in STEPS:
        walk.land(step)
    last = STEPS[-1]
    walk.count.watch.carry(SIDES.index(last.side), WEIGHT, last.x + 0.08, last.y, 0.0)
    assert walk.taken == 5
    assert walk.count.slip == pytest.approx(0.08)


def test_the_wrong_order_does_not_count():
    walk = Walk()
    for k in (1, 0, 3, 2, 5, 4):
        walk.land(STEPS[k])
    assert walk.taken < 6
    walk = Walk()
    for step in STEPS:
        walk.land(replace(step, side="right" if step.side == "left" else "left"))
    assert walk.taken == 0


def test_both_feet_have_to_be_there_in_the_end():
    walk = Walk()
    for step in STEPS:
        walk.land(step)
    walk.land(STEPS[-2], dx=-0.3)
    assert walk.taken == 4


def test_a_step_that_is_left_out_is_missed():
    walk = Walk()
    for k in (0, 1, 4, 5):
        walk.land(STEPS[k])
    assert walk.taken == 2


def moved_from(steps: tuple[Footstep, ...], first: int, dx: float, dy: float, reason: str) -> list[MovedStep]:
    return [MovedStep(k, s.x + dx, s.y + dy, s.yaw, reason) for k, s in enumerate(steps) if k >= first]


def test_a_walk_around_an_obstacle_counts_where_it_was_reported_before():
    walk = Walk()
    walk.land(STEPS[0])
    walk.land(STEPS[1])
    walk.report(*moved_from(STEPS, 2, -0.22, 0.0, "foothold refused"))
    for step in STEPS[2:]:
        walk.land(step, dx=-0.22)
    assert walk.taken == 6
    soles = dict.fromkeys(SIDES, np.zeros(2))
    assert walk.goal.end(soles)[0] == pytest.approx([STEPS[-1].x - 0.22, 0.0])
    assert walk.goal.end(soles, at_start=True)[0] == pytest.approx([STEPS[-1].x, 0.0])
    assert [row["reason"] for row in walk.goal.summary()] == ["foothold refused"] * 4


def test_what_is_reported_after_the_foot_landed_does_not_count():
    walk = Walk()
    for k, step in enumerate(STEPS):
        walk.land(step, dx=0.1 if k >= 2 else 0.0)
        if k >= 2:
            walk.time += 0.01
            walk.report(MovedStep(k, step.x + 0.1, step.y, 0.0, "where it landed"))
    assert walk.taken == 2


@pytest.mark.parametrize(
    ("dx", "yaw", "reason"),
    [
        (0.1, 0.0, ""),
        (0.1, 0.0, "  "),
        (0.9, 0.0, "far away"),
        (math.nan, 0.0, "nowhere"),
        (0.1, math.inf, "nowhere"),
        (0.1, 0.7, "turned round"),
    ],
)
def test_places_that_no_detour_explains_do_not_count(dx, yaw, reason):
    walk = Walk()
    walk.report(*(MovedStep(k, s.x + dx, s.y, s.yaw + yaw, reason) for k, s in enumerate(STEPS)))
    assert walk.goal.refused == 6
    assert not walk.goal.summary()
    for step in STEPS:
        walk.land(step, dx=0.1 if math.isnan(dx) else dx, dyaw=0.0 if math.isinf(yaw) else yaw)
    assert walk.taken == 0


def test_a_walk_that_is_cut_short_by_moving_its_steps_is_not_taken_over():
    """20 steps of 0.2 m, each said to have been moved back to where the robot stands."""
    feet, steps = straight_plan(20, length=0.2)
    walk = Walk(steps, feet)
    for k, step in enumerate(steps):
        walk.report(MovedStep(k, 0.0, step.y, 0.0, "tired"))
        walk.land(replace(step, x=0.0))
    assert walk.taken == 1
    assert walk.goal.end({"left": [0.0, 0.0], "right": [0.0, 0.0]})[0][0] > 3.0


def test_a_strip_that_turns_away_is_followed_to_its_end():
    """50 side steps of 8 cm along a beam that is turned by 10 degrees: each step shifts those to come."""
    feet, steps = straight_plan(50, length=0.0, sideways=0.08)
    walk, shift = Walk(steps, feet), 0.0
    for k, step in enumerate(steps):
        wanted = math.tan(math.radians(10.0)) * step.y
        move = max(-0.02, min(0.02, wanted - shift))
        shift += move
        walk.report(*moved_from(steps, k, shift, 0.0, "onto the strip that carries"))
        walk.land(step, dx=shift)
    assert shift > 0.3
    assert walk.taken == 50
    assert walk.goal.refused == 0


@pytest.mark.parametrize(("led", "refused"), [(0.0, 3), (0.5, 0)])
def test_who_leads_the_robot_explains_steps_that_go_along(led, refused):
    """Six steps in place, each moved 0.12 m farther than the one before: beyond 0.3 m a detour explains none."""
    feet, steps = straight_plan(6, length=0.0)
    goal = WalkGoal(feet, steps, led=led)
    for k in range(len(steps)):
        goal.move(float(k), [MovedStep(n, 0.12 * k, s.y, 0.0, "goes along") for n, s in enumerate(steps) if n == k])
    assert goal.refused == refused


def test_steps_that_do_not_exist_are_not_taken_over():
    walk = Walk()
    walk.report(MovedStep(-1, 0.0, 0.0, 0.0, "a"), MovedStep(6, 0.0, 0.0, 0.0, "a"))
    assert walk.goal.refused == 2


def walked_differently(steps, feet, turn, stretch, slip=0.0):
    """Each way from foothold to foothold as planned, but turned, stretched and slipped to the left by a little."""
    walk = Walk(steps, feet)
    goal, before = walk.goal, walk.goal.start()
    for k, step in enumerate(steps):
        (ahead, left, turns), _ = goal.ways(k, math.inf, math.inf)
        c, s = math.cos(before.yaw), math.sin(before.yaw)
        ahead, left = stretch * ahead, left + slip
        x, y = before.x + c * ahead - s * left, before.y + s * ahead + c * left
        before = Footstep(step.side, x, y, before.yaw + turns + turn)
        walk.land(before)
    return walk


def test_a_long_walk_is_judged_from_foothold_to_foothold():
    """300 steps that drift by 1 % and turn by a quarter of a turn in all, as dead reckoning would let them."""
    feet, steps = straight_plan(300, length=0.2)
    walk = walked_differently(steps, feet, math.radians(0.09), 0.99)
    counted = walk.count.count()
    assert (counted.taken, counted.missed) == (300, "")
    assert math.degrees(counted.turned) == pytest.approx(27.0, abs=0.1)
    assert counted.drift[0] == pytest.approx(-0.6, abs=0.01)
    assert counted.stands[-1].place[1] > 10.0  # far from where the plan has it


@pytest.mark.parametrize(
    ("turn", "stretch", "slip", "words"),
    [
        (0.0, 0.97, 0.0, "added up to 0.*m from their ways"),
        (0.0, 1.03, 0.0, "added up to 0.*m from their ways"),
        (0.0, 1.0, 0.006, "added up to 0.*m from their ways"),
        (0.2, 1.0, 0.0, "deg from their headings"),
        (4.9, 1.0, 0.0, "deg from their headings"),
    ],
    ids=["shorter", "longer", "aside", "turned", "turned as far as a step may"],
)
def test_a_little_of_each_step_does_not_add_up_to_another_walk(turn, stretch, slip, words):
    feet, steps = straight_plan(100, length=0.2)
    counted = walked_differently(steps, feet, math.radians(turn), stretch, slip).count.count()
    assert counted.taken < 80
    assert re.search(words, counted.missed)


def test_a_move_that_nothing_justifies_does_not_count():
    """20 steps of 0.15 m for 20 of 0.2 m, each reported as moved: 1 m short."""
    feet, steps = straight_plan(20, length=0.2)
    short = straight_plan(20, length=0.15)[1]
    for justified in (True, False):
        walk = Walk(steps, feet, justified)
        walk.report(*(MovedStep(k, s.x, s.y, 0.0, "x") for k, s in enumerate(short)))
        for step in short:
            walk.land(step)
        counted = walk.count.count()
        assert (counted.taken == 20) == justified
    assert "its move, 'x', neither ground nor a push justifies" in counted.missed
    assert counted.taken < 3


def test_the_foothold_before_is_not_moved_after_it_was_stood_on():
    """A step of 0.2 m becomes one of 0.1 m where the one before it is reported to have been meant 0.1 m further on."""
    walk = Walk()
    walk.land(STEPS[0])
    first = STEPS[0]
    walk.time += 0.1
    walk.report(MovedStep(0, first.x + 0.1, first.y, 0.0, "x"), MovedStep(1, STEPS[1].x, STEPS[1].y, 0.0, "x"))
    walk.land(STEPS[1], dx=-0.1)
    assert walk.taken == 1


def test_a_move_that_is_justified_is_judged_where_it_leads():
    walk = Walk()
    walk.report(*moved_from(STEPS, 2, 0.12, 0.0, "foothold refused"))
    for k, step in enumerate(STEPS):
        walk.land(step, dx=0.06 if k >= 2 else 0.0)
    assert walk.taken == 2
