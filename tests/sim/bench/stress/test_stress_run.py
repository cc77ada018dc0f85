"""Stress runs: what was found by them stays mended, and what is wrong is seen."""

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar.bench.kind import BenchOptions
from plantar.errors import InputError
from plantar.gait.command import Sensors
from plantar.gait.controller import WalkingController
from plantar.sensing.reading import Reading
from plantar.sim.bench.runner import run_kind
from plantar.sim.bench.stress import stress_run
from plantar.sim.bench.stress.faults import Faults, FaultySensors
from plantar.sim.bench.stress.scenario import SCENES, Scenario, draw_scenario
from plantar.sim.bench.stress.stress_run import FAILURES, STRESS, Outcome, run_scenario
from plantar.sim.run.scene import load_scene

CASES = json.loads((Path(__file__).parent / "cases.json").read_text())


def scenario_of(values: dict[str, Any]) -> Scenario:
    """A scenario from the JSON of its `asdict`; what lacks is as in a plain one."""
    lists = {name: tuple(values[name]) for name in ("settings", "place") if name in values}
    return Scenario(**values | lists | {"faults": Faults(**values.get("faults", {}))})


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, id=case["found"][:50], marks=[pytest.mark.long] if case["longest"] > 1.0 else [])
        for case in CASES
    ],
)
def test_what_was_found_stays_mended(case):
    """Where robots fall by chance, in which the last digits of a processor's sums count, either outcome is right.

    A run that stopped has the name of its safe state as its outcome; in the state "fallen" it fell.
    """
    outcome = run_scenario(scenario_of(case["scenario"]), case["longest"])
    came = outcome.detail if outcome.kind == "stopped" else outcome.kind
    came = "fell" if came == "fallen" else came
    assert came in case["outcome"].split(" or "), outcome.detail


def test_a_scenario_is_its_values_and_its_number():
    for number in range(50):
        scenario = draw_scenario(number)
        assert scenario_of(json.loads(json.dumps(asdict(scenario)))) == scenario


def test_every_scene_takes_what_makes_it_short():
    for name, (settings, _) in SCENES.items():
        load_scene(name, settings)


@pytest.mark.parametrize(
    ("spoil", "kind"),
    [
        (lambda command: command.changed(com=command.com * math.nan), "not finite"),
        (lambda command: command.changed(com=command.com + np.array([9.0, 0.0, 0.0])), "out of bounds"),
        (lambda command: command.changed(rotation_torso=2.0 * command.rotation_torso), "out of bounds"),
    ],
)
def test_a_command_that_may_not_be_is_seen(spoil, kind, monkeypatch):
    step = WalkingController.step
    monkeypatch.setattr(WalkingController, "step", lambda self, sensors: spoil(step(self, sensors)))
    assert run_scenario(Scenario(0, "flat", "h1"), 0.05).kind == kind


def test_what_a_tick_raises_is_reported_with_its_place(monkeypatch):
    def fail(*_: Any) -> None:
        raise ZeroDivisionError("by nothing")

    monkeypatch.setattr(WalkingController, "step", fail)
    outcome = run_scenario(Scenario(0, "flat", "h1"), 0.05)
    assert outcome.kind == "raised"
    assert "ZeroDivisionError: by nothing (bench/stress/test_stress_run.py:" in outcome.detail


def test_settings_that_a_scene_does_not_take_are_no_failure():
    outcome = run_scenario(Scenario(0, "flat", "h1", ("dcm_filter.unfelt_rate=0.01",)))
    assert outcome.kind == "refused"
    assert "sets dcm_filter.unfelt_rate, which does nothing" in outcome.detail


def test_faults_do_what_they_say():
    force = np.arange(1.0, 7.0)
    readings = {"left": Reading(0.0, force), "right": Reading(0.0, force)}
    told = Sensors(0.0, np.zeros(2), np.full(3, 0.1), np.zeros(3), readings)

    def passed(**faults: Any) -> Sensors:
        sensors = FaultySensors(Faults(**faults), {"left": 100.0, "right": 200.0}, 0)
        sensors.passed(told)
        return sensors.passed(told.changed(time=0.005, readings={s: Reading(0.004, 2.0 * force) for s in readings}))

    assert (passed().readings["left"].force == 2.0 * force).all()
    assert (passed(dropped=1.0).readings["left"].force == force).all()
    assert (passed(stuck=1.0).readings["left"].force == force).all()
    assert (passed(saturated=1.0).readings["right"].force == 200.0).all()
    assert np.isnan(passed(silent=1.0).readings["left"].force).all()
    assert np.isnan(passed(missing=1.0).gyro).all()
    assert passed(single=True).gyro[0] == float(np.float32(0.1)) != 0.1
    assert passed(jitter=1e-3).readings["left"].time != 0.004


def test_a_table_continues_where_it_was_left(tmp_path, monkeypatch):
    ran: list[int] = []

    def run(scenario: Scenario) -> Outcome:
        ran.append(scenario.number)
        return Outcome(FAILURES[0] if scenario.number == 2 else "ended", "a, text", 1.0)

    monkeypatch.setattr(stress_run, "run_scenario", run)
    run_kind(STRESS, BenchOptions(scenarios=2), tmp_path, lambda *_: None)
    with (tmp_path / "stress.csv").open("a") as table:
        table.write("2,fl")  # a run that was killed
    done = run_kind(STRESS, BenchOptions(scenarios=4), tmp_path, lambda *_: None)
    assert ran == [0, 1, 2, 3]
    assert done.result["outcomes"] == {"ended": 3, "raised": 1}
    assert [row["number"] for row in done.result["failures"]] == ["2"]
    assert done.failures == ("1 of 4 scenarios failed",)
    assert "a, text" in done.text
    (tmp_path / "stress.csv").write_text("something else\n")
    with pytest.raises(InputError, match="has other columns than number,scene"):
        run_kind(STRESS, BenchOptions(scenarios=1), tmp_path, lambda *_: None)
    with pytest.raises(InputError, match="allowed: 1 or more"):
        run_kind(STRESS, BenchOptions(scenarios=0), tmp_path, lambda *_: None)
