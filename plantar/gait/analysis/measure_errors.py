"""Standard errors of a step's measures."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.measures import MEASURES
from plantar.gait.analysis.steps.events import Levels
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import PressureRecording

# Standard error in s of heel strikes and toe offs by the form of the force (`benchmarks/gait_events.py`, all sets).
_EVENTS = {"insole": (2e-3, 7e-3), "robot": (3e-3, 5e-3), "platform": (4e-3, 5e-3), "plate": (4e-3, 5e-3)}
_FRAME = 12.0**-0.5  # Standard deviation of a place within a frame or a cell, as a share of its width
_EDGE = 3.5  # Cells at the edge of a print of n cells are about this times the root of n


def errors_of_foot(recording: PressureRecording, gait: FootGait) -> dict[str, float]:
    """Returns standard errors of one step's measures of a foot's `gait`, its steps measured, in a `recording`: by key
    in SI, by noise, rate, cells and events, and by calibration where the layout holds one.

    A mean over n steps errs by 1 / sqrt(n) of noise and frames, and fully of cells and definitions.
    """
    levels = gait.levels
    layout = gait.foot.layout
    if levels is None or not gait.used:
        return {}
    middle = {key: float(np.nanmedian(v)) for key, v in gait.columns.items() if np.isfinite(v).any()}
    out = _times(recording, levels, middle) | _forces(recording, gait, levels, middle)
    if layout is not None and gait.cop is not None:
        out |= _places(layout, levels, middle)
    if layout is not None and "contact_area_m2" in middle:
        out |= _pressures(layout, levels, gait.picture, middle)
    if layout is not None and layout.calibration is not None:
        out = _with_calibration(out, gait, layout, middle)
    return {key: error for key, error in out.items() if key in MEASURES and key in middle and np.isfinite(error)}


def _times(recording: PressureRecording, levels: Levels, middle: Mapping[str, float]) -> dict[str, float]:
    slope = max(1e-9, middle.get("loading_rate_N_s", 0.0) or 10.0 * levels.peak)
    frame = _FRAME / recording.rate_hz
    strike, lift = (float(np.hypot(np.hypot(frame, levels.noise / slope), own)) for own in _EVENTS[recording.kind])
    own = float(np.hypot(frame, levels.noise / slope))  # a definition's error is the same in each step
    stride = middle.get("stride_time_s", float("nan"))
    contact = float(np.hypot(strike, lift))
    share = 100.0 * contact / stride
    return {
        "contact_time_s": contact,
        "stride_time_s": 2.0**0.5 * own,
        "step_time_s": 2.0**0.5 * strike,
        "swing_time_s": contact,
        "stance_percent": share,
        "swing_percent": share,
        "double_support_percent": 2.0**0.5 * share,
        "single_support_percent": 2.0**0.5 * share,
        "flight_time_s": contact,
    }


def _forces(
    recording: PressureRecording, gait: FootGait, levels: Levels, middle: Mapping[str, float]
) -> dict[str, float]:
    noise = levels.noise
    step = 1.0 / recording.rate_hz
    peak = middle["peak_force_N"]
    contact = middle["contact_time_s"]
    force = float(np.hypot(noise, _FRAME * _fall_beside_peak(gait)))
    rise = 0.15 * contact
    impulse = float(np.hypot(noise * np.sqrt(contact * step), 0.02 * peak * _EVENTS[recording.kind][1]))
    return {
        **dict.fromkeys(("peak_force_N", "first_peak_N", "valley_N", "second_peak_N"), force),
        **dict.fromkeys(("first_peak_percent", "second_peak_percent", "valley_percent"), 100.0 * 2.0 * step / contact),
        "mean_force_N": float(
            np.hypot(impulse / contact, middle["mean_force_N"] * _EVENTS[recording.kind][1] / contact)
        ),
        "impulse_Ns": impulse,
        "loading_rate_N_s": float(np.hypot(2.0**0.5 * noise / rise, middle.get("loading_rate_N_s", 0.0) * step / rise)),
        "loading_rate_max_N_s": 2.0 * noise / step,
        "landing_impact_N": float(np.hypot(noise, middle["peak_force_N"] * _EVENTS[recording.kind][0] / 0.1)),
        **dict.fromkeys(("fx_peak_N", "fy_peak_N"), force),
    }


def _fall_beside_peak(gait: FootGait) -> float:
    falls = []
    for step in gait.used[:50]:
        force = gait.foot.vertical_force[step.contact.begin : step.contact.end]
        if len(force) > 2 and np.isfinite(force).all():
            at = int(np.clip(np.argmax(force), 1, len(force) - 2))
            falls.append(float(force[at] - 0.5 * (force[at - 1] + force[at + 1])))
    return max(0.0, float(np.mean(falls))) if falls else 0.0


def _places(layout: SoleLayout, levels: Levels, middle: Mapping[str, float]) -> dict[str, float]:
    cell = levels.noise / np.sqrt(len(layout))
    away = layout.positions[:, :2] - layout.positions[:, :2].mean(axis=0)
    turned = cell * np.sqrt((away**2).sum(axis=0))  # noise of the moment of all cells
    noise = turned / max(1e-9, middle["mean_force_N"])
    at_ends = turned / max(
        1e-9, 1.5 * (levels.release - levels.rest)
    )  # where a path begins and ends, and goes farthest
    loaded = max(1.0, middle.get("contact_area_m2", 0.0) / layout.areas.mean())
    pitch = float(np.sqrt(layout.areas.mean()))
    ahead, across = (float(np.hypot(n, _FRAME * pitch / np.sqrt(loaded))) for n in noise)
    pieces = max(1.0, middle["contact_time_s"] / 0.05)
    path = float(np.hypot(np.hypot(ahead, across) * min(np.sqrt(2.0 * pieces), 2.0), 2.0**0.5 * np.hypot(*at_ends)))
    return {
        "cop_path_m": path,
        "cop_excursion_ap_m": 2.0**0.5 * float(np.hypot(ahead, at_ends[0])),
        "cop_excursion_ml_m": 2.0**0.5 * float(np.hypot(across, at_ends[1])),
        "cop_velocity_m_s": path / middle["contact_time_s"],
        "cop_velocity_max_m_s": 2.0**0.5 * float(np.hypot(ahead, across)) / 0.05,
        "cpei_percent": 100.0 * 1.5 * across / float(np.ptp(layout.outline[:, 1])),
        "cop_margin_m": across,
        "cop_margin_polygon_m": 0.5 * pitch,
        "cop_margin_polygon_mean_m": 0.5 * pitch / np.sqrt(pieces),
        **dict.fromkeys(("foot_length_m", "foot_width_m"), 2.0 * _FRAME * pitch),
    }


def _pressures(
    layout: SoleLayout, levels: Levels, picture: NDArray[np.float64] | None, middle: Mapping[str, float]
) -> dict[str, float]:
    cell = levels.noise / np.sqrt(len(layout))
    area = float(layout.areas.mean())
    peak = middle["peak_pressure_Pa"]
    over = 0.0
    if picture is not None and (picture > 0.0).any():
        top = int(np.argmax(picture))
        near = [j for j in layout.neighbours[top] if j >= 0]
        over = (float(picture[top]) - float(picture[near].mean())) / 6.0 if near else 0.0  # of a parabola
    share = float(np.hypot(cell / area, over)) / peak if peak > 0.0 else float("nan")
    edge = {key: area * np.sqrt(_EDGE * np.sqrt(middle[key] / area) / 12.0) for key in _AREAS if key in middle}
    shared = edge["footprint_area_m2"] / max(area, middle["footprint_area_m2"])
    return {
        **{key: share * middle[key] for key in _PEAKS if key in middle},
        **{key: shared * middle[key] for key in _PER_AREA if key in middle},
        **edge,
    }


def _with_calibration(
    errors: Mapping[str, float], gait: FootGait, layout: SoleLayout, middle: Mapping[str, float]
) -> dict[str, float]:
    """Errors with those of the calibration's gains, which are the same in each step."""
    known = layout.calibration
    assert known is not None
    steps = gait.used[:50]
    loads = np.mean([np.nanmean(gait.foot.force[s.contact.begin : s.contact.end], axis=0) for s in steps], axis=0)
    share = known.load_deviation(loads)
    cell = float(np.median(known.gain_error))
    away = known.cop_deviation(layout, loads)
    ahead, across = (0.0, 0.0) if away is None else away.tolist()
    own: dict[str, float] = {key: share * abs(middle[key]) for key in _LOADS if key in middle}
    own |= {key: cell * middle[key] for key in _PEAKS if key in middle}
    own |= {"cop_excursion_ap_m": ahead, "cop_excursion_ml_m": across, "cop_margin_m": across}
    own["cop_path_m"] = 2.0**0.5 * float(np.hypot(ahead, across))
    return {key: float(np.hypot(error, own.get(key, 0.0))) for key, error in errors.items()}


_LOADS = (
    *("peak_force_N", "first_peak_N", "valley_N", "second_peak_N", "mean_force_N", "impulse_Ns", "landing_impact_N"),
    *("loading_rate_N_s", "loading_rate_max_N_s", "mean_pressure_Pa", "mean_pressure_max_Pa"),
)
_AREAS = ("contact_area_m2", "footprint_area_m2", "support_polygon_area_m2", "support_polygon_mean_m2")
_PEAKS = ("peak_pressure_Pa", "pressure_time_integral_Pas", "pressure_time_integral_cell_Pas")
_PER_AREA = ("mean_pressure_Pa", "mean_pressure_max_Pa", "force_time_integral_area_Pas", "arch_index")
