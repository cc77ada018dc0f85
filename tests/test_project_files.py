"""The files around the code: workflows, citation and licences agree with what they speak of."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

import plantar

yaml = pytest.importorskip("yaml")

ROOT = Path(__file__).resolve().parent.parent
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def steps(workflow: Path) -> list[dict[str, Any]]:
    """All steps of a workflow's jobs."""
    jobs = yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"]
    return [step for job in jobs.values() for step in job["steps"]]


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda w: w.stem)
def test_what_a_workflow_runs_is_there(workflow):
    for step in steps(workflow):
        words = str(step.get("run", "")).split()
        paths = [w for w in words if re.fullmatch(r"(\.ci|tools|tests|plantar)/[\w./]+", w)]
        assert [p for p in paths if not (ROOT / p).exists()] == []
        for extras in re.findall(r"\.\[([\w,]+)\]", str(step.get("run", ""))):
            known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
            assert set(extras.split(",")) <= set(known)


def test_every_job_ends_by_itself_and_may_write_only_where_it_says_so():
    assert {w.stem for w in WORKFLOWS} == {"tests", "docs", "release", "stranger"}
    for workflow in WORKFLOWS:
        content = yaml.safe_load(workflow.read_text(encoding="utf-8"))
        assert content["permissions"] == {"contents": "read"}
        for name, job in content["jobs"].items():
            assert "timeout-minutes" in job or name in ("deploy", "publish")


def test_the_pythons_of_the_workflow_are_those_of_the_wheels_and_not_older_than_declared():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    tested = yaml.safe_load((ROOT / ".github/workflows/tests.yml").read_text())["jobs"]["tests"]["strategy"]["matrix"]
    built = [f"{w[2]}.{w[3:5]}" for w in project["tool"]["cibuildwheel"]["build"].split()]
    assert tested["python"] == built
    assert project["project"]["requires-python"] == f">={built[0]}"


def test_the_oldest_mujoco_has_what_the_sources_call():
    """Before 3.10 `mj_fullM` takes no MjData, and before 3.4 no model lets bodies sleep."""
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]["sim"]
    oldest = next(re.fullmatch(r"mujoco>=(\d+)\.(\d+)", text) for text in needed if text.startswith("mujoco"))
    assert (int(oldest[1]), int(oldest[2])) >= (3, 10)


def test_the_citation_names_this_version_and_licence():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["version"] == plantar.__version__
    assert cited["license"] == tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["license"]


def test_the_licences_of_all_dependencies_are_told():
    done = subprocess.run([sys.executable, "tools/licences.py", "--check"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda w: w.stem)
def test_actions_are_pinned_by_their_hash_and_say_their_version(workflow):
    used = re.findall(r"uses: (.*)", workflow.read_text(encoding="utf-8"))
    assert used
    assert [line for line in used if not re.fullmatch(r"[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", line)] == []


def test_the_bill_of_materials_names_all_that_is_pinned(tmp_path):
    subprocess.run([sys.executable, "tools/sbom.py", str(tmp_path / "a.json")], cwd=ROOT, check=True)
    bill = json.loads((tmp_path / "a.json").read_text())
    names = {component["name"].lower() for component in bill["components"]}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = [*project["dependencies"], *(x for e in project["optional-dependencies"].values() for x in e)]
    direct = {re.split(r"[\[<>=~! ]", line)[0].lower() for line in lines}
    assert direct - {"plantar"} <= names
    assert all(component["licenses"][0]["license"] for component in bill["components"])


def test_no_declared_floor_has_a_published_vulnerability():
    # CVE-2026-23528 (distributed), CVE-2025-66034 (fonttools), CVE-2025-47273 (setuptools): fixed from these on.
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    text = " ".join(
        [*project["build-system"]["requires"], *map(str, project["project"]["optional-dependencies"].values())]
    )
    for name, fixed in (("distributed", (2026, 1, 1)), ("fonttools", (4, 60, 2)), ("setuptools", (78, 1, 1))):
        floors = re.findall(rf"{name}>=([\d.]+)", text)
        assert floors
        assert all(tuple(map(int, floor.split("."))) >= fixed for floor in floors)
