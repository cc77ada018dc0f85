import math

import numpy as np
import pytest

from plantar.gait.contact.edge_memory import EdgeMemory
from plantar.mechanics.rotation import level_rotation

LEVEL = level_rotation(0.0)
BEAM = 0.1  # rad, heading of the beam in these tests


def lines_under(place: np.ndarray, yaw: float, turn: float = 0.0) -> np.ndarray:
    """Edges of a beam 60 mm wide along x, turned by `BEAM`, in the frame of a sole; `turn` makes their directions
    wrong about the points next to the sole's middle."""
    normal = np.array([-math.sin(BEAM), math.cos(BEAM)])
    back = level_rotation(yaw)[:2, :2].T
    lines = []
    for n in (normal, -normal):
        point = place[:2] + (0.03 - float(n @ place[:2])) * n
        c, s = math.cos(turn), math.sin(turn)
        seen = back @ np.array([c * n[0] - s * n[1], s * n[0] + c * n[1]])
        lines.append((*seen, float(seen @ (back @ (point - place[:2])))))
    return np.array(lines)


def walked(memory: EdgeMemory, steps: int, rng: np.random.Generator, turn: float) -> None:
    """Take in footholds 0.1 m from each other, with directions that are off at random."""
    for step in range(steps):
        place = np.array([0.1 * step, 0.02 * (-1.0) ** step, 0.0])
        memory.update(step, lines_under(place, 0.0, turn * rng.normal()), np.zeros(2), place, LEVEL)


def test_an_edge_goes_on_under_the_next_sole_however_that_is_turned():
    memory = EdgeMemory()
    walked(memory, 1, np.random.default_rng(0), 0.0)
    place, yaw = np.array([0.2, 0.03, 0.01]), 0.4
    assert memory.expected(1, place, level_rotation(yaw)) == pytest.approx(lines_under(place, yaw), abs=1e-9)


def test_points_of_several_footholds_tell_the_direction():
    errors: dict[int, list[float]] = {1: [], 5: []}
    for seed in range(40):
        for steps, found in errors.items():
            memory = EdgeMemory()
            walked(memory, steps, np.random.default_rng(seed), 0.05)
            place = np.array([0.1 * steps + 0.1, 0.0, 0.0])
            lines, true = memory.expected(steps, place, LEVEL), lines_under(place, 0.0)
            found.append(float(np.abs(lines[:, 2] - true[:, 2]).max()))
    one, five = (float(np.mean(errors[k])) for k in (1, 5))
    assert five < 0.4 * one
    assert five < 0.003


def test_an_edge_across_another_one_is_not_the_same():
    memory = EdgeMemory()
    memory.update(0, np.array([[1.0, 0.0, 0.02]]), np.zeros(2), np.zeros(3), LEVEL)
    along = np.array([[0.0, 1.0, 0.02]])
    memory.update(1, along, np.zeros(2), np.array([0.1, 0.0, 0.0]), LEVEL)
    assert memory.expected(2, np.array([0.2, 0.0, 0.0]), LEVEL) == pytest.approx(along)


@pytest.mark.parametrize("expected_step", [0, 2, 3])
def test_only_the_foothold_before_tells(expected_step):
    memory = EdgeMemory()
    assert memory.expected(0, np.zeros(3), LEVEL).shape == (0, 3)
    memory.update(0, np.array([[1.0, 0.0, 0.02]]), np.zeros(2), np.zeros(3), LEVEL)
    assert memory.expected(expected_step, np.zeros(3), LEVEL).shape == (0, 3)


def test_whole_ground_is_no_edge_and_a_foothold_found_again_replaces_itself():
    memory = EdgeMemory()
    for lines in (np.array([[1.0, 0.0, 0.02]]), np.array([[1.0, 0.0, 0.03]])):
        memory.update(0, lines, np.zeros(2), np.zeros(3), LEVEL)
    assert memory.expected(1, np.zeros(3), LEVEL) == pytest.approx(np.array([[1.0, 0.0, 0.03]]))
    memory.update(1, np.empty((0, 3)), np.zeros(2), np.zeros(3), LEVEL)
    assert memory.expected(2, np.zeros(3), LEVEL).shape == (0, 3)
