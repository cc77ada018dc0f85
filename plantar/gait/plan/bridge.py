"""Bridges a DCM jump by a VRP shift in the support polygon (T 4.4.2)."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.gait.plan.vrp_plan import LipReference, VrpPlan
from plantar.geometry.polygon import closest_point
from plantar.mechanics.same_time import SAME_TIME

_RAMP = 0.15  # chosen: of the bridge's time at both ends, in which the VRP moves to where it bridges and back

Knots = tuple[list[float], list[NDArray[np.float64]]]


def bridged(
    plan: VrpPlan,
    knots: Knots,
    now: tuple[float, LipReference],
    window: tuple[float, float] | None,
    region: NDArray[np.float64],
    kept: tuple[int, NDArray[np.float64], float],
) -> tuple[VrpPlan, NDArray[np.float64]]:
    """The plan over other knots, bridged in a time window.

    `knots`: times in s and VRPs (2,) in m of rebuilt stances; `now`: time in s, and the plan then; `window`: bridge's
    begin and end in s; None for no bridge; `region`: convex (k, 2), world, in m for the bridge's VRP; empty for no
    limit; `kept`: first kept knot's index, and the kept knots' shift (2,) in m and delay in s. Returns the plan, and
    its DCM jump (2,) in m by the region.
    """
    time, state = now
    first, shift, delay = kept
    times, points, bridge = _with_bridge(knots, (time, state.vrp), window, plan.vrps[-1])
    new = plan.replanned(times, points, first, shift=shift, delay=delay)
    gap = state.dcm - new.dcm_waypoints[0]
    if bridge:
        push = gap / _response(times[: bridge[1] + 2], plan.omega)
        for i in bridge:
            wanted = points[i] + push
            nearest = closest_point(region, wanted)
            points[i] = wanted if nearest is None else nearest
        new = plan.replanned(times, points, first, shift=shift, delay=delay)
        gap = state.dcm - new.dcm_waypoints[0]
    return new, gap


def _with_bridge(
    knots: Knots, now: tuple[float, NDArray[np.float64]], window: tuple[float, float] | None, end: NDArray[np.float64]
) -> tuple[list[float], list[NDArray[np.float64]], list[int]]:
    """Knots from now with the bridge's, and the movable two's indices."""
    times = list(knots[0])
    points = list(knots[1])
    head_times = [now[0]]
    head = [now[1]]
    bridge: list[int] = []
    if window is not None:
        length = window[1] - window[0]
        before = [i for i, t in enumerate(times) if t <= window[0] + SAME_TIME]
        for i in before:
            if times[i] > now[0] + SAME_TIME:
                head_times.append(times[i])
                head.append(points[i])
        del times[: len(before)], points[: len(before)]
        ahead = points[0] if times else end
        bridge = [len(head), len(head) + 1]
        for share in (_RAMP, 1.0 - _RAMP):
            head_times.append(window[0] + share * length)
            head.append(head[bridge[0] - 1] + share * (ahead - head[bridge[0] - 1]))
        if times and times[0] > window[1] + SAME_TIME:  # a bridge inside a stance ends where the stance's VRP is
            head_times.append(window[1])
            head.append(ahead)
    # nature: floating point: knots that are nearer are one
    fresh = [i for i, t in enumerate(times) if t > head_times[-1] + 1e-6]
    return head_times + [times[i] for i in fresh], head + [points[i] for i in fresh], bridge


def _response(times: list[float], omega: float) -> float:
    """DCM at the first knot by 1 m of VRP at the two before the last."""
    dcm = 0.0
    vrp = [0.0] * (len(times) - 3) + [1.0, 1.0, 0.0]  # nature: the knots before
    for i in range(len(times) - 2, -1, -1):
        length = times[i + 1] - times[i]
        rate = (vrp[i + 1] - vrp[i]) / length
        dcm = vrp[i] + rate / omega + math.exp(-omega * length) * (dcm - vrp[i + 1] - rate / omega)
    return dcm
