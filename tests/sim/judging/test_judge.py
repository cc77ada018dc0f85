"""What justifies a move of a footstep, and which geoms are ground."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from plantar.gait.plan.footsteps import straight_plan
from plantar.mechanics.rotation import level_rotation
from plantar.sim.judging.judge import Judge, PlainGround, is_ground
from plantar.sim.judging.step_count import Stand
from plantar.sim.judging.walk_goal import WalkGoal
from plantar.sim.model.world import build_world
from plantar.sim.terrain import Ground, Motion, Solid

SOLE = np.array([[-0.1, -0.05], [0.15, -0.05], [0.15, 0.05], [-0.1, 0.05]])
WAY = (0.2, -0.17, 0.0)
"""Of a right foot after a left one."""


def plain(*solids: Solid) -> PlainGround:
    return PlainGround(Ground(solids, 0.0, 0.8), {"left": SOLE, "right": SOLE}, 0.1)


def judge(pushed: tuple[float, ...] = (), *solids: Solid) -> Judge:
    made = object.__new__(Judge)
    made.world = SimpleNamespace(body=SimpleNamespace(beat=0.25))
    made.ground = plain(*solids)
    made._pushed = list(pushed)
    return made


def justified(made: Judge, before: tuple[float, float, float] = (1.0, 0.085, 0.0), time: float = 10.0) -> bool:
    return made._justified(Stand("right", time, (0.0, 0.0, 0.0)), WAY, before)


def test_nothing_justifies_a_move_on_plain_ground():
    assert not justified(judge())
    made = judge()
    made.ground = None
    assert not justified(made)


@pytest.mark.parametrize(
    ("time", "counts"), [(9.9, True), (10.0, True), (6.3, True), (6.2, False), (10.01, False), (0.0, False)]
)
def test_a_push_justifies_it_within_three_steps_and_not_afterwards(time, counts):
    assert justified(judge((time,))) == counts
    assert justified(judge((0.0, time, 20.0))) == counts


def block(x: float, y: float) -> Solid:
    return Solid("box", (0.03, 0.03, 0.02), np.array([x, y, 0.02]))


@pytest.mark.parametrize(
    ("x", "y", "counts"),
    [(1.2, -0.085, True), (1.45, -0.085, True), (1.55, -0.085, False), (1.0, 0.085, True), (0.6, 0.085, False)],
    ids=["under it", "before its toe", "further ahead", "under the foot before", "behind that one"],
)
def test_ground_justifies_it_where_it_was_planned_or_where_the_foot_before_stands(x, y, counts):
    assert justified(judge((), block(x, y))) == counts


def test_the_planned_place_is_seen_from_the_foot_before_as_it_truly_stands():
    turned = (1.0, 0.085, np.pi / 2.0)  # the way leads to (1.17, 0.285) then
    assert justified(judge((), block(1.17, 0.285)), turned)
    assert not justified(judge((), block(1.2, -0.3)), turned)


def test_the_floor_and_what_moves_of_the_ground_are_ground_and_the_robot_is_not(h1):
    moving = Solid("box", (0.1, 0.1, 0.02), np.array([3.0, 0.0, 0.02]), motions=(Motion(1.0, 1.0, np.ones(3)),))
    world = build_world(h1, Ground((block(2.0, 0.0), moving), 0.0, 0.8))
    model, mask = world.model, is_ground(world)
    root = model.body_rootid[world.torso]
    of_robot = model.body_rootid[model.geom_bodyid] == root
    assert of_robot.sum() > 4
    assert (mask == ~of_robot).all()
    for side in ("left", "right"):
        assert not mask[list(world.sole_geoms[side])].any()


TILTED = np.array([[np.cos(0.1), 0.0, np.sin(0.1)], [0.0, 1.0, 0.0], [-np.sin(0.1), 0.0, np.cos(0.1)]])


@pytest.mark.parametrize(
    ("tilt", "share", "words"),
    [(39.0, 1.0, None), (41.0, 1.0, "tilted by 41.0 deg"), (0.0, 0.61, None), (0.0, 0.59, "m above the lower sole")],
)
def test_a_body_that_tilts_or_sinks_has_fallen(h1, tilt, share, words):
    world = build_world(h1, Ground((), 0.0, 0.8))
    world.data.qpos[2] = 2.0
    mujoco.mj_forward(world.model, world.data)
    goal = WalkGoal(*straight_plan(2, length=0.2))
    made = Judge(world, Judge(world, 1.0, goal).height / share, goal)
    mujoco.mju_axisAngle2Quat(world.data.qpos[3:7], np.array([0.6, 0.8, 0.0]), np.radians(tilt))
    mujoco.mj_forward(world.model, world.data)
    made.step()
    assert made.fell == (words is not None)
    assert words is None or words in made.fall[2]


def test_the_bare_floor_is_plain():
    assert plain().under("left", 3.0, -2.0, 1.0)


def test_what_lies_within_reach_is_not():
    ground = plain(Solid("box", (0.05, 0.05, 0.02), np.array([1.0, 0.0, 0.02])))
    assert not ground.under("left", 1.0, 0.0, 0.0)
    assert not ground.under("left", 0.72, 0.0, 0.0)  # its toe ends 0.08 m before it
    assert ground.under("left", 0.65, 0.0, 0.0)  # 0.15 m before it
    assert ground.under("left", 0.72, 0.0, np.pi)  # its heel does so 0.13 m before it
    assert not ground.under("left", 1.25, 0.0, np.pi)


@pytest.mark.parametrize(
    ("solid", "is_plain"),
    [
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1])), True),
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1]), level_rotation(0.4)), True),
        (Solid("box", (1.0, 0.06, 0.1), np.array([0.0, 0.0, 0.1])), False),
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1]), TILTED), False),
        (Solid("sphere", (1.0, 1.0, 1.0), np.array([0.0, 0.0, -0.9])), False),
        (Solid("box", (1.0, 1.0, 0.1), np.zeros(3), motions=(Motion(1.0, 1.0, np.ones(3)),)), False),
    ],
    ids=["a large level box", "a turned one", "a beam", "a slope", "a sphere", "ground that moves"],
)
def test_only_a_level_face_that_stays_is_plain(solid, is_plain):
    assert plain(solid).under("right", 0.0, 0.0, 0.0) == is_plain


def test_ground_that_slides_in_is_not_plain_where_it_comes_to_lie():
    """As `slide-in`: from 0.4 m aside to under the sole, which a step may leave."""
    slab = Solid("box", (0.15, 0.09, 0.01), np.array([1.2, -0.485, 0.0]))
    there = replace(slab, motions=(Motion(1.0, 0.4, np.array([1.2, -0.085, 0.0])),))
    assert not justified(judge((), slab))
    assert justified(judge((), there))
