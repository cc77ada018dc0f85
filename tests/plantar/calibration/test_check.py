"""A calibration that holds, one whose zero or gain moved, and hours of drift told apart."""

import numpy as np
import pytest

from plantar import InputError, grid_layout
from plantar.calibration import Take, check_calibration, drift
from plantar.layouts.calibration import SoleCalibration

SOLE = grid_layout([[0, 0], [0.12, 0], [0.12, 0.08], [0, 0.08]], pitch=(0.04, 0.04))
N = len(SOLE)
WEIGHT = 600.0


def calibrated(error: float = 0.03):
    from dataclasses import replace

    known = SoleCalibration.linear(np.full(N, 0.1), np.full(N, 100.0), error)
    return replace(SOLE, calibrations={"left": known, "right": known})


def ten_seconds(gain: float = 1.0, zero: float = 0.0) -> Take:
    """Standing on both feet for 6 s, then 2 s on each."""
    rng = np.random.default_rng(0)
    time = np.arange(1000) / 100
    share = np.where(time < 6.0, 0.5, np.where(time < 8.0, 1.0, 0.0))
    counts = {}
    for side, part in (("left", share), ("right", 1.0 - share)):
        force = np.tile(WEIGHT / N * part[:, None], (1, N))
        counts[side] = 100.0 + gain * force / 0.1 + rng.normal(0.0, 0.5, force.shape)
    counts["left"][:, 2] += zero
    return Take("motion", time, counts, WEIGHT)


def test_a_calibration_that_holds_is_said_to():
    found = check_calibration(ten_seconds(), calibrated())
    assert found.holds, found.failures
    assert found.measured == pytest.approx(WEIGHT, rel=0.01)
    assert found.interval[0] < WEIGHT < found.interval[1]
    assert found.as_dict()["failures"] == []


def test_a_gain_that_changed_and_a_zero_that_moved_are_told_apart():
    changed = check_calibration(ten_seconds(gain=1.15), calibrated())
    assert [line for line in changed.failures if "gains changed" in line]
    assert not [line for line in changed.failures if "zero" in line]
    moved = check_calibration(ten_seconds(zero=40.0), calibrated())
    assert [line for line in moved.failures if "zero of taxel 2 of the left sole moved by 4.0" in line]
    assert not [line for line in moved.failures if "gains changed" in line]


def test_a_wide_calibration_allows_more():
    """The interval follows the gains' errors: 10 % each, independent, of 12 taxels add 2.9 % of the load."""
    narrow, wide = (check_calibration(ten_seconds(), calibrated(error)).interval for error in (0.001, 0.1))
    assert np.ptp(wide) > 1.5 * np.ptp(narrow)
    with pytest.raises(InputError, match="no calibration of the left sole"):
        check_calibration(ten_seconds(), SOLE)


def test_hours_of_drift_are_told_apart():
    """Zero that moves by 3 N an hour, a gain that rises by 2 % an hour, and creep of 1.5 % a decade of load."""
    time = np.arange(0.0, 3 * 3600.0, 5.0)
    loaded = (time % 1800.0) > 300.0
    since = np.where(loaded, time % 1800.0 - 300.0, 0.0) + 5.0
    load = 300.0 * (1.0 + 0.02 * time / 3600.0) * (1.0 + 0.015 * np.log10(since / 5.0)) * loaded
    total = load + 3.0 * time / 3600.0
    counts = 100.0 + np.tile(total[:, None] / N / 0.1, (1, N))
    found = drift(Take("motion", time, {"left": counts}, 300.0), calibrated())["left"]
    assert found.in_air == pytest.approx(3.0, rel=0.05)
    assert found.under_load == pytest.approx(2.0, rel=0.25)
    assert found.creep == pytest.approx(1.5, rel=0.15)
