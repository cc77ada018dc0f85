"""A run as a row, also where it could not be."""

from typing import Any

import pytest

from plantar.errors import DependencyError
from plantar.sim.sweep.task import COLUMNS, Task, criteria_of, failed, run_one, run_task

STANDING = ("steps=0", "settle=0.0", "end=0.2", "start=0.2")


def test_a_row_holds_the_summary_of_the_run():
    row = run_one("flat", None, STANDING, 0)
    assert row["completed"] is True
    assert row["error"] == ""
    bad = run_one("push", None, ["steps=2", "push.step=7"], 0)
    assert bad["completed"] is False
    assert "2 steps" in bad["error"]


def test_a_row_names_every_criterion_that_failed():
    assert run_one("flat", None, STANDING, 0)["reasons"] == ""
    row = run_one("push", None, ["impulse=90", "push.step=0", "direction=right", "feedback=false", "steps=2"], 0)
    assert row["completed"] is False
    assert "fall: " in row["reasons"]
    assert {"fall", "steps"} <= set(criteria_of(row))


def test_a_defect_is_a_row_and_a_missing_library_is_none(monkeypatch):
    def defect(*_: Any) -> None:
        raise KeyError("knee")

    def without_mujoco(*_: Any) -> None:
        raise DependencyError("mujoco", "sim")

    task = Task("flat", None, STANDING, 0)
    monkeypatch.setattr("plantar.sim.sweep.task.simulation_of", defect)
    row = run_task(task)
    assert set(row) == set(COLUMNS) == set(failed(""))
    assert row["completed"] is False
    assert "KeyError" in row["error"]
    assert "test_task.py" in row["error"]
    monkeypatch.setattr("plantar.sim.sweep.task.simulation_of", without_mujoco)
    with pytest.raises(DependencyError):
        run_task(task)
