"""A robot that is pressed on stands, yields, and works only for links that are touched."""

import pytest


def test_without_pressure_it_stands_still(run_scene):
    summary, companion = run_scene("multi-contact", seconds=0.6)
    assert not summary["fell"]
    assert companion.experiment.com_off_max < 1e-3
    assert summary["cop_margin_min_mm"] > 50.0
    assert companion.controller.active == [0] * len(companion.controller.active)
    assert companion.robot.jacobians / len(companion.controller.took) < 20


@pytest.mark.long
@pytest.mark.parametrize("name", ["hug", "multi-contact"])
def test_it_yields_to_every_contact_and_keeps_its_balance(name, run_scene, tmp_path):
    summary, companion = run_scene(name)
    assert summary["completed"], summary["reasons"]
    assert summary["most_active"] >= 6
    assert summary["yield_median"] > 4.5
    assert [file.exists() for file in companion.experiment.plot(tmp_path)] == [True]


@pytest.mark.long
def test_without_skin_many_contacts_push_it_over(run_scene):
    summary, _ = run_scene("multi-contact", "control.skin=false")
    assert summary["fell"]
    assert summary["yield_median"] < 2.0


@pytest.mark.long
def test_joint_speeds_follow_the_area(run_scene, tmp_path):
    summary, companion = run_scene("pressure")
    assert summary["completed"], summary["reasons"]
    assert companion.experiment.plot(tmp_path)
    by_force, _ = run_scene("pressure", "control.by_pressure=false")
    assert by_force["speed_ratio"] == pytest.approx(1.0, abs=0.2)
