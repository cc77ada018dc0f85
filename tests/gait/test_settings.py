"""Every settings class of the controller says all that there is to say of each of its settings."""

import math
from dataclasses import replace

import pytest

from plantar.errors import InputError
from plantar.gait.balance.dcm_balance import BalanceGains
from plantar.gait.balance.foot_admittance import AdmittanceGains
from plantar.gait.balance.wrench_balance import WrenchBalanceGains
from plantar.gait.contact.ground_map import GroundMapSettings
from plantar.gait.contact.stance_contact import ContactSettings
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.controller_tables import CONTROLLER_TABLES, check_controller_table, controller_keys
from plantar.gait.estimate.estimator import EstimatorGains
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.ground_conformity import ConformityGains
from plantar.gait.feet.landing import Landing
from plantar.gait.plan.phases import Timing
from plantar.gait.propose.feasibility import FeasibilityRules
from plantar.gait.propose.foothold_rules import FootholdRules

CLASSES = (
    AdmittanceGains,
    BalanceGains,
    ComplianceGains,
    TouchdownGains,
    GroundMapSettings,
    FootholdRules,
    ConformityGains,
    ContactSettings,
    EstimatorGains,
    FeasibilityRules,
    Landing,
    Timing,
    WrenchBalanceGains,
)


@pytest.mark.parametrize("kind", CLASSES)
def test_each_setting_has_a_meaning_a_unit_and_a_range(kind):
    for told in kind.described():
        assert told.meaning, f"{kind.__name__}.{told.name} has no meaning in the docstring"
        assert told.allowed
        assert told.unit or told.allowed == "true, false" or "," in told.allowed


@pytest.mark.parametrize("kind", CLASSES)
def test_no_setting_takes_what_is_not_allowed(kind):
    for name in kind.names():
        owner = kind if name in kind.__dataclass_fields__ else AdmittanceGains
        for value in (math.nan, math.inf, -math.inf, None, "none of these", [1.0]):
            with pytest.raises(InputError, match=f"'{name}' is "):
                owner(**{name: value})


@pytest.mark.parametrize("name", ["com_height", "mass"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_a_controller_needs_a_height_and_a_mass(name, value):
    good = ControllerSettings(com_height=0.8, mass=60.0)
    with pytest.raises(InputError, match=f"'{name}' is .*; allowed: a finite number above 0"):
        replace(good, **{name: value})


@pytest.mark.parametrize(
    ("table", "name"), [(table, name) for table, (kind, *_) in CONTROLLER_TABLES.items() for name in kind.given_by]
)
def test_a_setting_that_a_scene_gives_elsewhere_is_refused_with_its_name_there(table, name):
    kind = CONTROLLER_TABLES[table][0]
    assert name in kind.names()
    assert name not in controller_keys(table)
    with pytest.raises(InputError, match=f"'{name}' is given by '{kind.given_by[name]}'"):
        check_controller_table(table, {name: 1.0}, f"[{table}]")
