"""The scene `balance`: pushes on a standing robot, sensed by skin and ankles (T 4.3.1)."""

import numpy as np
import pytest

from plantar.recordings.recording import read_mcap
from plantar.sim.figures.run_figure import plot_run
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

SHORT = ["push.count=2", "settle=8"]


@pytest.mark.parametrize("robot", ["h1", pytest.param("hrp2kai", marks=pytest.mark.long)])
def test_skin_and_ankles_agree_and_the_robot_recovers(robot, tmp_path):
    summary = run_scene(load_scene("balance", SHORT, robot), 0, record=tmp_path / "run.mcap")
    assert summary["completed"]
    balance = summary["balance"]
    assert balance["recovered"] == len(balance["pushes"]) == 2
    assert 0.05 < balance["zmp_off_max_m"] < 0.11
    zmps = balance["skin_against_force_torque"]
    assert zmps["samples"] == 1600
    assert 1e-4 < zmps["rms_m"] < 2e-3
    assert zmps["max_m"] < 5e-3
    run = read_mcap(tmp_path / "run.mcap")
    topic = run.topics["/zmp"]
    distance = np.hypot(*(topic.fields["skin"] - topic.fields["force_torque"])[topic.time >= 1.0].T)
    assert distance.max() == pytest.approx(zmps["max_m"], abs=2e-5)
    # Both against the truth, which neither of them knows.
    truth = run.topics["/truth/body"].fields["zmp"]
    assert np.median(np.hypot(*(topic.fields["force_torque"] - truth).T)) < 1e-3
    assert {p.name for p in plot_run(run, tmp_path)} >= {"zmp.png", "zmp_plane.png"}


def test_force_torque_is_a_source_of_feedback_too():
    by_skin = run_scene(load_scene("balance", SHORT), 1)
    by_ankles = run_scene(load_scene("balance", [*SHORT, "zmp_source=force_torque"]), 1)
    assert by_skin["completed"]
    assert by_ankles["completed"]
    pushes = [[(p["time_s"], p["impulse_Ns"]) for p in s["balance"]["pushes"]] for s in (by_skin, by_ankles)]
    assert pushes[0] == pushes[1]
    assert by_skin["estimate"] != by_ankles["estimate"]


@pytest.mark.long
@pytest.mark.parametrize("source", ["skin", "force_torque"])
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("seed", range(5))
def test_the_whole_scene(robot, source, seed):
    summary = run_scene(load_scene("balance", [f"zmp_source={source}"], robot), seed)
    assert summary["completed"]
    assert summary["balance"]["recovered"] == 6
    assert summary["balance"]["skin_against_force_torque"]["rms_m"] < 2e-3
    assert summary["balance"]["skin_against_force_torque"]["max_m"] < 5e-3
