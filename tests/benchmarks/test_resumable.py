"""Tables of outcomes: which runs are asked for, which rows count."""

import csv
import importlib.util
import re
import sys
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def resumable(monkeypatch):
    spec = importlib.util.spec_from_file_location("resumable", FOLDER / "resumable.py")
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "resumable", module)
    spec.loader.exec_module(module)
    return module


def row(seed: int, completed: bool, plant: str = "ordinary", commit: str = "made") -> dict[str, Any]:
    named = {"case": "a", "robot": "h1", "plant": plant, "seed": seed}
    return {**named, "completed": completed, "failed": "", "commit": commit}


def benchmark(resumable: Any, path: Path, rows: list[dict[str, Any]], aside: bool = False) -> Any:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, ("case", "robot", "plant", "seed", "completed", "failed", "commit"))
        writer.writeheader()
        writer.writerows(rows)
    case = resumable.Case("a", "flat", "h1", (), 6, aside, plants=("ordinary", "exact"))
    return resumable.Benchmark(path.stem, {}, [case], folder=path.parent)


def test_seeds_are_drawn_from_the_commit_the_same_for_all_cases(resumable):
    first, other = resumable.drawn_seeds("1234567", 8), resumable.drawn_seeds("1234568", 8)
    assert first == resumable.drawn_seeds("1234567", 10)[:8]
    assert len({*first, *other}) == 16
    assert all(0 <= seed < 2**32 for seed in first)


def test_what_is_missing_is_asked_for_on_both_plants_drawn_ones_first(resumable, tmp_path):
    seeds = resumable.drawn_seeds("made", 6)
    runs = sorted(resumable.wanted(benchmark(resumable, tmp_path / "a.csv", []), "made"), key=lambda r: r[0])
    assert [run for _, _, run in runs][:4] == [(p, s) for s in seeds[:2] for p in ("ordinary", "exact")]
    assert {run for _, _, run in runs} == {(p, s) for s in seeds for p in ("ordinary", "exact")}
    some = [row(seeds[0], True), row(seeds[3], False, "exact")]
    left = {run for _, _, run in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", some), "made")}
    assert len(left) == 10
    assert ("ordinary", seeds[3]) in left  # a row on the exact plant is none of this one
    other = {run for _, _, run in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", some), "later")}
    assert len(other) == 12  # another commit draws others


def test_comparisons_come_later_a_few_of_each_first(resumable, tmp_path):
    aside = {run: rank for rank, _, run in resumable.wanted(benchmark(resumable, tmp_path / "a.csv", [], True), "made")}
    plain = {run: rank for rank, _, run in resumable.wanted(benchmark(resumable, tmp_path / "b.csv", []), "made")}
    seeds = resumable.drawn_seeds("made", 6)
    few, rest = seeds[: resumable.FEW], seeds[resumable.FEW :]
    assert max(plain["ordinary", s] for s in few) < min(aside["ordinary", s] for s in few)
    assert max(aside["exact", s] for s in few) < min(plain["ordinary", s] for s in rest)


def test_completed_runs_are_counted_by_plant_with_their_interval(resumable, tmp_path):
    rows = [row(0, True), row(1, True), row(1, False, commit="new"), row(7, True, "exact")]
    texts = [{k: str(v) for k, v in r.items()} for r in rows]
    assert (resumable.counted(texts), resumable.counted(texts, ["exact"])) == ("1/2 (9-91)", "1/1 (21-100)")
    assert (resumable.counted(texts[:2]), resumable.counted(texts[:2], ["exact"])) == ("2/2 (34-100)", "-")
    assert {r["seed"] for r in resumable.of_now(texts)} == {"0", "1"}
    assert resumable.of_now(texts[3:]) == texts[3:]
    text = resumable.origin(benchmark(resumable, tmp_path / "a.csv", rows))
    assert text == "Runs by commit: 2 of made, 1 of new."


def test_a_row_is_added_to_a_file_of_older_rows(resumable, tmp_path, monkeypatch):
    path = tmp_path / "a.csv"
    path.write_text("case,robot,seed,completed,failed,commit\na,h1,3,True,,old\n")
    monkeypatch.setattr(resumable, "run_row", lambda *_: row(5, False))
    case = resumable.Case("a", "flat", "h1", (), 6)
    resumable.add_row(resumable.Benchmark("a", {}, [case], folder=tmp_path), case, ("ordinary", 5), "made")
    older, newer = resumable.rows_of(path)
    assert (older["plant"], older["seed"], older["commit"]) == ("", "3", "old")
    assert (newer["plant"], newer["seed"], newer["completed"]) == ("ordinary", "5", "False")


def test_the_index_names_every_page_and_every_page_its_command():
    index = (FOLDER / "README.md").read_text(encoding="utf-8")
    pages = {p.name for p in FOLDER.glob("*.md")} - {"README.md"}
    assert pages == set(re.findall(r"\]\((\w+\.md)\)", index))
    for page in pages:
        text = (FOLDER / page).read_text(encoding="utf-8")
        assert re.search(r"plantar (bench|sweep)|make bench|python\s+benchmarks/\w+\.py", text), page


def test_every_case_of_the_tables_is_a_scene_that_loads(resumable, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    from plantar.sim.run.scene import load_scene

    for name in (
        "balance",
        "unknown_ground",
        "guide",
        "parts",
        "walks",
        "push_steps",
    ):
        monkeypatch.delitem(sys.modules, name, raising=False)
        script = __import__(name)
        names = [(case.name, case.robot) for case in script.BENCHMARK.cases]
        assert len(set(names)) == len(names)
        for case in script.BENCHMARK.cases:
            load_scene(case.scene, case.settings, case.robot)
        made = {(r["case"], r["robot"]) for r in resumable.rows_of(script.BENCHMARK.path) if r.get("plant")}
        assert made <= set(names)
        monkeypatch.delitem(sys.modules, name)
