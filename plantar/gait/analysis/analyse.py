"""Analysis of one recording, from the file to the report."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from plantar.atomic import output_folder
from plantar.errors import InputError
from plantar.formats import ReadOptions, named_format, read_recording
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.activity import activity_of, progression_doubts, sway_measures
from plantar.gait.analysis.body_weight import implied_weight, weight_doubts
from plantar.gait.analysis.measures import MEASURES, REGION_MEASURES, raw_name
from plantar.gait.analysis.mirrored_feet import mirrored_doubts
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.gait.analysis.pages.footprint_report import analyse_image
from plantar.gait.analysis.pages.force_figures import figure_force, figure_steps, figure_symmetry, figure_wrench
from plantar.gait.analysis.pages.player import player_data
from plantar.gait.analysis.pages.report import report_page
from plantar.gait.analysis.pages.sole_figures import figure_pressure, figure_regions
from plantar.gait.analysis.pages.summary import gait_of_feet, regions_of_foot, summary_of_foot, symmetry
from plantar.gait.analysis.pages.tables import EACH_STEP
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.prints.platform import told_apart
from plantar.gait.analysis.spread import Spread
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.gait.analysis.steps.events import MINIMUM_STANCE, find_contacts
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.gait.analysis.steps.force_curve import landing_impact
from plantar.gait.analysis.steps.gaps import without_gaps
from plantar.gait.analysis.steps.stated import stated_beside_own
from plantar.gait.analysis.subject import Subject, device_of, mass_doubts
from plantar.layouts.layout import Side
from plantar.layouts.layout_file import read_layout
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

__all__ = ["Analysis", "analyse", "analyse_recording", "metrics_of", "not_given", "with_layout", "write_analysis"]

_ENDLESS = (math.inf, -math.inf)


@dataclass(frozen=True, eq=False)
class Analysis:
    """A recording, its feet and what was measured.

    Attributes:
        recording: The recording; a platform's with its footprints told apart.
        feet: The gait of each foot.
        metrics: What metrics.json holds.
    """

    recording: PressureRecording
    feet: Mapping[Side, FootGait]
    metrics: Mapping[str, Any]


def analyse_recording(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str],
    format: str | None = None,
    layout: str | os.PathLike[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
    *,
    options: ReadOptions | None = None,
    mm_per_pixel: float | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
    also: Callable[[Analysis, Path], None] | None = None,
) -> dict[str, Any]:
    """Analyse a recording or a footprint image; write metrics.json, tables, figures (PNG and SVG) and report.html.

    Args:
        path: The recording or image.
        out: Output folder, made if needed; nothing is left in it on an error.
        format: Name of the file's format; recognised from its content where None.
        layout: Layout file to use instead of the format's own geometry; mirrored for the other foot.
        progress: Called with a fraction 0..1 and what is being done.
        options: What else the user knows about the file.
        mm_per_pixel: Size of an image's pixel in mm.
        choices: Which steps are in the means, and whose events; a recording's only.
        subject: Who walks, as far as it is known.
        also: Called with the analysis and the folder, to write more there; see
            `plantar.gait.analysis.exports.exporter`.

    Returns:
        What metrics.json holds, and "files": the paths written.

    Raises:
        FormatError: If the file is not a recording that can be read.
        LayoutError: If the layout file is not valid.
        InputError: If the folder cannot be written to, or an option does not fit the file.
    """
    tell = progress or (lambda fraction, text: None)
    tell(0.0, "reading")
    known = with_layout(options, layout)
    image = named_format(path, format).read is None
    if mm_per_pixel is not None and not image:
        raise InputError(f"--mm-per-pixel is for footprint images; {path} is a recording")
    if also is not None and image:
        raise InputError(f"--export is for recordings; {path} is a footprint image")
    with output_folder(out, (path, layout, (choices or AnalysisOptions()).events_file)) as folder:
        if image:
            metrics = analyse_image(Path(path), folder, mm_per_pixel, known.side, subject)
        else:
            analysis = analyse(path, format, known, tell, choices, subject)
            metrics = dict(analysis.metrics)
            write_analysis(analysis, folder, lambda fraction, text: tell(0.5 + 0.5 * fraction, text))
            if also is not None:
                also(analysis, folder)
        names = sorted(p.name for p in folder.iterdir())
    tell(1.0, "done")
    return {**metrics, "files": [str(Path(out) / name) for name in names]}


def with_layout(options: ReadOptions | None, layout: str | os.PathLike[str] | None) -> ReadOptions:
    """The options with the layout of a file.

    Args:
        options: What the user knows about a file, or None.
        layout: Layout file, or None.

    Returns:
        The options.

    Raises:
        LayoutError: If the layout file is not valid.
    """
    options = options or ReadOptions()
    return options if layout is None else dataclasses.replace(options, layout=read_layout(layout))


def analyse(
    path: str | os.PathLike[str],
    format: str | None = None,
    options: ReadOptions | None = None,
    progress: Callable[[float, str], None] | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
) -> Analysis:
    """Read a recording and measure it; nothing is written.

    Args:
        path: The recording.
        format: Name of the file's format; recognised from its content where None.
        options: What the user knows about the file.
        progress: Called with a fraction 0..1 and what is being done; it ends at 0.5.
        choices: Which steps are in the means, and whose events.
        subject: Who walks, as far as it is known.

    Returns:
        The recording, its feet and their measures.

    Raises:
        FormatError: If the file is not a recording that can be read.
    """
    tell = progress or (lambda fraction, text: None)
    recording, prints = told_apart(read_recording(path, format, options=options))
    chosen = choices or AnalysisOptions()
    if chosen.events_file is not None:
        recording = dataclasses.replace(recording, events=read_events(chosen.events_file))
    recording = without_gaps(recording)
    if chosen.baseline == "auto":
        recording = without_baselines(recording)
    tell(0.3, "finding steps")
    feet = analyse_feet(recording, prints, chosen)
    tell(0.5, "drawing")
    return Analysis(recording, feet, metrics_of(recording, feet, subject))


def _why_no_contact(recording: PressureRecording, gait: FootGait) -> str:
    """Why no contact of a foot was found."""
    force, levels = gait.foot.vertical_force, gait.levels
    if levels is not None and find_contacts(recording.time, force, levels, minimum_stance=0.0):
        return f"has no contact of {MINIMUM_STANCE:g} s or longer"
    return "carries no load above its noise"


def write_analysis(analysis: Analysis, folder: Path, progress: Callable[[float, str], None] | None = None) -> None:
    """Write the tables, figures and report of an analysis.

    Args:
        analysis: The analysis.
        folder: Folder to write to, which exists.
        progress: Called with a fraction 0..1 and what is being done.
    """
    tell = progress or (lambda fraction, text: None)
    recording, feet, metrics = analysis.recording, analysis.feet, analysis.metrics
    figures = (
        (
            "pressure",
            figure_pressure(recording, feet),
            "Maximum pressure picture of each foot and CoP path of each step",
        ),
        ("regions", figure_regions(recording, feet), "Regions of each foot, its axis, and the thirds of its print"),
        ("force", figure_force(recording, feet), "Vertical force of each foot over time with its events"),
        (
            "steps",
            figure_steps(recording, feet),
            "Vertical force over the stance of all complete steps, mean and ± 1 SD",
        ),
        (
            "symmetry",
            figure_symmetry(symmetry(feet)),
            "Symmetry index of the main measures: the bars point to the foot whose value is larger",
        ),
        ("wrench", figure_wrench(recording, feet), "Wrench of the ground on each sole over time"),
    )
    embedded = write_figures(figures, folder, tell)
    (folder / "steps.csv").write_text(_steps_csv(feet, recording.raw), encoding="utf-8")
    if any(step.regions for gait in feet.values() for step in gait.steps):
        (folder / "regions.csv").write_text(_regions_csv(feet, recording.raw), encoding="utf-8")
    (folder / "metrics.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    player = player_data(recording, feet)
    page = report_page(metrics, embedded, title=recording.path.name, player=player)
    (folder / "report.html").write_text(page, encoding="utf-8")


def metrics_of(
    recording: PressureRecording, feet: Mapping[Side, FootGait], subject: Subject | None = None
) -> dict[str, Any]:
    """The analysis as plain JSON values; None where a value is not known.

    Args:
        recording: The recording.
        feet: The gait of each of its feet.
        subject: Who walks, as far as it is known.

    Returns:
        format, kind, subject, device, frames, rate_hz, duration_s, raw, grid, activity, feet, not_given, gait,
        warnings; see docs/metrics.md. In a recording of raw counts the keys end in "_raw" where they would else name a
        unit of force or pressure.
    """
    warnings = list(recording.warnings)
    activity = activity_of(recording, feet)
    standing = activity.name == "standing"
    if standing:
        warnings.append(f"this is standing: {activity.why}; sway is measured, steps are not")
    for side, gait in feet.items():
        if standing:
            continue
        if not np.isfinite(gait.foot.vertical_force).any():
            warnings.append(f"no frame of the {side} foot was measured: no steps")
        elif not gait.contacts:
            warnings.append(f"the {side} foot {_why_no_contact(recording, gait)}: no steps")
        elif not gait.steps:
            warnings.append(
                f"the {side} foot has no complete step: each contact is cut by the recording{_lowest(gait)}"
            )
        warnings += gait.warnings
    weight = implied_weight(recording, feet)
    subject = subject or Subject()
    warnings += progression_doubts(recording, feet) + mirrored_doubts(recording, feet)
    warnings += weight_doubts(recording, weight) + mass_doubts(subject, weight)
    named = _keys(recording.raw)
    indices = symmetry(feet)
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
        "feet": {
            side: _foot(recording, gait) | {"sway": _sway(recording, gait, standing)} for side, gait in feet.items()
        },
        "not_given": not_given(recording.kind),
        "gait": {
            **gait_of_feet(feet),
            "implied_weight_N": weight,
            "body_weight_N": None if recording.raw else subject.weight or weight,
            "symmetry_percent": {named(key): value for key, value in indices.items()},
        },
        "warnings": list(dict.fromkeys(warnings)),
    }


def _lowest(gait: FootGait) -> str:
    """What to say of a foot whose force never comes down: it stands, or its sensor has an offset that no walk shows."""
    force = gait.foot.vertical_force[np.isfinite(gait.foot.vertical_force)]
    low, high = (float(v) for v in np.percentile(force, (2.0, 95.0))) if len(force) else (0.0, 0.0)
    return f"; its force never falls below {low:.3g}" if low > 0.2 * high > 0.0 else ""


def _sway(recording: PressureRecording, gait: FootGait, standing: bool) -> dict[str, float] | None:
    """How a foot's CoP wanders in standing, and its share of the load; None of anything else."""
    if not standing:
        return None
    load = {side: float(np.nanmean(foot.vertical_force)) for side, foot in recording.feet.items()}
    share = 100.0 * load[gait.foot.side] / sum(load.values())
    return {"load_percent": share, **({} if gait.cop is None else sway_measures(recording.time, gait.cop))}


def not_given(kind: str) -> dict[str, str]:
    """Measures that this kind of sensor cannot give, each with the reason.

    Args:
        kind: What measured.

    Returns:
        The reasons by key.
    """
    if kind not in ("insole", "robot"):
        return {}
    what = "an insole" if kind == "insole" else "a robot's sole"
    reason = f"{what} does not see the outline of a foot: shoe and threshold decide which of its cells are loaded"
    return dict.fromkeys(("arch_index", "foot_length_m", "foot_width_m"), reason)


def _keys(raw: bool) -> Callable[[str], str]:
    return raw_name if raw else lambda key: key


def _foot(recording: PressureRecording, gait: FootGait) -> dict[str, Any]:
    foot, named = gait.foot, _keys(recording.raw)
    landings = [c.heel_strike for c in gait.contacts if c.heel_strike is not None]
    impacts = (landing_impact(recording.time, foot.vertical_force, strike) for strike in landings)
    return {
        "steps": len(gait.steps),
        "steps_used": [step.number for step in gait.used],
        "steps_unused": {str(step.number): step.unused for step in gait.steps if not step.used},
        "steps_odd": {str(step.number): step.odd for step in gait.steps if step.odd},
        "each_step": [_step(step, named) for step in gait.steps],
        "events": _events(gait, complete=True),
        "incomplete": _events(gait, complete=False),
        "landings_s": landings,
        named("landing_impacts_N"): [_plain(impact) for impact in impacts],
        "stated_events": stated_beside_own(recording.events.get(foot.side), gait),
        "cells": foot.force.shape[1],
        "cell_area_m2": None if foot.layout is None else float(foot.layout.areas.mean()),
        "missing_percent": _missing_percent(recording, foot),
        **{named(key): level for key, level in _levels(gait).items()},
        "measures": _spreads(summary_of_foot(gait), named),
        "regions": {region: _spreads(values, named) for region, values in regions_of_foot(gait).items()},
    }


def _missing_percent(recording: PressureRecording, foot: FootRecording) -> float:
    """Share of a foot's values that the file does not hold; gaps may have been filled since."""
    known: Mapping[Side, float] = recording.metadata.get("missing_percent", {})
    return known.get(foot.side, 0.0 if foot.missing is None else 100.0 * float(foot.missing.mean()))


def _step(step: Step, named: Callable[[str], str]) -> dict[str, Any]:
    """What the report's table shows of one step."""
    out = {"number": step.number, "used": step.used, "note": step.unused or step.odd}
    times = {"heel_strike_s": step.heel_strike_s, "toe_off_s": step.toe_off_s}
    return {**out, **times, **{named(key): _plain(step[key]) for key in EACH_STEP}}


def _events(gait: FootGait, complete: bool) -> list[dict[str, float | None]]:
    """Heel strike and toe off in s of the contacts that were recorded whole, or of those that were not."""
    return [{"heel_strike_s": c.heel_strike, "toe_off_s": c.toe_off} for c in gait.contacts if c.complete == complete]


def _levels(gait: FootGait) -> dict[str, float | None]:
    """Force levels of the events."""
    levels = gait.levels
    return {
        "event_level_N": None if levels is None else levels.release,
        "contact_level_N": None if levels is None else levels.contact,
        "toe_off_level_N": None if levels is None else min(levels.lift, levels.contact),
    }


def _spreads(values: Mapping[str, Spread], named: Callable[[str], str]) -> dict[str, Any]:
    return {named(key): dataclasses.asdict(value) for key, value in values.items()}


def _plain(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _steps_csv(feet: Mapping[Side, FootGait], raw: bool) -> str:
    """One row a complete step of either foot, in the order of time; empty where a value is not known."""
    steps = sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    names = [_keys(raw)(name) for name in MEASURES]
    rows = [
        [
            s.side,
            s.number,
            s.heel_strike_s,
            s.toe_off_s,
            *(s[name] for name in MEASURES),
            int(s.used),
            s.unused or s.odd,
        ]
        for s in steps
    ]
    return _csv(["side", "number", "heel_strike_s", "toe_off_s", *names, "used", "note"], rows)


def _regions_csv(feet: Mapping[Side, FootGait], raw: bool) -> str:
    """One row a region of a complete step."""
    steps = sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    rows = [
        [s.side, s.number, region, *(values.get(name, math.nan) for name in REGION_MEASURES)]
        for s in steps
        for region, values in s.regions.items()
    ]
    return _csv(["side", "number", "region", *(_keys(raw)(name) for name in REGION_MEASURES)], rows)


def _csv(names: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in rows:
        writer.writerow(["" if v != v or v in _ENDLESS else v for v in row])  # only NaN differs from itself
    return text.getvalue()
