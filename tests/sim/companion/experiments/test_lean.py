"""Leaning on a table: parts of it in short, and whole runs with and without the forearm's skin."""

import numpy as np
import pytest

from plantar.sim.companion.runner import Companion
from plantar.sim.companion.standing.lean_controller import _foremost
from plantar.sim.run.scene_kind import open_scene
from tests.sim.rates import check_rate, drawn_seeds


def test_the_foremost_edge_of_a_polygon():
    polygon = np.array([[0.0, -1.0], [2.0, -1.0], [1.0, 1.0], [0.0, 1.0]])
    assert _foremost(polygon, 0.0) == pytest.approx(1.5)
    assert _foremost(polygon, -1.0) == pytest.approx(2.0)
    assert _foremost(polygon, 5.0) == pytest.approx(2.0)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(4))
def test_the_soles_see_what_they_stand_on(seed):
    companion = Companion(open_scene("lean"), seed)
    companion.experiment.duration = 0.3
    companion.run()
    experiment, seen = companion.experiment, companion.controller.areas
    for side, (low, high) in experiment._ground().items():
        link = f"{side}_foot"
        place, area = experiment.stance.places[link][:2], seen[link]
        assert (place + np.array([area.x_min, area.y_min]) >= low - 1e-3).all()
        assert (place + np.array([area.x_max, area.y_max]) <= high + 1e-3).all()
        assert area.x_max - area.x_min > 0.2 * (high - low)[0]
        assert area.y_max - area.y_min > 0.2 * (high - low)[1]


def test_the_load_of_the_ground_is_the_robot_s_weight():
    companion = Companion(open_scene("lean"), 0)
    companion.experiment.duration = 0.8
    companion.run()
    trace = np.array(companion.experiment._trace)
    loads = trace[trace[:, 0] > 0.5][:, 2:4].sum(axis=1)
    assert np.median(loads) == pytest.approx(86.0 * 9.81, rel=0.01)


@pytest.mark.long
def test_the_forearm_carries_what_the_feet_cannot():
    seeds = drawn_seeds(test_the_forearm_carries_what_the_feet_cannot, 8)
    runs = [Companion(open_scene("lean"), seed).run() for seed in seeds]
    good = [run for run in runs if run["completed"]]
    check_rate((run["completed"] for run in runs), least=0.9)
    assert all(run["beyond_mm"] > 10.0 for run in good)
    check_rate((min(run["forearm_N"]) > 50.0 for run in good), least=0.9)
    blind = [Companion(open_scene("lean", ["skin=false"]), seed).run() for seed in seeds]
    assert not any(run["completed"] for run in blind)
    check_rate((run["fell"] for run in blind), least=0.8)
