"""The controller's settings of a run: defaults, then the robot's tables, then the scene's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError, SceneError
from plantar.gait.balance.ankle_strategy import AnkleRules
from plantar.gait.balance.balance_laws import balance_gains
from plantar.gait.contact.ground_map import GroundMapSettings
from plantar.gait.contact.stance_contact import ContactSettings
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.ankle_sensor import AnkleSensor
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
from plantar.layouts.layout import Side
from plantar.robots.robot import Robot
from plantar.robots.walk import Control, Walk, walk_timing
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.net_wrench import NetWrenchRules
from plantar.settings.body_scale import BodyScale
from plantar.settings.schema import Settings

__all__ = ["Task", "com_height_of", "controller_settings"]

_YAW_ON_UNKNOWN_GROUND = 0.1
"""Heading correction by the loaded feet in 1/s where they meet ground that is not where it is expected: they turn a
little as they land, which only the gyro shows. (Corrected by 2.0 a walk of 100 steps drifted 42 mm off to the side.)"""

_QUICK_HEIGHT = 1 / 12
"""Leg, clearance of the swing foot of quick steps at most."""

_OF_STEPS = ("step_adjustment", "step_region", "ankle_strategy")
"""Tables of steps that move for balance, however they do."""

_OF_DOUBLE_SUPPORTS = ("double_support_timing", "dsp_weights")
"""Tables of double supports that end sooner or later for it."""

T = TypeVar("T", bound=Settings)


class Task(Protocol):
    """What a controller is asked to do; a scene of the simulator is one."""

    @property
    def name(self) -> str:
        """Name, for messages."""

    @property
    def walk(self) -> Walk:
        """The gait."""

    @property
    def control(self) -> Control:
        """Which parts of the controller run."""

    @property
    def controller(self) -> Mapping[str, Mapping[str, Any]]:
        """Settings of the controller's parts by table and name, as far as given."""

    @property
    def proximity_range(self) -> float:
        """Distance in m that the soles see."""


def controller_settings(
    scene: Task,
    robot: Robot,
    body: BodyScale,
    ankles: Mapping[Side, AnkleSensor],
    limits: Mapping[Side, NDArray[np.float64]] | None = None,
    skin: BodySkin | None = None,
) -> ControllerSettings:
    """Settings of the walking controller for a scene.

    Args:
        scene: The scene, with its shares as those of the same body.
        robot: The robot.
        body: How large it is: what is stated as a share of its body counts for this one.
        ankles: Force-torque sensor of each ankle, where it has them.
        limits: Where its weight may act on one foot (`plantar.robots.kinematics.ankle_limits`); None for anywhere.
        skin: Skin of its upper body, in the base frame; None without.

    Returns:
        The settings.

    Raises:
        SceneError: If the scene sets something that it does not run, or asks for parts that need another one.
    """
    walk, control = scene.walk, scene.control
    _refuse_unused(scene, robot)
    # A robot that rocks keeps its own time, which its soles' edges make, and comes down as it rocks.
    looks = not robot.rocks and all("proximity" in layout.modalities for layout in robot.layouts.values())
    pfc = control.pfc and looks
    footholds = "off" if robot.rocks else control.footholds if looks or control.footholds == "off" else "force"
    approach = 0.0 if robot.rocks or walk.commanded else walk.approach_height  # which takes longer than quick swings
    adjusts = control.step_adjustment and not robot.rocks
    # Quick steps have no time to go high.
    swing_height = min(walk.swing_height, _QUICK_HEIGHT * body.leg) if walk.commanded else walk.swing_height
    yaw = {"yaw": _YAW_ON_UNKNOWN_GROUND} if pfc else {}
    # A hand that holds the arm is near to its skin always.
    held = {"proximity_force": 0.0} if walk.led else {}
    follows = {"confidence": walk.confidence, "yielding": walk.yielding}

    def made(kind: type[T], name: str, **given: Any) -> T:
        table = {**given, **robot.controller.get(name, {}), **scene.controller.get(name, {})}
        return kind.from_table(table, f"[{name}]", SceneError)

    found = ControllerSettings(
        com_height=com_height_of(walk, robot),
        partial_rise=min(walk.crouch, robot.largest_crouch) - min(walk.crouch, robot.largest_crouch_partial),
        mass=body.mass,
        trunk_lean=robot.trunk_lean if walk.lean else 0.0,
        period=_period(control),
        timing=walk_timing(walk, robot, body),
        swing_height=swing_height,
        swing_fit=made(SwingFitRules, "swing_fit", height=swing_height) if control.swing_shape == "fit" else None,
        ankle_reach=robot.ankle_reach,
        landing=made(Landing, "landing", approach_height=approach, approach_speed=walk.approach_speed),
        compliance=made(ComplianceGains, "compliance") if pfc else None,
        touchdown=made(TouchdownGains, "touchdown"),
        ground_map=made(GroundMapSettings, "ground_map", sensing_range=scene.proximity_range),
        slope=made(SlopeRules, "slope"),
        feasibility=made(FeasibilityRules, "feasibility", rule=control.feasibility)
        if pfc and control.feasibility != "off"
        else None,
        conformity=made(ConformityGains, "conformity") if pfc and control.conform else None,
        estimator=made(EstimatorGains, "estimator", **yaw),
        dcm_filter=made(DcmFilterRules, "dcm_filter") if control.dcm_estimate == "kalman" else None,
        identification=made(IdentificationRules, "identification") if control.identify else None,
        contact=made(ContactSettings, "contact"),
        foothold=made(FootholdRules, "foothold"),
        step_timing=made(StepTimingRules, "step_timing") if control.step_timing and not robot.rocks else None,
        step_adjustment=made(StepAdjustmentRules, "step_adjustment", **follows) if adjusts else None,
        learned_stride=made(LearnedStrideRules, "learned_stride") if adjusts and control.learn_strides else None,
        step_region=made(StepRegionRules, "step_region"),
        step_weights=made(StepWeights, "step_weights"),
        double_support_timing=made(DoubleSupportTimingRules, "double_support_timing"),
        dsp_weights=made(DspWeights, "dsp_weights"),
        ankle_strategy=made(AnkleRules, "ankle_strategy"),
        push=made(PushRules, "push_estimate") if control.push_estimate != "off" else None,
        push_felt=made(NetWrenchRules, "push_felt", **held) if control.push_estimate == "skin" else None,
        push_expected=made(WrenchFilterRules, "push_expected"),
        gains=balance_gains({**robot.balance, **scene.controller.get("balance", {})}),
        feedback=control.feedback,
        zmp_source=control.zmp_source,
        ankles=ankles,
        ankle_limits=limits or {},
        footholds=footholds,
        skin=skin,
    )
    try:
        return found.for_body(body)
    except InputError as error:
        raise SceneError(f"scene '{scene.name}' with robot '{robot.name}': {error}") from None


def com_height_of(walk: Walk, robot: Robot) -> float:
    """CoM height in m above the soles that a robot walks at, over footholds that carry the whole sole.

    Args:
        walk: The gait.
        robot: The robot, which crouches as far as it can.

    Returns:
        The height.
    """
    return robot.com_height - min(walk.crouch, robot.largest_crouch)


def _period(control: Control) -> float:
    """Control period in s: a whole number of physics steps."""
    steps = control.period / control.physics_period
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        raise SceneError(
            f"control.period is {control.period:g} s; allowed: a whole number of physics steps of "
            f"{control.physics_period:g} s (control.physics_period)"
        )
    return control.period


def _refuse_unused(scene: Task, robot: Robot) -> None:
    """Refuse switches that need another one, and settings of what is switched off: they would do nothing."""
    control, steps = scene.control, StepAdjustmentRules()
    table = {**robot.controller.get("step_adjustment", {}), **scene.controller.get("step_adjustment", {})}
    solves = table.get("method", steps.method) == "ssp_opt"
    adjusts_double = table.get("double_support", steps.double_support)
    runs = {
        **dict.fromkeys(("compliance", "touchdown", "ground_map", "slope"), (control.pfc, "control.pfc = true")),
        "identification": (control.identify, "control.identify = true"),
        "dcm_filter": (control.dcm_estimate == "kalman", "control.dcm_estimate = 'kalman'"),
        "swing_fit": (control.swing_shape == "fit", "control.swing_shape = 'fit'"),
        "step_timing": (control.step_timing, "control.step_timing = true"),
        **dict.fromkeys(_OF_STEPS, (control.step_adjustment, "control.step_adjustment = true")),
        "step_weights": (
            control.step_adjustment and solves,
            "control.step_adjustment = true and step_adjustment.method = 'ssp_opt'",
        ),
        **dict.fromkeys(
            _OF_DOUBLE_SUPPORTS,
            (
                control.step_adjustment and adjusts_double,
                "control.step_adjustment = true and step_adjustment.double_support = true",
            ),
        ),
        **dict.fromkeys(
            ("push_estimate", "push_expected"),
            (control.push_estimate != "off", "control.push_estimate = 'soles' or 'skin'"),
        ),
        "learned_stride": (
            control.step_adjustment and control.learn_strides,
            "control.step_adjustment = true and control.learn_strides = true",
        ),
        "push_felt": (control.push_estimate == "skin", "control.push_estimate = 'skin'"),
        "feasibility": (
            control.pfc and control.feasibility != "off",
            "control.pfc = true and control.feasibility = 'skin' or 'force_torque'",
        ),
        "conformity": (control.pfc and control.conform, "control.pfc = true and control.conform = true"),
        **dict.fromkeys(("contact", "foothold"), (control.footholds != "off", "control.footholds = 'force' or 'skin'")),
    }
    for name, (used, needed) in runs.items():
        if scene.controller.get(name) and not used:
            keys = ", ".join(f"{name}.{key}" for key in scene.controller[name])
            raise SceneError(f"scene '{scene.name}' sets {keys}, which does nothing; allowed: with {needed}")
