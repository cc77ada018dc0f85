"""The kernel of encoders and IMU against numpy, in both forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.kernels import python_form
from plantar.kernels.contacts.foot_contacts import ContactsInSole, FootContacts
from plantar.kernels.sensors import noise_rows
from plantar.sim.sensing.sole_pressure import SolePressure

FORMS = (noise_rows, python_form("noise_rows"))


@pytest.mark.parametrize("errs", [False, True])
@pytest.mark.parametrize("form", FORMS, ids=["compiled", "python"])
def test_they_read_what_is_there_with_noise_and_errors(form, errs):
    rng = np.random.default_rng(2)
    positions, rate, force = np.zeros(9), np.zeros(3), np.zeros(3)
    places, noise = np.array([7, 2, 3, 8]), rng.normal(size=(5, 10))
    offsets, bias = (rng.normal(size=4), rng.normal(size=3)) if errs else (np.empty(0), np.empty(0))
    body = form.SensedBody(positions, places, rate, force, form.NoiseRows(lambda: noise), offsets, bias)
    kept = []
    for k in range(12):
        positions[:], rate[:], force[:] = rng.normal(size=9), rng.normal(size=3), rng.normal(size=3)
        row = noise[k % 5]
        wanted = positions[places] + row[:4], rate + row[4:7], force + row[7:]
        if errs:
            wanted = wanted[0] + offsets, wanted[1] + bias, wanted[2]
        kept.append((body.read(), wanted))
    for told, wanted in kept:  # what was read once stays
        assert all(np.array_equal(a, b) for a, b in zip(told, wanted, strict=True))


LAYOUT = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])


@given(st.integers(0, 2**32 - 1))
def test_it_is_what_numpy_makes_of_them(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 60))
    force, noise = 30.0 * rng.random((3, n)), rng.normal(size=(3, n))
    force[rng.random((3, n)) < 0.1] = np.nan
    dead = np.flatnonzero(rng.random(n) < 0.2)
    wanted = np.minimum(np.maximum(force + noise, 2.0), 20.0)
    wanted[:, dead] = np.nan
    for form in FORMS:
        sample = form.TaxelSample(form.NoiseRows(lambda: noise), n, 2.0, 20.0, dead)
        read = [sample.of(row) for row in force]
        assert np.array_equal(read, wanted, equal_nan=True)


@pytest.mark.parametrize("seed", range(3))
def test_contacts_are_sampled_as_the_forces_that_they_press_with(seed):
    rng = np.random.default_rng(seed)
    positions = np.column_stack([rng.uniform([-0.1, -0.05], [0.1, 0.05], (4, 2)), np.zeros(4)])
    vectors = np.zeros((12, 3))
    vectors[::3], vectors[1::3, 2] = positions, rng.uniform(10.0, 90.0, 4)
    ids, gaps, carries = np.zeros((4, 2), dtype=np.int32), np.zeros(4), np.ones(4, dtype=np.uint8)
    foot, seen = FootContacts(np.zeros(1, dtype=np.uint8)), ContactsInSole()
    springs = SolePressure(LAYOUT).springs
    rows = rng.normal(size=(2, len(LAYOUT)))
    one, other = (
        noise_rows.TaxelSample(noise_rows.NoiseRows(lambda: rows), len(LAYOUT), 0.0, 785.0, np.array([1, 2]))
        for _ in range(2)
    )
    for count in (4, 0):
        foot.take(ids[:count], vectors[: 3 * count], gaps[:count], carries[:count])
        read = one.of_contacts(springs, foot, seen, 5e-4)
        assert np.array_equal(read, other.of(np.array(springs.forces)), equal_nan=True)
        assert (np.nansum(springs.forces) > 1.0) == (count > 0)


@pytest.mark.parametrize("rows", FORMS, ids=["compiled", "python"])
def test_noise_is_drawn_again_when_all_of_it_was_handed_out(rows):
    drawn = [np.arange(6.0).reshape(2, 3), np.arange(6.0, 9.0).reshape(1, 3), np.zeros((2, 3))]
    left = iter(drawn)
    noise = rows.NoiseRows(lambda: next(left))
    assert [next(noise).tolist() for _ in range(2)] == drawn[0].tolist()
    assert noise.advance() == 0
    assert np.asarray(noise.rows)[0].tolist() == [6.0, 7.0, 8.0]
    assert next(iter(noise)).tolist() == [0.0, 0.0, 0.0]
    assert noise.advance() == 1


@pytest.mark.parametrize("form", FORMS, ids=["compiled", "python"])
def test_samples_are_due_at_multiples_of_their_period(form):
    clock = form.SampleClock(0.004, 1e-9)
    clock.begin(0.5)
    due = [k for k in range(20) if clock.due(0.5 + 0.001 * k)]
    assert due == [0, 4, 8, 12, 16]
    assert clock.due(0.5 + 0.027)  # late: the next ones do not pile up
    assert not clock.due(0.5 + 0.0275)
    assert clock.due(0.5 + 0.028)
