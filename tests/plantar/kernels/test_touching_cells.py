"""The kernel of a sole's touching cells against the formulas in numpy, in both forms."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import Reading
from plantar.kernels import python_form
from plantar.kernels.gait import touching_cells

LEAST, SHARE, SMOOTHING, GAP = 4.0, 0.01, 0.3, 0.0005


@pytest.mark.parametrize("seed", range(12))
def test_both_forms_are_the_formulas(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 40))
    places = rng.uniform(-0.1, 0.1, (n, 2))
    masks = [np.zeros(n, dtype=bool) for _ in range(2)]
    cells = [
        module.TouchingCells(places, mask.view(np.uint8), LEAST, SHARE, SMOOTHING, GAP)
        for module, mask in zip((touching_cells, python_form("touching_cells")), masks, strict=True)
    ]
    mean, touches, slope = np.zeros(n), np.zeros(n, dtype=bool), np.zeros((n, 2))
    for k in range(40):
        if k == 25:  # the foot was in the air
            mean[:], touches[:], slope[:] = 0.0, False, 0.0
            for cell in cells:
                cell.lift()
        force, cop = rng.uniform(-1.0, 15.0, n), rng.uniform(-0.1, 0.1, 2)
        force[rng.random(n) < 0.1] = rng.choice([np.nan, np.inf])
        turn = Rotation.from_rotvec(0.01 * rng.normal(size=3)).as_matrix()
        mean += SMOOTHING * (np.where(np.isfinite(force), force, 0.0) - mean)
        carries, before = mean > max(LEAST, SHARE * mean.sum()), touches.copy()
        touches |= carries
        slope[carries] = turn[2, :2]
        carried, before = (touches != before).any(), touches.copy()
        touches &= ((turn[2, :2] - slope) * (places - cop)).sum(axis=1) < GAP
        for cell, mask in zip(cells, masks, strict=True):
            assert cell.carry(force, turn) == carried
            assert cell.turn(turn, cop) == (touches != before).any()
            np.testing.assert_array_equal(mask, touches)


@pytest.mark.parametrize("module", [touching_cells, python_form("touching_cells")])
def test_a_reading_is_added_once_until_the_foot_is_lifted(module):
    mask = np.zeros(2, dtype=bool)
    cells = module.TouchingCells(np.array([[0.0, 0.0], [0.1, 0.0]]), mask.view(np.uint8), LEAST, SHARE, 0.5, GAP)
    level, cop = np.eye(3), np.zeros(2)
    reading = Reading(1.0, np.array([9.0, 0.0]))
    assert cells.follow(reading, level, cop)
    assert mask.tolist() == [True, False]
    assert not cells.follow(reading, level, cop)
    other = Reading(1.0, np.array([9.0, 90.0]))
    assert not cells.follow(other, level, cop)  # no later than the last one
    assert cells.time == 1.0
    cells.lift()
    assert cells.time == -np.inf
    assert cells.follow(other, level, cop)
    tilted = Rotation.from_rotvec([0.0, -0.1, 0.0]).as_matrix()
    assert cells.follow(other, tilted, cop)  # turned off the ground
    assert mask.tolist() == [True, False]


@pytest.mark.parametrize("module", [touching_cells, python_form("touching_cells")])
def test_a_point_between_contacts_and_along_a_sole(module):
    triangle = np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]])
    assert module.encloses(triangle, np.array([0.02, 0.03]))
    assert module.encloses(triangle, np.array([0.05, 0.0]))
    assert not module.encloses(triangle, np.array([0.06, 0.06]))
    assert not module.encloses(triangle[:2], np.array([0.05, 0.0]))
    rng = np.random.default_rng(1)
    turn, position, point = Rotation.random(random_state=2).as_matrix(), rng.normal(size=3), rng.normal(size=2)
    expected = turn[:2, :2].T @ (point - position[:2])
    np.testing.assert_allclose(module.along_sole(turn, position, point), expected, rtol=0, atol=1e-15)
