"""The controller's settings by their dotted names, such as `estimator.gravity`: tables of a robot file or a scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from plantar.errors import InputError, PlantarError
from plantar.gait.balance.ankle_strategy import AnkleRules
from plantar.gait.balance.dcm_balance import BalanceGains
from plantar.gait.balance.wrench_balance import WrenchBalanceGains
from plantar.gait.contact.ground_map import GroundMapSettings
from plantar.gait.contact.stance_contact import ContactSettings
from plantar.gait.estimate.dcm_filter import DcmFilterRules
from plantar.gait.estimate.estimator import EstimatorGains
from plantar.gait.estimate.identification import IdentificationRules
from plantar.gait.estimate.push_estimate import PushRules
from plantar.gait.estimate.wrench_filter import WrenchFilterRules
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.foot_motion import Landing
from plantar.gait.feet.ground_conformity import ConformityGains
from plantar.gait.feet.swing_fit import SwingFitRules
from plantar.gait.propose.double_support_timing import DoubleSupportTimingRules
from plantar.gait.propose.dsp_opt import DspWeights
from plantar.gait.propose.feasibility import FeasibilityRules
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.learned_stride import LearnedStrideRules
from plantar.gait.propose.slope_inside import SlopeRules
from plantar.gait.propose.ssp_opt import StepRegionRules, StepWeights
from plantar.gait.propose.step_adjustment import StepAdjustmentRules
from plantar.gait.propose.step_timing import StepTimingRules
from plantar.sensing.net_wrench import NetWrenchRules
from plantar.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.settings.schema import Setting, Settings
from plantar.settings.unknown_keys import refuse_unknown_keys

__all__ = ["CONTROLLER_TABLES", "check_controller_table", "controller_keys", "controller_settings_described"]

CONTROLLER_TABLES: Mapping[str, tuple[type[Settings], ...]] = {
    "balance": (BalanceGains, WrenchBalanceGains),
    "estimator": (EstimatorGains,),
    "dcm_filter": (DcmFilterRules,),
    "identification": (IdentificationRules,),
    "landing": (Landing,),
    "swing_fit": (SwingFitRules,),
    "contact": (ContactSettings,),
    "foothold": (FootholdRules,),
    "step_timing": (StepTimingRules,),
    "step_adjustment": (StepAdjustmentRules,),
    "learned_stride": (LearnedStrideRules,),
    "step_region": (StepRegionRules,),
    "step_weights": (StepWeights,),
    "double_support_timing": (DoubleSupportTimingRules,),
    "dsp_weights": (DspWeights,),
    "ankle_strategy": (AnkleRules,),
    "push_estimate": (PushRules,),
    "push_felt": (NetWrenchRules,),
    "push_expected": (WrenchFilterRules,),
    "compliance": (ComplianceGains,),
    "touchdown": (TouchdownGains,),
    "ground_map": (GroundMapSettings,),
    "slope": (SlopeRules,),
    "feasibility": (FeasibilityRules,),
    "conformity": (ConformityGains,),
}
"""Settings classes of each table; `balance` has one for each balance law, of which a robot has one."""

_ELSEWHERE = {
    "landing.approach_height": "walk.approach_height",
    "landing.approach_speed": "walk.approach_speed",
    "ground_map.sensing_range": "sensing.proximity_range",
    "feasibility.rule": "control.feasibility",
    "swing_fit.height": "walk.swing_height",
}
"""Settings that a scene gives by another name."""

_MOVED = {
    **{f"compliance.{name}": f"ground_map.{name}" for name in GroundMapSettings.names() if name != "sensing_range"},
    **{f"compliance.{name}": f"touchdown.{name}" for name in TouchdownGains.names()},
    **{f"contact.{name}": f"foothold.{name}" for name in FootholdRules.names()},
    "compliance.ankle_reach": "slope.ankle_reach",
    "compliance.sensing_range": "sensing.proximity_range",
    "compliance.haste": "compliance.late_speed_ratio",
    "compliance.firming": "touchdown.load_time",
    "compliance.pliancy": "touchdown.admittance",
}
"""Names that settings had before, for messages."""


def controller_keys(table: str) -> tuple[str, ...]:
    """Names of the settings that a table may hold.

    Args:
        table: A name of `CONTROLLER_TABLES`.

    Returns:
        The names in order, without those that a scene gives elsewhere.

    Example:
        >>> controller_keys("landing")[:6]
        ('contact_force', 'press_force', 'depth', 'speed', 'acceleration', 'reach')
    """
    names = dict.fromkeys(name for kind in CONTROLLER_TABLES[table] for name in kind.names())
    return tuple(name for name in names if f"{table}.{name}" not in _ELSEWHERE)


def controller_settings_described(table: str, body: BodyScale = REFERENCE_BODY) -> tuple[Setting, ...]:
    """What there is to say of the settings of a table; of two classes that have one name, the first says it.

    Args:
        table: A name of `CONTROLLER_TABLES`.
        body: The body for which defaults that are shares of one are told in SI.

    Returns:
        The settings in order.
    """
    found: dict[str, Setting] = {}
    for kind in CONTROLLER_TABLES[table]:
        for told in kind.described(body):
            found.setdefault(told.name, told)
    return tuple(found[name] for name in controller_keys(table))


def check_controller_table(name: str, table: Any, where: str, error: type[PlantarError] = InputError) -> dict[str, Any]:
    """Check a table of settings before it is known what is run with it.

    Args:
        name: A name of `CONTROLLER_TABLES`.
        table: Values by name.
        where: Name of the table, for messages.
        error: What is raised.

    Returns:
        A copy of the table.

    Raises:
        PlantarError: Of the class `error`: a key is unknown or a value not allowed; the message names it.
    """
    if not isinstance(table, Mapping):
        raise error(f"{where} is not a table")
    for key in table:
        elsewhere = {**_MOVED, **_ELSEWHERE}.get(f"{name}.{key}")
        if elsewhere is not None:
            raise error(f"{where} '{key}' is given by '{elsewhere}'; leave it out here")
    refuse_unknown_keys(table, controller_keys(name), where, error)
    for kind in CONTROLLER_TABLES[name]:
        kind.from_table({k: v for k, v in table.items() if k in kind.names()}, where, error)
    return dict(table)
