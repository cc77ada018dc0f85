"""Studies of made recordings with effects that are known, and of none."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import FormatError, InputError, grid_layout
from plantar.cli import app
from plantar.common.gravity import GRAVITY
from plantar.formats import ReadOptions
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.compare import compare_recordings
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.study import measured_recordings
from plantar.gait.analysis.study import run_study as module
from plantar.gait.analysis.study.compare_conditions import compare_conditions
from plantar.gait.analysis.study.one_recording import GRID, RecordingResult, key_of, normalised, sampled
from plantar.gait.analysis.study.participants import Participation, read_participants
from plantar.gait.analysis.study.run_study import Study, run_study
from plantar.gait.analysis.study.study_page import study_page
from plantar.layouts.layout_file import layout_to_dict, write_layout

from ..browser import visit
from ..printing import printed_images
from ..test_report_in_browser import READABLE, whole
from ..walks import made_walk


def write_walk(path: Path, **options: object) -> None:
    """The left foot of a made walk as an NPZ file that holds its layout."""
    recording = made_walk(rate=50.0, strides=5, **options).recording
    layout = json.dumps(layout_to_dict(nominal_insole("x", "left")))
    np.savez(path, time=recording.time, unit="N", layout_left=layout, left=recording.feet["left"].force)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Eight people in two shoes; the second loads 18 % less. A damaged file, a file that is not there, a text."""
    folder = tmp_path_factory.mktemp("study") / "recordings"
    folder.mkdir()
    random = np.random.default_rng(8)
    lines = ["file,participant,condition,mass_kg,foot_length_mm,age"]
    for who in range(8):
        weight, stance = random.normal(700.0, 60.0), random.normal(0.62, 0.01)
        for condition, gain in (("flat", 1.0), ("rocker", 0.82)):
            name = f"p{who}_{condition}.npz"
            share = gain * random.normal(1.0, 0.02)
            write_walk(folder / name, weight=weight * share, stance=stance, seed=who, noise=0.2)
            lines.append(f"{name},p{who},{condition},{weight / GRAVITY:.2f},265,{30 + who}")
    (folder / "damaged.npz").write_bytes((folder / "p0_flat.npz").read_bytes()[:2000])
    (folder / "<script>alert(1)</script>.csv".replace("/", "-")).write_text("nothing\nof use\n")
    lines += ["damaged.npz,p8,flat,70,,40", "gone.npz,p9,flat,70,,41"]
    table = folder / "participants.csv"
    table.write_text("\n".join(lines) + "\n")
    out = folder.parent / "out"
    return folder, out, run_study(folder, out, table)


def test_the_effect_is_found_with_its_sign_and_size(study):
    (comparison,) = study[2].comparisons
    assert (comparison.a, comparison.b, comparison.paired) == ("flat", "rocker", True)
    force = comparison.effects["peak_force_percent_bw"]
    assert force.difference / force.mean_a == pytest.approx(-0.18, abs=0.03)
    assert force.low < -0.18 * force.mean_a < force.high
    assert force.p_all < 0.05
    assert comparison.effects["contact_time_s"].p_all > 0.05
    assert abs(comparison.effects["contact_time_s"].difference) < 0.01
    assert comparison.curve_unit == "% of body weight"
    assert comparison.curve_test.significant[20:80].mean() > 0.9
    assert (comparison.map_test.t[comparison.map_test.significant] < 0.0).all()


def test_the_tables_are_tidy(study):
    _, out, result = study
    with (out / "steps.csv").open() as stream:
        steps = list(csv.DictReader(stream))
    assert len(steps) == 16 * 5
    one = steps[0]
    assert (one["participant"], one["condition"], one["age"], one["side"]) == ("p0", "flat", "30", "left")
    masses = {p.who.file: p.who.mass_kg for p in result.results}
    share = 100.0 * float(one["peak_force_N"]) / (masses[one["recording"]] or 0.0) / GRAVITY
    assert float(one["peak_force_percent_bw"]) == pytest.approx(share)
    assert float(one["cop_path_percent_foot"]) == pytest.approx(100.0 * float(one["cop_path_m"]) / 0.265)
    assert len(one["sha256"]) == 64
    assert json.loads(one["options"])["steps"] == "steady"
    with (out / "recordings.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    errors = {row["recording"]: row["error"] for row in rows if row["error"]}
    assert set(errors) == {"damaged.npz", "gone.npz", "<script>alert(1)<-script>.csv"}
    assert all(errors.values())
    assert len(rows) == 16 + 3
    columns = result.steps
    assert {len(column) for column in columns.values()} == {len(steps)}
    assert columns["peak_force_N"].dtype == float
    json.loads((out / "study.json").read_text())
    assert "<script>alert" not in (out / "study.html").read_text()


def test_a_study_goes_on_where_it_was(study, monkeypatch):
    folder, out, before = study
    calls: list[str] = []
    monkeypatch.setattr(module, "study_figures", lambda comparisons: [])
    measure = measured_recordings.measure_recording
    monkeypatch.setattr(measured_recordings, "measure_recording", lambda *a: calls.append(a[1].file) or measure(*a))
    told: list[str] = []
    again = run_study(folder, out, folder / "participants.csv", lambda fraction, text: told.append(text))
    assert set(calls) == {"damaged.npz", "gone.npz", "<script>alert(1)<-script>.csv"}
    assert again.summary() == before.summary()
    assert "1 of 19: p0_flat.npz" in told
    calls.clear()
    kept = next((out / "measured").glob("*.npz"))
    kept.write_bytes(kept.read_bytes()[:100])
    run_study(folder, out, folder / "participants.csv")
    assert len(calls) == 4
    who = before.results[0].who
    assert len({key_of(folder, who, "0", AnalysisOptions(steps=steps)) for steps in ("all", "steady", (1, 3))}) == 3


def test_a_layout_that_was_changed_under_its_name_makes_other_keys(tmp_path):
    square = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05))
    wide = grid_layout([[0, 0], [0.2, 0], [0.2, 0.2], [0, 0.2]], pitch=(0.05, 0.1))
    assert square.name == wide.name
    who, keys = Participation("a.npz", "a", layout="its.json"), set()
    for layout in (square, wide):
        write_layout(layout, tmp_path / "its.json")
        keys.add(key_of(tmp_path, who, "0", AnalysisOptions()))
        keys.add(key_of(tmp_path, replace(who, layout=None), "0", AnalysisOptions(), ReadOptions(layout=layout)))
    assert len(keys) == 4


def test_a_file_of_events_is_of_one_recording(study, tmp_path):
    folder, *_ = study
    choices = AnalysisOptions(events="events.csv")
    with pytest.raises(InputError, match=r"--events events\.csv: a file of events is of one recording, and a study"):
        run_study(folder, tmp_path / "out", choices=choices)
    with pytest.raises(InputError, match="and --compare takes several"):
        compare_recordings(folder / "a", folder / "b", tmp_path / "out", choices=choices)
    assert not (tmp_path / "out").exists()


def result_of(who: str, condition: str, value: float, curve: np.ndarray) -> RecordingResult:
    feet = {"left": {"steps": 12.0, "peak_force_N": value, "contact_time_s": value}}
    person = Participation(f"{who}{condition}", who, condition)
    return RecordingResult(person, "", "", "x", "", False, (), feet, {"left": curve}, {}, (), {})


def test_no_effect_stays_none_in_95_of_100_studies():
    random = np.random.default_rng(6)
    found = 0
    for _ in range(40):
        results = []
        for who in range(5):
            for condition in ("a", "b"):
                curve = random.normal(0.0, 1.0) + np.linspace(0.0, 1.0, 101) * random.normal(0.0, 1.0)
                results.append(result_of(f"p{who}", condition, random.normal(700.0, 50.0), curve))
        (comparison,) = compare_conditions(results)
        assert comparison.curve_test is not None
        found += any(e.p_all <= 0.05 for e in comparison.effects.values()) or comparison.curve_test.significant.any()
    assert found <= 8  # of 40 draws with two families at 0.05 each: more is one in 60


def test_conditions_of_unlike_sensors_are_compared_with_a_doubt():
    curve = np.zeros(101)
    results = [result_of(f"{who}", c, 700.0 + who, curve) for who in range(4) for c in ("mat", "shoe")]

    def doubts(**shoe: tuple[str, float]) -> list[str]:
        sensors = {"mat": ("a platform", 25e-6), **shoe}
        (comparison,) = compare_conditions([replace(r, sensor=sensors[r.who.condition]) for r in results])
        return list(comparison.doubts)

    assert doubts(shoe=("a platform", 25e-6)) == doubts(shoe=("a platform", 30e-6)) == []
    (kinds,), (cells,) = doubts(shoe=("insoles", 25e-6)), doubts(shoe=("a platform", 100e-6))
    assert kinds.startswith("mat is of a platform (cells of 25 mm2), shoe of insoles (cells of 25 mm2): differences")
    assert "shoe of a platform (cells of 100 mm2)" in cells


def test_too_few_participants_are_not_compared():
    curve = np.zeros(101)
    results = [result_of(f"{who}{c}", c, 1.0, curve) for who in range(2) for c in ("a", "b")]
    (comparison,) = compare_conditions(results)
    assert comparison.effects == {}
    assert "a has 2 and b 2 participants, 0 of them in both" in comparison.note


def test_maps_are_in_one_frame():
    """A hot cell under the hallux of either foot of any size is at the same place, medial and in front."""
    places = []
    for size, side in (("u", "left"), ("y", "right"), ("v", "left")):
        layout = nominal_insole(size, side)
        medial = np.array([1.0, 1.0 if side == "right" else -1.0])
        values = np.zeros(99)
        values[-4] = 1.0
        found = sampled(layout.positions[:, :2] * medial, values, layout.outline * medial)
        assert found.shape == GRID
        places.append(np.argwhere(found == 1.0).mean(axis=0) / GRID)
    assert np.ptp(places, axis=0).max() < 0.12
    assert np.min(places, axis=0)[0] > 0.85


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("file,participant\na,b\n", "no column condition"),
        ("file,participant,condition\n", "no rows"),
        ("file,participant,condition\na,b,c\na,d,e\n", "a is named twice"),
    ],
)
def test_a_table_that_is_no_table(tmp_path, text, message):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(FormatError, match=message):
        read_participants(tmp_path / "t.csv")


@pytest.mark.parametrize(
    ("name", "read"),
    [
        *((name, "mass_kg") for name in ("weight", "mass_lb", "body_weight", "Body weight (lb)", "bodymass_g")),
        *((name, "participant") for name in ("subject", "subject_name", "patients", "id", "Name")),
        *((name, "condition") for name in ("group", "cohort", "shoes")),
        *((name, None) for name in ("age", "height_m", "mass_kg", "rate_hz", "speed", "heart_rate", "foot_length_mm")),
        *(("sample_rate", "rate_hz"), ("foot_length_in", "foot_length_m"), ("units", "unit"), ("tested side", "side")),
    ],
)
def test_columns_that_look_like_others_are_told(tmp_path, name, read):
    (tmp_path / "t.csv").write_text(f"file,participant,condition,{name}\na.csv,P0,pre,250\n")
    (one,) = read_participants(tmp_path / "t.csv")
    result = replace(result_of("P0", "pre", 1.0, np.zeros(101)), who=one)
    told = Study([result], [], AnalysisOptions()).summary()["notes"]
    assert [note.endswith(f"allowed: {read!r}") for note in told] == [True] * (read is not None)


def test_values_of_a_table_are_checked(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("file;subject;group;mass_kg;side\na.asc;1;x;72,5;Left\n")
    (one,) = read_participants(path)
    assert (one.mass_kg, one.side, one.condition) == (72.5, "left", "x")
    for row, message in (("a;1;x;7000;", "mass_kg is '7000'; allowed: 2 to 400"), ("a;1;x;;both", "side is 'both'")):
        path.write_text(f"file;subject;group;mass_kg;side\n{row}\n")
        with pytest.raises(InputError, match=message):
            read_participants(path)
    path.write_text("file;subject;group;foot_length_mm\na;1;x;26\n")
    with pytest.raises(InputError, match="foot_length_mm is '26'; allowed: 50 to 450"):
        read_participants(path)
    assert normalised({"peak_force_N": 100.0}, Participation("a", "a")) == {}


def test_the_command_takes_a_folder(study, tmp_path):
    folder, _, _ = study
    few = tmp_path / "few"
    few.mkdir()
    (few / "a.npz").write_bytes((folder / "p0_flat.npz").read_bytes())
    done = CliRunner().invoke(app, ["analyze", str(few), "-o", str(tmp_path / "out"), "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["measured"] == 1
    (tmp_path / "out" / "measured" / "empty").mkdir()
    with pytest.raises(InputError, match="no recording in it"):
        run_study(tmp_path / "out" / "measured" / "empty", tmp_path / "none")


def page_with_figures(study: tuple[Path, Path, Study], folder: Path) -> Path:
    """The page of the study with its figures, which tests that run it again leave out."""
    _, out, result = study
    page = folder / "study.html"
    figures = [(out / f"{name}.png", name) for name in ("effects", "curves", "maps")]
    page.write_text(study_page(result.summary(), result.results, result.comparisons, figures, "shoes"))
    return page


@pytest.mark.drawn
def test_the_page_opens_on_a_telephone(study, tmp_path):
    """At 390 px: no error, nothing to be pulled aside, every text is legible, figures are there."""
    page = page_with_figures(study, tmp_path)
    seen = visit(page, READABLE, tmp_path, width=390)
    assert seen.console == []
    assert seen.found["weak"] == seen.found["unnamed"] == seen.found["outline"] == seen.found["axe"] == []
    assert seen.found["wide"] <= 0
    assert seen.found["cut"] == []
    assert page.read_text().count("<figure") == 3


@pytest.mark.drawn
@pytest.mark.long
def test_no_figure_of_the_page_is_cut_in_print(study, tmp_path):
    """Each figure lies whole on one sheet."""
    page = page_with_figures(study, tmp_path)
    images = printed_images(page, tmp_path)
    assert len(images) == page.read_text().count("<figure") == 3
    assert whole(images)


def test_a_study_is_one_line_and_a_figure_in_a_notebook(study):
    measured = study[2]
    assert "\n" not in repr(measured)
    assert len(repr(measured)) < 200
    assert re.fullmatch(r"Study\(\d+ of \d+ recordings measured, .* compared: \w+ with \w+\)", repr(measured))
    assert "data:image/png" in measured._repr_html_()
    assert "img" not in Study([], [], measured.choices)._repr_html_()
