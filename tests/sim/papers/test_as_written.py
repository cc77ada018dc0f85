"""What a paper describes is really called in its scene, and is not called without it."""

from collections import Counter
from typing import Any

import pytest

from plantar.gait.balance import dcm_regulation
from plantar.gait.estimate.dcm_filter import DcmFilter
from plantar.gait.feet.swing_fit import SwingFit
from plantar.gait.propose import double_support_timing, step_adjustment
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SHORT = ("walk.steps=3", "walk.settle=0.0", "push.step=1", "push.small=0", "walk.start=0.8", "walk.end=0.4")
CALLED = {
    "K 7-8": (DcmFilter, "update"),
    "K 13-16": (SwingFit, "aim"),
    "K 21-24": (dcm_regulation, "target_dcms"),
    "K 25, single support": (dcm_regulation, "single_support_vrp"),
    "K 25-26, double support": (dcm_regulation, "double_support_vrp"),
    "K 27": (step_adjustment, "within_support"),
    "K 28-33": (step_adjustment, "solve_ssp"),
    "K 34-38": (double_support_timing, "solve_dsp"),
}


def counted(monkeypatch: pytest.MonkeyPatch, *settings: str) -> Counter[str]:
    """How often a short pushed walk calls each."""
    calls: Counter[str] = Counter()
    for name, (owner, attribute) in CALLED.items():
        plain = getattr(owner, attribute)

        def counts(*args: Any, _name: str = name, _plain: Any = plain, **named: Any) -> Any:
            calls[_name] += 1
            return _plain(*args, **named)

        monkeypatch.setattr(owner, attribute, counts)
    Simulation(load_scene("push-step", [*SHORT, *settings]), 1).run()
    return calls


def test_k_as_written_calls_all_of_k(monkeypatch):
    calls = counted(monkeypatch, "paper=K")
    assert set(calls) == set(CALLED), calls


@pytest.mark.long
def test_the_default_walk_calls_none_of_it(monkeypatch):
    assert not counted(monkeypatch)
