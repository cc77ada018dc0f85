"""Measures of steps against closed forms."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.gait.analysis.measures import MEASURES
from plantar.gait.analysis.metrics import not_given
from plantar.gait.analysis.parameters import analyse_feet, analyse_foot
from plantar.gait.analysis.summary import gait_of_feet, summary_of_foot, symmetry
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

from .walks import made_walk


def test_contact_area_of_a_uniform_load_is_the_loaded_area(walk):
    made = walk(steps=8)
    for side, foot in made.recording.feet.items():
        for step in analyse_foot(made.recording, side).steps:
            assert step["contact_area_m2"] == pytest.approx(foot.layout.areas.sum())
            assert step["peak_pressure_Pa"] == pytest.approx(made.weight / foot.layout.areas.sum())
            assert step["cop_excursion_ap_m"] < 1e-9


def test_measures_do_not_depend_on_how_many_contacts_are_measured_at_once(walk, monkeypatch):
    made = walk(steps=12, rate=101.0, noise=1.4715)
    at_once = analyse_foot(made.recording, "left").steps
    monkeypatch.setattr("plantar.gait.analysis.parameters.CACHED", 1)
    alone = analyse_foot(made.recording, "left").steps
    assert len(at_once) == len(alone) > 3
    for one, other in zip(at_once, alone, strict=True):
        assert one.measures == pytest.approx(other.measures, rel=1e-12, nan_ok=True)
        assert one.regions.keys() == other.regions.keys()
        for region, values in one.regions.items():
            assert values == pytest.approx(other.regions[region], rel=1e-12, nan_ok=True)


def test_walk_as_a_whole(walk):
    made = walk(steps=20, noise=1.4715)
    feet = {side: analyse_foot(made.recording, side) for side in made.recording.feet}
    whole = gait_of_feet(feet)
    assert whole["landings"] == 20
    assert whole["cadence_steps_per_min"] == pytest.approx(60 / 1.2, rel=0.005)
    assert whole["stride_time_s"] == pytest.approx(2.4, abs=0.005)
    assert whole["double_support_percent"] == pytest.approx(100 * 0.6 / 2.4, abs=1.5)
    left = summary_of_foot(feet["left"])
    assert left["stance_percent"].mean == pytest.approx(100 * 1.5 / 2.4, abs=1.0)
    assert left["step_time_s"].mean == pytest.approx(1.2, abs=0.01)
    assert left["landing_impact_N"].mean == pytest.approx(made.weight / 2, rel=0.08)
    known = {key: value for key, value in symmetry(feet).items() if value is not None}
    assert (
        {"contact_time_s", "peak_force_N", "impulse_Ns", "contact_area_m2", "cop_path_m"} <= set(known) <= set(MEASURES)
    )
    assert max(abs(known[key]) for key in ("contact_time_s", "stride_time_s", "peak_force_N", "impulse_Ns")) < 2.0
    index = symmetry(feet)["contact_time_s"]
    assert abs(index) < 1.0


def test_noise_does_not_count_as_contact_area(walk):
    made = walk(steps=8, noise=1.4715)
    gait = analyse_foot(made.recording, "left")
    assert gait.cell_threshold == pytest.approx([3 * 1.4715] * len(gait.cell_threshold), rel=0.2)


def test_a_foot_that_drags_in_swing_makes_no_steps_of_it():
    made = made_walk(strides=8, stride=1.6, stance=0.6)
    recording, foot = made.recording, made.recording.feet["right"]
    touches = sum(150.0 * (np.abs(recording.time - lift - 0.32) < 0.12) for lift in made.lifts["right"][:-1])
    dragged = replace(foot, force=foot.force + touches[:, None] / foot.force.shape[1])
    feet = analyse_feet(replace(recording, feet={**recording.feet, "right": dragged}))
    assert [len(gait.steps) for gait in feet.values()] == [8, 8]
    assert any("lightly 7 time(s)" in w for w in feet["right"].warnings)


def test_moments_of_rounding_have_no_symmetry():
    moments = {"left": (2e-15, 2.2), "right": (1e-15, 1.8)}
    feet = {s: SimpleNamespace(columns={"tx_peak_Nm": [x], "ty_peak_Nm": [y]}) for s, (x, y) in moments.items()}
    found = symmetry(feet)
    assert (found["tx_peak_Nm"], found["ty_peak_Nm"]) == (None, pytest.approx(20.0))


def test_symmetry_index_has_the_sign_of_the_larger_side(walk):
    made = walk(steps=12)
    recording = made.recording
    left = recording.feet["left"]
    doubled = FootRecording("left", left.force * 3.0, left.layout)
    heavy = PressureRecording(recording.path, "x", 250.0, recording.time, {**recording.feet, "left": doubled})
    feet = {side: analyse_foot(heavy, side) for side in heavy.feet}
    assert symmetry(feet)["peak_force_N"] == pytest.approx(100 * (3 - 1) / 2)
    assert set(symmetry({"left": feet["left"]}).values()) == {None}


def test_a_foot_without_geometry_gives_forces_only(walk):
    made = walk(steps=6)
    bare = FootRecording("left", made.recording.feet["left"].force, None)
    recording = PressureRecording(Path("x"), "x", 250.0, made.recording.time, {"left": bare})
    step = analyse_foot(recording, "left").steps[0]
    assert step["peak_force_N"] == pytest.approx(made.weight, rel=1e-6)
    assert np.isnan([step["peak_pressure_Pa"], step["contact_area_m2"], step["cop_path_m"], step["cop_margin_m"]]).all()


@pytest.mark.parametrize("forefoot", [1.0, 0.4, 0.1, 0.02])
def test_an_insole_gives_no_outline_of_a_foot(forefoot):
    """Which of its cells pass the threshold would decide: nothing of that is a measure, and the CPEI takes the sole."""
    gait = analyse_feet(made_walk(forefoot=forefoot).recording)["left"]
    assert not set(gait.steps[2].measures) & {"arch_index", "foot_length_m", "foot_width_m"}
    assert set(not_given("insole")) == {"arch_index", "foot_length_m", "foot_width_m"}
    assert not_given("platform") == {}
    assert gait.levels.lift == pytest.approx(2 * gait.levels.release, rel=0.01)  # a shoe presses on after toe off
    layout = gait.foot.layout
    assert gait.sole.length == pytest.approx(float(np.ptp(layout.outline[:, 0])), rel=1e-6)


@pytest.mark.parametrize(("noise", "told"), [(0.0, 0), (0.3, 0), (2.0, 2)])
def test_noise_that_moves_events_is_told(noise, told):
    """Noise of the 99 cells of an insole in N: that of a foot is ten times as large."""
    feet = analyse_feet(made_walk(noise=noise).recording)
    lines = [line for gait in feet.values() for line in gait.warnings]
    assert sum("scatters by" in line for line in lines) == told
