"""Stairs and slopes have their edges between the places of steps; a height field is as uneven as stated."""

import math

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import Relief, Slopes, Stairs

from ..test_terrain import feet, height_of


def placed(steps: int, length: float, heading: float = 0.0):
    """Footprints of a walk whose places are `length` apart, turned by a heading."""
    planned = feet(steps, length)
    c, s = math.cos(heading), math.sin(heading)
    for foot in (*planned.standing.values(), *planned.steps):
        foot.center[:] = np.array([[c, -s], [s, c]]) @ foot.center
        object.__setattr__(foot, "yaw", heading)
    return planned


@pytest.mark.parametrize(("rise", "heading"), [(0.1, 0.0), (-0.06, 0.0), (0.08, 0.7)])
def test_each_sole_is_on_one_tread_up_to_the_middle_and_down(rise, heading):
    planned = placed(6, 0.3, heading)
    height = height_of(Stairs(rise=rise, height=0.5), planned)
    for foot, tread in zip(planned.steps, (1, 2, 3, 2, 1, 0), strict=True):
        for along, across in ((-1, -1), (-1, 1), (1, -1), (1, 1), (0, 0)):
            point = foot.place(0.99 * along * foot.half[0], 0.99 * across * foot.half[1])
            assert height(point) == pytest.approx(0.5 + tread * rise, abs=1e-9)
    for foot in planned.standing.values():
        assert height(foot.center) == pytest.approx(0.5, abs=1e-9)


def test_treads_are_as_high_as_planned_and_higher_by_what_is_not() -> None:
    planned = placed(6, 0.3)
    for foot, level in zip(planned.steps, (0.1, 0.2, 0.3, 0.2, 0.1, 0.1), strict=True):
        object.__setattr__(foot, "z", level)
    height = height_of(Stairs(rise=0.02), planned)
    for foot, extra in zip(planned.steps, (1, 2, 3, 2, 1, 0), strict=True):
        assert height(foot.center) == pytest.approx(foot.z + 0.02 * extra, abs=1e-9)


def test_a_spread_changes_each_rise_by_its_seed():
    planned = placed(6, 0.3)
    tops = []
    for seed in (1, 2):
        height = height_of(Stairs(rise=0.1, spread=0.02), planned, seed)
        levels = np.array([0.0, *(height(foot.center) for foot in planned.steps)])
        assert (np.abs(np.abs(np.diff(levels)) - 0.1) <= 0.02).all()
        tops.append(levels)
    assert np.abs(tops[0] - tops[1]).max() > 1e-3


def test_slopes_go_up_and_down_again_without_a_gap():
    planned = placed(16, 0.2)
    height = height_of(Slopes(slope=10.0), planned)
    x = np.linspace(-0.5, 4.0, 2000)
    z = np.array([height(np.array([a, 0.05])) for a in x])
    steep = np.diff(z) / np.diff(x)
    assert np.abs(np.diff(z)).max() < 1.01 * math.tan(math.radians(10.0)) * (x[1] - x[0])
    for wanted in (math.tan(math.radians(10.0)), -math.tan(math.radians(10.0)), 0.0):
        assert np.sum(np.abs(steep - wanted) < 1e-6) > 200
    assert z[0] == pytest.approx(0.0, abs=1e-9)
    assert z[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("terrain", "steps", "words"),
    [
        (Stairs(), (6, 0.2), r"treads that are shorter than the sole of 0.25.*longer walk.length"),
        (Slopes(), (4, 0.3), r"slopes have 4 places of steps; allowed: 6 or more"),
    ],
)
def test_a_walk_that_does_not_fit_is_refused(terrain, steps, words):
    with pytest.raises(SceneError, match=words):
        terrain.ground(feet(*steps), np.random.default_rng(0))


def test_stairs_are_walked_with_both_feet_on_each_tread():
    simulation = Simulation(load_scene("stairs", ["steps=4", "climb=0.02", "settle=0.5"]), 1)
    places = [round(step.x, 6) for step in simulation.steps]
    assert places[0] == places[1] < places[2] == places[3]
    summary = simulation.run()
    assert summary["completed"], summary["reasons"]
    assert simulation.ground.facts["climb_m"] == pytest.approx(0.02, abs=0.004)


def test_slopes_are_walked():
    summary = run_scene(load_scene("slopes", ["steps=8", "slope=10", "settle=0.5"]), 1)
    assert summary["completed"], summary["reasons"]


def test_heights_have_their_range_and_slopes_their_length():
    planned = feet(10)
    height = height_of(Relief(unevenness=0.04, bump=0.5, height=0.3), planned, 3)
    ground = Relief(unevenness=0.04, bump=0.5, height=0.3).ground(planned, np.random.default_rng(3))
    assert ground.facts["unevenness_m"] == pytest.approx(0.04, rel=0.1)
    points = [(x, y) for x in np.linspace(-0.2, 2.1, 60) for y in np.linspace(-0.4, 0.4, 20)]
    z = np.array([height(np.array(p)) for p in points])
    assert z.max() <= ground.top + 1e-9
    assert z.min() >= ground.floor + 0.1 - 1e-9
    assert np.ptp(z) > 0.02
    for foot in planned.standing.values():
        assert height(foot.center) == pytest.approx(0.3, abs=1e-6)
    steepest = max(abs(height(np.array([x + 0.02, y])) - height(np.array([x, y]))) / 0.02 for x, y in points)
    assert steepest < 2.0 * np.pi / 0.5 * 0.04  # of a single wave of that length and twice its height


def test_each_seed_has_its_own_field():
    one, again, other = (
        Relief(unevenness=0.04, bump=0.5).ground(feet(), np.random.default_rng(seed)).solids[0].heights
        for seed in (1, 1, 2)
    )
    assert one is not None and again is not None and other is not None  # noqa: PT018
    assert (one == again).all()
    assert np.abs(one - other).max() > 0.005


def test_the_field_is_walked_and_is_no_plain_ground():
    summary = run_scene(load_scene("height-field", ["steps=3", "unevenness=0.01", "settle=0.5"]), 1)
    assert summary["completed"], summary["reasons"]


def test_no_unevenness_is_level():
    height = height_of(Relief(unevenness=0.0, bump=0.5), feet())
    assert height(np.array([0.7, 0.1])) == pytest.approx(0.0, abs=1e-5)
