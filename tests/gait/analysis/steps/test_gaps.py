"""Values that cells did not measure: they lower no force, and they are told."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.gaps import filled, without_gaps
from plantar.recordings import frame_table

from ..walks import made_walk


@pytest.mark.parametrize("share", [0.02, 0.08])
def test_scattered_gaps_change_no_measure(share):
    """As the sum of the cells that were measured, the force would be lower by the same share."""
    plain = made_walk(strides=4)
    truth = analyse_feet(plain.recording)["left"].steps
    recording = made_walk(strides=4).recording
    random = np.random.default_rng(4)
    force = recording.feet["left"].force
    force[random.random(force.shape) < share] = np.nan
    mended = without_gaps(recording)
    assert any("values are missing: gaps of up to 0.1 s are filled" in w for w in mended.warnings)
    feet = analyse_feet(mended)
    for step, true in zip(feet["left"].steps, truth, strict=True):
        for key in ("peak_force_N", "impulse_Ns", "contact_time_s", "cop_path_m"):
            assert step[key] == pytest.approx(true[key], rel=0.01), key
    held = metrics_of(mended, feet)["feet"]["left"]["missing_percent"]
    assert held == pytest.approx(100.0 * share, rel=0.1)


def test_cells_that_never_measure_are_told_and_long_gaps_stay():
    recording = made_walk(strides=3).recording
    force = recording.feet["right"].force
    force[:, :20] = np.nan
    force[100:150, 50] = np.nan
    mended = without_gaps(recording)
    assert any("20 of 99 cells of the right foot never measure" in w for w in mended.warnings)
    assert np.isnan(mended.feet["right"].force[100:150, 50]).all()
    assert mended.feet["left"].force is recording.feet["left"].force


def test_blocks_fill_as_the_whole_does(monkeypatch):
    recording = made_walk(strides=3).recording
    random = np.random.default_rng(1)
    force = recording.feet["left"].force
    force[random.random(force.shape) < 0.3] = np.nan
    whole = filled(force, 10)
    monkeypatch.setattr(frame_table, "_BLOCK", 99 * 37)
    assert np.array_equal(without_gaps(recording).feet["left"].force, whole, equal_nan=True)
    one = replace(recording, feet={"left": recording.feet["right"]})
    assert without_gaps(one) is one
