"""From footsteps and timing to the VRP plan (T 4.1.3, steps 2 and 3)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gait.footsteps import Footstep
from gait.phases import PhaseKind, WalkSchedule
from gait.vrp_plan import VrpPlan
from plantar.layout import Side

__all__ = ["plan_vrps", "vrp_of_step"]


def vrp_of_step(step: Footstep, vrp_in_sole: ArrayLike) -> NDArray[np.float64]:
    """VRP over a footstep (T 4.13).

    Args:
        step: The footstep.
        vrp_in_sole: Its place (2,) in the sole frame in m.

    Returns:
        VRP (2,) in the world frame in m.
    """
    return np.asarray(step.position[:2] + step.rotation_sole_to_world[:2, :2] @ np.asarray(vrp_in_sole, dtype=float))


def plan_vrps(
    feet: Mapping[Side, Footstep],
    schedule: WalkSchedule,
    vrp_in_sole: Mapping[Side, NDArray[np.float64]],
    omega: float,
    com: ArrayLike | None = None,
) -> VrpPlan:
    """VRP plan of a walk: still in single support, linear from foot to foot in double support.

    Args:
        feet: Where the feet stand at the start.
        schedule: The footsteps with their phases.
        vrp_in_sole: VRP (2,) in each sole's frame in m, usually the sole's centroid.
        omega: Pendulum frequency in rad/s.
        com: CoM (2,) at the start in m; between the feet where None.

    Returns:
        The plan over the schedule's times; it starts and ends between the feet.
    """
    standing = dict(feet)
    first = schedule.phases[0].end

    def between() -> NDArray[np.float64]:
        return np.asarray(np.mean([vrp_of_step(standing[s], vrp_in_sole[s]) for s in standing], axis=0))

    times, points = [first - 1.0, first], [between(), between()]
    for phase in schedule.phases[1:]:
        if phase.kind == PhaseKind.SINGLE_SUPPORT:
            assert phase.stance is not None
            vrp = vrp_of_step(standing[phase.stance], vrp_in_sole[phase.stance])
            times += [phase.start, phase.end]
            points += [vrp, vrp]
            step = schedule.steps[phase.step]
            standing[step.side] = step
        elif phase.kind == PhaseKind.STANDING:
            times += [phase.start, phase.start + 1.0]
            points += [between(), between()]
    keep = [0] + [i for i in range(1, len(times)) if times[i] > times[i - 1]]
    return VrpPlan([times[i] for i in keep], [points[i] for i in keep], omega, com)
