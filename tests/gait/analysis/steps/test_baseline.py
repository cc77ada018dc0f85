"""Offsets of sensors and cells that a crease keeps loaded: what is taken off, and what is left alone."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import Side
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.baseline import resting_level, without_baselines
from plantar.gait.analysis.steps.foot_gait import FootGait

from ..walks import MadeWalk, made_walk


def measured(made: MadeWalk) -> tuple[dict[Side, FootGait], tuple[str, ...]]:
    recording = without_baselines(made.recording)
    return analyse_feet(recording), recording.warnings


def means(gait: FootGait, key: str) -> float:
    return float(np.mean([step[key] for step in gait.steps]))


@pytest.mark.parametrize(
    ("offset", "drift", "strides"), [(300.0, 0.0, 6), (5000.0, 0.0, 6), (-400.0, 0.0, 6), (150.0, 150.0, 40)]
)
def test_a_walk_on_an_offset_is_the_walk_without_it(offset, drift, strides):
    plain, none = measured(made_walk(strides=strides))
    feet, warnings = measured(made_walk(offset=offset, drift=drift, strides=strides))
    assert none == ()
    assert sum("in swing" in w for w in warnings) == 2
    for side, gait in feet.items():
        assert len(gait.steps) == len(plain[side].steps) == strides
        strikes = [s.heel_strike_s - p.heel_strike_s for s, p in zip(gait.steps, plain[side].steps, strict=True)]
        assert np.abs(strikes).max() < 0.015
        for key in ("peak_force_N", "peak_pressure_Pa", "impulse_Ns", "contact_time_s", "cop_path_m"):
            assert means(gait, key) == pytest.approx(means(plain[side], key), rel=0.03), key
        assert means(gait, "contact_area_m2") == pytest.approx(means(plain[side], "contact_area_m2"), rel=0.05)


@pytest.mark.parametrize("offset", [100.0, 300.0])
@pytest.mark.parametrize("strides", [1, 2])
def test_one_or_two_strides_show_an_offset(strides, offset):
    plain, _ = measured(made_walk(strides=strides))
    feet, warnings = measured(made_walk(strides=strides, offset=offset))
    assert sum(f"reads {offset:.0f} N in swing" in w for w in warnings) == 2
    for side, gait in feet.items():
        assert len(gait.steps) == strides
        assert means(gait, "peak_force_N") == pytest.approx(means(plain[side], "peak_force_N"), rel=0.02)


@pytest.mark.parametrize("ramp", [0.5, 0.8])
def test_weight_that_is_shifted_shows_no_offset(ramp):
    """From both feet to one and back, slowly: the lower level is half a body weight, not the sensor's."""
    time = np.arange(0.0, 6.0, 0.01)
    shift = np.clip(np.minimum(time - 2.0, 4.0 - time) / ramp, 0.0, 1.0)
    assert resting_level(350.0 + 350.0 * shift, 100.0) is None


@pytest.mark.parametrize("offset", [-15.0, -40.0, -75.0])
def test_no_shoe_pulls(offset):
    """However little it is: cells below zero take the CoP out of the sole."""
    truth = analyse_feet(made_walk(strides=7).recording)["left"].steps[3]
    pulled = made_walk(strides=7).recording
    left = pulled.feet["left"]
    even = replace(left, force=left.force + offset / left.force.shape[1])
    mended = without_baselines(replace(pulled, feet={**pulled.feet, "left": even}))
    assert any("of the left foot" in w or "the left foot's sensor reads -" in w for w in mended.warnings)
    step = analyse_feet(mended)["left"].steps[3]
    for key in ("impulse_Ns", "cop_path_m", "contact_time_s"):
        assert step[key] == pytest.approx(truth[key], rel=0.01), key


def test_what_a_shoe_presses_in_swing_stays_in_the_forces():
    """Vendors leave it there, too; 5 % of the force is within what shoes do."""
    made = made_walk(offset=35.0)
    notes = without_baselines(made.recording).warnings
    assert sum("it stays in the forces" in w for w in notes) == 2
    assert without_baselines(made.recording).feet["left"].force is made.recording.feet["left"].force


def test_a_crease_and_a_stuck_cell_are_found_and_are_no_contact():
    plain, _ = measured(made_walk())
    made = made_walk(crease=[97, 3], crease_force=30.0)
    stuck = made.recording.feet["right"].force
    stuck[:, [97, 3]] = made_walk().recording.feet["right"].force[:, [97, 3]]
    stuck[:, 50] = 25.0
    feet, warnings = measured(made)
    assert any("cells 4, 98 of the left foot" in w for w in warnings)
    assert any("cell 51 of the right foot" in w for w in warnings)
    for side in feet:
        assert means(feet[side], "peak_pressure_Pa") == pytest.approx(means(plain[side], "peak_pressure_Pa"), rel=0.02)
    assert means(feet["left"], "impulse_Ns") == pytest.approx(means(plain["left"], "impulse_Ns"), rel=0.04)


def test_a_cell_that_stays_loaded_in_swing_is_in_contact_only_above_that():
    """Its threshold lies above what the shoe presses there."""
    made = made_walk()
    force = made.recording.feet["left"].force
    heel = int(np.argmax(force[:, :20].max(axis=0)))
    force[:, heel] += 0.2 * force[:, heel].max()
    feet, _ = measured(made)
    gait = feet["left"]
    assert gait.cell_threshold[heel] > 0.99 * force[0, heel]
    swing = np.ones(len(force), dtype=bool)
    for step in gait.steps:
        swing[step.contact.begin - 2 : step.contact.end + 12] = False
    assert not (force[swing] > gait.cell_threshold).any()


def test_a_contact_of_just_half_of_the_range():
    force = np.zeros(400)
    force[200:260], force[360:] = 350.0, 700.0
    assert resting_level(force, 100.0) is not None


@pytest.mark.parametrize("seed", range(4))
def test_standing_has_no_level_in_swing(seed):
    random = np.random.default_rng(seed)
    sway = np.convolve(random.normal(0.0, 1.0, 3000), np.exp(-np.arange(200) / 40.0), mode="same")
    assert resting_level(400.0 + 6.0 * sway, 100.0) is None
    time = np.arange(3000) * 0.01
    assert resting_level(400.0 + 200.0 * np.sin(2.0 * np.pi * 0.4 * time), 100.0) is None
    on_one_foot = np.where((time // 5.0) % 2 == 0, 650.0, 120.0) + random.normal(0.0, 5.0, 3000)
    assert resting_level(on_one_foot, 100.0) is None  # 5 s on the other foot is no swing


def test_walking_after_standing_keeps_the_offset_of_the_walk():
    made = made_walk(offset=350.0, strides=20)
    force = made.recording.feet["left"].force.copy()
    force[:1200] = force.mean(axis=0) + 0.4 * force[100:1300].mean(axis=0)
    feet = {**made.recording.feet, "left": replace(made.recording.feet["left"], force=force)}
    recording = without_baselines(replace(made.recording, feet=feet))
    assert any("left foot's sensor reads 35" in w for w in recording.warnings)
    swing = recording.feet["left"].vertical_force[-600:]
    assert np.percentile(swing, 10.0) == pytest.approx(0.0, abs=5.0)
