"""Scenes on partial footholds, and what was found of them against the ground's true geometry."""

import pytest

from sim.runner import run_scene
from sim.scene import load_scene


@pytest.fixture(scope="module")
def inner() -> dict:  # type: ignore[type-arg]
    return run_scene(load_scene("partial-inner", ["settle=0.5"]), 1)


def test_half_a_foothold_is_found_and_walked_over(inner: dict) -> None:  # type: ignore[type-arg]
    assert inner["completed"]
    assert inner["replans"] >= 1
    felt, true = inner["footholds"]["area_ratio_felt"], inner["footholds"]["area_ratio_true"]
    assert true[2] == pytest.approx(0.5, abs=0.02)
    assert felt[2] == pytest.approx(true[2], abs=0.1)
    assert [round(v, 2) for v in felt[:2] + felt[3:]] == [1.0] * 5
    assert inner["footholds"]["centroid_error_m"]["p95"] < 0.01


def test_without_looking_at_footholds_nothing_is_replanned() -> None:
    blind = run_scene(load_scene("partial-third", ["footholds=off"]), 1)
    assert blind["replans"] == 0
    assert "footholds" not in blind
    assert blind["fell"]


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("seed", [0, 3])
def test_the_beam_is_crossed(robot: str, seed: int) -> None:
    run = run_scene(load_scene("beam", [], robot), seed)
    assert run["completed"]
    assert run["steps_taken"] == 50
    assert min(run["contact_area_ratio"]) < 0.6


@pytest.mark.long
@pytest.mark.parametrize("settings", [["yaw=5"], ["yaw=-5"], ["offset_range=0.0", "terrain.width=0.06"]])
def test_turned_and_narrow_beams_are_crossed(settings: list[str]) -> None:
    assert run_scene(load_scene("beam-yaw", settings), 0)["completed"]
