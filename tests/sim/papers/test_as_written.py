"""What a paper describes is really called in its scene, and is not called without it."""

from collections import Counter
from typing import Any

import numpy as np
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
    # The 40 N s that K allows at most: what is expected of less keeps u* in double support within the sole.
    calls = counted(monkeypatch, "paper=K", "push.dv=0.465")
    assert set(calls) == set(CALLED), calls


def test_k_as_written_expects_a_push_to_stay_in_both_supports(monkeypatch):
    """K 18-20: u_w is in the DCM of single and of double support."""
    expected = {"single": 0.0, "double": 0.0}
    for name in expected:
        plain = getattr(dcm_regulation, f"{name}_support_vrp")

        def notes(*args: Any, _name: str = name, _plain: Any = plain) -> Any:
            expected[_name] = max(expected[_name], float(np.hypot(*args[-2])))
            return _plain(*args)

        monkeypatch.setattr(dcm_regulation, f"{name}_support_vrp", notes)
    Simulation(load_scene("push-step", [*SHORT, "paper=K"]), 1).run()
    assert min(expected.values()) > 1e-3, expected  # m: a push of 26 N s of 86 kg moves u_w by more than 1 mm


@pytest.mark.long
def test_the_default_walk_calls_none_of_it(monkeypatch):
    assert not counted(monkeypatch)
