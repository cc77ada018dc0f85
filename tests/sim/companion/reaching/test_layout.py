import itertools
import math

import numpy as np
import pytest

from plantar.sim.companion.reaching.layout import KINDS, random_layout

TIP = np.array([0.8, 0.48])
REACH = ((0.4, 0.6), (0.0, math.pi / 2.0))


@pytest.mark.parametrize("kind", KINDS)
def test_a_layout_leaves_room_for_pushing(kind):
    for seed in range(50):
        layout = random_layout(np.random.default_rng(seed), kind, TIP, REACH, (2.0, 5.0))
        length = np.linalg.norm(layout.goal - TIP)
        way = (layout.goal - TIP) / length
        assert 0.4 <= length <= 0.6
        for post in layout.posts:
            along, beside = (post.place - TIP) @ way, abs((post.place - TIP) @ [-way[1], way[0]])
            assert np.linalg.norm(post.place - TIP) > post.radius + 0.035
            assert 2.0 <= post.friction <= 5.0 or post.name.startswith("fixed")
            if not post.friction:  # the tip, 35 mm thick, passes it on its straight way to the goal
                assert along > length or beside > post.radius + 0.035
        fixed = sum(not post.friction for post in layout.posts)
        assert fixed == {"beside": 1, "ring": 6}.get(kind, 0)
        if kind != "ring":
            assert np.linalg.norm(layout.posts[0].place - layout.goal) < 0.03


@pytest.mark.parametrize(("kind", "first"), [("movable", 1), ("ring", 0)])
def test_neighbours_leave_no_gap_for_the_tip(kind, first):
    for seed in range(50):
        posts = random_layout(np.random.default_rng(seed), kind, TIP, REACH, (2.0, 5.0)).posts[first:]
        for one, other in itertools.pairwise([*posts, posts[0]] if kind == "ring" else posts):
            gap = np.linalg.norm(one.place - other.place) - one.radius - other.radius
            assert 0.0 < gap < 0.07


def test_a_seed_determines_the_layout():
    one, other = (random_layout(np.random.default_rng(3), "beside", TIP, REACH, (2.0, 5.0)) for _ in range(2))
    assert np.array_equal(one.goal, other.goal)
    assert [p.friction for p in one.posts] == [p.friction for p in other.posts]
