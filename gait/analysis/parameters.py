"""Gait parameters: what each step, each foot and the walk as a whole measure. Definitions: docs/metrics.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import cast

import numpy as np
from numpy.typing import NDArray

from gait.analysis.cop_path import averaged_path, margin_to_outline
from gait.analysis.events import Contact, Levels, find_contacts, force_levels
from gait.analysis.spread import Spread, spread
from plantar.layout import Side
from plantar.pressure_recording import FootRecording, PressureRecording

__all__ = [
    "MEASURES",
    "FootGait",
    "Step",
    "analyse_foot",
    "gait_of_feet",
    "landing_impact",
    "summary_of_foot",
    "symmetry",
]

COP_WINDOW = 0.05
"""Time in s over which the centre of pressure is averaged, weighted by force: a path of noise has no length."""

NOISE_FRAMES = 5000
"""Frames of swing from which a cell's noise is judged: enough for 2 %."""

IMPACT_WINDOW = 0.05
"""Time in s after touchdown in which the landing impact is looked for."""


@dataclass(frozen=True)
class Step:
    """One complete contact of one foot. SI units; NaN where the recording cannot give the value.

    Attributes:
        side: "left" or "right".
        number: 1 for the first complete contact of its foot.
        heel_strike_s: Time of heel strike.
        toe_off_s: Time of toe off.
        contact_time_s: Toe off less heel strike.
        stride_time_s: Heel strike to the next heel strike of the same foot.
        step_time_s: Heel strike of the other foot before it, to this heel strike.
        swing_time_s: Toe off to the next heel strike of the same foot.
        stance_percent: Contact time as a share of the stride.
        swing_percent: Swing time as a share of the stride.
        double_support_percent: Share of the stride with both feet on the ground.
        peak_force_N: Largest vertical force.
        impulse_Ns: Vertical force over the contact time (force-time integral).
        landing_impact_N: Largest vertical force within 50 ms of heel strike.
        peak_pressure_Pa: Largest pressure of any cell.
        pressure_time_integral_Pas: Integral of the largest pressure of each frame.
        contact_area_m2: Largest area loaded at one instant.
        cop_path_m: Length of the path of the centre of pressure.
        cop_excursion_ap_m: Range of the centre of pressure from back to front.
        cop_excursion_ml_m: Range of the centre of pressure from side to side.
        cop_velocity_m_s: Path length over its time.
        cop_margin_m: Smallest distance of the centre of pressure to the edge of the sole's convex outline.
    """

    side: Side
    number: int
    heel_strike_s: float
    toe_off_s: float
    contact_time_s: float
    stride_time_s: float
    step_time_s: float
    swing_time_s: float
    stance_percent: float
    swing_percent: float
    double_support_percent: float
    peak_force_N: float
    impulse_Ns: float
    landing_impact_N: float
    peak_pressure_Pa: float
    pressure_time_integral_Pas: float
    contact_area_m2: float
    cop_path_m: float
    cop_excursion_ap_m: float
    cop_excursion_ml_m: float
    cop_velocity_m_s: float
    cop_margin_m: float


MEASURES: tuple[str, ...] = tuple(f.name for f in fields(Step))[4:]
"""Names of the measures of a step that have a mean and a spread."""


@dataclass(frozen=True, eq=False)
class FootGait:
    """One foot's recording with its events and steps.

    Attributes:
        foot: What was measured.
        levels: Force levels of its events, None where the foot carries no load.
        contacts: All contacts, also those cut by the recording.
        steps: The complete ones, measured.
        cop: Centre of pressure (n, 2) of each frame in the sole frame in m, averaged over 50 ms; NaN without load, None
            without geometry.
        cell_threshold: Force in N (k,) above which a cell counts as loaded.
    """

    foot: FootRecording
    levels: Levels | None
    contacts: tuple[Contact, ...]
    steps: tuple[Step, ...]
    cop: NDArray[np.float64] | None
    cell_threshold: NDArray[np.float64]


def analyse_foot(recording: PressureRecording, side: Side) -> FootGait:
    """Find the contacts of one foot and measure its complete steps.

    Args:
        recording: The recording.
        side: A foot that it has.

    Returns:
        The foot's gait. Measures that need the other foot use its contacts where it was recorded.
    """
    foot = recording.feet[side]
    force = foot.vertical_force
    levels = force_levels(force)
    contacts = find_contacts(recording.time, force, levels) if levels is not None else []
    other: Side = "right" if side == "left" else "left"
    others: list[Contact] | None = None
    if other in recording.feet:
        others = find_contacts(recording.time, recording.feet[other].vertical_force)
    cop = foot.center_of_pressure(levels.release if levels is not None else np.inf)
    if cop is not None:
        cop = averaged_path(cop, force, round(COP_WINDOW * recording.rate_hz))
    threshold = _cell_threshold(foot, contacts)
    steps: list[Step] = []
    for i, contact in enumerate(contacts):
        if not contact.complete:
            continue
        previous = contacts[i - 1].heel_strike if i > 0 else None
        following = contacts[i + 1].heel_strike if i + 1 < len(contacts) else None
        steps.append(
            _measure(recording, foot, contact, previous, following, others, cop, threshold, number=len(steps) + 1)
        )
    return FootGait(foot, levels, tuple(contacts), tuple(steps), cop, threshold)


def _cell_threshold(foot: FootRecording, contacts: Sequence[Contact]) -> NDArray[np.float64]:
    """A cell counts as loaded above its layout's threshold, and above 3 standard deviations of its noise in swing."""
    n, k = foot.force.shape
    base = 1e-3 if foot.layout is None else foot.layout.force_threshold
    air = np.ones(n, dtype=bool)
    for contact in contacts:
        air[contact.begin : contact.end] = False
    pairs = np.flatnonzero(air[:-1] & air[1:])[:NOISE_FRAMES]
    steps = np.abs(foot.force[pairs + 1] - foot.force[pairs])
    steps = steps[np.isfinite(steps).all(axis=1)]
    if len(steps) < 20:
        return np.full(k, base)
    noise = np.median(steps, axis=0) / (0.6745 * np.sqrt(2.0))
    return np.asarray(np.maximum(base, 3.0 * noise))


def _measure(
    recording: PressureRecording,
    foot: FootRecording,
    contact: Contact,
    previous: float | None,
    following: float | None,
    others: Sequence[Contact] | None,
    cop: NDArray[np.float64] | None,
    threshold: NDArray[np.float64],
    number: int,
) -> Step:
    strike, lift = cast(float, contact.heel_strike), cast(float, contact.toe_off)
    span = slice(contact.begin, contact.end)
    time, force = recording.time[span], foot.vertical_force[span]
    known = np.isfinite(force)
    time, force = time[known], force[known]
    stride = following - strike if following is not None else np.nan
    between = [
        c.heel_strike
        for c in others or ()
        if c.heel_strike is not None and previous is not None and previous < c.heel_strike < strike
    ]
    step_time = strike - between[0] if len(between) == 1 else np.nan
    double = _overlap(strike, lift, others, recording) / stride if others is not None else np.nan
    with np.errstate(invalid="ignore"):
        loaded = foot.force[span] > threshold
    peak_pressure = integral = area = np.nan
    pressure = foot.pressure(span)
    if pressure is not None and foot.layout is not None:
        frames = np.where(np.isfinite(pressure), pressure, 0.0).max(axis=1)
        peak_pressure = float(frames.max())
        integral = float(np.trapezoid(frames, recording.time[span]))
        area = float((loaded * foot.layout.areas).sum(axis=1).max())
    path = ap = ml = velocity = margin = np.nan
    if cop is not None and foot.layout is not None:
        points = cop[span]
        inside = np.isfinite(points[:, 0])
        points, moments = points[inside], recording.time[span][inside]
        if len(points) >= 2:
            path = float(np.hypot(*np.diff(points, axis=0).T).sum())
            ap, ml = (float(v) for v in np.ptp(points, axis=0))
            velocity = path / float(moments[-1] - moments[0])
            margin = margin_to_outline(foot.layout, points)
    return Step(
        side=foot.side,
        number=number,
        heel_strike_s=strike,
        toe_off_s=lift,
        contact_time_s=lift - strike,
        stride_time_s=stride,
        step_time_s=step_time,
        swing_time_s=following - lift if following is not None else np.nan,
        stance_percent=100.0 * (lift - strike) / stride,
        swing_percent=100.0 * (1.0 - (lift - strike) / stride),
        double_support_percent=100.0 * double,
        peak_force_N=float(force.max()),
        impulse_Ns=float(np.trapezoid(force, time)),
        landing_impact_N=landing_impact(recording.time, foot.vertical_force, strike),
        peak_pressure_Pa=peak_pressure,
        pressure_time_integral_Pas=integral,
        contact_area_m2=area,
        cop_path_m=path,
        cop_excursion_ap_m=ap,
        cop_excursion_ml_m=ml,
        cop_velocity_m_s=velocity,
        cop_margin_m=margin,
    )


def landing_impact(time: NDArray[np.float64], force: NDArray[np.float64], strike: float) -> float:
    """Largest vertical force in N within 50 ms of a heel strike; NaN where none was measured.

    Args:
        time: Times (n,) in s.
        force: Vertical force (n,) in N.
        strike: Time of the heel strike in s.

    Returns:
        The force in N.
    """
    window = force[np.searchsorted(time, strike) : np.searchsorted(time, strike + IMPACT_WINDOW, side="right")]
    window = window[np.isfinite(window)]
    return float(window.max()) if len(window) else float("nan")


def _overlap(strike: float, lift: float, others: Sequence[Contact] | None, recording: PressureRecording) -> float:
    """Time in s of one contact in which the other foot is on the ground too."""
    total = 0.0
    for other in others or ():
        begin = other.heel_strike if other.heel_strike is not None else float(recording.time[other.begin])
        end = other.toe_off if other.toe_off is not None else float(recording.time[other.end - 1])
        total += max(0.0, min(lift, end) - max(strike, begin))
    return total


def summary_of_foot(gait: FootGait) -> dict[str, Spread]:
    """Each measure of a foot over its complete steps."""
    return {name: spread([getattr(step, name) for step in gait.steps]) for name in MEASURES}


def gait_of_feet(feet: Mapping[Side, FootGait]) -> dict[str, float | int | None]:
    """Measures of the walk as a whole.

    Args:
        feet: The feet that were recorded.

    Returns:
        landings (heel strikes of all feet), stride_time_s (mean), cadence_steps_per_min (two steps in the median
        stride) and double_support_percent (mean); None where the recording cannot tell.
    """
    steps = [step for g in feet.values() for step in g.steps]
    strides = [s.stride_time_s for s in steps if np.isfinite(s.stride_time_s)]
    return {
        "landings": sum(c.heel_strike is not None for g in feet.values() for c in g.contacts),
        "stride_time_s": float(np.mean(strides)) if strides else None,
        "cadence_steps_per_min": 120.0 / float(np.median(strides)) if strides else None,
        "double_support_percent": spread([s.double_support_percent for s in steps]).mean,
    }


def symmetry(feet: Mapping[Side, FootGait]) -> dict[str, float | None]:
    """Symmetry index of each measure in percent: 100 (L - R) / ((L + R) / 2) of the feet's means (Robinson 1987).

    Args:
        feet: The feet that were recorded.

    Returns:
        0 for symmetry, above 0 where the left foot's value is larger; None where a foot has no value.
    """
    if "left" not in feet or "right" not in feet:
        return dict.fromkeys(MEASURES)
    left, right = summary_of_foot(feet["left"]), summary_of_foot(feet["right"])
    out: dict[str, float | None] = {}
    for name in MEASURES:
        a, b = left[name].mean, right[name].mean
        known = a is not None and b is not None and a + b != 0.0
        out[name] = 200.0 * (a - b) / (a + b) if known and a is not None and b is not None else None
    return out
