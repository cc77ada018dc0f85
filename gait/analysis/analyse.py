"""Analysis of one recording, from the file to the report."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from gait.analysis.figures import figure_force, figure_pressure, figure_steps
from gait.analysis.parameters import (
    FootGait,
    Step,
    analyse_foot,
    gait_of_feet,
    landing_impact,
    summary_of_foot,
    symmetry,
)
from gait.analysis.report import report_page
from plantar.atomic import output_folder
from plantar.formats import read_recording
from plantar.layout import Side
from plantar.layout_file import read_layout
from plantar.plotting import save_figure
from plantar.pressure_recording import PressureRecording

__all__ = ["analyse_recording", "metrics_of"]


def analyse_recording(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str],
    format: str | None = None,
    layout: str | os.PathLike[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> dict[str, Any]:
    """Analyse a recording and write metrics.json, steps.csv, figures (PNG and SVG) and report.html.

    Args:
        path: The recording.
        out: Output folder, made if needed; nothing is left in it on an error.
        format: Name of the file's format; recognised from its content where None.
        layout: Layout file to use instead of the format's own geometry; mirrored for the other foot.
        progress: Called with a fraction 0..1 and what is being done.

    Returns:
        What metrics.json holds, and "files": the paths written.

    Raises:
        FormatError: If the file is not a recording that can be read.
        LayoutError: If the layout file is not valid.
        InputError: If the folder cannot be written to.
    """
    tell = progress or (lambda fraction, text: None)
    tell(0.0, "reading")
    sole = None if layout is None else read_layout(layout)
    recording = read_recording(path, format, sole)
    tell(0.3, "finding steps")
    feet: dict[Side, FootGait] = {side: analyse_foot(recording, side) for side in recording.feet}
    metrics = metrics_of(recording, feet)
    with output_folder(out) as folder:
        tell(0.5, "drawing")
        captions = {
            "pressure": (figure_pressure(feet), "Maximum pressure picture of each foot and CoP path of each step"),
            "force": (figure_force(recording, feet), "Vertical force of each foot over time with its events"),
            "steps": (figure_steps(recording, feet), "Vertical force over the stance of all complete steps"),
        }
        embedded: list[tuple[Path, str]] = []
        for i, (name, (figure, caption)) in enumerate(captions.items()):
            if figure is not None:
                embedded.append((save_figure(figure, folder / f"{name}.png"), caption))
                save_figure(figure, folder / f"{name}.svg")
            tell(0.5 + 0.15 * (i + 1), "drawing")
        (folder / "steps.csv").write_text(_steps_csv(feet), encoding="utf-8")
        (folder / "metrics.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
        page = report_page(metrics, embedded, title=recording.path.name)
        (folder / "report.html").write_text(page, encoding="utf-8")
        names = sorted(p.name for p in folder.iterdir())
    tell(1.0, "done")
    return {**metrics, "files": [str(Path(out) / name) for name in names]}


def metrics_of(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> dict[str, Any]:
    """The analysis as plain JSON values; None where a value is not known.

    Args:
        recording: The recording.
        feet: The gait of each of its feet.

    Returns:
        format, frames, rate_hz, duration_s, feet, gait, warnings; see docs/metrics.md.
    """
    warnings = list(recording.warnings)
    for side, gait in feet.items():
        if not gait.contacts:
            warnings.append(f"the {side} foot carries no load above its noise: no steps")
        elif not gait.steps:
            warnings.append(f"the {side} foot has no complete step: each contact is cut by the recording")
    return {
        "format": recording.format,
        "frames": len(recording.time),
        "rate_hz": recording.rate_hz,
        "duration_s": float(recording.time[-1] - recording.time[0]),
        "feet": {side: _foot(recording, gait) for side, gait in feet.items()},
        "gait": {**gait_of_feet(feet), "symmetry_percent": symmetry(feet)},
        "warnings": warnings,
    }


def _foot(recording: PressureRecording, gait: FootGait) -> dict[str, Any]:
    levels = gait.levels
    landings = [c.heel_strike for c in gait.contacts if c.heel_strike is not None]
    impacts = [landing_impact(recording.time, gait.foot.vertical_force, strike) for strike in landings]
    return {
        "steps": len(gait.steps),
        "events": [{"heel_strike_s": c.heel_strike, "toe_off_s": c.toe_off} for c in gait.contacts if c.complete],
        "incomplete": [
            {"heel_strike_s": c.heel_strike, "toe_off_s": c.toe_off} for c in gait.contacts if not c.complete
        ],
        "landings_s": landings,
        "landing_impacts_N": [_plain(impact) for impact in impacts],
        "cells": gait.foot.force.shape[1],
        "event_level_N": None if levels is None else levels.release,
        "contact_level_N": None if levels is None else levels.contact,
        "measures": {name: dataclasses.asdict(value) for name, value in summary_of_foot(gait).items()},
    }


def _plain(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _steps_csv(feet: Mapping[Side, FootGait]) -> str:
    """One row a complete step of either foot, in the order of time; empty where a value is not known."""
    steps = sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = [f.name for f in dataclasses.fields(Step)]
    writer.writerow(names)
    for step in steps:
        values = (getattr(step, name) for name in names)
        writer.writerow("" if isinstance(v, float) and not math.isfinite(v) else v for v in values)
    return text.getvalue()
