"""The controller's proposers and their order."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.path_drift import PathDrift
from plantar.gait.contact.support_strip import SupportStrip
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.identification import IdentificationRules
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.double_support_timing import DoubleSupportTiming
from plantar.gait.propose.edge_beside import EdgeBeside
from plantar.gait.propose.foothold_found import FootholdCarries
from plantar.gait.propose.foothold_refused import StepGuard
from plantar.gait.propose.foothold_seen import FootholdSeenAhead
from plantar.gait.propose.late_foot import LateFoot
from plantar.gait.propose.learned_stride import LearnedStride
from plantar.gait.propose.proposer import Proposer
from plantar.gait.propose.ssp_opt import touching_distance
from plantar.gait.propose.step_adjustment import StepAdjustment
from plantar.gait.propose.step_in_reach import StepInReach
from plantar.gait.propose.step_timing import StepTiming
from plantar.layouts.layout import SoleLayout

_NO_GROUND = 0.8  # chosen: of the taxels' sensing range: a sole that stands sees this far only where there is no ground
_SHORTEST_WALK = 1 / 12  # chosen: leg: a walk that is shorter has no direction


def proposers(
    settings: ControllerSettings,
    layouts: Mapping[Side, SoleLayout],
    plan: WalkPlan,
    feet: Mapping[Side, Footstep],
    begin: float,
    middles: Mapping[Side, NDArray[np.float64]],
    limits: Mapping[Side, AnkleLimits],
    guard: StepGuard | None,
) -> list[Proposer]:
    """Returns a walk's proposers in order.

    `begin`: plan's start in s; `middles`: point (2,) of each sole in m under its ankle; `limits`: of each ankle;
    `guard`: checks footholds; None allows all.
    """
    s = settings
    outlines = {side: layouts[side].outline for side in SIDES}
    start = plan.at(begin).com
    way = plan.end - start
    length = float(np.hypot(*way))
    forward = np.array([math.cos(feet["left"].yaw), math.sin(feet["left"].yaw)])
    strip = SupportStrip.for_body(s.body, start, way / length if length > _SHORTEST_WALK * s.body.leg else forward)
    found: list[Proposer] = [] if guard is None else [guard]
    found += [
        FootholdSeenAhead(s.foothold),
        FootholdCarries(s.foothold, middles, outlines, strip, s.ankle_reach),
        StepInReach(limits, middles, s.foothold.least_move, s.body.leg),
    ]
    if s.compliance is not None:
        found.append(LateFoot(s.body.beat, s.period))
        drift = None if s.footholds == "off" else _drift(s, layouts)
        found.append(EdgeBeside(layouts, s.foothold, _NO_GROUND * s.ground_map.sensing_range, drift))
    timing = None if s.step_timing is None else StepTiming(s.step_timing, s.period)
    if s.step_adjustment is None:
        return found if timing is None else [*found, timing]
    rules = s.step_adjustment, s.step_region, touching_distance(outlines), s.step_weights, s.ankle_strategy
    found.append(StepAdjustment(*rules, s.period, timing))
    if s.step_adjustment.double_support:
        timed = s.double_support_timing, s.dsp_weights, s.step_adjustment.confidence, s.period
        found.append(DoubleSupportTiming(*timed, s.ankle_strategy))
    if s.learned_stride is not None:
        found.append(LearnedStride(s.learned_stride))
    return found


def _drift(settings: ControllerSettings, layouts: Mapping[Side, SoleLayout]) -> PathDrift:
    """Returns the drift of the ground, whose edges are seen to a taxel."""
    taxel = max(layout.sole_area / len(layout) for layout in layouts.values())
    identified = settings.identification or IdentificationRules().for_body(settings.body)
    # derived: the variance of an even error that is a taxel wide, a twelfth of its square
    return PathDrift(math.sqrt(taxel / 12.0), identified.gyro_time)
