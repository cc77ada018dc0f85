"""At the physics rate no control tick makes torques jump, and the judge's support polygon is the contacts' hull."""

import pytest
from true_ground import RUNS, Watched, is_hull, row_of

from plantar.sim.run.scene import load_scene

BEYOND = {
    ("box-step", "h1"),  # pushed to the edge of its support
    ("box-step", "hrp2kai"),  # pushed to the edge of its support
    ("height-field", "h1"),  # feet rock on two or three points
    ("height-field", "hrp2kai"),  # feet rock on two or three points
    ("partial-third", "hrp2kai"),  # falls
    ("pebbles", "h1"),  # falls
    ("pebbles", "hrp2kai"),  # falls
    ("push-beam", "h1"),  # pushed to the edge of its support
    ("push-beam", "hrp2kai"),  # pushed to the edge of its support
    ("push-partial", "h1"),  # pushed to the edge of its support
    ("push-partial", "hrp2kai"),  # pushed to the edge of its support
    ("slopes", "h1"),  # a hip that takes all of its torque
    ("stairs", "h1"),  # its hind knee is straight as the body rises
    ("stairs", "hrp2kai"),  # falls
}
"""Scenes with figures beyond their limits, in `benchmarks/convergence.md`."""


def test_a_hull_is_distinguished_from_other_rings():
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    assert is_hull(square, [*square, (0.5, 0.5), (0.5, 0.0)])
    assert not is_hull(square, [*square, (0.5, -1e-11)])
    assert not is_hull(square[::-1], square)
    assert not is_hull([square[k] for k in (0, 2, 1, 3)], square)
    assert not is_hull(square[:3], square)
    assert is_hull([], [])
    assert not is_hull([], square)
    assert is_hull([(0.0, 0.0), (1.0, 0.0)], [(0.5, 0.0), (0.0, 0.0), (1.0, 0.0)])


@pytest.mark.sample(1)
@pytest.mark.parametrize(("scene", "robot"), [("uneven", "h1"), ("flat", "hrp2kai")])
def test_a_short_walk(scene, robot):
    run = Watched(load_scene(scene, ["steps=4"], robot), 0)
    run.run()
    assert run.torque_steps().max() <= 0.1
    assert run.compared > 9000
    assert run.other == 0
    share, off = run.stand()
    assert share == pytest.approx(0.5, abs=0.05)
    assert max(map(abs, off)) < 0.01


@pytest.mark.long
@pytest.mark.parametrize(("scene", "robot"), RUNS)
def test_no_figure_of_a_scene_is_beyond_its_limit(scene, robot):
    beyond = {name: cell for name, cell in row_of(scene, robot).items() if "**" in cell}
    assert bool(beyond) == ((scene, robot) in BEYOND), beyond
