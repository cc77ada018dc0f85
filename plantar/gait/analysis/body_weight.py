"""Weight that a recording implies: over a stride the ground carries the body in any gait."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gravity import GRAVITY
from plantar.recordings.let_go import column_maxima
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sides import Side

__all__ = ["implied_weight", "weight_doubts"]

MASSES = (20.0, 200.0)
"""Masses in kg of people whose feet are measured; a wrong unit of pressure is wrong by 6.9 times or more."""

_STEPPING = 1.1
"""Largest force of a step in walking in body weights, for recordings of single steps (Perry & Burnfield 2010)."""

_FULL = 1.05
"""Share of its range that a taxel may read before it is more than its maker rated."""


def implied_weight(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> float | None:
    """Returns the weight in N of the body that makes a recording's forces on these feet; None of raw counts or if
    unknown.

    It is the impulses of a step of each foot over the stride time (of one foot twice its impulse); without strides the
    largest force of its steps over 1.1; in standing the mean force of both feet.
    """
    if recording.raw:
        return None
    impulses = {side: _median(gait, "impulse_Ns") for side, gait in feet.items()}
    strides = [v for gait in feet.values() if np.isfinite(v := _median(gait, "stride_time_s"))]
    known = [v for v in impulses.values() if np.isfinite(v)]
    if strides and known:
        return 2.0 * float(np.mean(known)) / float(np.mean(strides))
    peaks = [v for gait in feet.values() if np.isfinite(v := _median(gait, "peak_force_N"))]
    if peaks:
        return float(np.mean(peaks)) / _STEPPING
    measured = [foot.vertical_force[np.isfinite(foot.vertical_force)] for foot in recording.feet.values()]
    forces = [float(force.mean()) for force in measured if len(force)]
    return sum(forces) if len(forces) == 2 and min(forces) > 0.0 else None


def _median(gait: FootGait, key: str) -> float:
    values = np.array([step[key] for step in gait.used])
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else float("nan")


def weight_doubts(recording: PressureRecording, weight: float | None) -> list[str]:
    """Returns warnings where a recording implies a weight in N of no person, or a robot's taxels exceed their range."""
    if recording.kind == "robot":
        return [line for foot in recording.feet.values() if (line := _overload(recording, foot.side))]
    if weight is None:
        return []
    mass = weight / GRAVITY
    if MASSES[0] <= mass <= MASSES[1]:
        return []
    return [
        f"the forces imply a person of {mass:.3g} kg; people of {MASSES[0]:g} to {MASSES[1]:g} kg are usual: check the "
        "unit, the cell size and the insole's size (--unit, --layout, --insole-size override)"
    ]


def _overload(recording: PressureRecording, side: Side) -> str:
    """Note on a robot's foot whose taxels exceed their range, or empty."""
    foot = recording.feet[side]
    if foot.layout is None or recording.raw or "force" not in foot.layout.ranges or not len(foot.force):
        return ""
    highest, rated = float(column_maxima(foot.force).max()), float(max(foot.layout.ranges["force"]))
    if not rated > 0.0 or highest <= _FULL * rated:
        return ""
    return f"a taxel of the {side} sole reads {highest:.4g} N, its layout rates it for {rated:.4g} N: check the unit"
