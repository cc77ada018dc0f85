"""Errors of a run beside its reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.sim.bench.scenes.changed_run import SAMPLE, Trace
from plantar.sim.bench.scenes.trace_error import PARTED, trace_error

RNG = np.random.default_rng(0)
REFERENCE = Trace(
    com=RNG.normal(size=(200, 3)),
    zmp=RNG.normal(size=(200, 2)),
    force=RNG.uniform(0.0, 800.0, (200, 2)),
    landings=(("left", 0.5, 200.0), ("right", 1.5, 400.0)),
    leg=0.6,
    weight=800.0,
)


def test_a_run_is_its_own_reference() -> None:
    error = trace_error(REFERENCE, REFERENCE)
    assert error[:4] == (0.0, 0.0, 0.0, 0.0)
    assert error.together_s == error.whole_s == pytest.approx(2.0)


@pytest.mark.parametrize("size", [1e-9, 1e-4, 0.9 * PARTED * 0.6])
def test_a_constant_offset_is_the_error(size: float) -> None:
    shifted = replace(
        REFERENCE,
        com=REFERENCE.com + np.array([size, 0.0, 0.0]),
        zmp=REFERENCE.zmp + np.array([0.0, 2.0 * size]),
        force=REFERENCE.force + 8.0,
        landings=(("left", 0.51, 220.0), ("right", 1.5, 360.0)),
    )
    error = trace_error(shifted, REFERENCE)
    assert error.com_m == pytest.approx(size)
    assert error.zmp_m == pytest.approx(2.0 * size)
    assert error.force == pytest.approx(0.01)
    assert error.impact == pytest.approx(0.1)
    assert error.together_s == pytest.approx(2.0)


@pytest.mark.parametrize("at", [1, 60, 199])
def test_what_comes_after_runs_part_does_not_count(at: int) -> None:
    com, force = REFERENCE.com.copy(), REFERENCE.force.copy()
    com[at:, 1] += 1.01 * PARTED * 0.6
    force[at:] += 1e6
    error = trace_error(replace(REFERENCE, com=com, force=force), REFERENCE)
    assert error.together_s == pytest.approx(at * SAMPLE)
    assert error.com_m == error.force == 0.0
    assert np.isnan(error.impact) == (at < 50)


def test_landings_of_another_foot_or_time_are_not_compared() -> None:
    other = replace(REFERENCE, landings=(("left", 0.5, 300.0), ("left", 1.5, 0.0)))
    assert trace_error(other, REFERENCE).impact == pytest.approx(0.5)
    late = replace(REFERENCE, landings=(("left", 0.6, 300.0),))
    assert np.isnan(trace_error(late, REFERENCE).impact)


def test_a_shorter_run_is_compared_as_far_as_it_goes_and_nothing_carried_is_no_error() -> None:
    zmp = REFERENCE.zmp[:50].copy()
    zmp[10:20] = np.nan
    cut = replace(REFERENCE, com=REFERENCE.com[:50], zmp=zmp, force=REFERENCE.force[:50])
    error = trace_error(cut, REFERENCE)
    assert (error.zmp_m, error.together_s, error.whole_s) == (0.0, pytest.approx(0.5), pytest.approx(2.0))
