"""Partial footholds walked by forces alone, under a model of the taxels that the controller does not know."""

from __future__ import annotations

import pytest

from sim.run.runner import run_scene
from sim.run.scene import load_scene


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_level_foot_finds_the_rear_half_that_carries(robot: str) -> None:
    summary = run_scene(load_scene("partial-rear", ["footholds=force", "sensing.taxels=elastic"], robot), 0)
    assert summary["completed"], summary["reasons"]
    found, true = (summary["footholds"][f"area_ratio_{which}"][2] for which in ("found", "true"))
    assert found == pytest.approx(true, abs=0.15)


def test_a_foot_that_comes_as_it_does_stays_on_the_edge_that_it_met() -> None:
    """Neither levelled nor told by its slope where the ground is, it takes the edge for the foothold."""
    off = ("landing.levelling=0", "contact.level=0.5")
    summary = run_scene(load_scene("partial-rear", ["footholds=force", *off]), 0)
    assert summary["fell"]
    assert summary["footholds"]["area_ratio_found"][2] < 0.5 * summary["footholds"]["area_ratio_true"][2]


BEAM = ("footholds=force", "sensing.taxels=elastic", "terrain.width=0.26 sole", "offset_range=0.174 sole")


def test_a_foot_looks_for_the_rest_of_a_beam_that_it_met_the_edge_of() -> None:
    """Before the weight comes; a foot that does not falls off the first part of a beam of a quarter of the sole."""
    walked, fell = (
        run_scene(load_scene("beam", [*BEAM, "walk.steps=14", f"landing.probing={on}"], "hrp2kai"), 2)
        for on in ("true", "false")
    )
    assert walked["completed"], walked["reasons"]
    assert fell["fell"]
