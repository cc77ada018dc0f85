"""The files around the code: workflows, citation and licences agree with what they speak of."""

from __future__ import annotations

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
def test_what_a_workflow_runs_is_there(workflow: Path) -> None:
    for step in steps(workflow):
        words = str(step.get("run", "")).split()
        paths = [w for w in words if re.fullmatch(r"(\.ci|tools|tests|plantar)/[\w./]+", w)]
        assert [p for p in paths if not (ROOT / p).exists()] == []
        for extras in re.findall(r"\.\[([\w,]+)\]", str(step.get("run", ""))):
            known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
            assert set(extras.split(",")) <= set(known)


def test_every_job_ends_by_itself_and_may_write_only_where_it_says_so() -> None:
    assert {w.stem for w in WORKFLOWS} == {"tests", "docs", "release"}
    for workflow in WORKFLOWS:
        content = yaml.safe_load(workflow.read_text(encoding="utf-8"))
        assert content["permissions"] == {"contents": "read"}
        for name, job in content["jobs"].items():
            assert "timeout-minutes" in job or name in ("deploy", "publish")


def test_the_pythons_of_the_workflow_are_those_of_the_wheels_and_not_older_than_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    tested = yaml.safe_load((ROOT / ".github/workflows/tests.yml").read_text())["jobs"]["tests"]["strategy"]["matrix"]
    built = [f"{w[2]}.{w[3:5]}" for w in project["tool"]["cibuildwheel"]["build"].split()]
    assert tested["python"] == built
    assert project["project"]["requires-python"] == f">={built[0]}"


def test_the_citation_names_this_version_and_licence() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["version"] == plantar.__version__
    assert cited["license"] == tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["license"]


def test_the_licences_of_all_dependencies_are_told() -> None:
    done = subprocess.run([sys.executable, "tools/licences.py", "--check"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
