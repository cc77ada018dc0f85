"""Settings of a walking controller's parts."""

import math
from collections.abc import Mapping
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, choice, fixed, number, share, switch
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.balance.ankle_strategy import AnkleRules
from plantar.gait.balance.dcm_balance import BalanceGains
from plantar.gait.balance.law import LawGains
from plantar.gait.contact.ground_map import GroundMapSettings
from plantar.gait.contact.stance_contact import ContactSettings
from plantar.gait.contact.standing_leg import StandingLeg
from plantar.gait.estimate.ankle_sensor import AnkleSensor
from plantar.gait.estimate.dcm_filter import DcmFilterRules
from plantar.gait.estimate.estimator import EstimatorGains
from plantar.gait.estimate.identification import IdentificationRules
from plantar.gait.estimate.push_estimate import PushRules
from plantar.gait.estimate.wrench_filter import WrenchFilterRules
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.ground_conformity import ConformityGains
from plantar.gait.feet.landing import Landing
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import SwingKind
from plantar.gait.plan.phases import Timing
from plantar.gait.propose.double_support_timing import DoubleSupportTimingRules
from plantar.gait.propose.dsp_opt import DspWeights
from plantar.gait.propose.feasibility import FeasibilityRules
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.learned_stride import LearnedStrideRules
from plantar.gait.propose.proposer_kind import ProposerKind
from plantar.gait.propose.ssp_opt import StepRegionRules, StepWeights
from plantar.gait.propose.step_adjustment import StepAdjustmentRules
from plantar.gait.propose.step_timing import StepTimingRules
from plantar.mechanics.leg_inertia import LegInertia
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.net_wrench import NetWrenchRules


class ControllerSettings(Settings):
    """Settings of a walk: numbers, and parts under their tables' names.

    A part that is None does not run; `plantar.gait.controller_tables` derives all lists from the field types.

    Attributes:
        com_height: CoM over the soles in m.
        spare_crouch: How much lower than that in m it may walk.
        mass: In kg.
        period: Control period in s.
        timing: Phase durations.
        swing_height: Swing foot clearance in m.
        swing: Swing path.
        ankle_reach: Distance in m along the sole within which an ankle bears the robot.
        outward: Share of the way from a sole's middle to its outer edge where it is loaded, as a sole that leans.
        trunk_lean: Torso roll in rad per metre of the CoM from the feet's middle.
        balance: Gains; they make the law.
        proposers: Of other packages, that run in this walk.
        feedback: False walks in open loop, for comparison.
        zmp_source: Source of loads and ZMP: "skin", or "force_torque" at the ankles.
        ankles: Their force-torque sensors, if any.
        ankle_limits: Strips (m, 5) of each sole where weight can act on that foot alone
            (`plantar.gait.contact.ankle_limits`); empty without limits.
        standing_legs: How high each leg has to stand for its knee; empty without limits.
        leg_inertia: Of a leg that swings, for plan and estimate.
        footholds: How footholds are found: "off" assumes whole soles, for comparison; "force" uses forces, "skin" also
            proximity.
        skin: Upper body skin (`Sensors.skin`): on the base, base frame, and on links posed by `Sensors.links`.
    """

    com_height: float
    mass: float
    spare_crouch: float = number(0.0, "m", 0.0, 0.5)
    period: float = number(0.005, "s", 1e-4, 0.1)  # nature: K Table 1
    timing: Timing = field(default_factory=Timing)
    swing_height: float = share(1 / 12, "leg", 0.0, 1.0)  # nature: K Table 1, 0.05 m
    swing: SwingKind = field(default_factory=PolynomialSwing)
    ankle_reach: float = number(1.0, "m", 0.0, 1.0)  # derived: farther than any sole: no limit
    outward: float = number(0.0, "1", 0.0, 1.0)
    landing: Landing = field(default_factory=Landing)
    compliance: ComplianceGains | None = None
    touchdown: TouchdownGains = field(default_factory=TouchdownGains)
    ground_map: GroundMapSettings = field(default_factory=GroundMapSettings)
    feasibility: FeasibilityRules | None = None
    conformity: ConformityGains | None = None
    trunk_lean: float = number(0.0, "rad/m", 0.0, 10.0)
    lean_reach: float = fixed(53 / 600, "leg")  # Distance in m beyond which the lean stays; chosen: 53 mm on h1
    # Time constant in s of the command frame following real footholds; derived: as long as a double support, 0.3 s on
    # h1
    alignment_time: float = fixed(1.21, "beat")
    balance: LawGains = field(default_factory=BalanceGains)
    estimator: EstimatorGains = field(default_factory=EstimatorGains)
    dcm_filter: DcmFilterRules | None = None
    identification: IdentificationRules | None = None
    contact: ContactSettings = field(default_factory=ContactSettings)
    foothold: FootholdRules = field(default_factory=FootholdRules)
    step_timing: StepTimingRules | None = None
    step_adjustment: StepAdjustmentRules | None = None
    learned_stride: LearnedStrideRules | None = None
    step_region: StepRegionRules = field(default_factory=StepRegionRules)
    step_weights: StepWeights = field(default_factory=StepWeights)
    double_support_timing: DoubleSupportTimingRules = field(default_factory=DoubleSupportTimingRules)
    dsp_weights: DspWeights = field(default_factory=DspWeights)
    ankle_strategy: AnkleRules = field(default_factory=AnkleRules)
    proposers: tuple[ProposerKind, ...] = ()
    push_estimate: PushRules | None = None
    push_felt: NetWrenchRules | None = None
    push_expected: WrenchFilterRules = field(default_factory=WrenchFilterRules)
    feedback: bool = switch(True)
    zmp_source: str = choice("skin", "force_torque")
    ankles: Mapping[Side, AnkleSensor] = field(default_factory=dict)
    ankle_limits: Mapping[Side, NDArray[np.float64]] = field(default_factory=dict)
    standing_legs: Mapping[Side, StandingLeg] = field(default_factory=dict)
    leg_inertia: LegInertia = field(default_factory=LegInertia)
    footholds: str = choice("off", "force", "skin")
    skin: BodySkin | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("com_height", "mass"):
            if not 0.0 < getattr(self, name) < math.inf:
                raise InputError(f"setting '{name}' is {getattr(self, name)!r}; allowed: a finite number above 0")
