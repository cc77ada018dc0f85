"""Result of an analysis: recording, feet, tables, metrics and report."""

import json
import math
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.table_writer import csv_text
from plantar.errors import InputError
from plantar.gait.analysis.measures import MEASURES, REGION_MEASURES, naming
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.layouts.layout import Side
from plantar.recordings.pressure_recording import PressureRecording

_LONG = 500  # Steps from which metrics.json is one line


@dataclass(frozen=True, eq=False, repr=False)
class Analysis:
    """Recording, its feet and their measures. `recording` of platforms with footprints separated."""

    recording: PressureRecording
    feet: Mapping[Side, FootGait]
    metrics: Mapping[str, Any]

    def __repr__(self) -> str:
        steps = ", ".join(f"{side} {len(gait.steps)} steps" for side, gait in self.feet.items()) or "no feet"
        span = len(self.recording.time) / self.recording.rate_hz
        return f"Analysis({self.recording.path.name}: {self.recording.format}, {span:.1f} s; {steps})"

    def _repr_html_(self) -> str:
        from plantar.gait.analysis.pages.one_page import figure_summary
        from plantar.plotting import html_of

        return html_of(figure_summary(self.recording, self.feet), repr(self))

    @cached_property
    def steps(self) -> dict[str, NDArray[Any]]:
        """Complete steps of both feet in time order, as columns (n,) by name.

        side, number, heel_strike_s, toe_off_s, every measure of `MEASURES` (NaN if unknown), used (in the means) and
        note (why not, or what is odd).
        """
        steps = _in_order(self.feet)
        named = naming(self.recording.raw)
        return {
            "side": np.array([s.side for s in steps], dtype=object),
            "number": np.array([s.number for s in steps], dtype=int),
            "heel_strike_s": np.array([s.heel_strike_s for s in steps], dtype=float),
            "toe_off_s": np.array([s.toe_off_s for s in steps], dtype=float),
            **{named(key): np.array([s.measures.get(key, math.nan) for s in steps], dtype=float) for key in MEASURES},
            "used": np.array([s.used for s in steps], dtype=bool),
            "note": np.array([s.unused or s.odd for s in steps], dtype=object),
        }

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was assumed, repaired, left out or is doubtful."""
        return tuple(self.metrics["warnings"])

    def to_pandas(self) -> Any:
        """Steps as `pandas.DataFrame`; InputError without pandas."""
        return as_data_frame(self.steps)

    def report(self, path: str | Path | None = None) -> str:
        """Report page as one HTML text, also written to `path` if given."""
        with tempfile.TemporaryDirectory() as folder:
            write_analysis(self, Path(folder))
            page = (Path(folder) / "report.html").read_text(encoding="utf-8")
        if path is not None:
            from plantar.common.atomic import write_text

            write_text(Path(path), page)
        return page


def as_data_frame(columns: Mapping[str, NDArray[Any]]) -> Any:
    """Columns as `pandas.DataFrame`; InputError without pandas."""
    try:
        import pandas
    except ImportError:
        raise InputError("to_pandas() needs pandas: pip install pandas; `.steps` holds the same columns") from None
    return pandas.DataFrame(dict(columns))


def write_analysis(
    analysis: Analysis, folder: Path, progress: Callable[[float, str], None] | None = None, figures: bool = True
) -> None:
    """Write an analysis' metrics.json, steps.csv and regions.csv into a folder; with figures these and two pages.

    `progress` is called with a share 0..1 and the work.
    """
    recording = analysis.recording
    feet = analysis.feet
    metrics = analysis.metrics
    (folder / "steps.csv").write_text(_steps_csv(analysis.steps), encoding="utf-8")
    if any(step.regions for gait in feet.values() for step in gait.steps):
        (folder / "regions.csv").write_text(_regions_csv(feet, recording.raw), encoding="utf-8")
    lines = None if sum(len(gait.steps) for gait in feet.values()) > _LONG else 1  # indented takes six times as long
    (folder / "metrics.json").write_text(json.dumps(metrics, indent=lines, allow_nan=False) + "\n", encoding="utf-8")
    if not figures:
        return
    from plantar.gait.analysis.pages.figure_files import draw_figures, write_figures
    from plantar.gait.analysis.pages.one_page import figure_summary, one_page
    from plantar.gait.analysis.pages.player import player_data
    from plantar.gait.analysis.pages.report import report_page

    embedded = draw_figures(recording, feet, folder, progress)
    page = report_page(metrics, embedded, title=recording.path.name, player=player_data(recording, feet))
    (folder / "report.html").write_text(page, encoding="utf-8", errors="replace")
    sheet = write_figures(
        [("summary", figure_summary(recording, feet), "Force, butterfly and trend of the steps")], folder
    )
    (folder / "summary.html").write_text(
        one_page(metrics, sheet, recording.path.name), encoding="utf-8", errors="replace"
    )


def _in_order(feet: Mapping[Side, FootGait]) -> list[Step]:
    return sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)


def _steps_csv(columns: Mapping[str, NDArray[Any]]) -> str:
    whole = {name: values.astype(int) if values.dtype == bool else values for name, values in columns.items()}
    return csv_text(list(whole), list(zip(*(values.tolist() for values in whole.values()), strict=True)))


def _regions_csv(feet: Mapping[Side, FootGait], raw: bool) -> str:
    named = naming(raw)
    rows = [
        [s.side, s.number, region, *(values.get(name, math.nan) for name in REGION_MEASURES)]
        for s in _in_order(feet)
        for region, values in s.regions.items()
    ]
    return csv_text(["side", "number", "region", *(named(name) for name in REGION_MEASURES)], rows)
