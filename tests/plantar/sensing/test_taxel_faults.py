"""Faults of taxels: each does what its name states, many soles are as single ones, and a recording gives them back."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, ReadingError, hex_layout
from plantar.sensing.identify_faults import identify_faults
from plantar.sensing.taxel_faults import CREEPING, WARMING, TaxelFaults

from ...examples import examples

SOLE = hex_layout([[-0.1, -0.05], [0.12, -0.05], [0.12, 0.05], [-0.1, 0.05]])
N = len(SOLE)
ALL = TaxelFaults(0.1, 0.5, 0.3, 0.1, 0.15, 0.1, 0.2, 0.05, 0.02, 0.013)


def recording(faults, seed=0, frames=400, period=0.004):
    """Loads that come on and go off, each taxel's at its own pace, and what is read of them."""
    rng = np.random.default_rng(seed)
    time = period * np.arange(frames)
    rate, phase = rng.uniform(2.0, 9.0, N), rng.uniform(0.0, 6.0, N)
    force = 15.0 * (1.0 + np.sin(np.outer(time, rate) + phase))
    worn = faults.worn(SOLE, seed)
    return time, force, np.array([worn.read(t, f) for t, f in zip(time, force, strict=True)]), worn


def test_without_faults_taxels_read_what_is_on_them():
    time, force, read, _ = recording(TaxelFaults())
    assert np.array_equal(force, read)
    assert len(time) == len(read)


@examples(10)
@given(st.integers(0, 2**31), st.integers(1, 4))
def test_the_same_seed_gives_the_same_and_many_soles_keep_their_own_state(seed, batch):
    rng = np.random.default_rng(seed)
    forces, vectors = rng.uniform(0.0, 20.0, (12, batch, N)), rng.normal(0.0, 5.0, (12, batch, N, 3))
    a, b = ALL.worn(SOLE, seed, (batch,)), ALL.worn(SOLE, seed, (batch,))
    quiet = TaxelFaults(hysteresis=0.2, crosstalk=0.1, shear=0.3, resolution=0.01, delay=0.02)
    many, singles = quiet.worn(SOLE, seed, (batch,)), [quiet.worn(SOLE, seed) for _ in range(batch)]
    for k, (force, vector) in enumerate(zip(forces, vectors, strict=True)):
        assert np.array_equal(a.read(0.01 * k, force, vector), b.read(0.01 * k, force, vector), equal_nan=True)
        rows = [s.read(0.01 * k, f, v) for s, f, v in zip(singles, force, vector, strict=True)]
        assert np.allclose(many.read(0.01 * k, force, vector), rows, rtol=0, atol=1e-9)
    again = ALL.worn(SOLE, seed + 1, (batch,)).read(0.0, forces[0], vectors[0])
    assert not np.array_equal(again, a.read(1.0, forces[0], vectors[0]), equal_nan=True)


def test_each_fault_does_what_its_name_states():
    press = np.full(N, 10.0)

    def read(time=0.0, vectors=None, force=press, **given):
        return TaxelFaults(**given).worn(SOLE, 3).read(time, force, vectors)

    assert read(gain=0.1).std() == pytest.approx(1.0, rel=0.3)
    assert (read(offset=0.5, force=np.zeros(N))).std() == pytest.approx(0.5, rel=0.3)
    assert np.array_equal(read(drift=0.5), press)
    assert (read(time=WARMING, drift=0.5) - press).std() == pytest.approx(0.5 * (1 - np.exp(-1)), rel=0.3)
    one = np.zeros(N)
    one[N // 2] = 10.0
    spread = read(crosstalk=0.2, force=one)
    assert spread.sum() == pytest.approx(10.0)
    assert spread[N // 2] == pytest.approx(8.0)
    assert set(np.flatnonzero(spread)) == {N // 2, *SOLE.neighbours[N // 2]}
    assert np.isnan(read(dead=0.25)).sum() == round(0.25 * N)
    side = np.tile([3.0, 4.0, 10.0], (N, 1))
    assert np.allclose(read(shear=0.1, vectors=side), 10.5)
    worn = TaxelFaults(delay=0.015).worn(SOLE)
    values = [worn.read(0.01 * k, np.full(N, float(k)))[0] for k in range(6)]
    assert values == pytest.approx([0.0, 0.0, 0.5, 1.5, 2.5, 3.5])
    worn.reset()
    assert worn.read(0.0, press)[0] == 10.0


def test_quantised_readings_are_multiples_of_the_step():
    read = TaxelFaults(resolution=0.3).worn(SOLE).read(0.0, np.linspace(0.0, 9.0, N))
    assert np.allclose(read / 0.3, np.round(read / 0.3), atol=1e-9)
    assert np.abs(read - np.linspace(0.0, 9.0, N)).max() <= 0.15 + 1e-12


@pytest.mark.parametrize("name", [f.name for f in fields(TaxelFaults)])
@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf, "much"])
def test_a_fault_is_finite_and_not_below_zero(name, value):
    with pytest.raises(InputError, match=f"taxel fault '{name}'"):
        TaxelFaults(**{name: value})


def test_wrong_forces_are_refused():
    worn = TaxelFaults(shear=0.1).worn(SOLE)
    with pytest.raises(ReadingError, match="vectors"):
        worn.read(0.0, np.zeros(N))


def test_a_recording_gives_the_faults_back():
    faults = TaxelFaults(0.15, 0.5, 0.0, 0.08, 0.12, 0.1, 0.0, 0.03, 0.0, 0.02)
    time, force, read, worn = recording(faults)
    found = identify_faults(SOLE, time, force, read)
    alive = ~worn.dead
    assert np.array_equal(found.worn.dead, worn.dead)
    assert np.abs(found.worn.gains - worn.gains)[alive].max() < 0.01
    assert np.abs(found.worn.offsets - worn.offsets)[alive].max() < 0.1
    for name in ("crosstalk", "hysteresis", "delay"):
        assert getattr(found.faults, name) == pytest.approx(getattr(faults, name), abs=0.005), name
    assert found.faults.noise == pytest.approx(0.03, rel=0.2)
    again = np.array([found.worn.read(t, f) for t, f in zip(time, force, strict=True)])
    assert np.abs(again - read)[5:, alive].max() < 0.25


def test_resolution_is_found_and_none_where_there_is_none():
    for resolution in (0.0, 0.1):
        time, force, read, _ = recording(TaxelFaults(gain=0.1, resolution=resolution), frames=60)
        assert identify_faults(SOLE, time, force, read).faults.resolution == pytest.approx(resolution, abs=1e-6)


def test_frames_that_were_lost_kill_no_taxel():
    time, force, read, worn = recording(TaxelFaults(gain=0.1, dead=0.1), frames=60)
    read[20], read[30, 0] = np.nan, np.inf
    found = identify_faults(SOLE, time, force, read)
    assert np.array_equal(found.worn.dead, worn.dead)
    assert np.abs(found.worn.gains - worn.gains)[~worn.dead].max() < 0.01
    read[:18, 1] = np.nan
    read[22:40, 2] = np.nan
    with pytest.raises(ReadingError, match="allowed: 20 or more"):
        identify_faults(SOLE, time[:40], force[:40], read[:40])


def test_recordings_that_identify_nothing_are_refused():
    time, force, read, _ = recording(TaxelFaults(), frames=30)
    with pytest.raises(ReadingError, match="20 frames"):
        identify_faults(SOLE, time[:10], force[:10], read[:10])
    with pytest.raises(ReadingError, match="no taxel's load changes"):
        identify_faults(SOLE, time, np.ones_like(force), read)
    with pytest.raises(ReadingError, match="dead"):
        identify_faults(SOLE, time, force, np.full_like(read, np.nan))
    with pytest.raises(ReadingError, match="shape"):
        identify_faults(SOLE, time, force, read[:, :-1])


def test_a_curve_takes_gain_as_the_load_rises():
    read = TaxelFaults(curve=0.02).worn(SOLE).read(0.0, np.linspace(0.0, 50.0, N))
    assert np.allclose(read, np.linspace(0.0, 50.0, N) / (1.0 + 0.02 * np.linspace(0.0, 50.0, N)))


def test_a_reading_creeps_under_a_load_that_stays_and_back_after_it():
    worn = TaxelFaults(creep=0.2).worn(SOLE)
    press = np.full(N, 10.0)
    times = np.arange(0.0, 3.0 * CREEPING, 0.05)
    read = np.array([worn.read(t, press)[0] for t in times])
    assert np.allclose(read, 10.0 * (1.2 - 0.2 * np.exp(-times / CREEPING)), atol=1e-9)
    after = worn.read(times[-1], np.zeros(N))[0]
    assert after == pytest.approx(read[-1] - 10.0)
    worn.reset()
    assert worn.read(0.0, press)[0] == 10.0


def test_small_forces_read_nothing_and_large_ones_the_same():
    read = TaxelFaults(dead_band=1.0, saturation=20.0).worn(SOLE).read(0.0, np.linspace(0.0, 40.0, N))
    truth = np.linspace(0.0, 40.0, N)
    assert not read[truth < 1.0].any()
    assert (read[truth > 20.0] == 20.0).all()
    between = (truth >= 1.0) & (truth <= 20.0)
    assert np.array_equal(read[between], truth[between])


def test_gains_change_as_the_skin_warms():
    worn = TaxelFaults(temperature=0.1).worn(SOLE, 2)
    press = np.full(N, 10.0)
    assert np.array_equal(worn.read(0.0, press), press)
    warm = worn.read(20.0 * WARMING, press)
    assert warm.std() == pytest.approx(1.0, rel=0.3)
    assert np.allclose(worn.read(20.0 * WARMING, 2.0 * press), 2.0 * warm)


def test_lost_rows_lie_across_the_sole():
    lost = np.isnan(TaxelFaults(rows=0.25).worn(SOLE, 5).read(0.0, np.full(N, 3.0)))
    assert lost.any()
    x = np.round(SOLE.positions[:, 0], 6)
    for place in np.unique(x):
        assert lost[x == place].all() or not lost[x == place].any()
    rows = len(np.unique(x))
    assert len(np.unique(x[lost])) == round(0.25 * rows)


def test_new_faults_leave_the_draws_of_the_others():
    old = TaxelFaults(gain=0.1, offset=0.5).worn(SOLE, 9, (3,))
    new = TaxelFaults(gain=0.1, offset=0.5, temperature=0.1, rows=0.1, creep=0.1).worn(SOLE, 9, (3,))
    assert np.array_equal(old.gains, new.gains)
    assert np.array_equal(old.offsets, new.offsets)
