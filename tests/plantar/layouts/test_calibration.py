"""Calibrations of soles: what they make of counts, and how the interval of gains goes into load and CoP."""

from dataclasses import replace

import numpy as np
import pytest

from plantar import LayoutError, Percept, Reading, grid_layout, mirrored, read_layout, write_layout
from plantar.layouts.calibration import CountStream, SoleCalibration, leakage

SOLE = grid_layout([[0, 0], [0.12, 0], [0.12, 0.08], [0, 0.08]], pitch=(0.04, 0.04))
N = len(SOLE)


def calibration(**changed) -> SoleCalibration:
    return replace(SoleCalibration.linear(np.linspace(0.05, 0.1, N), np.linspace(90.0, 110.0, N), 0.04), **changed)


def test_crosstalk_is_taken_off_and_keeps_the_load():
    force = np.array([30.0, 0.0, 0.0, 10.0, 0.0, 0.0])
    shared = force + 0.1 * leakage(SOLE) @ force
    known = calibration(crosstalk=0.1)
    counts = shared / known.gain + known.offset
    assert CountStream(known, SOLE).force(counts) == pytest.approx(force, abs=1e-9)
    assert shared.sum() == pytest.approx(force.sum())


def test_a_loop_reads_the_same_force_on_both_branches():
    """Counts of a loop below a peak of 400, whose branches lie as far above and below as the calibration states."""
    rise = np.linspace(40.0, 400.0, 200)
    middle = np.concatenate([rise[::-1], rise])
    half = 0.03 * 4.0 * middle * (1.0 - middle / 400.0)
    counts = middle + np.concatenate([half[:200], -half[200:]])
    known = replace(SoleCalibration.linear([0.1], [0.0]), hysteresis=[0.03, 0.0], top=[400.0])
    falling, rising = (known.forces(counts[:, None])[at, 0] for at in (99, 300))
    assert counts[99] - counts[300] > 20.0
    assert abs(falling - rising) < 0.1 * 0.1 * (counts[99] - counts[300])
    assert rising == pytest.approx(0.1 * middle[300], rel=0.01)


def test_a_missing_count_is_a_missing_force_and_spoils_no_other():
    known = calibration(crosstalk=0.1)
    force = known.forces([[np.nan, *np.full(N - 1, 300.0)]], SOLE)[0]
    assert np.isnan(force[0])
    assert np.isfinite(force[1:]).all()


def test_the_interval_of_the_cop_is_that_of_drawn_gains():
    known = calibration()
    force = np.array([10.0, 25.0, 5.0, 40.0, 15.0, 30.0])
    drawn = force * (1.0 + 0.04 * np.random.default_rng(0).normal(size=(20000, N)))
    places = drawn @ SOLE.positions[:, :2] / drawn.sum(axis=1, keepdims=True)
    sole = replace(SOLE, calibrations={"left": known})
    deviation = Percept(sole, Reading(0.0, force)).cop_deviation_in_sole
    assert deviation == pytest.approx(places.std(axis=0), rel=0.03)
    assert known.load_deviation(force) == pytest.approx(drawn.sum(axis=1).std() / force.sum(), rel=0.03)
    assert Percept(SOLE, Reading(0.0, force)).cop_deviation_in_sole is None
    assert Percept(sole, Reading(0.0, np.zeros(N))).cop_deviation_in_sole is None


def test_a_layout_file_holds_both_soles_and_a_mirrored_layout_keeps_them(tmp_path):
    right = calibration(date="2026-03-01", method="pressed", unobserved=("crosstalk: not seen",), crosstalk=0.07)
    kept = read_layout(
        write_layout(replace(SOLE, calibrations={"left": calibration(), "right": right}), tmp_path / "a")
    )
    found = mirrored(kept).calibration
    assert found is not None
    assert (found.date, found.method, found.unobserved, found.crosstalk) == (
        "2026-03-01",
        "pressed",
        right.unobserved,
        0.07,
    )
    assert np.abs(found.covariance - right.covariance).max() < 1e-9
    assert found.forces(np.full((1, N), 200.0)) == pytest.approx(right.forces(np.full((1, N), 200.0)))
    assert kept.calibration is not None


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("gain", [0.0] * N, "not above 0"),
        ("gain", [0.1] * (N + 1), "shape"),
        ("crosstalk", 0.7, "allowed: 0 up to 0.5"),
        ("covariance", [[1.0]], "covariance"),
        ("covariance", [[1.0, 2.0]], "1, 2"),
        ("offset", ["a"] * N, "offset"),
        ("top", None, "top"),
    ],
)
def test_a_file_with_a_wrong_calibration_is_refused_by_field(tmp_path, field, value, words):
    source = calibration().as_dict()
    source[field] = value
    with pytest.raises(LayoutError, match=words):
        SoleCalibration.from_mapping(source, "a.json")
    with pytest.raises(LayoutError, match=rf"calibrations.left' is of {N} taxels; expected 1"):
        replace(
            grid_layout([[0, 0], [0.04, 0], [0.04, 0.04], [0, 0.04]], pitch=(0.04, 0.04)),
            calibrations={"left": calibration()},
        )
