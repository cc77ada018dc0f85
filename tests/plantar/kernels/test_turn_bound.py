"""The bound on rectangles that turn about vertices, their corners cut by lines: against areas at angles within it."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar import kernels

TurnBound = kernels.python_form("turn_bound").TurnBound
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


class Problem(TurnBound):
    """Vertices and lines as they are drawn, not found in an outline: some sides, or two opposite ones, have none."""

    def __init__(self, rng):
        super().__init__(True)
        self.size = np.array([1.0, math.exp(rng.uniform(-2.5, 0.0))])
        self.half = math.exp(rng.uniform(math.log(1e-3), math.log(0.05)))
        bare = ((), (0, 1), (2, 3))[rng.integers(3)]
        self.vertices = [self._vertex(rng, side) for side in range(4) if side not in bare and rng.random() < 0.75]
        self.cuts = [self._line(rng, corner) for corner in CORNERS for _ in range(rng.integers(4))]
        self.box = [v for x in 0.46 * self.size for v in (-x, x)]
        wide = rng.choice([0.5, 0.52, 0.6])
        self.around = [v for x in wide * self.size for v in (-x, x)]

    def _vertex(self, rng, side):
        place = rng.uniform(-0.45, 0.45, 2)
        place[side // 2] = (-0.5, 0.5)[side % 2] * rng.choice([1.0, 1.5]) * rng.uniform(1.0, 1.05)
        return side, *(place * self.size)

    def _line(self, rng, corner):
        phi = rng.uniform(self.half + 1e-6, 0.5 * math.pi - self.half - 1e-6)
        normal = np.array(corner) * [math.cos(phi), math.sin(phi)]
        x, y = normal * rng.uniform(0.95, 1.2) * 0.5 * float(np.abs(normal) @ self.size)
        return [x, y, -normal[1], normal[0]]

    def _find_bearing(self, xs, ys, m, box, half):
        self.bearings = len(self.vertices)
        for k, (side, _x, _y) in enumerate(self.vertices):
            self.bearing[k], self.side[k] = k, side

    def _find_lines(self, xs, ys, start, rings, box, lean):
        self.lines = len(self.cuts)
        for k, line in enumerate(self.cuts):
            self.line[4 * k : 4 * k + 4], self.edge[k] = line, k

    def room(self, turn):
        """Largest area at an angle."""
        xs, ys = [v[1] for v in self.vertices], [v[2] for v in self.vertices]
        self._find_bearing(xs, ys, 0, self.box, self.half)
        self._find_lines(xs, ys, [0], 0, self.box, self.half)
        return self._room(xs, ys, self.box, turn)

    def is_near(self, turn):
        """Whether the middle of the rectangle that was found at an angle is one of those that are asked for."""
        self._find_centre(turn)
        x, y = self.centre
        low_x, high_x, low_y, high_y = self.middles
        return low_x <= x <= high_x and low_y <= y <= high_y

    def reach(self, target):
        """How far from the middle there is no more than a target, towards both sides."""
        xs, ys = [v[1] for v in self.vertices], [v[2] for v in self.vertices]
        reach = [0.0, 0.0]
        self.forget()
        self.clear(xs, ys, [0], 0, self.box, self.around, self.half, target, self.half, self.half, reach)
        return reach


def is_within(rng):
    """Compare one problem's reach with 2 x 8 areas within it; whether there was one."""
    problem = Problem(rng)
    middle = problem.room(0.0)
    if not 0.0 < middle < math.inf:
        return False
    target = middle * (1.0 + math.exp(rng.uniform(math.log(1e-7), math.log(0.1))))
    low, high = problem.reach(target)
    assert 0.0 <= min(low, high) <= max(low, high) <= problem.half
    for turn in (*np.linspace(-low, 0.0, 8, endpoint=False), *np.linspace(high, 0.0, 8, endpoint=False)):
        area = problem.room(float(turn))
        if area == math.inf or not problem.is_near(float(turn)):  # open, or none that the bound speaks of
            continue
        assert area <= target * (1.0 + 1e-12)
    return low > 0.0 or high > 0.0


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None)
def test_no_room_within_reach_is_above_the_target(seed):
    rng = np.random.default_rng(seed)
    assert sum(is_within(rng) for _ in range(30)) > 5


def test_what_is_known_of_the_same_vertices_and_lines_is_no_more_than_what_is_found():
    rng = np.random.default_rng(4)
    compared = 0
    while compared < 100:
        problem = Problem(rng)
        middle = problem.room(0.0)
        if not 0.0 < middle < math.inf:
            continue
        first = problem.reach(1.001 * middle)
        xs, ys = [v[1] for v in problem.vertices], [v[2] for v in problem.vertices]
        again = [0.0, 0.0]
        wanted = 0.7 * problem.half
        problem.clear(xs, ys, [0], 0, problem.box, problem.around, problem.half, 1.001 * middle, wanted, wanted, again)
        assert again == [min(wanted, side) for side in first]
        compared += 1
