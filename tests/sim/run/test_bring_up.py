"""A robot is checked before its first step: what is wired the wrong way is named, and what is not walks as ever."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from plantar.sim.run.bring_up import bring_up_text, check_before_walk
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

sys.path.insert(0, str(Path(__file__).parents[2] / "gait" / "safety"))
from miswirings import MISWIRINGS


def checked(robot, wiring=None, settings=(), scene="flat", seed=0):
    run = Simulation(load_scene(scene, ["steps=2", *settings], robot), seed)
    feet = {side: run.world.data.site_xpos[site].copy() for side, site in run.world.sole_sites.items()}
    checks = check_before_walk(run, wiring)
    moved = [np.abs(run.world.data.site_xpos[run.world.sole_sites[side]] - at).max() for side, at in feet.items()]
    return run, checks, max(moved)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", MISWIRINGS)
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_miswiring_is_named_before_the_first_step_and_takes_none(robot, name):
    made, cause = MISWIRINGS[name]
    run, checks, moved = checked(robot, made())
    assert not checks.passed
    causes = [finding.cause for finding in checks.findings]
    assert any(found.startswith(cause) for found in causes), causes
    assert checks.time <= 6.0
    assert run.controller.safe_state == "refused"
    assert moved < 5e-3  # both feet are where they were
    assert "takes no step" in bring_up_text(checks)


@pytest.mark.sample(1)
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_sound_robot_passes_in_six_seconds_and_walks(robot):
    run, checks, moved = checked(robot)
    assert checks.passed
    assert checks.time <= 6.0
    assert moved < 5e-3
    summary = run.run()
    assert summary["completed"], summary["reasons"]
    assert summary["steps_taken"] == 2


@pytest.mark.sample(1)
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_drawn_plants_pass(robot, seed):
    _, checks, _ = checked(robot, None, ["plant=random", "level=3"], seed=seed)
    assert checks.passed, checks.findings


def test_a_robot_that_falls_over_meanwhile_goes_limp():
    run = Simulation(load_scene("flat", ["steps=2"]), 0)
    run.world.data.qvel[1] = 3.0
    checks = check_before_walk(run)
    assert checks.fell
    assert run.controller.safe_state == "fallen"


def plantar(*arguments):
    return subprocess.run([sys.executable, "-m", "plantar", *arguments], capture_output=True, text=True, timeout=600)


def test_the_command_prints_what_it_checked():
    run = plantar("sim", "flat", "--set", "steps=1", "--set", "settle=0.2", "--bring-up", "--json")
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["completed"]
    assert found["bring_up"] == {"passed": True, "fell": False, "time_s": 5.95, "findings": []}
    refused = plantar("sim", "hug", "--bring-up")
    assert refused.returncode == 2
    assert "scenes of a walk" in refused.stderr
