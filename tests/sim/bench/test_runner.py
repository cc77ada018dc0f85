"""One runner for all kinds of `plantar bench`: what is measured, written and refused."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from plantar import cli
from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable
from plantar.errors import InputError
from plantar.sim.bench import runner
from plantar.sim.bench.runner import KINDS, run_bench


def kind(measured: list[str], resumes: bool, failures: tuple[str, ...] = ()) -> Kind:
    """Two cases of two rows, which take no time."""

    def measure(name: str) -> list[dict[str, Any]]:
        measured.append(name)
        return [{"value": 1, "parts": {"a": 2}}] if not resumes else [{"value": 1}]

    return Kind(
        page="made",
        title="Made up",
        lead="What it is.",
        table="made_rows.csv",
        keys=("name",),
        columns=("value",) if resumes else ("value", "parts"),
        cases=lambda options: [Case((name,), partial(measure, name)) for name in ("x", "y")],
        find=lambda rows, options: Finding(
            {"rows": [dict(row) for row in rows]},
            [PageTable("Values", ("name", "value"), [(r["name"], r["value"]) for r in rows])],
            failures,
        ),
        resumes=resumes,
    )


@pytest.fixture
def of_kind(monkeypatch):
    """Makes every kind a made-up one."""

    def replace(made: Kind) -> None:
        monkeypatch.setattr(runner, "resolve_name", lambda place: made)

    return replace


def test_a_kind_that_continues_measures_what_is_missing(of_kind, tmp_path):
    measured: list[str] = []
    of_kind(kind(measured, resumes=True))
    (tmp_path / "made_rows.csv").write_text("name,value\nx,1\ny,")  # killed while it wrote
    done = run_bench("scenes", BenchOptions(), tmp_path)
    assert measured == ["y"]
    assert done.result["rows"] == [{"name": "x", "value": "1"}, {"name": "y", "value": "1"}]
    assert json.loads((tmp_path / "bench.json").read_text()) == done.result
    assert {Path(name).name for name in done.result["files"]} == {"made.md", "made_rows.csv", "bench.json"}
    assert all(Path(name).is_file() for name in done.result["files"])
    assert "| x | 1 |" in (tmp_path / "made.md").read_text()


def test_the_others_measure_everything_again(of_kind, tmp_path):
    measured: list[str] = []
    of_kind(kind(measured, resumes=False, failures=("the check did not hold",)))
    for _ in range(2):
        done = run_bench("kernels", BenchOptions(quick=True), tmp_path)
    assert measured == ["x", "y"] * 2
    assert done.result["kernels"]["rows"][0] == {"name": "x", "value": 1, "parts": {"a": 2}}
    assert done.failures == ("the check did not hold",)
    assert (tmp_path / "made_rows.csv").read_text() == "name,value,parts: a\nx,1,2\ny,1,2\n"
    assert set(run_bench("all", BenchOptions(), tmp_path).result) == {"kernels", "skip", "files"}


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ((), "give what to measure"),
        (("speed",), "allowed: kernels, scenes, skip, stress, footholds, all"),
        (("contact",), "cannot measure 'contact'"),
        (("all", "--scene", "flat"), "--scene is for scenes and footholds, not 'all'"),
        (("skip", "--robot", "h1"), "not 'skip'"),
        (("scenes", "--scenarios", "3"), "--scenarios is for stress, not 'scenes'"),
    ],
)
def test_what_is_wrong_is_refused_before_anything_is_written(words, line, tmp_path):
    result = CliRunner().invoke(cli.app, ["bench", *words, "-o", str(tmp_path / "out")])
    assert isinstance(result.exception, InputError)
    assert line in str(result.exception)
    assert not (tmp_path / "out").exists()


@pytest.mark.long
@pytest.mark.parametrize("what", KINDS)
def test_every_kind_runs_quickly_and_writes_its_files(what, tmp_path):
    result = CliRunner().invoke(cli.app, ["bench", what, "--quick", "-o", str(tmp_path), "--json"])
    assert result.exit_code == 0, result.output
    summary = json.loads(result.stdout)
    assert all(Path(name).is_file() for name in summary["files"])
