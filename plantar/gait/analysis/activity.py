"""Activity of a recording, and sway in standing."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.steps.cop_path import chords
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.segments import FLIGHT, most_common
from plantar.recordings.pressure_recording import PressureRecording, true_runs

# Stance in % of the stride of both feet above which they cannot both be in the air, with 2 % for what events err.
_HALF = 52.0
# Shares of its load that a standing body keeps on the ground, and from which it has stepped on.
_STEADY = 0.5
_WHOLE = 0.9
_STRIDE = 1.0  # Time in s of a stride: less does not show whether a foot is lifted
# Shares of the sole's length: the CoP lands in front of 0.6 on the forefoot (the heads of the metatarsals are at 0.7;
# a heel strike is below 0.33), stays in front of 0.55 where the heel never carries, and comes back by 0.15 where it
# does; from toes to heel it goes by 0.3 or more.
_FOREFOOT = 0.6
_NO_HEEL = 0.55
_DOWN = 0.15
_BACKWARD = 0.3
# Stairs up: the CoP lands in front of 0.45 of the sole (on the middle or front of the foot, as no heel strikes), the
# last hump of the force is at least 1.1 times the first one, and stance takes 62 % of the stride or more (McFadyen &
# Winter 1988, J. Biomech. 21:733; Riener et al. 2002, Gait Posture 15:32). One of these alone is also that of a slope
# or of a forefoot gait.
_UP_LANDING = 0.45
_UP_HUMPS = 1.1
_UP_STANCE = 62.0
_CHI2 = -2.0 * math.log(0.05)  # 95 % quantile of the chi-squared distribution with two degrees of freedom
# Contact times in s of running (0.2 to 0.35) and of walking (0.5 and more), for single steps (Novacheck 1998).
_RUN = 0.35
_WALK = 0.5
# How often a foot that does not stand is lifted at least: one that is put elsewhere once is lifted once or twice.
_LIFTS = 3
# Shares of a foot's peak above which it is on the ground and below which it is off it, and the share of both feet's
# usual load that its peak is above: of the foot in the air of somebody who stands on one leg it is noise.
_LOADED = 0.3
_FREE = 0.1
_CARRIES = 0.3
_SHORTEST = 5.0  # Time in s of standing under which sway means nothing: its slow part has periods of seconds


@dataclass(frozen=True)
class Activity:
    """Activity in a recording.

    `name`: "walking", "running", "standing", "walking up stairs", "walking down stairs", "toe walking", "walking
    without heel strike" (stairs up, a slope or a forefoot gait: not known which), "hopping" or "unknown".
    """

    name: str
    why: str


def activity_of(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Activity:
    """Returns activity of a recording with these feet.

    Landing on the front, then lowering the heel: down stairs; a heel that never carries: on the toes; landing in front
    of the heel with strong push-off: up stairs. Ramps and turns count as walking.
    """
    if any(step.activity == "hopping" for gait in feet.values() for step in gait.used or gait.steps):
        return Activity("hopping", "both feet land and lift together")
    found = _by_times(recording, feet)
    return (_by_landing(recording, feet) or found) if found.name == "walking" else found


def progression_doubts(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> list[str]:
    """Returns warnings about feet of a recording that roll from toes to heel, or were recorded at different times."""
    out = []
    if _out_of_step(feet):
        out.append(
            "both feet seem to be off the ground between steps, though each stands for more than half of its stride: "
            "check whether left and right were recorded at the same time"
        )
    for side, gait in feet.items():
        strides = _rolls(recording, gait)
        if len(strides) and float(np.median(strides[:, 0] - strides[:, 1])) > _BACKWARD:
            flat = recording.kind == "robot"
            reason = "this robot sets its soles down flat, or walks backwards" if flat else "this is walking backwards"
            out.append(
                f"the {side} foot's CoP goes from the toes to the heel: check the order of the cells and the layout, "
                f"unless {reason}"
            )
    return out


def _out_of_step(feet: Mapping[Side, FootGait]) -> bool:
    """Whether both feet seem to fly though each stands over half its stride: clocks disagree."""
    if len(feet) < 2:
        return False
    known = {
        s: [(f, p) for t in g.used if np.isfinite([f := t["flight_time_s"], p := t["stance_percent"]]).all()]
        for s, g in feet.items()
    }
    if not all(known.values()):
        return False
    medians = [np.median(np.array(rows), axis=0) for rows in known.values()]
    return max(float(m[0]) for m in medians) > FLIGHT and min(float(m[1]) for m in medians) > _HALF


def _rolls(recording: PressureRecording, gait: FootGait) -> NDArray[np.float64]:
    """CoP at landing, lift-off and hindmost, in shares of the sole (steps, 3)."""
    return gait.rolls if recording.kind in ("insole", "robot") else np.zeros((0, 3))


def _by_landing(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Activity | None:
    """Activity of steps that land on the forefoot; None for the heel or flat."""
    rolls = np.concatenate([_rolls(recording, gait) for gait in feet.values()])
    if len(rolls) < 3 or recording.kind != "insole":
        return None
    landing, end, hindmost = (float(v) for v in np.median(rolls, axis=0))
    if landing < _UP_LANDING or end < _FOREFOOT:
        return None
    if landing < _FOREFOOT or not (hindmost > _NO_HEEL or hindmost < landing - _DOWN):
        return _without_heel_strike(feet, landing)
    if hindmost > _NO_HEEL:
        why = f"the CoP stays in front of {100.0 * hindmost:.0f} % of the sole's length"
        return Activity("toe walking", f"{why}, as it also does up stairs on the front of the foot")
    why = f"the foot lands at {100.0 * landing:.0f} % of its length, then comes down to {100.0 * hindmost:.0f} %"
    return Activity("walking down stairs", f"{why}, as on stairs down")


def _without_heel_strike(feet: Mapping[Side, FootGait], landing: float) -> Activity:
    rows = [[s["second_peak_N"] / s["first_peak_N"], s["stance_percent"]] for g in feet.values() for s in g.used]
    known = [[v for v in column if np.isfinite(v)] for column in zip(*rows, strict=True)]
    humps, stance = (float(np.median(v)) if v else float("nan") for v in known)
    why = f"the foot lands at {100.0 * landing:.0f} % of its length, not on the heel"
    if humps >= _UP_HUMPS and stance >= _UP_STANCE:
        more = f"stands for {stance:.0f} % of its stride and pushes off with {humps:.2g} times its first peak"
        return Activity("walking up stairs", f"{why}, {more}, as on stairs up")
    return Activity(
        "walking without heel strike", f"{why}: stairs up, a slope or a forefoot gait; pressure does not show which"
    )


def _by_times(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Activity:
    steps = [step for gait in feet.values() for step in gait.used or gait.steps]
    name = most_common([step.activity for step in steps])
    flights = [
        float(np.median(own))
        for g in feet.values()
        if (own := [v for step in g.used or g.steps if np.isfinite(v := step["flight_time_s"])])
    ]
    stances = [v for step in steps if np.isfinite(v := step["stance_percent"])]
    if flights:
        off = f"both feet are off the ground for {max(flights):.3g} s"
        flies = max(flights) > FLIGHT and not _out_of_step(feet)
        if flies and name != "walking":
            return Activity("running", f"{off} between steps")
        stands = f"{off} in a stride, but a foot stands for {np.mean(stances):.0f} % of it" if flies else ""
        return Activity("walking", stands or "a foot is on the ground at all times")
    if stances:
        return Activity(name, f"the foot is on the ground for {np.median(stances):.0f} % of its stride")
    if steps:
        contact = float(np.median([step["contact_time_s"] for step in steps]))
        if contact >= _WALK or contact <= _RUN:
            name = "walking" if contact >= _WALK else "running"
            return Activity(
                name, f"single steps of {contact:.2g} s: those of a run last less than {_RUN:g} s, of a walk more"
            )
        return Activity("unknown", f"single steps of {contact:.2g} s are those of a walk or a run")
    span = loaded_frames(recording)
    load = np.sum([foot.vertical_force[span] for foot in recording.feet.values()], axis=0)
    load = load[np.isfinite(load)]  # what was not measured is no load, and no lack of it
    usual = float(np.median(load)) if len(load) else 0.0
    if any(_is_lifted(gait.foot.vertical_force, usual) for gait in feet.values()):
        return Activity("unknown", "feet are lifted and set down again, but no step is complete")
    lasts = float(np.ptp(recording.time[span])) if len(load) else 0.0
    if lasts >= _STRIDE and usual > 0.0 and float(np.percentile(load, 2.0)) > _STEADY * usual:
        return Activity("standing", "the load stays on the ground and no foot is lifted")
    return Activity("unknown", "no foot is lifted and set down again")


def loaded_frames(recording: PressureRecording) -> slice:
    """Frames of a recording from the first to the last with its whole load: who stands may step on and off."""
    load = np.sum([foot.vertical_force for foot in recording.feet.values()], axis=0)
    known = load[np.isfinite(load)]
    on = np.flatnonzero(load > _WHOLE * np.percentile(known, 95.0)) if len(known) else known
    return slice(int(on[0]), int(on[-1]) + 1) if len(on) else slice(0, 0)


def _is_lifted(force: NDArray[np.float64], usual: float) -> bool:
    """Whether a foot's force (n,) repeatedly leaves the ground, next to a usual load in N."""
    known = force[np.isfinite(force)]
    peak = float(np.percentile(known, 99.0)) if len(known) else 0.0
    if not peak > _CARRIES * usual:
        return False
    sure = known[(known > _LOADED * peak) | (known < _FREE * peak)]
    return int((np.diff((sure > _LOADED * peak).astype(int)) < 0).sum()) >= _LIFTS


def sway_measures(time: NDArray[np.float64], points: NDArray[np.float64]) -> dict[str, float]:
    """Returns distance and speed of the CoP in standing, by key.

    `time`: times (n,) in s; `points`: positions (n, 2) forward and to the left in m, NaN for none. Returns
    sway_ellipse_m2 (95 % prediction ellipse: 5.99 pi times the root of the covariance's determinant; Schubert &
    Kirchner 2014, Gait Posture 39:518), sway_path_m (see `chords`), sway_velocity_m_s, sway_ap_m and sway_ml_m
    (standard deviations). Empty below 5 s.

    Example:
        >>> t = np.linspace(0.0, 10.0, 1001)
        >>> circle = 0.01 * np.column_stack([np.cos(2.0 * np.pi * t), np.sin(2.0 * np.pi * t)])
        >>> found = sway_measures(t, circle)
        >>> round(found["sway_path_m"], 3), round(found["sway_ap_m"], 4)
        (0.626, 0.0071)
    """
    known = np.asarray(np.isfinite(points).all(axis=1))
    if known.sum() < 10 or float(np.ptp(time[known])) < _SHORTEST:
        return {}
    at = points[known]
    spans = [chords(time[i:j], points[i:j]) for i, j in true_runs(known) if j - i > 1]  # a gap has no path and no time
    if not spans:
        return {}
    path, seconds = (float(sum(part.sum() for part in column)) for column in zip(*spans, strict=True))
    covariance = np.cov(at.T)
    ahead, across = (float(v) for v in at.std(axis=0, ddof=1))
    return {
        "sway_ellipse_m2": math.pi * _CHI2 * math.sqrt(max(0.0, float(np.linalg.det(covariance)))),
        "sway_path_m": path,
        "sway_velocity_m_s": path / seconds,
        "sway_ap_m": ahead,
        "sway_ml_m": across,
    }
