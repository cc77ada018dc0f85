"""The weight that forces imply, against weights that are known."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.gait.analysis.health import implied_weight, weight_doubts
from plantar.gait.analysis.parameters import analyse_feet
from plantar.recordings.pressure_recording import PressureRecording

from .walks import made_walk, two_humps


def of_side(recording: PressureRecording, side: str) -> PressureRecording:
    return replace(recording, feet={s: f for s, f in recording.feet.items() if s == side})


@pytest.mark.parametrize("only", ["", "left"])
@pytest.mark.parametrize(("unit", "doubted"), [(1.0, False), (6.895, True), (0.1333, True), (10.0, True), (0.1, True)])
def test_a_wrong_unit_implies_nobodys_weight(unit, doubted, only):
    """Units of pressure that are mistaken for kPa: psi, mmHg, N/cm2."""
    recording = made_walk(weight=700.0 * unit, rate=50.0, strides=5).recording
    recording = of_side(recording, only) if only else recording
    weight = implied_weight(recording, analyse_feet(recording))
    over_a_stride = 2.0 * 0.62 * float(np.mean(two_humps(np.linspace(0.0, 1.0, 1001))))  # body weights, of both feet
    assert weight == pytest.approx(700.0 * unit * over_a_stride, rel=0.02)
    doubts = weight_doubts(recording, weight)
    assert bool(doubts) == doubted
    assert all(f"a person of {weight / GRAVITY:.3g} kg" in line for line in doubts)


def test_standing_and_raw_counts():
    recording = made_walk(strides=2).recording
    assert implied_weight(replace(recording, raw=True), analyse_feet(recording)) is None
    still = {side: replace(foot, force=foot.force * 0.0 + 350.0 / 99.0) for side, foot in recording.feet.items()}
    standing = replace(recording, feet=still)
    assert implied_weight(standing, analyse_feet(standing)) == pytest.approx(700.0)


def test_taxels_of_a_robot_are_held_against_their_range():
    recording = replace(made_walk().recording, kind="robot")
    layout = recording.feet["left"].layout
    rated = max(layout.ranges["force"])
    gain = 2.0 * rated / float(recording.feet["left"].force.max())
    loud = {side: replace(foot, force=foot.force * gain) for side, foot in recording.feet.items()}
    assert weight_doubts(recording, 50.0) == []
    lines = weight_doubts(replace(recording, feet=loud), 50.0)
    assert len(lines) == 2
    assert f"rates it for {rated:.4g} N" in lines[0]
