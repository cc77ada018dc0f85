"""Footsteps from velocities, one touchdown after another, without a walk."""

import math
from itertools import pairwise

import numpy as np
import pytest
from shapely import Polygon

from plantar.errors import InputError
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.phases import PhaseKind, Timing
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.velocity_command import (
    STOP,
    Legs,
    Stride,
    Velocity,
    VelocityCommand,
    VelocityTable,
    next_step,
    table_of,
)

NOWHERE = np.empty((0, 2))
LEGS = Legs(0.17, 0.8, heel=0.09, toe=0.13, inner=0.06)
T = 1.2  # s from step to step of the default timing


def walked(command, tick_at, until, count=0):
    """The footsteps of a walk, the plan asked at each tick of 0.1 s."""
    feet, steps = straight_plan(count)
    plan = WalkPlan(feet, steps, Timing(), {side: np.array([0.02, 0.0]) for side in feet}, 3.5, 1.0)
    taken: dict[int, Footstep] = {}
    for k in range(1, round(until / 0.1)):
        tick = tick_at(plan, 0.1 * k + 0.05)
        change = command.propose(tick)
        if change is not None:
            plan.apply(change, tick.time, NOWHERE)
        phase = plan.schedule.at(tick.time)
        if phase.swing is not None:
            taken[phase.step] = plan.view.foothold(phase.step)
    return plan, [taken[k] for k in sorted(taken)]


def command(*rows: list[float | str]) -> VelocityCommand:
    return VelocityCommand(table_of(rows, 0.0), LEGS)


def test_a_forward_velocity_makes_steps_of_its_length(tick_at):
    _, steps = walked(command([1.0, 0.1, 0.0, 0.0]), tick_at, 30.0)
    assert [s.side for s in steps[:4]] == ["left", "right", "left", "right"]
    assert np.diff([s.x for s in steps[:20]]) == pytest.approx(0.1 * T)
    assert {round(abs(s.y), 6) for s in steps} == {0.085}


@pytest.mark.parametrize("left", [0.05, -0.05])
def test_sideways_the_foot_on_that_side_opens_and_the_other_one_closes(tick_at, left):
    _, steps = walked(command([1.0, 0.0, left, 0.0]), tick_at, 30.0)
    assert steps[0].side == ("left" if left > 0.0 else "right")
    apart = [abs(a.y - b.y) for a, b in pairwise(steps)]
    assert min(apart) == pytest.approx(LEGS.width)
    assert max(apart) == pytest.approx(LEGS.width + 2.0 * abs(left) * T)
    assert steps[20].y - steps[0].y == pytest.approx(20 * left * T)


@pytest.mark.parametrize("turn", [0.15, -0.15])
def test_turning_on_the_spot_goes_round_the_middle_between_the_feet(tick_at, turn):
    _, steps = walked(command([1.0, 0.0, 0.0, turn]), tick_at, 60.0)
    assert steps[20].yaw - steps[0].yaw == pytest.approx(20 * turn * T)
    turns = [math.copysign(1.0, turn) * math.remainder(b.yaw - a.yaw, 2.0 * math.pi) for a, b in pairwise(steps[:20])]
    assert turns == pytest.approx([abs(turn) * T] * 19)  # one foot out, the other one in by as much
    middles = np.array([[0.5 * (a.x + b.x), 0.5 * (a.y + b.y)] for a, b in pairwise(steps)])
    rooms = [LEGS.room(turn * T), LEGS.room(-turn * T)]
    assert np.hypot(*middles.T).max() <= sum(rooms) + 0.5 * LEGS.width * (1.0 - math.cos(turn * T)) + 1e-9


def test_a_fast_turn_is_left_to_the_foot_that_turns_out(tick_at):
    _, steps = walked(command([1.0, 0.0, 0.0, 0.25]), tick_at, 30.0)
    turns = {a.side: math.remainder(a.yaw - b.yaw, 2.0 * math.pi) for b, a in pairwise(steps[:12])}
    assert turns == pytest.approx({"right": Stride().turn_in, "left": 2.0 * 0.25 * T - Stride().turn_in})


def test_a_turn_begins_with_the_next_step_whichever_foot_it_is(tick_at):
    """Heading, as the mean of the feet's: half a step behind the command, by either foot."""
    for begin in (4.0, 4.0 + T):
        _, steps = walked(command([1.0, 0.0, 0.0, 0.0], [begin, 0.0, 0.0, 0.1]), tick_at, 20.0)
        k = next(i for i, step in enumerate(steps) if step.yaw != 0.0)
        heading = [0.5 * (a.yaw + b.yaw) for a, b in pairwise(steps)]
        assert np.diff(heading[k - 2 : k + 3]) == pytest.approx([0.05 * T, *[0.1 * T] * 3])


def test_feet_never_come_nearer_than_at_rest_whatever_is_commanded(tick_at):
    """Soles as rectangles, from one step to the next: their distance, heels and toes."""
    rng = np.random.default_rng(3)
    rows = [[1.0 + 3.0 * k, *rng.uniform([-0.3, -0.2, -0.6], [0.3, 0.2, 0.6]).tolist()] for k in range(40)]
    _, steps = walked(command(*rows), tick_at, 120.0)
    corners = np.array([[-0.09, -0.06], [0.13, -0.06], [0.13, 0.08], [-0.09, 0.08]])
    for a, b in pairwise(steps):
        left, right = (a, b) if a.side == "left" else (b, a)
        here, there = (
            Polygon((f.rotation_sole_to_world[:2, :2] @ (corners * [1.0, s]).T).T + f.position[:2])
            for f, s in ((left, 1.0), (right, -1.0))
        )
        assert here.distance(there) >= LEGS.width - 2.0 * LEGS.inner - 2e-3
        apart = math.remainder(left.yaw - right.yaw, 2.0 * math.pi)
        assert -Stride().turn_in - 1e-9 <= apart <= Stride().turn + 1e-9


def test_a_command_that_asks_for_too_much_is_walked_slower():
    left, right = Footstep("left", 0.0, 0.085), Footstep("right", 0.0, -0.085)
    step = next_step(right, left, Velocity(5.0, 5.0, 5.0), LEGS, Stride(), 1.0)
    assert step.yaw == pytest.approx(Stride().turn)
    assert math.hypot(step.x, step.y) < 0.8


@pytest.mark.parametrize("stop", [5.3, 5.6, 6.1, 6.4, 6.9])
def test_a_stop_comes_to_rest_within_two_steps_with_the_feet_parallel(tick_at, stop):
    plan, _ = walked(command([1.0, 0.1, 0.05, 0.1], [stop, "stop"]), tick_at, 20.0)
    landings = [p.touchdown for p in plan.schedule.phases if p.swing is not None and p.touchdown > stop]
    assert 1 <= len(landings) <= 2
    last, other = plan.view.foothold(plan.view.count - 1), plan.view.foothold(plan.view.count - 2)
    apart = math.dist((last.x, last.y), (other.x, other.y))
    assert LEGS.width - 1e-9 <= apart <= LEGS.width + LEGS.room(2.0 * 0.1 * T) + 1e-9
    assert last.yaw == other.yaw
    assert plan.schedule.at(20.0).kind == PhaseKind.STANDING


def test_a_stop_counts_until_the_foot_lifts_off(tick_at):
    """Of a step cycle, the double support that the stop is heard in belongs to the step that it still changes."""
    rows: list[list[float | str]] = [[1.0, 0.1, 0.0, 0.0]]
    plan, _ = walked(command(*rows), tick_at, 6.0)
    swings = [p for p in plan.schedule.phases if p.swing is not None]
    before, after = swings[0], swings[1]
    for share, most in ((0.1, 1), (0.6, 1), (1.2, 2)):  # of the double support; the last in the swing
        stop = before.touchdown + share * (after.start - before.touchdown)
        plan, _ = walked(command(*rows, [stop, "stop"]), tick_at, 12.0)
        landings = [p.touchdown for p in plan.schedule.phases if p.swing is not None and p.touchdown > stop]
        assert len(landings) == most


def test_from_rest_it_walks_again_and_zero_takes_steps_in_place(tick_at):
    rows: list[list[float | str]] = [[1.0, 0.1, 0.0, 0.0], [6.0, "stop"], [14.0, 0.0, 0.0, 0.0]]
    plan, steps = walked(command(*rows), tick_at, 30.0)
    assert len(steps) > 12
    assert len({round(s.x, 9) for s in steps[-8:]}) == 1
    swings = [p.start for p in plan.schedule.phases if p.swing is not None]
    assert all(b > a for a, b in pairwise(swings))


def test_the_plan_always_ends_at_rest(plan_of, tick_at):
    """If no command came any more, the steps that are planned would close the feet."""
    change = command([0.0, 0.15, 0.0, 0.0]).propose(tick_at(plan_of(0), 1.5))
    assert change is not None
    assert change.following is not None
    *_, before, last = change.following
    assert last.x == pytest.approx(before.x)


def test_it_asks_again_where_somebody_else_had_his_way(plan_of, tick_at):
    plan, asked = plan_of(6), command([0.0, 0.1, 0.0, 0.0])
    time = next(p.start for p in plan.schedule.phases if p.step == 3 and p.swing is None) + 0.01
    assert asked.propose(tick_at(plan, time)) is not None
    plan.apply(PlanChange("somebody else's", 4, vrp=(1.0, 0.0)), time, NOWHERE)
    again = asked.propose(tick_at(plan, time + 0.005))
    assert again is not None
    plan.apply(again, time + 0.005, NOWHERE)
    assert asked.propose(tick_at(plan, time + 0.01)) is None


def test_nothing_is_changed_while_a_foot_swings(plan_of, tick_at):
    plan = plan_of(6)
    swing = next(p for p in plan.schedule.phases if p.swing is not None)
    assert command([0.0, 0.1, 0.0, 0.0]).propose(tick_at(plan, swing.start + 0.1)) is None


@pytest.mark.parametrize(
    "row", [[1.0], [1.0, "go"], [1.0, 0.1, 0.1], ["stop", 1.0], [1.0, 0.1, 0.1, True], "stop", 3.0]
)
def test_a_row_that_is_no_command_is_named(row):
    with pytest.raises(InputError, match=r"a velocity command is .*; allowed: \[time, forward, left, turn\] or"):
        table_of([row], 0.0)


def test_bad_tables_are_refused():
    with pytest.raises(InputError, match="increase"):
        VelocityTable((2.0, 1.0), (STOP, STOP))
    with pytest.raises(InputError, match="1 times for 0 commands"):
        VelocityTable((2.0,), ())
    with pytest.raises(InputError, match="velocity 'turn' is nan"):
        Velocity(turn=math.nan)
    with pytest.raises(InputError, match="'turn' is 5"):
        Stride(turn=5.0)


def test_velocities_are_set_at_any_tick_and_a_plan_is_left_alone_before(tick_at):
    command = VelocityCommand(None, LEGS)
    plan, steps = walked(command, tick_at, 6.0, count=3)
    assert plan.view.count == 3 == len(steps)  # as it was planned
    set_at = {50: Velocity(forward=0.1), 151: STOP, 290: Velocity(turn=0.2), 400: STOP}
    command = VelocityCommand(None, LEGS)

    def tick(plan, time):
        if round(10.0 * time - 0.5) in set_at:
            command.set_velocity(set_at[round(10.0 * time - 0.5)])
        return tick_at(plan, time)

    plan, steps = walked(command, tick, 50.0)
    assert plan.schedule.at(49.0).kind == PhaseKind.STANDING
    forward = [step for step in steps if step.yaw == 0.0]
    assert len(forward) >= 8
    assert forward[-1].x == pytest.approx(forward[-2].x)  # the feet are closed
    assert steps[-1].yaw == pytest.approx(steps[-2].yaw)
    assert steps[-1].yaw > 1.0


def test_a_stop_in_a_plan_of_steps_ends_it_at_the_next_touchdown(tick_at):
    command = VelocityCommand(None, LEGS)

    def tick(plan, time):
        if 5.0 < time < 5.1:
            command.set_velocity(STOP)
        return tick_at(plan, time)

    plan, steps = walked(command, tick, 30.0, count=20)
    assert plan.schedule.at(25.0).kind == PhaseKind.STANDING
    assert len(steps) < 8
    assert steps[-1].x == pytest.approx(steps[-2].x)
