"""Robots of one shape walk alike whatever their size: every length, force and time is a share of the body."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.recordings.recording import read_mcap
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

from ..rates import check_rate, drawn_seeds
from .scaled_robot import scaled_h1

BEAT = math.sqrt(0.6 / 9.81)

CLOCK = [
    f"control.period={0.005 / BEAT!r} beat",
    f"control.physics_period={0.001 / BEAT!r} beat",
    f"skin_rate={250.0 * BEAT!r} 1/beat",
    "gyro_noise=0",
    f"walk.begin={2.0 / BEAT!r} beat",
    f"settle={0.5 / BEAT!r} beat",
]
"""What does not grow with a robot by itself: periods of physics, control, skin; gyro noise would move landings."""

Motion = dict[str, NDArray[np.float64]]


def walked(robot: Path, folder: Path, scene: str, settings: list[str], seed: int) -> tuple[dict[str, Any], Motion]:
    """Summary of a walk, and its motion over time: joint angles in rad, true CoM in m."""
    path = folder / f"{robot.parent.name}.mcap"
    summary = run_scene(load_scene(scene, settings, str(robot)), seed, record=path)
    topics = read_mcap(path).topics
    joints = topics["/joints"]
    return summary, {
        "time": joints.time,
        "angles": joints.fields["position"],
        "com": topics["/truth/body"].fields["com"],
    }


@pytest.mark.long
@pytest.mark.parametrize("s", [0.35, 1.2])
def test_a_scaled_robot_takes_the_same_steps(tmp_path, s):
    # What is left is how the feet settle on the ground in the beginning, which rounding decides.
    # A foot that sees the ground lands a reading sooner or later, which the noise decides.
    settings = ["steps=3", "pfc=false", *CLOCK]
    robots = scaled_h1(tmp_path / "own", 1.0), scaled_h1(tmp_path / "other", s)
    alike = []
    for seed in drawn_seeds(test_a_scaled_robot_takes_the_same_steps, 4, str(s)):
        own, first = walked(robots[0], tmp_path, "flat", settings, seed)
        other, motion = walked(robots[1], tmp_path, "flat", settings, seed)
        assert not own["fell"]
        assert not other["fell"]
        assert own["steps_taken"] == other["steps_taken"] == 3
        assert motion["time"] == pytest.approx(math.sqrt(s) * first["time"], abs=1e-6)
        assert np.abs(motion["com"] / s - first["com"]).max() < 0.02 * 0.6
        landings = np.array(other["landings_s"]) / math.sqrt(s) - own["landings_s"]
        near = np.abs(motion["angles"] - first["angles"]).max() < 0.02
        near &= np.abs(motion["com"] / s - first["com"]).max() < 0.005 * 0.6
        alike.append(bool(near and np.abs(landings).max() < 0.01))
    check_rate(alike, least=0.5)


@pytest.mark.long
@pytest.mark.parametrize(("s", "mass"), [(0.35, 0.0), (0.6, 33.0), (1.2, 95.0)])
@pytest.mark.parametrize(("scene", "steps"), [("flat", 6), ("push", 6), ("beam", 24), ("uneven", 12), ("stones", 12)])
def test_a_scaled_robot_holds_what_its_model_holds(tmp_path, s, mass, scene, steps):
    # The clocks of physics, control and skin, IMU and encoders stay what they are.
    robot = scaled_h1(tmp_path / "robot", s, mass)
    summary = run_scene(load_scene(scene, [f"steps={steps}"], str(robot)), 0)
    assert summary["completed"], summary["reasons"]
    assert summary["final"]["tilt_deg"] < 0.5
