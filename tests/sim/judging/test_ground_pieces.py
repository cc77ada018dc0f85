"""Which pieces of ground lie under planned footprints."""

import numpy as np
import pytest

from plantar.sim.judging.ground_pieces import GroundPieces
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


def pieces_of(scene: str, *settings: str) -> tuple[Simulation, GroundPieces]:
    simulation = Simulation(load_scene(scene, [*settings, "settle=0.3"]), 2)
    assert simulation.judge.pieces is not None
    return simulation, simulation.judge.pieces


def test_all_stones_of_a_walk_lie_under_its_steps():
    simulation, pieces = pieces_of("stones", "steps=6")
    assert pieces.count == len(simulation.ground.solids) == 8
    assert set(pieces.under(simulation.planned, 0.2)) >= {2, 3, 4, 5, 6, 7}  # 0 and 1 are those of the start


def test_the_far_platform_of_a_beam_lies_under_no_step_of_a_short_walk():
    simulation, pieces = pieces_of("beam", "steps=8")
    assert pieces.under(simulation.planned, 0.2) == [0, 2]


def test_a_slab_that_slides_in_lies_where_it_ends():
    simulation, pieces = pieces_of("slide-in")
    assert pieces.under(simulation.planned, 0.2) == [0]


def test_nothing_is_followed_where_no_criterion_asks_for_it():
    assert Simulation(load_scene("flat")).judge.pieces is None


@pytest.mark.parametrize("share", [0.2, 0.9])
def test_a_block_counts_by_how_much_of_a_sole_it_covers(share):
    simulation, pieces = pieces_of("obstacle", "terrain.width=0.05", "terrain.step=2")
    soles = simulation.planned.steps[2].half
    covered = 0.05 / (2.0 * soles[1])
    assert (pieces.under(simulation.planned, share) == [0]) == (covered > share)
    assert np.isclose(pieces.longest(0), 0.0)
