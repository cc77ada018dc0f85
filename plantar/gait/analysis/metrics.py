"""Analysis as the plain values of metrics.json."""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from plantar.gait.analysis.activity import activity_of, loaded_frames, progression_doubts, sway_measures
from plantar.gait.analysis.direction import direction_notes, direction_of
from plantar.gait.analysis.health import (
    creep_doubts,
    implied_weight,
    inverted_doubts,
    mirrored_doubts,
    scrambled_doubts,
    silent_cell_doubts,
    uneven_doubts,
    weight_doubts,
)
from plantar.gait.analysis.measure_errors import errors_of_foot
from plantar.gait.analysis.measures import naming
from plantar.gait.analysis.pages.tables import EACH_STEP
from plantar.gait.analysis.steps.events import LEAST_FRAMES, MINIMUM_STANCE, find_contacts
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.gait.analysis.steps.segments import Segment, segments_of
from plantar.gait.analysis.steps.stated import stated_beside_own
from plantar.gait.analysis.steps.step_measures import landing_impact
from plantar.gait.analysis.subject import Subject, device_of, mass_doubts, subject_of
from plantar.gait.analysis.summary import gait_of_feet, regions_of_foot, spread, summary_of_foot, symmetry
from plantar.layouts.layout import Side
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

_FEWEST_FRAMES = 12.0  # Frames a second below which forces of steps cannot be told from noise


def metrics_of(
    recording: PressureRecording, feet: Mapping[Side, FootGait], subject: Subject | None = None
) -> dict[str, Any]:
    """Returns analysis of a `recording`, the gait of each of its `feet` and a `subject` as plain JSON values
    (docs/metrics.md); None if unknown.

    Raw counts' keys end in "_raw" in place of a unit of force or pressure.
    """
    warnings = list(recording.warnings)
    activity = activity_of(recording, feet)
    standing = activity.name == "standing"
    if standing:
        measured = "loads and sway" if any(gait.cop is not None for gait in feet.values()) else "loads"
        warnings.append(f"this is standing: {activity.why}; {measured} are measured, steps are not")
    warnings += inverted_doubts(recording, feet)
    for side, gait in feet.items():
        if standing:
            continue
        if not np.isfinite(gait.foot.vertical_force).any():
            warnings.append(f"no frame of the {side} foot was measured: no steps")
        elif not gait.contacts:
            warnings.append(f"the {side} foot {_why_no_contact(recording, gait)}: no steps")
        elif not gait.steps:
            warnings.append(f"the {side} foot has no complete step: each contact is cut off{_lowest(gait)}")
        warnings += gait.warnings
    direction = None if standing else direction_of(feet)
    warnings += direction_notes(feet, direction)
    weight = implied_weight(recording, feet)
    subject = subject_of(recording, subject)
    segments = () if standing else segments_of(feet)
    warnings += _segment_notes(segments, feet)
    warnings += silent_cell_doubts(recording) + scrambled_doubts(recording) + creep_doubts(feet)
    warnings += uneven_doubts(recording, feet)
    warnings += progression_doubts(recording, feet) + mirrored_doubts(recording, feet)
    warnings += weight_doubts(recording, weight) + mass_doubts(subject, weight)
    named = naming(recording.raw)
    return {
        "format": recording.format,
        "kind": recording.kind,
        "subject": dataclasses.asdict(subject),
        "device": device_of(recording),
        "frames": recording.metadata.get("frames", len(recording.time)),
        "rate_hz": recording.rate_hz,
        "duration_s": float(recording.time[-1] - recording.time[0]),
        "raw": recording.raw,
        "grid": None if recording.grid is None else {"rows": recording.grid[0], "columns": recording.grid[1]},
        "activity": dataclasses.asdict(activity),
        "segments": [_segment(segment, feet) for segment in segments],
        "feet": {
            side: _foot(recording, gait) | {"sway": _sway(recording, gait, standing)} for side, gait in feet.items()
        },
        "not_given": not_given(recording.kind),
        "gait": {
            **gait_of_feet(feet),
            "direction": direction,
            "implied_weight_N": weight,
            "body_weight_N": None if recording.raw else subject.weight or weight,
            "symmetry_percent": {named(key): value for key, value in symmetry(feet).items()},
        },
        "warnings": list(dict.fromkeys(warnings)),
    }


def _why_no_contact(recording: PressureRecording, gait: FootGait) -> str:
    force = gait.foot.vertical_force
    levels = gait.levels
    if (count := int(np.isfinite(force).sum())) < LEAST_FRAMES:
        return f"has {count} frame(s), too few for a contact"
    if levels is not None and find_contacts(recording.time, force, levels, minimum_stance=0.0):
        return f"has no contact of {MINIMUM_STANCE:g} s or longer"
    few = f", as far as {recording.rate_hz:g} frames a second show (steps take {_FEWEST_FRAMES:g} or more)"
    return f"carries no load above its noise{few if recording.rate_hz < _FEWEST_FRAMES else ''}"


def _segment(segment: Segment, feet: Mapping[Side, FootGait]) -> dict[str, Any]:
    numbers = {side: set(own) for side, own in segment.steps.items()}
    steps = [s for side, own in numbers.items() for s in feet[side].steps if s.number in own]
    means = {
        key: spread([s[key] for s in steps]).mean
        for key in ("stride_time_s", "contact_time_s", "double_support_percent")
    }
    stride = means["stride_time_s"]
    return {
        "activity": segment.activity,
        "begin_s": segment.begin,
        "end_s": segment.end,
        "steps": {side: len(own) for side, own in segment.steps.items()},
        "used": sum(s.used for s in steps),
        "cadence_steps_per_min": None if stride is None else 120.0 / stride,
        **means,
    }


def _segment_notes(segments: Sequence[Segment], feet: Mapping[Side, FootGait]) -> list[str]:
    if len(segments) < 2:
        return []
    parts = ", ".join(
        f"{s.activity} {s.begin:.1f} to {s.end:.1f} s" + (f" ({s.count} steps)" if s.count else "")
        for s in segments[:6]
    )
    more = f" and {len(segments) - 6} more" if len(segments) > 6 else ""
    used = list(dict.fromkeys(s.activity for gait in feet.values() for s in gait.used if s.activity))
    means = f"; means are of {' and '.join(used)} (--segment, --from and --to choose)" if used else ""
    return [f"the recording has {len(segments)} segments: {parts}{more}{means}"]


def _lowest(gait: FootGait) -> str:
    """Note on a foot whose force never comes down: standing, or an offset that no walk shows."""
    force = gait.foot.vertical_force[np.isfinite(gait.foot.vertical_force)]
    low, high = (float(v) for v in np.percentile(force, (2.0, 95.0))) if len(force) else (0.0, 0.0)
    return f"; its force never falls below {low:.3g}" if low > 0.2 * high > 0.0 else ""


def _sway(recording: PressureRecording, gait: FootGait, standing: bool) -> dict[str, float] | None:
    if not standing:
        return None
    span = loaded_frames(recording)
    load = {side: float(np.nanmean(foot.vertical_force[span])) for side, foot in recording.feet.items()}
    share = 100.0 * load[gait.foot.side] / sum(load.values())
    return {"load_percent": share, **({} if gait.cop is None else sway_measures(recording.time[span], gait.cop[span]))}


def not_given(kind: str) -> dict[str, str]:
    """Measures that this kind of sensor cannot give, with reasons."""
    if kind not in ("insole", "robot"):
        return {}
    what = "an insole" if kind == "insole" else "a robot's sole"
    reason = f"{what} does not see the outline of a foot: shoe and threshold decide which of its cells are loaded"
    return dict.fromkeys(("arch_index", "foot_length_m", "foot_width_m"), reason)


def _foot(recording: PressureRecording, gait: FootGait) -> dict[str, Any]:
    foot = gait.foot
    named = naming(recording.raw)
    errors = errors_of_foot(recording, gait)
    known = {step.heel_strike_s: step["landing_impact_N"] for step in gait.steps}
    impacts = (
        known[strike] if strike in known else landing_impact(recording.time, foot.vertical_force, strike)
        for strike in gait.heel_strikes
    )
    return {
        "steps": len(gait.steps),
        "steps_used": [step.number for step in gait.used],
        "steps_unused": {str(step.number): step.unused for step in gait.steps if not step.used},
        "steps_odd": {str(step.number): step.odd for step in gait.steps if step.odd},
        "each_step": [_step(step, named) for step in gait.steps],
        "events": _events(gait, complete=True),
        "incomplete": _events(gait, complete=False),
        "landings_s": gait.heel_strikes,
        named("landing_impacts_N"): [_plain(impact) for impact in impacts],
        "stated_events": stated_beside_own(recording.events.get(foot.side), gait),
        "cells": foot.force.shape[1],
        "cell_area_m2": None if foot.layout is None else float(foot.layout.areas.mean()),
        "missing_percent": _missing_percent(recording, foot),
        **{named(key): level for key, level in _levels(gait).items()},
        "measures": {
            named(key): {**dataclasses.asdict(value), "error": errors.get(key)}
            for key, value in summary_of_foot(gait).items()
        },
        "regions": {
            region: {named(key): dataclasses.asdict(value) for key, value in values.items()}
            for region, values in regions_of_foot(gait).items()
        },
    }


def _missing_percent(recording: PressureRecording, foot: FootRecording) -> float:
    known: Mapping[Side, float] = recording.metadata.get("missing_percent", {})
    return known.get(foot.side, 0.0 if foot.missing is None else 100.0 * float(foot.missing.mean()))


def _step(step: Step, named: Callable[[str], str]) -> dict[str, Any]:
    out = {"number": step.number, "used": step.used, "note": step.unused or step.odd}
    times = {"heel_strike_s": step.heel_strike_s, "toe_off_s": step.toe_off_s}
    return {**out, **times, **{named(key): _plain(step[key]) for key in EACH_STEP}}


def _events(gait: FootGait, complete: bool) -> list[dict[str, float | None]]:
    return [{"heel_strike_s": c.heel_strike, "toe_off_s": c.toe_off} for c in gait.contacts if c.complete == complete]


def _levels(gait: FootGait) -> dict[str, float | None]:
    levels = gait.levels
    return {
        "event_level_N": None if levels is None else levels.release,
        "contact_level_N": None if levels is None else levels.contact,
        "toe_off_level_N": None if levels is None else min(levels.lift, levels.contact),
    }


def _plain(value: float) -> float | None:
    return value if math.isfinite(value) else None
