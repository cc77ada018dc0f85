"""Rows, verdicts, page and figure from made-up runs."""

import csv
from pathlib import Path
from typing import Any

import pytest

from plantar.bench.kind import BenchOptions
from plantar.bench.page import tables_text, write_page
from plantar.errors import InputError
from plantar.sim.bench.runner import run_kind
from plantar.sim.bench.scenes.scene_row import NOISE, knob_verdicts, scene_rows
from plantar.sim.bench.scenes.scene_runs import COLUMNS, KEYS
from plantar.sim.bench.scenes.scenes_report import SCENES

OWN, FINE, COARSE = "scene's own", "reference", "physics step: 1.67 ms"


def run(setting: str, kind: str, cpu: float, com: float = 0.0, seed: int = 1, **named: Any) -> dict[str, str]:
    against = {"seeded": "", "noise": OWN}.get(kind, FINE)
    row = {"scene": "flat", "robot": "h1", "walk": "steps=4", "setting": setting, "against": against, "kind": kind}
    row |= {"seed": seed, "sim_s": 10.0, "cpu_s": cpu, "completed": "yes", "impact_N": 300.0, "margin_mm": 20.0}
    if kind != "seeded":
        row |= {"com_mm": com, "zmp_mm": com, "force": 0.01 * com, "impact": 0.1, "together_s": 10.0}
    return {name: str(value) for name, value in {**dict.fromkeys((*KEYS, *COLUMNS), ""), **row, **named}.items()}


def runs(coarse_error: float, coarse_cpu: float = 1.0, own_error: float = 0.5) -> list[dict[str, str]]:
    return [
        run(OWN, "traced", 2.0, own_error),
        run(FINE, "traced", 9.0),
        run(COARSE, "traced", coarse_cpu, coarse_error),
        run(OWN, "noise", 2.0, 1.0),
        run(OWN, "seeded", 4.0),
        run(COARSE, "seeded", 2.0 * coarse_cpu),
        run(OWN, "seeded", 2.0, seed=2),
        run(COARSE, "seeded", coarse_cpu, seed=2),
    ]


def test_costs_are_ratios_of_the_same_seed_and_kind():
    rows = {r.setting: r for r in scene_rows(runs(0.7))}
    assert list(rows) == [OWN, FINE, COARSE, NOISE]
    assert (rows[COARSE].ratio, rows[COARSE].cpu) == (0.5, 0.1)
    assert rows[FINE].ratio == 4.5
    assert (rows[COARSE].completed, rows[COARSE].seeds, rows[COARSE].com_mm) == (2, 2, 0.7)
    assert (rows[OWN].ratio, rows[FINE].seeds) == (1.0, 0)


@pytest.mark.parametrize(
    ("coarse", "cpu", "own", "stays", "words"),
    [
        (0.7, 1.0, 0.5, False, "would do: 50 % less time"),
        (1.2, 1.0, 0.5, True, "saves 50 % but: CoM 1.20 mm"),
        (0.7, 1.95, 0.5, True, "nothing else saves"),
        (0.7, 3.0, 1.5, False, "at 1.50 x"),
        (1.2, 3.0, 1.5, True, "so does all else"),
    ],
)
def test_verdicts_go_by_noise_and_time(coarse, cpu, own, stays, words):
    (verdict,) = knob_verdicts(scene_rows(runs(coarse, cpu, own)))
    assert (verdict.knob, verdict.stays) == ("physics step", stays)
    assert words in verdict.reason


@pytest.mark.parametrize(("error", "words"), [(0.5, "no more than noise"), (1.5, "more than noise")])
def test_what_the_machine_has_is_kept_and_what_finer_would_do_is_reported(error, words):
    fine, slow = "skin rate: 1000 Hz", "skin rate: 50 Hz"
    more = [run(OWN, "traced", 2.0, error, against=fine), run(slow, "traced", 1.0, 0.1, against=fine)]
    verdict = next(v for v in knob_verdicts(scene_rows([*runs(1.2), *more])) if v.knob == "skin rate")
    assert verdict.stays
    assert f": {words}" in verdict.reason


def test_a_cheaper_setting_that_falls_or_parts_will_not_do():
    for change in ({"completed": "no: fall"}, {"together_s": "3.0"}):
        rows = [{**r, **change} if r["setting"] == COARSE and r["kind"] == "traced" else r for r in runs(0.7)]
        (verdict,) = knob_verdicts(scene_rows(rows))
        assert verdict.stays
    rows = [{**r, "completed": "no: fall"} if r["setting"] == COARSE and r["seed"] == "2" else r for r in runs(0.7)]
    assert knob_verdicts(scene_rows(rows))[0].stays


def test_files_report_what_was_run(tmp_path):
    finding = SCENES.find(runs(0.7), BenchOptions())
    assert write_page(tmp_path, SCENES, finding) == ["scenes.md", "scenes.png", "scenes.csv"]
    page = (tmp_path / "scenes.md").read_text()
    assert "| flat | h1 | physics step | **a better one** |" in page
    assert "nan" not in page
    with (tmp_path / "scenes.csv").open() as table:
        assert [r["setting"] for r in csv.DictReader(table)] == [OWN, FINE, COARSE, NOISE]
    assert tables_text(finding) in page
    assert finding.result["rows"][0]["setting"] == OWN
    assert not finding.failures


def test_a_foreign_table_is_refused(tmp_path):
    (tmp_path / "scene_runs.csv").write_text("time,force\n")
    with pytest.raises(InputError, match="has other columns than scene,robot"):
        run_kind(SCENES, BenchOptions(quick=True), tmp_path, lambda *_: None)


@pytest.mark.parametrize(("scene", "robot"), [("beem", "h1"), ("flat", "h2")])
def test_an_unknown_walk_is_refused_before_anything_is_written(tmp_path: Path, scene: str, robot: str):
    with pytest.raises(InputError, match="allowed: "):
        run_kind(SCENES, BenchOptions(scene=(scene,), robot=(robot,)), tmp_path / "out", lambda *_: None)
    assert not (tmp_path / "out").exists()
