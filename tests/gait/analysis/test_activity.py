"""Walking, running and standing told apart, and the sway of standing against closed forms."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.errors import InputError
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.activity import activity_of, progression_doubts, sway_measures
from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.report import summary_text
from plantar.gait.analysis.pages.sole_figures import figure_pressure
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, StatedEvents

from .walks import made_walk


@pytest.mark.parametrize("one_foot", [False, True])
@pytest.mark.parametrize(
    ("stride", "stance", "name"),
    [
        (1.1, 0.62, "walking"),
        (1.8, 0.7, "walking"),
        (0.9, 0.56, "walking"),
        (0.7, 0.36, "running"),
        (0.62, 0.3, "running"),
    ],
)
def test_a_run_has_flight_and_a_walk_none(stride, stance, name, one_foot):
    recording = made_walk(stride=stride, stance=stance, strides=7).recording
    if one_foot:
        recording = replace(recording, feet={"left": recording.feet["left"]})
    feet = analyse_feet(recording)
    assert activity_of(recording, feet).name == name
    if not one_foot:
        flight = np.median([s["flight_time_s"] for g in feet.values() for s in g.used[1:-1]])
        truth = max(0.0, (0.5 - stance) * stride)
        assert flight == pytest.approx(truth, abs=0.03 if truth else 1e-9)  # events lie at a share of the force


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(
    ("name", "roll"),
    [
        ("walking", ((0.0, 0.15), (1.0, 0.85))),
        ("walking", ((0.0, 0.35), (1.0, 0.85))),
        ("walking without heel strike", ((0.0, 0.55), (0.3, 0.45), (1.0, 0.85))),
        ("walking down stairs", ((0.0, 0.9), (0.15, 0.8), (0.4, 0.2), (1.0, 0.85))),
        ("toe walking", ((0.0, 0.75), (1.0, 0.9))),
    ],
)
def test_where_the_foot_lands_names_the_walk(name, roll, side):
    recording = made_walk(strides=5, roll=roll).recording
    recording = replace(recording, feet={side: recording.feet[side]})
    feet = analyse_feet(recording)
    assert activity_of(recording, feet).name == name
    assert progression_doubts(recording, feet) == []


def stairs_up(seed, stance=None, landing=None, peaks=None):
    """A walk up stairs as the literature describes it: front or middle of the foot first, slow, a strong push-off."""
    random = np.random.default_rng(seed)
    stances, landings, stride = random.uniform(0.645, 0.68), random.uniform(0.5, 0.62), random.uniform(1.3, 1.6)
    first, second = (random.uniform(0.9, 1.0), random.uniform(1.12, 1.3)) if peaks is None else peaks
    at = landings if landing is None else landing
    return made_walk(
        strides=5,
        stride=stride,
        stance=stances if stance is None else stance,
        roll=((0.0, at), (0.35, at - 0.1), (1.0, 0.85)),
        humps=(first, 0.7, second),
        rate=50.0,
    ).recording


@pytest.mark.parametrize("seed", range(6))
def test_stairs_up_take_three_evidences(seed):
    def name(recording: PressureRecording) -> str:
        return activity_of(recording, analyse_feet(recording)).name

    assert name(stairs_up(seed)) == "walking up stairs"
    assert name(stairs_up(seed, stance=0.57)) == "walking without heel strike"
    assert name(stairs_up(seed, peaks=(1.1, 1.05))) == "walking without heel strike"
    assert name(stairs_up(seed, landing=0.3)) == "walking"


def test_a_foot_that_is_rolled_over_backwards_is_told():
    """As cells in the reversed order show it."""
    recording = made_walk(strides=5, roll=((0.0, 0.9), (1.0, 0.1))).recording
    doubts = progression_doubts(recording, analyse_feet(recording))
    assert [d.split("'")[0] for d in doubts] == ["the left foot", "the right foot"]
    assert all("order of the cells" in d for d in doubts)
    robot = replace(recording, kind="robot")
    assert all("sets its soles down flat" in d for d in progression_doubts(robot, analyse_feet(robot)))


def test_heart_and_breath_of_a_body_that_stands_on_one_leg_are_no_steps():
    time = np.arange(0.0, 20.0, 0.01)
    force = 700.0 + 3.0 * np.sin(5.0 * time)
    assert analyse({"left": force, "unit": "N"}, rate_hz=100.0).metrics["activity"]["name"] == "standing"


def test_too_few_frames_for_steps_are_told():
    recording = made_walk(rate=8.0).recording
    assert any("steps take 12 or more" in w for w in metrics_of(recording, analyse_feet(recording))["warnings"])


def test_feet_that_were_not_recorded_at_one_time_are_told():
    """A walk whose right foot is 0.3 s late seems to fly; a run, which does, is not doubted."""
    recording = made_walk(strides=6).recording
    right = replace(recording.feet["right"], force=np.roll(recording.feet["right"].force, 30, axis=0))
    late = replace(recording, feet={"left": recording.feet["left"], "right": right})
    feet = analyse_feet(late)
    assert activity_of(late, feet).name == "walking"
    assert any("recorded at the same time" in d for d in progression_doubts(late, feet))
    run = made_walk(stride=0.7, stance=0.36, strides=6).recording
    assert progression_doubts(run, analyse_feet(run)) == []


def standing(seconds: float = 20.0, seed: int = 0) -> PressureRecording:
    """Two feet that carry 350 N each, whose CoP wanders over 4 and 2 mm (standard deviations)."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, seconds, 0.02)
    feet = {}
    for side in ("left", "right"):
        layout = nominal_insole("x", side)
        kernel = np.exp(-0.5 * (np.arange(-50, 51) / 12.0) ** 2)
        wander = np.array([np.convolve(random.normal(0, 1, len(time) + 100), kernel, "valid") for _ in "xy"]).T
        wander *= np.array([0.004, 0.002]) / wander.std(axis=0)
        near = layout.positions[:, None, :2] - (layout.positions[:, :2].mean(axis=0) + wander)
        load = np.exp(-0.5 * (near**2).sum(axis=2) / 0.03**2).T
        feet[side] = FootRecording(side, 350.0 * load / load.sum(axis=1, keepdims=True), layout)
    return PressureRecording(Path("standing"), "synthetic", 50.0, time, feet)


def test_standing_is_named_and_its_sway_measured():
    recording = standing()
    feet = analyse_feet(recording)
    metrics = metrics_of(recording, feet)
    assert metrics["activity"]["name"] == "standing"
    assert not any("is cut off" in w for w in metrics["warnings"])
    for side in feet:
        sway = metrics["feet"][side]["sway"]
        assert sway["load_percent"] == pytest.approx(50.0)
        assert 0.002 < sway["sway_ap_m"] < 0.005
        assert sway["sway_ap_m"] > 1.4 * sway["sway_ml_m"]
        assert sway["sway_velocity_m_s"] == pytest.approx(sway["sway_path_m"] / 20.0, rel=0.01)
    assert any("loads and sway are measured" in w for w in metrics["warnings"])
    assert summary_text(metrics).count(f"(95 % of its CoP in {1e4 * sway['sway_ellipse_m2']:.3g} cm²)") >= 1
    *panels, bar = figure_pressure(recording, feet).axes
    assert [panel.get_title() for panel in panels] == ["left foot, all frames", "right foot, all frames"]
    assert bar.get_ylabel() == "maximum pressure (kPa)"
    walk = made_walk().recording
    assert metrics_of(walk, analyse_feet(walk))["feet"]["left"]["sway"] is None


@pytest.mark.parametrize("steps", [(40, 50), (1, 2)])
def test_steps_that_nobody_asked_for_are_a_walk_all_the_same(steps):
    recording = made_walk(strides=7).recording
    feet = analyse_feet(recording, options=AnalysisOptions(steps=steps))
    metrics = metrics_of(recording, feet)
    assert metrics["activity"]["name"] == "walking"
    asked = [w for w in metrics["warnings"] if "among those that were asked for" in w]
    assert len(asked) == (2 if steps[0] > 7 else 0)


@pytest.mark.parametrize("walk", [{"stride": 0.4, "stance": 0.2}, {"stride": 1.1, "rate": 10.0}])
def test_feet_that_are_lifted_do_not_stand_though_no_step_is_found(walk):
    """A sprint whose contacts are all shorter than 0.1 s, and ten frames a second."""
    recording = made_walk(strides=30, **walk).recording
    feet = analyse_feet(recording)
    assert not any(gait.steps for gait in feet.values())
    found = activity_of(recording, feet)
    assert found.name == "unknown"
    assert "lifted and set down" in found.why


def test_events_by_another_clock_are_refused():
    """In ms, a walk would be called standing."""
    made = made_walk(strides=7)
    for factor, offset in ((1000.0, 0.0), (1.0, 1.7e9)):
        events = {s: StatedEvents(made.strikes[s] * factor + offset, made.lifts[s] * factor + offset) for s in SIDES}
        with pytest.raises(InputError, match=r"events of the left foot are stated from .* by the recording's clock"):
            analyse_feet(replace(made.recording, events=events), options=AnalysisOptions(events="vendor"))


def test_events_far_from_those_in_the_force_are_doubted():
    """By another clock: the walk in them is none."""
    made = made_walk(strides=7)
    for strikes, lifts, doubt in ((0.0, 0.0, False), (0.3, 0.3, True)):
        events = {s: StatedEvents(made.strikes[s] + strikes, made.lifts[s] + lifts) for s in SIDES}
        recording = replace(made.recording, events=events)
        feet = analyse_feet(recording, options=AnalysisOptions(events="vendor"))
        warnings = metrics_of(recording, feet)["warnings"]
        assert any("from those in its force: by another clock, or toe offs?" in w for w in warnings) == doubt


@pytest.mark.parametrize("strides", [3, 12])
@pytest.mark.parametrize(("strikes", "lifts"), [(0.682, 0.418), (0.55, 0.55), (0.75, 0.3)])
def test_events_in_swing_are_refused(strikes, lifts, strides):
    """Toe offs for heel strikes, the other foot's events, and contacts within the swing."""
    made = made_walk(strides=strides)
    events = {s: StatedEvents(made.strikes[s] + strikes, made.lifts[s] + lifts) for s in SIDES}
    with pytest.raises(InputError, match=r"the left foot carries .* exchanged\? Allowed: events of its contacts"):
        analyse_feet(replace(made.recording, events=events), options=AnalysisOptions(events="vendor"))


@pytest.mark.parametrize(
    "options", [{"begin": math.nan}, {"end": math.nan}, {"steps": (5, 3)}, {"steps": (0, 3)}, {"steps": "some"}]
)
def test_options_that_leave_no_step_are_refused(options):
    with pytest.raises(InputError, match=r"allowed: first and last|is not before"):
        AnalysisOptions(**options)


@pytest.mark.parametrize("period", [2.5, 4.0, 8.0])
@pytest.mark.parametrize("depth", [0.3, 0.6])
def test_weight_that_goes_from_foot_to_foot_is_no_walk(period, depth):
    """No foot is lifted: each carries a fifth of a body weight or more at any time."""
    layout = nominal_insole("x", "left")
    time = np.arange(0.0, 30.0, 0.01)
    feet = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        load = 350.0 * (1.0 + sign * depth * np.sin(2.0 * np.pi * time / period))
        feet[side] = FootRecording(side, np.outer(load, np.full(len(layout), 1.0 / len(layout))), None)
    recording = PressureRecording(Path("x"), "x", 100.0, time, feet, kind="insole")
    for given in (recording, without_baselines(recording)):
        found = analyse_feet(given)
        assert not any(gait.steps for gait in found.values())
        assert activity_of(given, found).name == "standing"


def test_the_ellipse_holds_95_of_100_points():
    random = np.random.default_rng(2)
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    points = random.normal(0.0, 1.0, (4000, 2)) * (0.006, 0.002) @ turn.T
    area = sway_measures(np.arange(4000) * 0.01, points)["sway_ellipse_m2"]
    assert area == pytest.approx(np.pi * 5.991 * 0.006 * 0.002, rel=0.05)
    inverse = np.linalg.inv(np.cov(points.T))
    scale = area / np.pi / np.sqrt(np.linalg.det(np.cov(points.T)))
    inside = np.einsum("ni,ij,nj->n", points, inverse, points) < scale
    assert inside.mean() == pytest.approx(0.95, abs=0.01)
    assert sway_measures(np.arange(100) * 0.01, points[:100]) == {}


@pytest.mark.parametrize(("on", "off"), [(0.3, 99.0), (0.3, 19.5), (6.0, 99.0), (9.0, 15.5)])
def test_who_steps_on_or_off_a_sensor_stands_between(on, off):
    """What is measured is the time between: neither one long step, nor sway of the way up."""
    layout = nominal_insole("x", "left")
    time = np.arange(0.0, 20.0, 0.01)
    load = 350.0 * np.clip(np.minimum(time - on, off - time) / 0.1, 0.0, 1.0)
    shift = layout.positions[:, 0] * 0.4 * np.sin(2.0 * np.pi * time / 2.5)[:, None]
    rise = 30.0 * (0.13 - layout.positions[:, 0]) * (load < 170.0)[:, None]  # the heel first
    share = 1.0 + shift + rise
    force = load[:, None] * np.maximum(share, 0.0) / np.maximum(share, 0.0).sum(axis=1, keepdims=True)
    feet = {s: FootRecording(s, force, nominal_insole("x", s)) for s in SIDES}
    recording = PressureRecording(Path("x"), "x", 100.0, time, feet)
    gaits = analyse_feet(recording)
    assert not any(gait.steps for gait in gaits.values())
    metrics = metrics_of(recording, gaits)
    assert metrics["activity"]["name"] == "standing"
    within = slice(int(np.argmax(load > 340.0)), len(time) - int(np.argmax(load[::-1] > 340.0)))
    sway = sway_measures(time[within], gaits["left"].cop[within])
    assert metrics["feet"]["left"]["sway"]["sway_ap_m"] == pytest.approx(sway["sway_ap_m"], rel=0.05)


def test_both_feet_on_a_sensor_for_two_seconds_are_no_step():
    time = np.arange(0.0, 10.0, 0.01)
    load = 350.0 * np.clip(np.minimum(time - 5.0, 7.0 - time) / 0.1, 0.0, 1.0)
    feet = {s: FootRecording(s, load[:, None].copy(), None) for s in SIDES}
    recording = PressureRecording(Path("x"), "x", 100.0, time, feet)
    gaits = analyse_feet(recording)
    assert not any(gait.steps for gait in gaits.values())
    assert activity_of(recording, gaits).name == "standing"
