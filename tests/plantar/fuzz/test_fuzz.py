"""Odd readings for every function of the perception: none raises, gives NaN unasked, or leaves its bound.

A block of readings is drawn by hypothesis: a sole (lattices, clipped, mixed, curved and clockwise cells), and forces,
distances, temperatures and accelerations with faults (`soles.py`). A warning of numpy is a failure.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.geometry import polygon

from ...examples import examples
from .members import MEMBER_CHECKS
from .shapes import SHAPE_CHECKS
from .soles import block_of, stress_soles

SOLES = stress_soles()
CHECKS = (*MEMBER_CHECKS, *SHAPE_CHECKS)

blocks = st.builds(
    block_of, st.sampled_from(SOLES), st.integers(16, 60), st.integers(0, 2**32 - 1), st.integers(0, 2**12)
)
"""Blocks of 16 to 60 readings: every kind of check finds some that it looks at."""


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__.strip("_"))
@given(block=blocks)
@examples(5)
def test_odd_readings(check, block):
    check(block)


@pytest.mark.long
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__.strip("_"))
@given(block=blocks)
@examples(300)
def test_many_odd_readings(check, block):
    check(block)


def test_a_planted_fault_is_found(monkeypatch):
    right = polygon.area
    monkeypatch.setattr(polygon, "area", lambda ring: 1.001 * right(ring))
    with pytest.raises(AssertionError):
        [check(block_of(SOLES[0], 60, 0, 0)) for check in SHAPE_CHECKS]


def test_the_same_seed_gives_the_same_readings():
    one, two, other = (block_of(SOLES[4], 50, seed, 0).force for seed in (3, 3, 4))
    assert np.array_equal(one, two, equal_nan=True)
    assert not np.array_equal(one, other, equal_nan=True)


def test_every_pattern_of_a_lattice_of_three_rows_comes():
    force = np.concatenate([block_of(SOLES[0], 512, k, 0).active for k in range(10)])
    assert len({tuple(row) for row in force.tolist()}) == 2**9
