"""Analysis of one recording: in memory, or from a file to its tables, figures and report."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from plantar.atomic import output_folder
from plantar.errors import InputError
from plantar.formats import ReadOptions, named_format
from plantar.formats.given import recording_of
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.prints.platform import separated_feet
from plantar.gait.analysis.results import Analysis, write_analysis
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.gait.analysis.steps.gaps import without_gaps
from plantar.gait.analysis.subject import Subject
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import read_layout

__all__ = ["Progress", "analyse_one", "analyse_recording", "with_layout"]

Progress = Callable[[float, str], None]
"""Called with a fraction 0..1 and what is being done."""


def analyse_one(
    given: Any,
    format: str | None = None,
    options: ReadOptions | None = None,
    progress: Progress | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
) -> Analysis:
    """Returns the analysis of one recording.

    Args:
        given: A recording in any form of `plantar.formats.given.recording_of`.
        format: Name of a file's format; recognised from its content where None.
        options: What else is known of the data.
        progress: Called with a fraction 0..0.5 and what is being done.
        choices: Which steps are in the means, and which events are used.
        subject: The person. FormatError if the data is no recording that can be read.
    """
    report = progress or (lambda fraction, text: None)
    known = options or ReadOptions()
    if subject is not None and known.mass_kg is None:
        known = dataclasses.replace(known, mass_kg=subject.mass_kg)
    recording, prints = separated_feet(recording_of(given, format, known))
    chosen = choices or AnalysisOptions()
    if chosen.events_file is not None:
        recording = dataclasses.replace(recording, events=read_events(chosen.events_file))
    recording = without_gaps(recording)
    if chosen.baseline == "auto":
        recording = without_baselines(recording)
    report(0.3, "finding steps")
    feet = analyse_feet(recording, prints, chosen)
    report(0.5, "drawing")
    return Analysis(recording, feet, metrics_of(recording, feet, subject))


def analyse_recording(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str],
    format: str | None = None,
    layout: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    *,
    options: ReadOptions | None = None,
    mm_per_pixel: float | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
    also: Callable[[Analysis, Path], None] | None = None,
    figures: bool = True,
) -> dict[str, Any]:
    """Analyse a recording or a footprint image; write metrics.json, tables, figures (PNG and SVG) and report.html.

    Args:
        path: The recording or image.
        out: Output folder, made if needed; nothing is left in it on an error.
        format: Name of the file's format; recognised from its content where None.
        layout: Layout file to use instead of the format's own geometry; mirrored for the other foot.
        progress: Called with a fraction 0..1 and what is being done.
        options: What else is known of the file.
        mm_per_pixel: Size of an image's pixel in mm.
        choices: Which steps are in the means, and which events are used; a recording's only.
        subject: The person, as far as known.
        also: Called with the analysis and the folder, to write more there; see
            `plantar.gait.analysis.exports.exporter`.
        figures: Whether a recording's figures and report.html are written.

    Returns:
        What metrics.json holds, and "files": the paths written.

    Raises:
        FormatError: If the file is not a recording that can be read.
        LayoutError: If the layout file is not valid.
        InputError: If the folder cannot be written to, or an option does not fit the file.
    """
    report = progress or (lambda fraction, text: None)
    report(0.0, "reading")
    known = with_layout(options, layout)
    image = named_format(path, format).read is None
    if mm_per_pixel is not None and not image:
        raise InputError(f"--mm-per-pixel is for footprint images; {path} is a recording")
    if also is not None and image:
        raise InputError(f"--export is for recordings; {path} is a footprint image")
    with output_folder(out, (path, layout, (choices or AnalysisOptions()).events_file)) as folder:
        if image:
            from plantar.gait.analysis.pages.footprint_report import analyse_image

            metrics = analyse_image(Path(path), folder, mm_per_pixel, known.side, subject)
        else:
            analysis = analyse_one(path, format, known, report, choices, subject)
            metrics = dict(analysis.metrics)
            write_analysis(analysis, folder, lambda fraction, text: report(0.5 + 0.5 * fraction, text), figures)
            if also is not None:
                also(analysis, folder)
        names = sorted(p.name for p in folder.iterdir())
    report(1.0, "done")
    return {**metrics, "files": [str(Path(out) / name) for name in names]}


def with_layout(options: ReadOptions | None, layout: SoleLayout | str | os.PathLike[str] | None) -> ReadOptions:
    """Returns the options with a layout, or the path of its file; LayoutError if that is not valid."""
    options = options or ReadOptions()
    if layout is None:
        return options
    own = layout if isinstance(layout, SoleLayout) else read_layout(layout)
    return dataclasses.replace(options, layout=own)
