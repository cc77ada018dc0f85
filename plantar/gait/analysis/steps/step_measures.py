"""Measures of one step without the steps around it: force, pressure, path of the CoP, wrench, footprint."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.steps.cop_path import cop_measures, excursion_index, margin_to_outline
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.force_curve import force_measures, landing_impact
from plantar.gait.analysis.steps.pressure_measures import robot_measures
from plantar.gait.analysis.steps.step_load import StepLoad
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["step_measures"]


def step_measures(
    recording: PressureRecording,
    gait: FootGait,
    contact: Contact,
    print_: Footprint | None,
    pressures: Mapping[str, float],
    load: StepLoad | None = None,
) -> dict[str, float]:
    """Returns the known measures by key of one step that do not need other steps.

    Args:
        recording: The recording.
        gait: One foot of it.
        contact: The step, complete.
        print_: The footprint of lengths and regions; None without geometry.
        pressures: Measures of its pressures; empty where none are known.
        load: Load of a robot's cells in the step.
    """
    foot, span = gait.foot, slice(contact.begin, contact.end)
    force, time = foot.vertical_force[span], recording.time[span]
    known = np.isfinite(force)
    strike = cast(float, contact.heel_strike)
    out = force_measures(time[known], force[known], strike, cast(float, contact.toe_off)) | dict(pressures)
    out["landing_impact_N"] = landing_impact(recording.time, foot.vertical_force, strike)
    if out.get("footprint_area_m2", 0.0) > 0.0:
        out["force_time_integral_area_Pas"] = out["impulse_Ns"] / out["footprint_area_m2"]
    if gait.cop is not None:
        out |= _cop_measures(recording, gait, time, gait.cop[span], print_)
    if load is not None and foot.layout is not None and gait.cop is not None:
        out |= robot_measures(load, foot.layout)
    if foot.wrench is not None:
        out |= _wrench_measures(recording, foot.wrench[span])
    if print_ is not None and recording.kind == "platform":
        out |= {"arch_index": print_.arch_index(), "foot_length_m": print_.length, "foot_width_m": print_.width}
    return {key: float(value) for key, value in out.items()}


def _cop_measures(
    recording: PressureRecording,
    gait: FootGait,
    time: NDArray[np.float64],
    cop: NDArray[np.float64],
    print_: Footprint | None,
) -> dict[str, float]:
    """Measures of the CoP (m, 2) of one step: its path, and its margins to the edges."""
    kind, layout = recording.kind, gait.foot.layout
    # On a platform the foot's own axis is forward, in a sole the sole's.
    out = cop_measures(time, print_.in_foot(cop) if print_ is not None and kind == "platform" else cop)
    across = gait.sole if kind == "insole" else print_
    if across is not None and kind != "robot":
        out["cpei_percent"] = excursion_index(across, cop)
    if layout is not None:
        inside = cop[np.isfinite(cop[:, 0])]
        if kind in ("insole", "robot") and len(inside):
            out["cop_margin_m"] = margin_to_outline(layout, inside)
    return out


def _wrench_measures(recording: PressureRecording, wrench: NDArray[np.float64]) -> dict[str, float]:
    """Largest magnitudes of a wrench (m, 6); of a force plate, whose origin is not the sole's, without tx and ty."""
    wrench = wrench[np.isfinite(wrench).all(axis=1)]
    if not len(wrench):
        return {}
    fx, fy, _, tx, ty, tz = np.abs(wrench).max(axis=0)
    out = {"fx_peak_N": fx, "fy_peak_N": fy, "tz_peak_Nm": tz}
    return out | ({"tx_peak_Nm": tx, "ty_peak_Nm": ty} if recording.kind == "robot" else {})
