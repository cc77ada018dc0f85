"""Studies as people really have them: with gaps, one level, covariates that explain all: results or a clear line."""

import numpy as np
import pytest

from plantar import InputError
from plantar.gait.analysis.study.compare_conditions import compare_conditions
from plantar.gait.analysis.study.measured_table import check_names
from plantar.gait.analysis.study.mixed_models import mixed_effects
from plantar.gait.analysis.study.one_against_group import one_against_group
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.participants import Participation
from plantar.gait.analysis.study.reliability import agreements

PEOPLE = ("Zoë", "李", "אבי", "=SUM(1)", 'O\'Brien, "x"', "Ærø", "p7")


def recording(who, condition, value, **more):
    row = {"side": "left", "step": 1, "used": 1, "note": "", "peak_force_N": value, "contact_time_s": 0.7}
    feet = {"left": {"steps": 1.0, "peak_force_N": value, "contact_time_s": 0.7}}
    name = f"{who}_{condition}_{sorted(more.items())}.npz"
    own = Participation(name, who, condition, more={key: str(held) for key, held in more.items()})
    return RecordingResult(own, "", "", "arrays", "", False, (row,) * 4, feet, {}, {}, (), {})


def study(conditions=("硬い靴", "weich & <b>"), people=PEOPLE, **more):
    random = np.random.default_rng(3)
    out = []
    for number, who in enumerate(people):
        for level, condition in enumerate(conditions):
            own = {key: value(number, level) if callable(value) else value for key, value in more.items()}
            out.append(recording(who, condition, 700.0 + 30.0 * number + 50.0 * level + random.normal(), **own))
    return out


def test_names_in_other_languages_and_a_constant_measure():
    (found,) = compare_conditions(study())
    assert (found.a, found.b, found.note, list(found.doubts)) == ("硬い靴", "weich & <b>", "", [])
    assert found.effects["peak_force_N"].difference == pytest.approx(50.0, abs=2.0)
    assert found.effects["peak_force_N"].p == pytest.approx(2 / 2**7)
    constant = found.effects["contact_time_s"]
    assert (constant.difference, constant.p, constant.p_all) == (0.0, 1.0, 1.0)


def test_people_without_one_of_the_levels_are_named():
    (found,) = compare_conditions(study()[:-1])
    assert found.effects["peak_force_N"].n_a == 6
    assert list(found.doubts) == ["1 participant(s) are not in every level and left out: p7"]


def test_a_covariate_that_is_the_factor_leaves_nothing_to_compare():
    (found,) = compare_conditions(study(code=lambda _, level: 1.0 + level), covariates=("code",))
    assert not found.effects
    assert found.note == "code alone shows which level it is: no difference is left when it is allowed for"
    (kept,) = compare_conditions(study(age=lambda number, _: 30 + number), covariates=("age",))
    assert kept.effects["peak_force_N"].difference == pytest.approx(50.0, abs=2.0)


def test_two_people_are_too_few_and_it_says_so():
    (found,) = compare_conditions(study(people=PEOPLE[:2]))
    assert "2 participants, 2 of them in both: differences take 3 in both" in found.note


@pytest.mark.parametrize(
    ("results", "factor", "line"),
    [
        (study(group="x"), "group", "--factor group: all of it is 'x'; allowed: two levels or more"),
        (study(), "side", "--factor side: all of it is 'left'; allowed: two levels or more"),
        (study(affected_side="top"), "affected", "no recording's affected side is left or right"),
        (study(), "sole", "--factor sole: no recording has it; allowed: condition, side, affected"),
    ],
)
def test_factors_of_one_level_or_none_are_refused(results, factor, line):
    with pytest.raises(InputError, match=line.replace("(", r"\(")):
        check_names(results, (factor,), ())


def test_covariates_of_text_are_refused():
    with pytest.raises(InputError, match="--covariate age: no recording has a number of it"):
        check_names(study(age="old"), (), ("age",))


def test_one_device_or_three_have_no_agreement():
    for devices in ("a", "abc"):
        results = study(device=lambda number, _, devices=devices: devices[number % len(devices)])
        with pytest.raises(InputError, match="allowed: a column that names two devices"):
            agreements(results, "device")


def test_a_mixed_model_of_steps_that_do_not_vary_is_no_number():
    """Four equal steps a recording: a person's steps have no spread of their own; a constant measure is left out."""
    pytest.importorskip("statsmodels")
    found = mixed_effects(study(), "condition")
    assert [effect.measure for effect in found] == ["peak_force_N"]
    assert found[0].note


def test_a_patient_is_compared_in_the_groups_own_condition():
    results = study()
    found = one_against_group(results, "p7", "硬い靴")
    (own,) = (r for r in results if r.who.participant == "p7" and r.who.condition == "硬い靴")
    assert found.measures["left"]["peak_force_N"].value == own.feet["left"]["peak_force_N"]
    assert not any("means of" in note for note in found.notes)
    others = one_against_group([*results, *study(("a", "b"), ("new",))], "new", "硬い靴")
    assert any("values of new are means of a and b, none of which is 硬い靴" in note for note in others.notes)
