"""Tables of outcomes: which runs are asked for, which rows count."""

from __future__ import annotations

import csv
import importlib.util
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


def row(seed: int, completed: bool, commit: str, case: str = "a") -> dict[str, Any]:
    return {"case": case, "robot": "h1", "seed": seed, "completed": completed, "failed": "", "commit": commit}


def benchmark(resumable: Any, path: Path, rows: list[dict[str, Any]], aside: bool = False) -> Any:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, ("case", "robot", "seed", "completed", "failed", "commit"))
        writer.writeheader()
        writer.writerows(rows)
    case = resumable.Case("a", "flat", "h1", (), 6, aside)
    return resumable.Benchmark(path, (), [case], lambda *_: {})


def test_fresh_seeds_and_four_old_ones_are_asked_for(resumable: Any, tmp_path: Path) -> None:
    old = [row(k, True, resumable.OLD) for k in range(6)]
    runs = [(rank, seed) for rank, _, seed in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", old))]
    assert sorted(runs) == sorted([(k, 1000 + k) for k in range(10)] + [(k, k) for k in range(4)])
    aside = resumable.wanted(benchmark(resumable, tmp_path / "a.csv", old, aside=True))
    assert sorted(seed for _, _, seed in aside) == [0, 1, 2, 3, 1000, 1001, 1002, 1003]


def test_a_verdict_that_changed_asks_for_the_whole_row(resumable: Any, tmp_path: Path) -> None:
    rows = [row(k, True, resumable.OLD) for k in range(6)]
    same = [*rows, *(row(k, True, "new") for k in (0, 1, 2, 3, *resumable.FRESH))]
    assert not list(resumable.wanted(benchmark(resumable, tmp_path / "a.csv", same)))
    other = [*rows, *(row(k, k != 2, "new") for k in (0, 1, 2, 3, *resumable.FRESH))]
    assert [seed for _, _, seed in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", other))] == [4, 5]


def test_the_last_row_of_a_seed_counts_and_old_ones_are_marked(resumable: Any) -> None:
    rows = [{k: str(v) for k, v in row(s, True, resumable.OLD).items()} for s in range(3)]
    assert resumable.count(rows, fresh=False) == "3/3 (old)"
    assert resumable.count(rows, fresh=True) == "-"
    rows.append({k: str(v) for k, v in row(1, False, "new").items()})
    assert resumable.count(rows, fresh=False) == "2/3 (1 again)"
    rows += [{k: str(v) for k, v in row(s, True, "new").items()} for s in (0, 2, 1000, 1001)]
    assert resumable.count(rows, fresh=False) == "2/3"
    assert resumable.count(rows, fresh=True) == "2/2"


def test_every_case_of_the_tables_is_a_scene_that_loads(resumable: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(FOLDER))
    from sim.run.scene import load_scene

    for name in ("balance", "footholds", "push", "unknown_ground"):
        monkeypatch.delitem(sys.modules, name, raising=False)
        script = __import__(name)
        names = [(case.name, case.robot) for case in script.BENCHMARK.cases]
        assert len(set(names)) == len(names)
        for case in script.BENCHMARK.cases:
            load_scene(case.scene, case.settings, case.robot)
        made = {(r["case"], r["robot"]) for r in resumable.rows_of(script.BENCHMARK.path)}
        assert made <= set(names)
        monkeypatch.delitem(sys.modules, name)
