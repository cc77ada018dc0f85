"""Recordings of several activities: each step is of one, stops are no steps, and means are of one activity."""

import re

import numpy as np
import pytest

from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.options import AnalysisOptions

RATE = 100.0


def steps(seconds: float, period: float, stance: float, phase: float, peak: float = 820.0) -> np.ndarray:
    """Vertical force in N of a foot: two humps in a walk, one in a run."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    share = np.clip(((time + phase) % period) / period / stance, 0.0, 1.0)
    humps = np.sin(np.pi * share) + (0.25 * np.sin(3.0 * np.pi * share) if stance > 0.5 else 0.0)
    return np.where((share > 0.0) & (share < 1.0), peak * humps / humps.max(), 0.0)


def walk(seconds: float = 10.0, phase: float = 0.0) -> list[np.ndarray]:
    return [steps(seconds, 1.1, 0.62, phase), steps(seconds, 1.1, 0.62, phase + 0.55)]


def run(seconds: float = 10.0) -> list[np.ndarray]:
    return [steps(seconds, 0.7, 0.36, p, 1500.0) for p in (0.0, 0.35)]


def stand(seconds: float = 10.0) -> list[np.ndarray]:
    random = np.random.default_rng(0)
    return [410.0 + random.normal(0.0, 5.0, round(seconds * RATE)) for _ in range(2)]


def analysed(*parts: list[np.ndarray], **more: object) -> Analysis:
    left, right = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    return analyse({"left": left, "right": right, "unit": "N"}, rate_hz=RATE, **more)


def test_a_stop_between_walks_is_no_step():
    found = analysed(walk(), stand(), walk(phase=0.3))
    assert [s["activity"] for s in found.metrics["segments"]] == ["walking", "standing", "walking"]
    for foot in found.metrics["feet"].values():
        assert foot["measures"]["contact_time_s"]["mean"] == pytest.approx(0.682, abs=0.01)
    assert found.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(120.0 / 1.1, rel=0.003)
    assert any("3 segments" in w for w in found.warnings)


@pytest.mark.parametrize(("choice", "cadence"), [("walking", 120.0 / 1.1), ("running", 120.0 / 0.7)])
def test_means_are_of_one_activity(choice, cadence):
    found = analysed(walk(), run(), choices=AnalysisOptions(segment=choice))
    assert found.metrics["activity"]["name"] == choice
    assert found.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(cadence, rel=0.003)
    used = [step for gait in found.feet.values() for step in gait.used]
    assert len(used) > 12
    assert {step.activity for step in used} == {choice}


@pytest.mark.parametrize("weak", [0, 1])
@pytest.mark.parametrize(
    ("stances", "period", "activity", "why"),
    [
        ((0.52, 0.44), 0.75, "running", "both feet are off the ground for"),  # a limping run
        ((0.50, 0.40), 0.7, "running", "both feet are off the ground for"),
        (
            (0.75, 0.45),
            1.1,
            "walking",
            "off the ground for 0.0[4-7].* but a foot stands for (59|60) % of it",
        ),  # on crutches
        ((0.70, 0.54), 1.1, "walking", "a foot is on the ground at all times"),  # a limp
    ],
)
def test_both_feet_of_a_stride_have_one_activity(stances, period, activity, why, weak):
    feet = [steps(20.0, period, s, p, 1000.0) for s, p in zip(stances, (0.0, 0.5 * period), strict=True)]
    found = analysed(feet[::-1] if weak == 0 else feet)
    assert found.metrics["activity"]["name"] == activity
    assert re.search(why, found.metrics["activity"]["why"])
    for gait in found.feet.values():
        assert len(gait.used) > 0.85 * len(gait.steps)
        assert {step.activity for step in gait.steps} == {activity}
    assert [s["activity"] for s in found.metrics["segments"]] == [activity]


def test_a_walk_that_becomes_a_limping_run_changes_once():
    limp = [steps(10.0, 0.75, s, p, 1000.0) for s, p in ((0.52, 0.0), (0.44, 0.375))]
    found = analysed(walk(), limp)
    assert [s["activity"] for s in found.metrics["segments"]] == ["walking", "running"]


def test_hops_of_both_feet_are_no_walk():
    both = [steps(10.0, 0.6, 0.5, phase, 1500.0) for phase in (0.0, 0.005)]
    found = analysed(both)
    assert found.metrics["activity"]["name"] == "hopping"
    assert found.metrics["gait"]["double_support_percent"] is None


def test_two_people_in_one_file_are_pointed_out():
    found = analysed([steps(20.0, 1.0, 0.62, 0.0), steps(20.0, 1.22, 0.62, 0.5)])
    assert any("strides are 20 % shorter" in w for w in found.warnings)
    assert found.metrics["gait"]["double_support_percent"] is None


def test_both_feet_share_one_window():
    left, right = walk(20.0)
    right[: round(8.0 * RATE)] *= 0.5  # eight seconds in which the right foot carries half
    found = analysed([left, right])
    begins = [gait.used[0].heel_strike_s for gait in found.feet.values()]
    assert abs(begins[0] - begins[1]) <= 1.11


def test_a_gap_in_standing_is_no_lift():
    time = np.arange(0.0, 20.0, 1.0 / RATE)
    circle = 0.01 * np.column_stack([np.cos(2.0 * np.pi * time), np.sin(2.0 * np.pi * time)])
    from plantar.gait.analysis.activity import sway_measures

    whole = sway_measures(time, circle)
    circle[800:1100] = np.nan
    assert sway_measures(time, circle)["sway_velocity_m_s"] == pytest.approx(whole["sway_velocity_m_s"], rel=1e-3)
    gap = [np.full(300, np.nan)] * 2
    assert analysed(stand(), gap, stand()).metrics["activity"]["name"] == "standing"
