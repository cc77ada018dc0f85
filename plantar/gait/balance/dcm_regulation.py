"""DCM regulation: controls only the DCM at the end of a phase (K 21-27).

Tracking feeds back the DCM error at every instant (T 4.28); here a moved footstep changes no trajectory at once (K
3.3).
"""

import numpy as np
from numpy.typing import NDArray

from plantar.gait.balance.ankle_strategy import AnkleVrp, double_support_vrp, single_support_vrp, target_dcms
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.plan.walk_plan import PlanView


def phase_goal(plan: PlanView, phase: Phase, offset: NDArray[np.float64], omega: float) -> NDArray[np.float64] | None:
    """DCM (2,) in m at a phase's end that lets the walk rest over its next step (K 21-24).

    Returns it in the present `phase` of a `plan`, by a push's u_w, `offset` (2,) in m, and `omega` in rad/s; None in a
    walk's first and last phases, whose goal is the plan's.
    """
    step = phase.step
    schedule = plan.schedule
    if phase.kind == PhaseKind.SINGLE_SUPPORT and step + 1 < plan.count:
        place = plan.vrp(step)
        stance = plan.stance_vrp(step)
        following = schedule.following(phase)
        stride = plan.vrp(step + 1) - place
        both = following.end - following.start
        return target_dcms(place, stance, stride, schedule.timing.single_support, both, offset, omega).single_end
    if phase.kind == PhaseKind.DOUBLE_SUPPORT and plan.first < step < plan.count:
        place = plan.stance_vrp(step)
        both = phase.end - phase.start
        stride = plan.vrp(step) - place
        single = schedule.timing.single_support
        return target_dcms(place, place, stride, single, both, offset, omega).double_end
    return None


def regulated_vrp(
    plan: PlanView,
    phase: Phase,
    time: float,
    dcm: NDArray[np.float64],
    goal: NDArray[np.float64],
    offset: NDArray[np.float64],
    omega: float,
) -> AnkleVrp | None:
    """VRP u* that brings the DCM to its goal by the phase's end (K 25-26), unlimited (K 27).

    Returns u* by `plan`, its `phase` at a `time` in s, `dcm`, `goal` (`phase_goal`) and u_w, `offset`, each (2,) in m,
    and `omega` in rad/s; None in a walk's first and last phases.
    """
    if phase.kind == PhaseKind.SINGLE_SUPPORT:
        return single_support_vrp(dcm, goal, phase.end - time, offset, omega)
    if phase.kind == PhaseKind.DOUBLE_SUPPORT and plan.first < phase.step < plan.count:
        length = phase.end - phase.start
        end = plan.stance_vrp(phase.step)
        return double_support_vrp(dcm, goal, end, length, time - phase.start, offset, omega)
    return None
