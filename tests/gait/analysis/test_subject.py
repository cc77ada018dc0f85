"""Who walks and what measured: checked, held against the forces, and told at the head of the report."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import InputError
from plantar.cli import app
from plantar.common.gravity import GRAVITY
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.health import implied_weight
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.pages.report import report_page, summary_text
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.gait.analysis.subject import Subject, device_of, mass_doubts
from plantar.layouts.layout_file import layout_to_dict

from .walks import made_walk


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"mass_kg": 7000.0}, "--mass is 7000; allowed: 2 to 400 kg"),
        ({"mass_kg": float("nan")}, "--mass is nan; allowed: 2 to 400 kg"),
        ({"foot_length_m": 265.0}, "--foot-length is 265; allowed: 0.05 to 0.45 m"),
    ],
)
def test_impossible_bodies_are_refused(values, message):
    with pytest.raises(InputError, match=re.escape(message)):
        Subject(**values)


def test_a_mass_that_is_not_of_these_forces_is_doubted():
    assert mass_doubts(Subject(mass_kg=70.0), 70.0 * 1.25 * GRAVITY) == []
    assert mass_doubts(Subject(), 700.0) == mass_doubts(Subject(mass_kg=70.0), None) == []
    (doubt,) = mass_doubts(Subject(mass_kg=70.0), 90.0 * 1.1 * GRAVITY)
    assert "the forces imply 99 kg, the stated mass is 70 kg" in doubt


def test_an_offset_that_is_cut_off_below_zero_shows_beside_the_mass():
    """It looks like a lighter person's walk with shorter steps: nothing but the mass tells."""
    walk = made_walk(weight=700.0)
    for cut, told in ((0.0, 0), (3.0, 1)):
        feet = {side: replace(f, force=np.maximum(f.force - cut, 0.0)) for side, f in walk.recording.feet.items()}
        recording = without_baselines(replace(walk.recording, feet=feet))
        assert not any("in swing" in w for w in recording.warnings)
        doubts = mass_doubts(Subject(mass_kg=700.0 / GRAVITY), implied_weight(recording, analyse_feet(recording)))
        assert sum("what it reads below zero may be cut off" in d for d in doubts) == told


def test_the_head_of_the_report_tells_of_whom_it_is():
    """Escaped, with the device and its size, and peak forces in percent of the stated weight."""
    recording = replace(made_walk(weight=700.0, rate=50.0, strides=5).recording, metadata={"sensor": "X-1234"})
    feet = analyse_feet(recording)
    metrics = metrics_of(recording, feet, Subject("<P07>", 700.0 / GRAVITY, 0.265))
    page = report_page(metrics, (), "walk")
    for words in (
        "&lt;P07&gt;",
        "265 mm",
        "X-1234",
        "99 cells (nominal 99-cell insole, size X)",
        "71.4 kg; the forces",
    ):
        assert words in page
    peak = metrics["feet"]["left"]["measures"]["peak_force_N"]["mean"]
    assert f"is {100.0 * peak / 700.0:.0f} % ({peak:.0f} N) on the left" in summary_text(metrics)
    assert "Vertical force, % of body weight (71.4 kg, as stated)" in page
    assert "Peak force (% of body weight)" in page
    layout = feet["left"].foot.layout
    assert device_of(recording)["feet"]["left"]["length_m"] == pytest.approx(np.ptp(layout.outline[:, 0]))
    unknown = report_page(metrics_of(recording, feet), (), "walk")
    assert "not stated; the forces imply" in unknown
    assert "kg, which the forces imply)" in unknown


def test_the_command_takes_who_walks(tmp_path):
    recording = made_walk(rate=50.0, strides=4).recording
    path = tmp_path / "walk.npz"
    layout = json.dumps(layout_to_dict(nominal_insole("x", "left")))
    np.savez(path, time=recording.time, unit="N", layout_left=layout, left=recording.feet["left"].force)
    out = tmp_path / "out"
    given = ["--participant", "P07", "--mass", "30", "--foot-length", "0.26"]
    done = CliRunner().invoke(app, ["analyze", str(path), "-o", str(out), "--json", "--figures", *given])
    assert done.exit_code == 0, done.output
    metrics = json.loads((out / "metrics.json").read_text())
    assert metrics["subject"] == {"name": "P07", "mass_kg": 30.0, "foot_length_m": 0.26}
    assert metrics["gait"]["body_weight_N"] == pytest.approx(30.0 * GRAVITY)
    assert any("the stated mass is 30 kg" in w for w in metrics["warnings"])
    assert "P07" in (out / "report.html").read_text()
    wrong = CliRunner().invoke(app, ["analyze", str(tmp_path), "-o", str(out), "--mass", "70"])
    assert isinstance(wrong.exception, InputError)
