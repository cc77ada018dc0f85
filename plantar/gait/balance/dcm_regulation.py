"""DCM regulation: only where the DCM is when a phase ends is controlled, not the way there (K 21-27).

Tracking feeds back the DCM's distance from the plan at every instant (T 4.28). Regulation applies the VRP that brings
the DCM to its goal by the end of the phase, so a footstep that has moved changes no trajectory at once (K 3.3).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.gait.balance.ankle_strategy import AnkleVrp, double_support_vrp, single_support_vrp, target_dcms
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.plan.walk_plan import PlanView

__all__ = ["phase_goal", "regulated_vrp"]


def phase_goal(plan: PlanView, phase: Phase, offset: NDArray[np.float64], omega: float) -> NDArray[np.float64] | None:
    """DCM (2,) in m at the end of a phase from which the walk could come to rest over its next step (K 21-24).

    Args:
        plan: The plan.
        phase: The phase now.
        offset: u_w (2,) in m by which a push is expected to move the VRP.
        omega: Pendulum frequency in rad/s.

    Returns:
        The goal; None in the first and the last phases of a walk, whose goal is the plan's.
    """
    step, schedule = phase.step, plan.schedule
    if phase.kind == PhaseKind.SINGLE_SUPPORT and step + 1 < plan.count:
        place, stance, following = plan.vrp(step), plan.stance_vrp(step), schedule.following(phase)
        stride, both = plan.vrp(step + 1) - place, following.end - following.start
        return target_dcms(place, stance, stride, schedule.timing.single_support, both, offset, omega).single_end
    if phase.kind == PhaseKind.DOUBLE_SUPPORT and plan.first < step < plan.count:
        place, both = plan.stance_vrp(step), phase.end - phase.start
        stride, single = plan.vrp(step) - place, schedule.timing.single_support
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
    """VRP u* that brings the DCM to its goal at the end of the phase (K 25-26), not yet limited (K 27).

    Args:
        plan: The plan.
        phase: The phase now.
        time: Time in s.
        dcm: DCM (2,) in m.
        goal: Its goal (2,) in m (`phase_goal`).
        offset: u_w (2,) in m.
        omega: Pendulum frequency in rad/s.

    Returns:
        The VRP; None in the first and the last phases of a walk.
    """
    if phase.kind == PhaseKind.SINGLE_SUPPORT:
        return single_support_vrp(dcm, goal, phase.end - time, offset, omega)
    if phase.kind == PhaseKind.DOUBLE_SUPPORT and plan.first < phase.step < plan.count:
        length, end = phase.end - phase.start, plan.stance_vrp(phase.step)
        return double_support_vrp(dcm, goal, end, length, time - phase.start, offset, omega)
    return None
