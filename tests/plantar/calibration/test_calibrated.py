"""Calibration of soles whose faults an independent simulation drew: gains, intervals, and what was not observed."""

import numpy as np
import pytest
from faulty_soles import RATE, Faults, correlated, rolled

from plantar import InputError, grid_layout, hex_layout
from plantar.calibration import Take, calibrate

OUTLINE = [[-0.07, -0.045], [0.09, -0.045], [0.09, 0.045], [-0.07, 0.045]]
SOLE = hex_layout(OUTLINE, cell_area=691e-6, clip=False)
N = len(SOLE)


def pressed(seed: int, seconds: float = 30.0) -> tuple[Faults, Take, Take]:
    rng = np.random.default_rng(seed)
    faults = Faults.drawn(rng, SOLE)
    air = Take("zero", np.arange(50) / RATE, {"left": faults.counts(np.zeros((50, N)), rng)})
    time, force = rolled(rng, SOLE, seconds)
    load = force.sum(axis=1) * (1.0 + 0.003 * correlated(rng, len(time), 0.2)[:, 0])
    return faults, air, Take("press", time, {"left": faults.counts(force, rng)}, load)


def test_gains_of_a_sole_that_was_pressed_on_a_scale_are_within_three_percent():
    faults, air, press = pressed(3)
    found = calibrate([air, press], SOLE, date="2026-03-01")
    known = found.calibrations["left"]
    error = known.gain / faults.newtons_per_count(known.reference) - 1.0
    assert np.ptp(faults.gain) > 0.5
    assert np.median(np.abs(error)) < 0.03
    assert np.abs(error).max() < 0.06
    assert np.mean(np.abs(error) < 1.96 * known.gain_error) > 0.7
    assert known.offset == pytest.approx(4095.0 * faults.offset, abs=2.0)
    assert found.layout.calibrations["left"] is known
    assert "scale" not in known.method
    assert known.method == "1 s without load, 30 s pressed by known forces"
    assert any("crosstalk" in line for line in found.unobserved)  # a scale shows no center of pressure


def test_a_steady_load_shows_no_gain_and_is_said_to():
    """A body that stands still: one number for all gains, which stay the batch's mean with the batch's spread."""
    rng = np.random.default_rng(0)
    faults = Faults.drawn(rng, SOLE)
    air = Take("zero", np.arange(50) / RATE, {"left": faults.counts(np.zeros((50, N)), rng)})
    force = np.tile(400.0 / N, (1000, N))
    still = Take("motion", np.arange(1000) / RATE, {"left": faults.counts(force, rng)}, 400.0)
    found = calibrate([air, still], SOLE)
    known = found.calibrations["left"]
    error = known.gain / faults.newtons_per_count(known.reference) - 1.0
    assert np.mean(np.abs(error) < 1.96 * known.gain_error) > 0.85
    assert np.median(known.gain_error) > 0.15
    assert any(f"gains of {N} taxels of the left sole" in line for line in found.unobserved)
    assert any("hysteresis" in line for line in found.unobserved)
    counts = faults.counts(force, rng)
    assert known.forces(counts, SOLE, RATE).sum(axis=1).mean() == pytest.approx(400.0, rel=0.02)


def test_a_zero_of_soles_that_carry_is_refused():
    """It would become the offset: all loads were too small by it, without a word."""
    _, _, press = pressed(4, 8.0)
    carrying = Take("zero", press.time, press.counts)
    with pytest.raises(InputError, match=r"take: without load the left sole gives more than in take .* in the air"):
        calibrate([carrying, press], SOLE)


@pytest.mark.parametrize("drift", [-0.1, 0.1])
def test_a_zero_that_drifted_as_far_as_cells_do_is_taken(drift):
    _, air, press = pressed(4, 8.0)
    span = np.ptp(press.counts["left"].sum(axis=1)) / N
    moved = Take("zero", air.time, {"left": air.counts["left"] + drift * span})
    assert calibrate([moved, press], SOLE).calibrations["left"].offset.shape == (N,)


def test_takes_that_do_not_fit_are_refused_in_a_line():
    _, air, press = pressed(1, 4.0)
    with pytest.raises(InputError, match="no take holds a load"):
        calibrate([air], SOLE)
    with pytest.raises(InputError, match="nothing shows the left sole without load"):
        calibrate([press], SOLE)
    with pytest.raises(InputError, match=rf"{N} counts of the left sole; allowed: 6"):
        calibrate([air, press], grid_layout([[0, 0], [0.12, 0], [0.12, 0.08], [0, 0.08]], pitch=(0.04, 0.04)))
    dead = Take("press", press.time, {"left": np.tile(4095.0 * 0.01, (len(press.time), N))}, press.load)
    with pytest.raises(InputError, match="counts"):
        calibrate([Take("zero", air.time, {"left": np.full((50, N), 4095.0 * 0.01)}), dead], SOLE)


@pytest.mark.long
def test_standing_and_stepping_finds_the_cop_and_honest_intervals():
    """By joints on two soles of 42 taxels: CoP within 1 mm on another motion, though gains stay at 10 %."""
    from calibration import EACH, LAYOUTS, SIDES, scene, scores, takes

    assert EACH > 3
    calibrated, held_out = scene(1), scene(2)
    inside = []
    for seed in range(4):
        rng = np.random.default_rng(500 + seed)
        faults = {side: Faults.drawn(rng, LAYOUTS[side]) for side in SIDES}
        known = dict(calibrate(takes("robot", calibrated, faults, rng), LAYOUTS["left"]).calibrations)
        found = scores(known, held_out, faults, rng)
        assert np.sqrt(np.mean(found["cop"] ** 2)) < 1.2
        inside.append(np.abs(found["z"]) < 1.96)
    assert np.mean(inside) > 0.85
