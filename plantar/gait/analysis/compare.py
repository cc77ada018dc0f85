"""Two recordings side by side."""

import json
import math
import os
from collections.abc import Callable, Iterable, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.atomic import output_folder
from plantar.common.console.progress import part_of
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.formats import ReadOptions, named_format
from plantar.gait.analysis.analyse_one import analyse_one, with_layout
from plantar.gait.analysis.earlier_output import earlier_output, remove_earlier
from plantar.gait.analysis.measures import COMPARED, MEASURES
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.gait.analysis.pages.force_figures import STANCE, draw_sd, force_label, stance_curves
from plantar.gait.analysis.pages.report import comparison_page
from plantar.gait.analysis.pages.sole_figures import figure_pair
from plantar.gait.analysis.results import Analysis, write_analysis
from plantar.gait.analysis.subject import Subject
from plantar.plotting import COLOURS, new_figure
from plantar.recordings.pressure_recording import PressureRecording

_SENSORS = {"insole": "insoles", "platform": "a platform", "robot": "a robot's soles", "plate": "force plates"}


def compare_recordings(
    a: str | os.PathLike[str],
    b: str | os.PathLike[str],
    out: str | os.PathLike[str],
    format: str | None = None,
    layout: str | os.PathLike[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
    *,
    options: ReadOptions | None = None,
    choices: AnalysisOptions | None = None,
    subject: Subject | None = None,
    figures: bool = True,
) -> dict[str, Any]:
    """Analyse two recordings; write comparison.json, figures, report.html, and folders "a" and "b" with each analysis.

    `format` of both; `progress`, `choices`, `subject` and `figures` likewise as of `analyse_recording`; `options`: what
    else is known of both. Returns "a" and "b": metrics of each; "difference": `difference_of` each foot; "warnings";
    "files": paths written.
    """
    report = progress or (lambda fraction, text: None)
    (choices or AnalysisOptions()).of_several("--compare takes")
    known = with_layout(options, layout)
    for path in (a, b):
        if named_format(path, format).read is None:
            raise InputError(f"{path} is a footprint image; --compare takes two recordings over time")
    analyses: dict[str, Analysis] = {}
    earlier = earlier_output(out)
    with output_folder(out, (a, b, layout)) as folder:
        for i, (key, path) in enumerate((("a", a), ("b", b))):
            report(0.4 * i, f"reading {key}")
            analyses[key] = analyse_one(path, format, known, choices=choices, subject=subject)
            (folder / key).mkdir()
            write_analysis(analyses[key], folder / key, part_of(report, 0.4 * i + 0.1, 0.3), figures)
        if analyses["a"].recording.raw != analyses["b"].recording.raw:
            raise InputError(
                "one recording is calibrated and the other is of raw counts: their values cannot be compared"
            )
        metrics = _write_comparison(analyses, folder, (Path(a).name, Path(b).name), figures)
        names = sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    written = [str(Path(out) / name) for name in names]
    remove_earlier(earlier, (*written, a, b, layout))
    report(1.0, "done")
    return {**metrics, "files": written}


def _write_comparison(
    analyses: Mapping[str, Analysis], folder: Path, names: tuple[str, str], figures: bool
) -> dict[str, Any]:
    pairs = _pairs(analyses["a"], analyses["b"])
    difference = {name: difference_of(analyses, one, other) for name, (one, other) in pairs.items()}
    metrics: dict[str, Any] = {k: dict(v.metrics) for k, v in analyses.items()} | {"difference": difference}
    a, b = ([sensor_of(one.recording)] for one in analyses.values())
    metrics["warnings"] = unlike(a, b, "A", "B")
    (folder / "comparison.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if figures:
        drawn = write_figures(_figures(analyses, pairs, difference), folder)
        page = comparison_page(metrics, drawn, names, ("a/report.html", "b/report.html"))
        (folder / "report.html").write_text(page, encoding="utf-8", errors="replace")
    return metrics


def sensor_of(recording: PressureRecording) -> tuple[str, float]:
    """Kind of a recording's sensors and least area of their cells in m2; 0 without cells."""
    return _SENSORS[recording.kind], min((f.layout.cell_area for f in recording.feet.values() if f.layout), default=0.0)


def unlike(a: Iterable[tuple[str, float]], b: Iterable[tuple[str, float]], one: str, other: str) -> list[str]:
    """Returns a doubt where a sensor of `a`, named `one`, differs from one of `b`, named `other`, in kind or cells."""
    for pair in product(a, b):
        areas = [area for _, area in pair]
        if pair[0][0] != pair[1][0] or max(areas) > 1.5 * min(areas):
            cells = [f"cells of {1e6 * area:.0f} mm2" if area else "no cells" for area in areas]
            first, second = (f"{kind} ({what})" for (kind, _), what in zip(pair, cells, strict=True))
            doubt = "differences may be of the sensors, peak pressures and areas above all"
            return [f"{one} is of {first}, {other} of {second}: {doubt}"]
    return []


def _pairs(a: Analysis, b: Analysis) -> dict[str, tuple[Side, Side]]:
    common: dict[str, tuple[Side, Side]] = {s: (s, s) for s in SIDES if s in a.feet and s in b.feet}
    if not common and len(a.feet) == 1 and len(b.feet) == 1:
        one = next(iter(a.feet))
        other = next(iter(b.feet))
        return {f"{one} and {other}": (one, other)}
    return common


def difference_of(analyses: Mapping[str, Analysis], one: Side, other: Side) -> dict[str, Any]:
    """Difference B - A of each measure that both recordings have.

    `analyses`: "a" and "b". Returns for each measure "a" and "b" (mean, sd, cv_percent, n), "difference", "percent" (of
    A) and "effect_size" (Cohen's d).
    """
    first = analyses["a"].metrics["feet"][one]["measures"]
    second = analyses["b"].metrics["feet"][other]["measures"]
    out: dict[str, Any] = {}
    for key in first:
        x = first[key]
        y = second.get(key)
        if x["mean"] is None or y is None or y["mean"] is None:
            continue
        change = y["mean"] - x["mean"]
        pooled = _pooled_sd(x, y)
        out[key] = {
            "a": x,
            "b": y,
            "difference": change,
            "percent": 100.0 * change / abs(x["mean"]) if x["mean"] and not key.endswith("_deg") else None,
            "effect_size": change / pooled if pooled else None,
        }
    return out


def _pooled_sd(x: Mapping[str, Any], y: Mapping[str, Any]) -> float | None:
    if x["sd"] is None or y["sd"] is None or x["n"] + y["n"] <= 2:
        return None
    return math.sqrt(((x["n"] - 1) * x["sd"] ** 2 + (y["n"] - 1) * y["sd"] ** 2) / (x["n"] + y["n"] - 2))


def _figures(
    analyses: Mapping[str, Analysis], pairs: Mapping[str, tuple[Side, Side]], difference: Mapping[str, Any]
) -> list[tuple[str, Any, str]]:
    a = analyses["a"]
    b = analyses["b"]
    return [
        (
            "pressure",
            figure_pair([(k, x.recording, x.feet) for k, x in (("A", a), ("B", b))]),
            "Maximum pressure pictures of A and B on one scale",
        ),
        (
            "steps",
            _curves(a, b, pairs),
            "Vertical force over the stance in A and B: mean and ± 1 SD of the complete steps",
        ),
        ("difference", _bars(difference), "Difference of the main measures, B less A in percent of A"),
    ]


def _curves(a: Analysis, b: Analysis, pairs: Mapping[str, tuple[Side, Side]]) -> Any | None:
    shown = {n: p for n, p in pairs.items() if a.feet[p[0]].used and b.feet[p[1]].used}
    if not shown:
        return None
    figure, axes = new_figure(5.0 * len(shown), 3.6, columns=len(shown), grid=True, sharey=True, squeeze=False)
    for panel, (name, sides) in zip(axes[0], shown.items(), strict=True):
        for key, analysis, side, colour in (("A", a, sides[0], COLOURS["left"]), ("B", b, sides[1], COLOURS["cop"])):
            curves = stance_curves(analysis.recording, analysis.feet[side])
            name_of_mean = f"{key}, {side}: mean of {len(curves)}"
            panel.plot(STANCE, curves.mean(axis=0), color=colour, linewidth=1.8, label=name_of_mean)
            draw_sd(panel, curves, color=colour, alpha=0.2)
        panel.set(title=f"{name} foot" if sides[0] == sides[1] else name, xlabel="stance (%)")
        panel.legend(fontsize=8, loc="lower center")
    axes[0][0].set_ylabel(force_label(a.recording))
    return figure


def _bars(difference: Mapping[str, Mapping[str, Any]]) -> Any | None:
    rows = {
        name: {k: d["percent"] for k, d in own.items() if d["percent"] is not None} for name, own in difference.items()
    }
    keys = [k for k in (*COMPARED, "landing_impact_N") if any(k in r for r in rows.values())]
    if not keys:
        return None
    figure, axes = new_figure(8.0, 1.0 + 0.4 * len(keys))
    places = np.arange(len(keys))[::-1]
    height = 0.8 / max(len(rows), 1)
    for i, (name, values) in enumerate(rows.items()):
        at = places - (i - 0.5 * (len(rows) - 1)) * height
        heights = [values.get(k, 0.0) for k in keys]
        axes.barh(at, heights, height=0.9 * height, color=COLOURS["right" if name == "right" else "left"], label=name)
    axes.axvline(0.0, color="#111111", linewidth=0.8)
    axes.set_yticks(places, [MEASURES[k].title for k in keys])
    axes.set_xlabel("B less A (% of A)")
    axes.legend(fontsize=8)
    return figure
