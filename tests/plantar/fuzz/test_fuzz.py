"""Odd readings for every function of the perception: none raises, gives NaN unasked, or leaves its bound.

A block of readings is drawn by hypothesis: a sole (lattices, clipped, mixed, curved and clockwise cells), and forces,
distances, temperatures and accelerations with faults (`soles.py`). A warning of numpy is a failure.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.geometry import polygon

from .fields import FIELD_CHECKS
from .force import FORCE_CHECKS, LAST_CHECKS
from .random_cells import RANDOM_CHECKS
from .rings import Rings
from .shapes import SHAPE_CHECKS
from .soles import block_of, stress_soles
from .tally import Tally

SOLES = stress_soles()
CHECKS = (*FORCE_CHECKS, *SHAPE_CHECKS, *FIELD_CHECKS)

blocks = st.builds(
    block_of, st.sampled_from(SOLES), st.integers(16, 60), st.integers(0, 2**32 - 1), st.integers(0, 2**12)
)
"""Blocks of 16 to 60 readings: every kind of check finds some that it looks at."""


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__.strip("_"))
@given(block=blocks)
@settings(max_examples=12, deadline=None)
def test_odd_readings(check, block):
    check(block, Tally())
    for last in LAST_CHECKS:
        last(block, Tally())


@pytest.mark.long
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__.strip("_"))
@given(block=blocks)
@settings(max_examples=300, deadline=None)
def test_many_odd_readings(check, block):
    check(block, Tally())


@pytest.mark.parametrize("check", RANDOM_CHECKS, ids=lambda check: check.__name__.strip("_"))
@pytest.mark.parametrize("number", [0, 40])
def test_patterns_of_a_thousand_cells(check, number):
    check(block_of(SOLES[0], 16, number, number), Tally())


def test_every_function_is_met():
    """Of each function that `__all__` of the perception's rooms names, as of each member, some reading is seen."""
    tally = Tally()
    for k, sole in enumerate(SOLES[:3]):
        for check in (*CHECKS, *LAST_CHECKS):
            check(block_of(sole, 40, k, k), tally)
    assert len(tally.readings) > 100
    assert min(tally.readings.values()) > 0


def test_a_planted_fault_is_found(monkeypatch):
    right = polygon.signed_margin
    monkeypatch.setattr(polygon, "signed_margin", lambda ring, point: 1.001 * right(ring, point))
    block = block_of(SOLES[0], 60, 0, 0)
    with pytest.raises(AssertionError, match="signed_margin: sole '3 rows of 3'"):
        [check(block, Tally()) for check in SHAPE_CHECKS]


def test_the_same_seed_gives_the_same_readings():
    one, two, other = (block_of(SOLES[4], 50, seed, 0).force for seed in (3, 3, 4))
    assert np.array_equal(one, two, equal_nan=True)
    assert not np.array_equal(one, other, equal_nan=True)


def test_every_pattern_of_a_lattice_of_three_rows_comes():
    force = np.concatenate([block_of(SOLES[0], 512, k, 0).active for k in range(10)])
    assert len({tuple(row) for row in force.tolist()}) == 2**9


def test_rings_find_a_dent_of_one_unit_in_the_last_place():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    flat = np.insert(square, 1, [0.5, 0.0], axis=0)
    dented = np.insert(square, 1, [0.5, 5e-324], axis=0)
    bulged = np.insert(square, 1, [0.5, -5e-324], axis=0)
    assert Rings([square, flat, dented, bulged, square[::-1]]).not_convex().tolist() == [0.0, 1.0, 1.0, 0.0, 1.0]
