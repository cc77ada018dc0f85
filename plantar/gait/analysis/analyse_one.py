"""Analysis of one recording, in memory or from file to report."""

import dataclasses
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from plantar.common.atomic import output_folder
from plantar.errors import InputError
from plantar.formats import ReadOptions, named_format
from plantar.formats.given import recording_of
from plantar.formats.nominal_insole import named_or_read_layout
from plantar.formats.plausibility import refuse_small
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.earlier_output import earlier_output, remove_earlier
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.prints.platform import separated_feet
from plantar.gait.analysis.results import Analysis, write_analysis
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.gait.analysis.steps.gaps import without_gaps
from plantar.gait.analysis.subject import Subject
from plantar.layouts.layout import SoleLayout

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
    """Returns analysis of one recording.

    `given`: any form of `plantar.formats.given.recording_of`; `progress`: called with a share 0..0.5 and the work.
    """
    report = progress or (lambda fraction, text: None)
    known = options or ReadOptions()
    if subject is not None and known.mass_kg is None:
        known = dataclasses.replace(known, mass_kg=subject.mass_kg)
    held = recording_of(given, format, known)
    refuse_small(held)
    recording, prints = separated_feet(held)
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
    """Analyse a recording or footprint image; write metrics.json, tables, figures (PNG and SVG) and report.html.

    Args:
        out: Output folder, made if needed; left empty on an error.
        format: By content where None.
        layout: Layout file; mirrored for the other foot.
        progress: Called with a share 0..1 and the work.
        mm_per_pixel: Of an image, in mm.
        choices: Steps in the means, and events used; of recordings only.
        also: Called with analysis and folder, to write more; see `plantar.gait.analysis.exports.exporter`.

    Returns:
        Contents of metrics.json, and "files": paths written.
    """
    report = progress or (lambda fraction, text: None)
    report(0.0, "reading")
    known = with_layout(options, layout)
    image = named_format(path, format).read is None
    if mm_per_pixel is not None and not image:
        raise InputError(f"--mm-per-pixel is for footprint images; {path} is a recording")
    if also is not None and image:
        raise InputError(f"--export is for recordings; {path} is a footprint image")
    earlier = earlier_output(out)
    inputs = (path, layout, (choices or AnalysisOptions()).events_file)
    with output_folder(out, inputs) as folder:
        if image:
            from plantar.gait.analysis.pages.footprint_report import analyse_image

            metrics = analyse_image(Path(path), folder, mm_per_pixel, known.side, subject, figures)
        else:
            analysis = analyse_one(path, format, known, report, choices, subject)
            metrics = dict(analysis.metrics)
            write_analysis(analysis, folder, lambda fraction, text: report(0.5 + 0.5 * fraction, text), figures)
            if also is not None:
                also(analysis, folder)
        names = sorted(p.name for p in folder.iterdir())
    written = [str(Path(out) / name) for name in names]
    remove_earlier(earlier, (*written, *inputs))
    report(1.0, "done")
    return {**metrics, "files": written}


def with_layout(options: ReadOptions | None, layout: SoleLayout | str | os.PathLike[str] | None) -> ReadOptions:
    """Returns options with a layout, the path of its file, or a nominal insole such as "moticon:7"."""
    options = options or ReadOptions()
    if layout is None:
        return options
    return dataclasses.replace(options, layout=named_or_read_layout(layout))
