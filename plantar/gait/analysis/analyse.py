"""Entry point of gait analysis."""

import dataclasses
import os
from collections.abc import Mapping
from typing import Any

from plantar.formats import ReadOptions, is_study_folder
from plantar.gait.analysis.analyse_one import Progress, analyse_one, analyse_recording, with_layout
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.results import Analysis
from plantar.gait.analysis.study.run_study import Study, run_study
from plantar.gait.analysis.study.stored_steps import KeptFolder
from plantar.gait.analysis.subject import Subject
from plantar.layouts.layout import SoleLayout

__all__ = ["Analysis", "Study", "analyse", "analyse_recording", "with_layout"]


def analyse(
    given: Any,
    format: str | None = None,
    options: ReadOptions | None = None,
    progress: Progress | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
    *,
    layout: SoleLayout | str | os.PathLike[str] | None = None,
    unit: str | None = None,
    rate_hz: float | None = None,
    columns: str | Mapping[str, str | int] | None = None,
) -> Analysis | Study:
    """Measure a recording in any form; no file is written.

    Args:
        given: Path of a file; folder of recordings (a study); `PressureRecording`; array (n, k) of n frames and k
            cells, or a mapping of arrays "left", "right" and "time"; data frame with a column a cell.
        format: By content where None.
        options: What else is known; the four keywords below override it.
        progress: Called with a share 0..1 and the work.
        choices: Steps in the means, and events used.
        subject: Person.
        layout: Layout or its file; mirrored for the other foot.
        unit: Unit of values, such as "kPa", "N" or "raw".
        rate_hz: Frames a second.
        columns: Which columns of a table or data frame are what: "left=Fz1, right=Fz2, time=t", or a mapping.

    Returns:
        Analysis: `.steps` (columns of every measure), `.to_pandas()`, `.report()`, `.metrics`, `.feet`; of a folder a
        `Study`.

    Raises:
        FormatError: If unreadable.
        InputError: If an option is unfit.

    Example:
        >>> import numpy as np
        >>> time = np.arange(0.0, 10.0, 0.01)
        >>> left = 615.4 * np.clip(np.sin(2.0 * np.pi * time) + 0.3, 0.0, None)
        >>> walk = analyse({"left": left, "right": np.roll(left, 50), "unit": "N"}, rate_hz=100.0)
        >>> [round(float(v)) for v in walk.steps["peak_force_N"][:3]], walk.metrics["activity"]["name"]
        ([800, 800, 800], 'walking')
    """
    known = with_layout(options, layout)
    changes = {k: v for k, v in (("unit", unit), ("rate_hz", rate_hz), ("columns", columns)) if v is not None}
    known = dataclasses.replace(known, **changes)  # type: ignore[arg-type]
    if isinstance(given, str | os.PathLike) and is_study_folder(given):
        folder = KeptFolder()
        study = run_study(given, folder.path, progress=progress, choices=choices, options=known, figures=False)
        folder.keep_for(result.rows for result in study.results)
        return dataclasses.replace(study, files=())
    return analyse_one(given, format, known, progress, choices, subject)
