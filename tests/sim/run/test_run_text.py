"""A run's summary in words: what went wrong is told, and what the scene has not is left out."""

import pytest

from plantar.sim.run.run_text import run_text
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene


@pytest.fixture(scope="module")
def summary():
    return run_scene(load_scene("flat", ["steps=2", "settle=0.2"]))


def test_a_completed_run_tells_no_fault(summary):
    lines = run_text(summary).splitlines()
    assert lines[0].startswith("flat with h1, seed 0: completed, 2 of 2 steps in ")
    assert not [line for line in lines if "not completed" in line or "at times more than" in line]
    assert lines[-1].endswith("us (99 %)")


def test_what_went_wrong_is_reported(summary):
    bad = summary | {
        "completed": False,
        "fell": True,
        "reasons": [{"criterion": "torque_limit", "value": 1, "limit": 0, "text": "too weak"}],
        "zmp_margin_min_m": None,
        "drift": None,
        "impacts_N": [],
        "torque_limit": {"share_of_time": 0.1, "joints": {f"j{k}": 0.01 * k for k in range(5)}},
        "joint_speed": None,
        "out_of_reach_since_s": 1.5,
        "figures": ["plots/feet.png"],
    }
    text = run_text(bad)
    assert "drifted" not in text
    assert "the walk drifted by" in run_text(summary)
    for words in (
        "FELL",
        "not completed, torque limit: too weak",
        "ZMP margin -",
        "10.0 % of the time (j4 4.0 %, j3 3.0 %, j2 2.0 %)",
        "joint speeds are not limited",
        "from 1.50 s on a leg was at times more than 20 mm or mrad off its target",
    ):
        assert words in text
    assert "landing impact" not in text
    assert text.endswith("\n  plots/feet.png")


def test_pushes_and_the_ankles_are_listed_where_there_are_any(summary):
    assert "pushes" not in run_text(summary | {"balance": {}})
    balance = {
        "pushes": [{}, {}],
        "recovered": 1,
        "zmp_off_max_m": 0.03,
        "skin_against_force_torque": {"rms_m": 0.002, "max_m": 0.004},
    }
    text = run_text(summary | {"balance": balance})
    assert "recovered from 1 of 2 pushes, which moved the true ZMP by up to 30 mm" in text
    assert "2.00 mm RMS, 4.0 mm at most" in text
