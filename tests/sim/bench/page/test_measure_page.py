"""`plantar bench all` from parts that take no time: what is measured, how often, and what is written."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest

import plantar.bench.report
import plantar.sim.bench.page.measure_page
import plantar.sim.bench.skipping
import plantar.sim.contact_models.report
from plantar import cli
from plantar.sim.bench.scenes.scene_runs import COLUMNS, TABLE

from .test_bench_page import RESULT


@pytest.fixture
def asked(monkeypatch):
    """What each part was asked for; the parts give made-up results and write a file each."""
    seen: dict[str, Any] = {}

    def part(module: Any, function: str, name: str) -> None:
        def measure(*args: Any, **named: Any) -> dict[str, Any]:
            seen[name] = (args, named)
            files = []
            if isinstance(args[0], Path):
                (args[0] / f"{name}.md").write_text(name)
                files = [f"{name}.md"]
            extra = {"holds": True} if name == "contact" else {"same_motion": True} if name == "skip" else {}
            return {**RESULT[name], **extra, "files": files}

        monkeypatch.setattr(module, function, measure)

    part(plantar.bench.report, "measure_kernels", "kernels")
    part(plantar.sim.contact_models.report, "measure_contact", "contact")
    part(plantar.sim.bench.skipping, "measure_skipping", "skip")
    part(plantar.sim.bench.page.measure_page, "measure_scenes", "scenes")
    part(plantar.sim.bench.page.measure_page, "measure_papers", "papers")
    monkeypatch.setattr("plantar.sim.contact_models.report.contact_text", lambda _: "contact")
    return seen


def bench(monkeypatch: pytest.MonkeyPatch, *words: str) -> int:
    monkeypatch.setattr(sys, "argv", ["plantar", "bench", *words])
    with pytest.raises(SystemExit) as end:
        cli.main()
    return int(end.value.code or 0)


@pytest.mark.parametrize("quick", [False, True])
def test_all_ends_in_a_page(quick, asked, tmp_path, monkeypatch, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / TABLE).write_text(",".join(COLUMNS) + "\n")
    assert bench(monkeypatch, "all", *(["--quick"] if quick else []), "-o", str(out), "--json") == 0
    assert asked["kernels"][1] == {"rounds": 3 if quick else 9}
    assert asked["skip"][0][3] == (1 if quick else 3)
    assert len(asked["skip"][0][2]) == (1 if quick else 6)
    assert asked["scenes"][1] == {"quick": True}
    assert asked["papers"][1] == {"quick": quick}
    told = json.loads(capsys.readouterr().out)
    page = (out / "bench.html").read_text(encoding="utf-8")
    assert page.count("<section") == 5
    assert ("a quick run" in page) == quick
    names = {Path(name).name for name in told["files"]}
    assert names == {"kernels.md", "contact.md", "skip.md", "scenes.md", "bench.html", "bench.json"}
    assert names | {TABLE} == {p.name for p in out.iterdir()}
    assert json.loads((out / "bench.json").read_text())["papers"] == RESULT["papers"]


@pytest.mark.parametrize(
    "words",
    [
        ("kernels", "--quick"),
        ("all", "--scene", "flat"),
        ("skip", "--robot", "h1"),
        ("contact", "--scenarios", "3"),
        ("stress", "--layout", "sole.json"),
    ],
)
def test_options_of_other_parts_are_refused(words, tmp_path, monkeypatch, capsys):
    assert bench(monkeypatch, *words, "-o", str(tmp_path / "out")) == 2
    assert f"not '{words[0]}'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
