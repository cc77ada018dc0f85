"""Tables of outcomes: which runs are asked for, which rows count."""

from __future__ import annotations

import csv
import importlib.util
import re
import sys
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def resumable(monkeypatch: pytest.MonkeyPatch) -> Any:
    spec = importlib.util.spec_from_file_location("resumable", FOLDER / "resumable.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "resumable", module)
    spec.loader.exec_module(module)
    return module


def row(seed: int, completed: bool, commit: str = "made", case: str = "a") -> dict[str, Any]:
    return {"case": case, "robot": "h1", "seed": seed, "completed": completed, "failed": "", "commit": commit}


def benchmark(resumable: Any, path: Path, rows: list[dict[str, Any]], aside: bool = False) -> Any:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, ("case", "robot", "seed", "completed", "failed", "commit"))
        writer.writeheader()
        writer.writerows(rows)
    case = resumable.Case("a", "flat", "h1", (), 6, aside)
    return resumable.Benchmark(path, (), [case], lambda *_: {})


def test_what_is_missing_is_asked_for_and_fresh_seeds_come_first(resumable: Any, tmp_path: Path) -> None:
    runs = list(resumable.wanted(benchmark(resumable, tmp_path / "a.csv", [])))
    assert [seed for _, _, seed in sorted(runs, key=lambda r: r[0])] == [*range(1000, 1010), *range(6)]
    some = [row(k, True) for k in (0, 3, 1001)]
    left = [seed for _, _, seed in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", some))]
    assert sorted(left) == sorted({*range(1000, 1010), *range(6)} - {0, 3, 1001})


def test_comparisons_come_last_a_few_of_each_first(resumable: Any, tmp_path: Path) -> None:
    aside = benchmark(resumable, tmp_path / "a.csv", [], aside=True)
    ranks = {seed: rank for rank, _, seed in resumable.wanted(aside)}
    whole = max(rank for rank, *_ in resumable.wanted(benchmark(resumable, tmp_path / "b.csv", [])))
    assert min(ranks.values()) > whole
    few = {*range(resumable.FEW), *range(1000, 1000 + resumable.FEW)}
    assert max(ranks[s] for s in few) < min(ranks[s] for s in set(ranks) - few)


def test_the_last_row_of_a_seed_counts(resumable: Any, tmp_path: Path) -> None:
    rows = [row(0, True), row(1, True), row(1, False, "new"), row(1000, True, "new")]
    told = [{k: str(v) for k, v in r.items()} for r in rows]
    assert resumable.count(told, fresh=False) == "1/2"
    assert resumable.count(told, fresh=True) == "1/1"
    assert resumable.count(told[:2], fresh=True) == "-"
    made = resumable.origin(benchmark(resumable, tmp_path / "a.csv", rows))
    assert made == "Runs by commit: 2 of new, 1 of made. Still to be run: 13."


def test_the_index_names_every_page_and_every_page_its_command() -> None:
    index = (FOLDER / "README.md").read_text(encoding="utf-8")
    pages = {p.name for p in FOLDER.glob("*.md")} - {"README.md"}
    assert pages == set(re.findall(r"\]\((\w+\.md)\)", index))
    for page in pages:
        text = (FOLDER / page).read_text(encoding="utf-8")
        assert re.search(r"plantar (bench|sweep)|make bench|python\s+benchmarks/\w+\.py", text), page


def test_every_case_of_the_tables_is_a_scene_that_loads(resumable: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(FOLDER))
    from plantar.sim.run.scene import load_scene

    for name in ("balance", "footholds", "push", "unknown_ground", "velocity", "stones", "guide", "force_only"):
        monkeypatch.delitem(sys.modules, name, raising=False)
        script = __import__(name)
        names = [(case.name, case.robot) for case in script.BENCHMARK.cases]
        assert len(set(names)) == len(names)
        for case in script.BENCHMARK.cases:
            load_scene(case.scene, case.settings, case.robot)
        made = {(r["case"], r["robot"]) for r in resumable.rows_of(script.BENCHMARK.path)}
        assert made <= set(names)
        monkeypatch.delitem(sys.modules, name)
