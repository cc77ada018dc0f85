"""The judge's support polygon is the hull of its contact points, to a picometre, in every walking scene."""

import math

import pytest

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, builtin_scenes, load_scene
from plantar.sim.run.scene_kind import open_scene

Point = tuple[float, float]
STEPS = 10_000
SCENES = [name for name in builtin_scenes() if isinstance(open_scene(name), Scene)]


def is_left(a: Point, b: Point, c: Point) -> bool:
    """Whether c is left of the line from a to b, or no more than a picometre to its right."""
    x, y = b[0] - a[0], b[1] - a[1]
    return x * (c[1] - a[1]) - y * (c[0] - a[0]) >= -1e-12 * math.hypot(x, y)


def is_hull(ring: list[Point], points: list[Point]) -> bool:
    """Whether a ring goes round all points, counter-clockwise, from one to another of them."""
    if len(ring) < 3:
        return {*ring} == {min(points), max(points)} if points else not ring
    edges = list(zip(ring, [*ring[1:], ring[0]], strict=True))
    return {*ring} <= {*points} and all(is_left(a, b, c) for a, b in edges for c in points)


class Compared(Simulation):
    """A run that compares the judge's polygon at each physics step."""

    compared = 0

    @property
    def ended(self) -> bool:
        return super().ended or self.compared >= STEPS

    def advance(self) -> None:
        super().advance()
        truth = self.judge.truth()
        assert is_hull(truth.ring, [p for foot in truth.points for p in foot]), (self.world.data.time, truth)
        self.compared += 1


def test_a_hull_is_distinguished_from_other_rings():
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    assert is_hull(square, [*square, (0.5, 0.5), (0.5, 0.0)])
    assert not is_hull(square, [*square, (0.5, -1e-11)])
    assert not is_hull(square[::-1], square)
    assert not is_hull(square[:3], square)
    assert is_hull([], [])
    assert is_hull([(0.0, 0.0), (1.0, 0.0)], [(0.5, 0.0), (0.0, 0.0), (1.0, 0.0)])


@pytest.mark.parametrize("scene", ["flat", *(pytest.param(name, marks=pytest.mark.long) for name in SCENES)])
def test_the_support_is_the_hull_of_the_contacts(scene):
    short = ["steps=1", "settle=0.2", "end=0.2"] if scene == "flat" else []
    run = Compared(load_scene(scene, short), 1)
    run.run()
    assert run.compared > 1000
