"""Every criterion of the verdict, alone, on either side of its limit."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.sim.judging.verdict import FASTER_FOR, Ending, reasons

STILL = SimpleNamespace(longest=np.zeros(3), fastest=np.zeros(3), names=["hip", "knee", "ankle"])
APART = SimpleNamespace(first=None, duration=0.0)


def ending(**changes: Any) -> Ending:
    good: dict[str, Any] = {"fall": None, "stopped": None, "steps": (8, 8), "missed": "", "position": 0.0}
    return Ending(**(good | {"heading": 0.0, "tilt": 0.0} | changes))


def failed(legs: Any = APART, joints: Any = STILL, **changes: Any) -> list[tuple[str, float, float]]:
    return [(r["criterion"], r["value"], r["limit"]) for r in reasons(ending(**changes), legs, joints)]


def test_a_good_end_has_no_reasons():
    assert failed() == []
    assert failed(position=None, heading=None, steps=(0, 0)) == []


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ({"fall": (41.2345, 40.0, "the robot fell")}, ("fall", 41.2345, 40.0)),
        ({"stopped": "sensors froze"}, ("emergency_stop", 1, 0)),
        ({"raised": (3, "InputError: x")}, ("controller_error", 3, 0)),
        ({"overrun": (60.0, 12.0)}, ("overrun", 60.0, 12.0)),
        ({"steps": (7, 8), "missed": "x"}, ("steps", 7, 8)),
        ({"steps": (0, 8), "missed": "x"}, ("steps", 0, 8)),
        ({"pushes": (5, 6)}, ("pushes", 5, 6)),
        ({"position": 0.1001}, ("position", 0.1001, 0.1)),
        ({"position": float("nan")}, None),
        ({"heading": 5.1}, ("heading", 5.1, 5.0)),
        ({"tilt": 5.0}, ("tilt", 5.0, 5.0)),
    ],
)
def test_each_criterion_fails_alone(changes, found):
    got = failed(**changes)
    assert len(got) == 1
    assert found is None or got == [found]


@pytest.mark.parametrize(
    "changes", [{"position": 0.0999}, {"heading": 4.9}, {"tilt": 4.9}, {"pushes": (6, 6)}, {"steps": (9, 8)}]
)
def test_what_is_within_its_limit_is_no_reason(changes):
    assert failed(**changes) == []


def test_a_smaller_robot_has_to_come_nearer():
    half = BodyScale(**{**vars_of(REFERENCE_BODY), "leg": 0.5 * REFERENCE_BODY.leg})
    assert failed(position=0.06, body=half) == [("position", 0.06, 0.05)]
    assert failed(position=0.04, body=half) == []


def vars_of(body: BodyScale) -> dict[str, float]:
    return {name: getattr(body, name) for name in body.__dataclass_fields__}


def test_legs_that_touch_and_joints_that_are_too_fast_are_named():
    touched = SimpleNamespace(first=(1.5, "left_foot", "right_foot"), duration=0.0123)
    (reason,) = reasons(ending(), touched, STILL)
    assert (reason["criterion"], reason["value"], reason["limit"]) == ("collision", 0.0123, 0.0)
    assert "left_foot touched right_foot, first at 1.50 s, for 0.012 s" in reason["text"]
    for lasting, fails in ((FASTER_FOR, False), (FASTER_FOR + 0.001, True)):
        fast = SimpleNamespace(
            longest=np.array([0.0, lasting, 0.01]), fastest=np.array([3.0, 1.2, 1.1]), names=STILL.names
        )
        found = reasons(ending(), APART, fast)
        assert bool(found) == fails
    assert found[0]["criterion"] == "joint_speed"
    assert found[0]["value"] == pytest.approx(0.021)
    assert "knee was faster than its limit for 0.021 s, by 1.20 times" in found[0]["text"]


def test_all_that_failed_is_listed():
    got = failed(fall=(50.0, 40.0, "fell"), stopped="x", steps=(1, 8), missed="y", position=1.0, tilt=60.0)
    assert [name for name, _, _ in got] == ["fall", "emergency_stop", "steps", "position", "tilt"]
