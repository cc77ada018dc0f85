"""Criteria of scenes: each kind on a made run that shows it and on one that does not, and the table of a scene."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.errors import SceneError
from plantar.sim.judging.criteria.criterion import Criterion
from plantar.sim.judging.criteria.kinds import criterion_kinds, outcome_of
from plantar.sim.judging.step_count import Stand
from plantar.sim.partner.settings import PartnerSettings
from plantar.sim.run.listing import scene_row
from plantar.sim.run.listing import scene_text as scene_words
from plantar.sim.run.scene import Push, builtin_scenes, load_scene, override, scene_file
from plantar.sim.run.scene_kind import open_scene
from plantar.sim.terrain import Footprint, PlannedFeet

WEIGHT = REFERENCE_BODY.weight
FAILED = [{"criterion": "x", "value": 1, "limit": 2, "text": "x"}]


def pieces(under: list[int], longest: list[float]) -> SimpleNamespace:
    """Pieces of which some lie under footprints, and the time in s for which each carried."""
    return SimpleNamespace(
        count=len(longest),
        under=lambda planned, share: under,
        carried=lambda piece: longest[piece] > 0.0,
        longest=lambda piece: longest[piece],
    )


def landed(*impacts: float) -> list[SimpleNamespace]:
    return [SimpleNamespace(impact=WEIGHT * impact) for impact in impacts]


def planned(way: float) -> PlannedFeet:
    """Both feet, and one step of each by `way` in m."""
    places = {side: np.array([0.0, y]) for side, y in (("left", 0.1), ("right", -0.1))}
    feet = {side: Footprint(side, at, 0.0, (0.1, 0.05), at) for side, at in places.items()}
    ahead = np.array([way, 0.0])
    return PlannedFeet(feet, tuple(Footprint(s, at + ahead, 0.0, (0.1, 0.05), at + ahead) for s, at in places.items()))


def with_partner(role: str, way: float, moved: float, force: float, feet: tuple[float, float]) -> dict[str, Any]:
    """A run of a partner that came by `moved` in m, pressed with `force` in weights, and feet that ended at x in m."""
    stands = [Stand(side, 1.0, (x, 0.0, 0.0)) for side, x in zip(("left", "right"), feet, strict=True)]
    return {
        "planned": planned(way),
        "scene": SimpleNamespace(partner=PartnerSettings(role=role)),
        "touched": SimpleNamespace(partner=SimpleNamespace(moved=moved, largest_force=WEIGHT * force)),
        "judge": SimpleNamespace(steps=SimpleNamespace(last_stands=lambda: stands)),
    }


def by_hand(reasons: str, failed: bool) -> dict[str, Any]:
    steps = SimpleNamespace(last_stands=list)
    touched = SimpleNamespace(**{reasons: lambda *stands: FAILED if failed else []})
    return {"touched": touched, "judge": SimpleNamespace(steps=steps)}


def pushed(by_hands: bool, given: float) -> dict[str, Any]:
    impulse = SimpleNamespace(largest_impulse=lambda: given)
    touched, force = (impulse, None) if by_hands else (None, impulse)
    return {"touched": touched, "pusher": force, "scene": SimpleNamespace(push=Push(impulse=20.0))}


def zmps(rms: float | None) -> dict[str, Any]:
    return {"zmps": SimpleNamespace(summary=lambda: {"rms_m": rms})}


def judge(**parts: Any) -> dict[str, Any]:
    return {"planned": None, "judge": SimpleNamespace(**parts)}


SHOWN: dict[str, list[tuple[dict[str, Any], set[str]]]] = {
    "stood_on": [
        (judge(pieces=pieces([0, 2], [0.4, 0.0, 0.3])), set()),
        (judge(pieces=pieces([0, 1, 2], [0.4, 0.0, 0.3])), {"stood_on"}),
    ],
    "never_stood_on": [
        (judge(pieces=pieces([0], [0.19, 0.0])), set()),
        (judge(pieces=pieces([0], [0.0, 0.21])), {"never_stood_on"}),
    ],
    "soft_landings": [
        (judge(landings=landed(0.1, 0.49)), set()),
        (judge(landings=[]), set()),
        (judge(landings=landed(0.1, 0.51, 0.2)), {"soft_landings"}),
    ],
    "pushed": [
        (pushed(False, 20.0), set()),
        (pushed(True, 18.1), set()),
        (pushed(False, 0.0), {"pushed"}),
        (pushed(True, 17.9), {"pushed"}),
        ({"scene": SimpleNamespace(push=Push())}, {"pushed"}),
    ],
    "same_zmp": [
        ({"zmps": None}, {"same_zmp"}),
        (zmps(0.002), set()),
        (zmps(0.003), {"same_zmp"}),
        (zmps(None), {"same_zmp"}),
    ],
    "partner_led": [
        ({"touched": None}, {"partner_led"}),
        (with_partner("follower", 0.6, -0.31, 0.07, (0.6, 0.6)), set()),
        (with_partner("follower", 0.6, -0.29, 0.07, (0.6, 0.6)), {"led"}),
        (with_partner("follower", 0.6, 0.5, 0.07, (0.6, 0.6)), {"led"}),
        (with_partner("leader", 0.0, 0.07, 0.07, (-0.06, -0.06)), set()),
        (with_partner("leader", 0.0, 0.07, 0.07, (0.0, 0.0)), {"led"}),
        (with_partner("leader", 0.0, 0.07, 0.2, (-0.06, -0.06)), {"leaning"}),
    ],
    **{
        name: [(by_hand(reasons, False), set()), (by_hand(reasons, True), {"x"}), ({"touched": None}, {name})]
        for name, reasons in (
            ("larger_pushes_step", "steps_reasons"),
            ("longer_strides", "stride_reasons"),
            ("com_accelerated", "acceleration_reasons"),
            ("follows_guide", "guide_reasons"),
        )
    },
}


def found(name: str, parts: dict[str, Any], body: BodyScale = REFERENCE_BODY) -> set[str]:
    """What fails; every reason has a value beyond its limit, and a text."""
    criterion = criterion_kinds()[name]().for_body(body)
    reasons = criterion.reasons(SimpleNamespace(body=body, **parts))
    for reason in reasons:
        assert set(reason) == {"criterion", "value", "limit", "text"}
        assert reason["value"] != reason["limit"]
        assert reason["text"]
    return {reason["criterion"] for reason in reasons}


def test_every_kind_is_tried():
    assert set(SHOWN) == set(criterion_kinds())
    for name, runs in SHOWN.items():
        assert any(failed for _, failed in runs), name
        assert any(not failed for _, failed in runs), name


@pytest.mark.parametrize(("name", "case"), [(name, k) for name, runs in SHOWN.items() for k in range(len(runs))])
def test_a_run_that_shows_it_has_no_reason_and_another_has_it(name, case):
    parts, failed = SHOWN[name][case]
    assert found(name, parts) == failed


def test_a_smaller_robot_may_stand_less_long_on_what_lies_in_its_way():
    half = BodyScale(**{n: getattr(REFERENCE_BODY, n) for n in REFERENCE_BODY.__dataclass_fields__} | {"leg": 0.3})
    assert half.beat == pytest.approx(REFERENCE_BODY.beat / math.sqrt(2.0))
    assert found("never_stood_on", judge(pieces=pieces([0], [0.15])), half) == {"never_stood_on"}


@pytest.mark.parametrize("kind", criterion_kinds().values())
def test_a_kind_says_in_a_sentence_what_it_claims(kind):
    claim = kind().claim()
    assert 10 < len(claim) < 250
    assert not claim.endswith(".")
    assert kind.__doc__


@pytest.mark.parametrize("name", builtin_scenes())
def test_every_built_in_scene_states_what_its_experiment_shows(name):
    scene = open_scene(name)
    if hasattr(scene, "outcome"):
        assert "[outcome" in scene_file(name).read_text()
        assert all(isinstance(criterion, Criterion) for criterion in scene.outcome.values())
    else:
        assert scene.claims()


def test_settings_of_a_criterion_are_read_checked_and_scaled():
    outcome = outcome_of({"never_stood_on": {"longest": "1 beat"}}, "scene 'x'")
    assert outcome["never_stood_on"].for_body(REFERENCE_BODY).longest == pytest.approx(REFERENCE_BODY.beat)
    assert load_scene("obstacle").outcome["soft_landings"].largest == 0.5


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"stood_onn": {}}, r"\[outcome\] has an unknown key 'stood_onn'; nearest: stood_on, "),
        ({"stood_on": {"cover": 1}}, r"\[outcome.stood_on\] has an unknown key 'cover'; nearest: covers"),
        ({"soft_landings": {"largest": -1}}, r"\[outcome.soft_landings\] 'largest' is -1; allowed: a number 0 to 10"),
        ({"soft_landings": 3}, r"\[outcome.soft_landings\] is not a table"),
        ("all", r"outcome is 'all'; allowed: a table, or \"none\""),
    ],
)
def test_a_wrong_outcome_is_named(table, words):
    with pytest.raises(SceneError, match=words):
        outcome_of(table, "scene 'x'")


def test_what_a_scene_has_to_show_is_listed():
    row = scene_row("obstacle")
    assert list(row["outcome"]) == ["stood_on", "soft_landings"]
    assert "and no foot lands with more than 0.5 of the weight (soft_landings)" in scene_words(row)
    assert "the hand draws back (retreat)" in scene_words(scene_row("stove"))


def test_a_run_may_leave_the_outcome_out():
    assert override({"outcome": {"stood_on": {}}}, ["outcome=none"]) == {"outcome": "none"}
    assert load_scene("obstacle", ["outcome=none"]).outcome == {}
