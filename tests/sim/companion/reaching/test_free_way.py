"""A way without contact is found where there is one, and refused only where none exists."""

import math

import mujoco
import numpy as np
import pytest

from plantar.sim.companion.machine import load_machine
from plantar.sim.companion.reaching.free_way import Tip, free_way
from plantar.sim.companion.reaching.layout import Post

START, GOAL = np.array([0.0, 0.0, 0.2]), np.array([0.5, 0.0, 0.2])


def ring(gap, radius=0.05, size=0.2):
    """Posts about the goal, `gap` m between neighbours, and a fixed side."""
    count = math.floor(math.pi / math.asin((radius + 0.5 * gap) / size))
    radius = size * math.sin(math.pi / count) - 0.5 * gap
    turns = 2.0 * math.pi / count * np.arange(count)
    return [Post(str(i), GOAL[:2] + size * np.array([math.cos(t), math.sin(t)]), radius) for i, t in enumerate(turns)]


def tip(radius, lifts=False):
    return Tip(START, START, radius, lifts)


@pytest.mark.parametrize(("radius", "gap", "passes"), [(0.03, 0.045, False), (0.03, 0.08, True), (0.02, 0.05, True)])
def test_a_ring_is_closed_to_what_is_thicker_than_its_gaps(radius, gap, passes):
    posts = ring(gap)
    assert free_way(tip(radius), GOAL, 0.01, posts, 0.1) == passes
    assert free_way(tip(radius), GOAL, 0.01, posts[1:], 0.1)


def test_a_tip_that_lifts_comes_from_above():
    assert free_way(tip(0.03, lifts=True), GOAL, 0.01, ring(0.02), 0.03)


@pytest.mark.parametrize("lifts", [False, True])
def test_a_goal_that_is_taken_is_out_of_reach(lifts):
    post = Post("0", GOAL[:2] + np.array([0.02, 0.0]), 0.05)
    assert not free_way(tip(0.03, lifts), GOAL, 0.01, [post], 0.1)
    assert free_way(tip(0.03, lifts), GOAL, 0.08, [post], 0.1)


def test_no_way_begins_inside_of_an_obstacle():
    assert not free_way(tip(0.03), GOAL, 0.01, [Post("0", START[:2], 0.05)], 0.1)


def test_distances_are_those_of_mujoco():
    post, rng = Post("post", np.array([0.1, -0.2]), 0.06), np.random.default_rng(0)
    spec = mujoco.MjSpec()
    post.add_to(spec, 0.3, 0.05)
    points = rng.uniform(-0.5, 0.6, (50, 3))
    for i, point in enumerate(points):
        body = spec.worldbody.add_body(name=f"p{i}", pos=point)
        body.add_geom(name=f"p{i}", size=[1e-6, 0.0, 0.0])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    there = model.geom("post").id
    wanted = [
        max(mujoco.mj_geomDistance(model, data, there, model.geom(f"p{i}").id, 9.0, None), 0.0) for i in range(50)
    ]
    assert post.distance(points, 0.3, 0.05) == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize(
    ("name", "link", "point", "radius", "offset", "lifts"),
    [
        ("planar-arm", "link7", [0.265, 0.0, 0.0], 0.035, 0.035, False),
        ("table-arm", "finger", [0.0, 0.0625, 0.0], 0.025, 0.0, True),
    ],
)
def test_the_ball_is_that_of_the_tips_link(name, link, point, radius, offset, lifts):
    machine = load_machine(name)
    model = machine.spec().compile()
    data = mujoco.MjData(model)
    data.qpos[:] = machine.posture
    mujoco.mj_kinematics(model, data)
    found = Tip.of(model, data, link, np.array(point))
    assert (found.radius, found.lifts) == (radius, lifts)
    assert np.linalg.norm(found.place - found.middle) == pytest.approx(offset, abs=1e-9)
