"""Two recordings side by side."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import FormatError, InputError, cli, write_layout
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.compare import compare_recordings


def write_walk(path: Path, sides: tuple[str, ...], gain: float = 1.0, unit: str = "N") -> Path:
    """Eight contacts a foot, the forces a half sine over cells that are alike."""
    random = np.random.default_rng(1)
    time = np.arange(0.0, 9.0, 0.01)
    arrays = {}
    for side, offset in (("left", 0.2), ("right", 0.75)):
        phase = ((time - offset) % 1.1) / 0.65
        height = gain * (700.0 + 20.0 * np.floor((time - offset) / 1.1))
        total = np.where((phase < 1) & (time > offset), height * np.sin(np.pi * np.clip(phase, 0, 1)), 0.0)
        cells = total[:, None] * np.full(99, 1 / 99) + random.normal(0.0, 0.02, (len(time), 99))
        if side in sides:
            arrays[side] = np.maximum(cells, 0.0)
    np.savez(path, time=time, unit=unit, **arrays)
    return path


@pytest.fixture
def layout(tmp_path):
    return write_layout(nominal_insole("y", "left"), tmp_path / "layout.json")


@pytest.mark.drawn
def test_before_and_after(tmp_path, layout):
    a = write_walk(tmp_path / "before.npz", ("left", "right"))
    b = write_walk(tmp_path / "after.npz", ("left", "right"), 1.25)
    result = compare_recordings(a, b, tmp_path / "out", layout=layout)
    assert set(result["difference"]) == {"left", "right"}
    row = result["difference"]["left"]["peak_force_N"]
    assert row["percent"] == pytest.approx(25.0, abs=0.1)
    assert row["difference"] == pytest.approx(row["b"]["mean"] - row["a"]["mean"])
    pooled = np.sqrt(0.5 * (row["a"]["sd"] ** 2 + row["b"]["sd"] ** 2))
    assert row["effect_size"] == pytest.approx(row["difference"] / pooled, rel=1e-6)
    assert abs(result["difference"]["right"]["contact_time_s"]["percent"]) < 1.0
    names = {str(p.relative_to(tmp_path / "out")) for p in (tmp_path / "out").rglob("*") if p.is_file()}
    assert {"comparison.json", "report.html", "pressure.png", "steps.svg", "difference.png"} <= names
    assert {"a/report.html", "b/metrics.json"} <= names
    stored = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert stored == {k: v for k, v in result.items() if k != "files"}
    page = (tmp_path / "out" / "report.html").read_text()
    assert "before.npz" in page
    assert 'href="a/report.html"' in page


def test_left_against_right(tmp_path, layout):
    a = write_walk(tmp_path / "l.npz", ("left",))
    b = write_walk(tmp_path / "r.npz", ("right",), 2.0)
    arguments = ["analyze", "--compare", str(a), str(b), "--layout", str(layout), "-o", str(tmp_path / "out"), "--json"]
    done = CliRunner().invoke(cli.app, arguments)
    assert done.exit_code == 0, done.output
    result = json.loads(done.stdout)
    assert list(result["difference"]) == ["left and right"]
    assert result["difference"]["left and right"]["impulse_Ns"]["percent"] == pytest.approx(100.0, abs=3.0)


@pytest.mark.parametrize("option", ["--no-figures", "--json"])
@pytest.mark.parametrize("what", ["one", "two", "study"])
def test_tables_alone_are_written(tmp_path, what, option):
    (tmp_path / "walks").mkdir()
    path = str(write_walk(tmp_path / "walks" / "a.npz", ("left", "right")))
    given = {"one": [path], "two": ["--compare", path, path], "study": [str(tmp_path / "walks")]}[what]
    done = CliRunner().invoke(cli.app, ["analyze", *given, option, "-o", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    assert {p.suffix for p in (tmp_path / "out").rglob("*") if p.is_file()} <= {".csv", ".json", ".npz"}
    assert "report.html" not in done.stdout + done.stderr


def test_other_sensors_are_told(tmp_path, layout):
    """Insoles with plates, and cells of another size; the same insoles without a word."""
    a, plates = write_walk(tmp_path / "a.npz", ("left", "right")), tmp_path / "plates.csv"
    with np.load(a) as held:
        table = np.column_stack([held["time"], held["left"].sum(axis=1), held["right"].sum(axis=1)])
    np.savetxt(plates, table, delimiter=",", header="time (s),left Fz (N),right Fz (N)", comments="")
    result = compare_recordings(a, plates, tmp_path / "out")
    assert result["warnings"][0].startswith("A is of insoles (no cells), B of force plates (no cells): differences may")
    assert "A is of insoles" in (tmp_path / "out" / "report.html").read_text()
    done = CliRunner().invoke(
        cli.app, ["analyze", "--compare", str(a), str(plates), "--no-figures", "-o", str(tmp_path / "no")]
    )
    assert "note: A is of insoles (no cells), B of force plates" in done.stderr
    assert compare_recordings(a, a, tmp_path / "same", layout=layout, figures=False)["warnings"] == []


def test_what_cannot_be_compared(tmp_path, layout):
    a = write_walk(tmp_path / "a.npz", ("left",))
    b = write_walk(tmp_path / "b.npz", ("left",), unit="raw")
    with pytest.raises(InputError, match="cannot be compared"):
        compare_recordings(a, b, tmp_path / "out", layout=layout)
    with pytest.raises(FormatError, match="cannot be read"):
        compare_recordings(a, tmp_path / "none", tmp_path / "out")
    assert not (tmp_path / "out").exists()
    for arguments, text in (
        (["analyze"], "give either one recording or --compare A B"),
        (["analyze", str(a), "--compare", str(a), str(b)], "give either one recording or --compare A B"),
        (["analyze", str(a), "--side", "up"], "allowed: left, right"),
        (["analyze", str(a), "--mm-per-pixel", "1"], "is for footprint images"),
    ):
        done = CliRunner().invoke(cli.app, [*arguments, "-o", str(tmp_path / "out")])
        assert isinstance(done.exception, InputError)
        assert text in str(done.exception)
    assert not (tmp_path / "out").exists()
