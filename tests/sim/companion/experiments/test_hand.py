"""A hand that is repelled by what is near, by heat and by pressure, and what it does without."""

import pytest

pytestmark = pytest.mark.long


@pytest.mark.parametrize("name", ["feather", "stove", "nociception"])
def test_it_draws_back(name, run_scene, tmp_path):
    summary, companion = run_scene(name)
    assert summary["completed"], summary["reasons"]
    assert [file.exists() for file in companion.experiment.plot(tmp_path)] == [True]


@pytest.mark.parametrize(
    ("name", "setting", "criterion"),
    [
        ("feather", "control.proximity=false", "touched"),
        ("stove", "control.temperature=false", "retreat"),
        ("nociception", "control.reflex=false", "threshold_ratio"),
        ("nociception", "control.smooth=false", "torque_jump"),
    ],
)
def test_without_its_sense_it_does_not(name, setting, criterion, run_scene):
    summary, _ = run_scene(name, setting)
    assert criterion in [reason["criterion"] for reason in summary["reasons"]]
