"""Contacts of a sole on bumps: remembered while the load wanders, forgotten once the sole has turned away."""

import numpy as np
import pytest

from plantar.gait.contact.contact_memory import ContactMemory
from plantar.geometry.polygon import area
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout
from plantar.mechanics.rotation import rotation_from_vector
from plantar.sensing.reading import Reading

BUMPS = ((-0.07, 0.04), (0.08, 0.05), (0.02, -0.06))


@pytest.fixture(scope="module")
def sole():
    return hex_layout([[-0.11, -0.08], [0.11, -0.08], [0.11, 0.08], [-0.11, 0.08]])


def stand(memory: ContactMemory, sole: SoleLayout, loads: tuple[float, ...], start: float, turn: float = 0.0) -> None:
    """Forty milliseconds on the bumps with given loads, the left edge `turn` rad higher."""
    force = np.zeros(len(sole))
    for (x, y), load in zip(BUMPS, loads, strict=True):
        force[int(np.argmin(np.hypot(sole.positions[:, 0] - x, sole.positions[:, 1] - y)))] += load
    cop = force @ sole.positions[:, :2] / force.sum()
    rotation = rotation_from_vector(np.array([turn, 0.0, 0.0]))
    for k in range(10):
        memory.update(Reading(start + 0.004 * k, force), rotation, cop)


def test_a_bump_without_load_is_still_there(sole):
    memory = ContactMemory(sole, least_force=8.0, gap=0.002)
    stand(memory, sole, (250.0, 250.0, 250.0), 0.0)
    before = memory.polygon
    assert area(before) == pytest.approx(0.0076, abs=0.002)
    stand(memory, sole, (800.0, 0.0, 0.0), 0.1)
    assert memory.polygon == pytest.approx(before)


def test_a_bump_that_the_sole_turned_away_from_is_forgotten(sole):
    memory = ContactMemory(sole, least_force=8.0, gap=0.002)
    stand(memory, sole, (250.0, 250.0, 250.0), 0.0)
    stand(memory, sole, (0.0, 0.0, 800.0), 0.1)
    assert len(memory.polygon) >= 3
    stand(memory, sole, (0.0, 0.0, 800.0), 0.2, turn=0.05)  # the left edge rises by 5 mm
    assert len(memory.polygon) == 0
    assert not memory.encloses(np.zeros(2))


def test_what_lies_between_the_contacts_is_enclosed(sole):
    memory = ContactMemory(sole, least_force=8.0, gap=0.002)
    assert not memory.encloses(np.zeros(2))
    stand(memory, sole, (250.0, 250.0, 250.0), 0.0)
    assert memory.encloses(np.array([0.01, 0.01]))
    assert not memory.encloses(np.array([-0.1, -0.07]))


def test_a_line_of_bumps_is_no_place_to_stand(sole):
    memory = ContactMemory(sole, least_force=8.0, gap=0.002)
    stand(memory, sole, (250.0, 250.0, 0.0), 0.0)
    assert not memory.encloses(np.array([0.0, 0.02]))
    memory.lift()
    assert len(memory.polygon) == 0


@pytest.mark.parametrize("cell", [4e-5, 2e-4, 1e-3])
def test_a_sole_of_any_density_that_is_evenly_loaded_encloses_its_middle(cell):
    sole = hex_layout([[-0.11, -0.08], [0.11, -0.08], [0.11, 0.08], [-0.11, 0.08]], cell_area=cell)
    memory = ContactMemory(sole, least_force=300.0 / len(sole), gap=0.002)
    force = np.full(len(sole), 800.0 / len(sole))
    for k in range(10):
        memory.update(Reading(0.004 * k, force), np.eye(3), np.zeros(2))
    assert memory.encloses(np.array([0.05, 0.02]))
