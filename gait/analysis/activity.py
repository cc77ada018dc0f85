"""What a recording is of: walking, running or standing; and how a standing body sways."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gait.analysis.steps.foot_gait import FootGait
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sides import Side

__all__ = ["Activity", "activity_of", "sway_measures"]

_FLIGHT = 0.01
"""Median time in s with both feet off the ground from which steps are those of a run: above what events err."""

_RUNNING_STANCE = 45.0
"""Stance in % of the stride under which one foot's steps are those of a run: walking has 58 to 65, a run below 45."""

_STEADY = 0.5
"""Share of the usual load that a standing body keeps on the ground."""

_CHI2 = -2.0 * math.log(0.05)
"""95 % quantile of the chi-squared distribution with two degrees of freedom."""

_SHORTEST = 5.0
"""Time in s of standing under which sway means nothing: its slow part has periods of seconds."""


@dataclass(frozen=True)
class Activity:
    """What somebody does in a recording.

    Attributes:
        name: "walking", "running", "standing" or "unknown".
        why: What tells.
    """

    name: str
    why: str


def activity_of(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Activity:
    """Tell walking, running and standing apart.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        The activity. Stairs, ramps and turns load the feet as walking does, and are not told from it.
    """
    steps = [step for gait in feet.values() for step in gait.used]
    flights = [v for step in steps if np.isfinite(v := step["flight_time_s"])]
    stances = [v for step in steps if np.isfinite(v := step["stance_percent"])]
    if flights:
        median = float(np.median(flights))
        if median > _FLIGHT:
            return Activity("running", f"both feet are off the ground for {median:.3g} s between steps")
        return Activity("walking", "a foot is on the ground at all times")
    if stances:
        median = float(np.median(stances))
        name = "running" if median < _RUNNING_STANCE else "walking"
        return Activity(name, f"the foot is on the ground for {median:.0f} % of its stride")
    if steps:
        return Activity("unknown", "single steps tell walking and running not apart")
    load = np.sum([np.nan_to_num(foot.vertical_force) for foot in recording.feet.values()], axis=0)
    usual = float(np.median(load)) if len(load) else 0.0
    if usual > 0.0 and float(np.percentile(load, 2.0)) > _STEADY * usual:
        return Activity("standing", "the load stays on the ground and no foot is lifted")
    return Activity("unknown", "no foot is lifted and set down again")


def sway_measures(time: NDArray[np.float64], points: NDArray[np.float64]) -> dict[str, float]:
    """How far and how quickly a centre of pressure wanders in standing.

    Args:
        time: Times (n,) in s.
        points: Positions (n, 2) forward and to the left in m, NaN where there is none.

    Returns:
        sway_ellipse_m2 (area of the 95 % prediction ellipse of a normal distribution with the points' covariance, pi
        times 5.99 times the root of its determinant; Schubert & Kirchner 2014, Gait Posture 39:518), sway_path_m,
        sway_velocity_m_s (path over time), sway_ap_m and sway_ml_m (standard deviations). Empty for less than 5 s.

    Example:
        >>> t = np.linspace(0.0, 10.0, 1001)
        >>> circle = 0.01 * np.column_stack([np.cos(2.0 * np.pi * t), np.sin(2.0 * np.pi * t)])
        >>> found = sway_measures(t, circle)
        >>> round(found["sway_path_m"], 3), round(found["sway_ap_m"], 4)
        (0.628, 0.0071)
    """
    known = np.isfinite(points).all(axis=1)
    if known.sum() < 10 or float(np.ptp(time[known])) < _SHORTEST:
        return {}
    at, when = points[known], time[known]
    pieces = np.hypot(*np.diff(at, axis=0).T)
    covariance = np.cov(at.T)
    ahead, across = (float(v) for v in at.std(axis=0, ddof=1))
    return {
        "sway_ellipse_m2": math.pi * _CHI2 * math.sqrt(max(0.0, float(np.linalg.det(covariance)))),
        "sway_path_m": float(pieces.sum()),
        "sway_velocity_m_s": float(pieces.sum()) / float(when[-1] - when[0]),
        "sway_ap_m": ahead,
        "sway_ml_m": across,
    }
