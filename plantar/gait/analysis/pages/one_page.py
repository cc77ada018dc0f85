"""One-page summary: main measures, loads and trends."""

import html
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.pages.page import Section, embedded, number, page, row, table, warning_list
from plantar.common.sides import Side
from plantar.gait.analysis.measures import MEASURES, full_title
from plantar.gait.analysis.pages.force_figures import STANCE, draw_sd, force_label, stance_curves
from plantar.gait.analysis.pages.report import asset, facts_of, summary_text
from plantar.gait.analysis.pages.tables import mean_and, shown_as
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.plotting import COLOURS, new_figure
from plantar.recordings.pressure_recording import PressureRecording

_ROWS = (
    *("contact_time_s", "stride_time_s", "stance_percent", "double_support_percent", "stride_length_m"),
    *("stride_velocity_m_s", "peak_force_N", "first_peak_N", "second_peak_N", "impulse_Ns", "peak_pressure_Pa"),
    *("contact_area_m2", "cop_velocity_m_s", "cpei_percent"),
)
_APART = 0.1  # Distance in m at which insoles are drawn, which measure no step width
_MOST_WARNINGS = 4


def one_page(metrics: Mapping[str, Any], figures: Sequence[tuple[Path, str]], title: str) -> str:
    """Returns HTML that prints on one page of A4: metrics, figures (PNG files, captions), and a title."""
    warnings = metrics["warnings"]
    more = len(warnings) - _MOST_WARNINGS
    notes = [*warnings[:_MOST_WARNINGS], *([f"{more} more notes are in report.html"] if more > 0 else [])]
    sections = [
        Section("summary", "Summary", f"<p>{html.escape(summary_text(metrics))}</p>"),
        Section("main", "Measures", _table(metrics)),
        Section("figures", "Feet and steps", embedded(figures)),
        Section("notes", "Notes", warning_list(notes) or "<p>None.</p>"),
    ]
    return page(f"Gait summary: {title}", facts_of(metrics, title), sections, style=asset("one_page.css"))


def _table(metrics: Mapping[str, Any]) -> str:
    feet = metrics["feet"]
    gait = metrics["gait"]
    raw = bool(metrics.get("raw"))
    rows = []
    cadence = gait.get("steady_cadence_steps_per_min")
    if cadence is not None:
        both = [f"{number(cadence)} (both feet)", *[""] * (len(feet) - 1)]
        rows.append(row("Cadence (steps/min)", [*both, ""]))
    for plain in _ROWS:
        key, title, factor = shown_as(plain, replace(MEASURES[plain], title=full_title(plain)), raw)
        spreads = {side: foot["measures"].get(key) for side, foot in feet.items()}
        if any(s and s["mean"] is not None for s in spreads.values()):
            cells = [mean_and(spreads[side], "error", factor) for side in feet]
            rows.append(row(title, [*cells, number(gait["symmetry_percent"].get(key), 2)]))
    if not rows:
        return "<p>The recording holds no complete step.</p>"
    caption = "Means ± standard error of one step. Symmetry: 0 is symmetric."
    head = ("Measure", *(f"{side} foot" for side in feet), "Symmetry (%)")
    return table("Main measures", caption, head, rows)


def figure_summary(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Returns figure of a recording's mean forces, CoP butterfly of its feet and trend; None without used steps."""
    shown = {side: gait for side, gait in feet.items() if gait.used}
    if not shown:
        return None
    figure, (curves, wings, trend) = new_figure(10.0, 3.2, columns=3, grid=True)
    for side, gait in shown.items():
        own = stance_curves(recording, gait)
        curves.plot(STANCE, own.mean(axis=0), color=COLOURS[side], linewidth=1.8, label=f"{side}, {len(own)} steps")
        draw_sd(curves, own, color=COLOURS[side], alpha=0.2)
        impulse = np.array([step["impulse_Ns"] for step in gait.used])
        begin = np.array([step.heel_strike_s for step in gait.used])
        trend.plot(begin, 100.0 * impulse / np.nanmean(impulse), ".", color=COLOURS[side], markersize=4)
        if len(begin) > 2:
            line = np.polyfit(begin - begin[0], 100.0 * impulse / np.nanmean(impulse), 1)
            trend.plot(begin, np.polyval(line, begin - begin[0]), color=COLOURS[side], linewidth=1.2)
    _draw_butterfly(wings, recording, shown)
    for panel, name, across, up in (
        (curves, "Force over the stance", "stance (%)", force_label(recording)),
        (wings, "Butterfly: CoP of both feet", "to the right (mm)", "forward (mm)"),
        (trend, "Trend: impulse of each step", "time (s)", "% of the mean"),
    ):
        panel.set_title(name, fontsize=9)
        panel.set_xlabel(across, fontsize=8)
        panel.set_ylabel(up, fontsize=8)
    curves.legend(fontsize=7, loc="lower center")
    return figure


def _draw_butterfly(panel: Any, recording: PressureRecording, feet: Mapping[Side, FootGait]) -> None:
    known = {s: g for s, g in feet.items() if g.cop is not None}
    if len(known) < 2:
        panel.text(0.5, 0.5, "takes both feet with cells", ha="center", va="center", transform=panel.transAxes)
        return
    force = {s: g.foot.vertical_force for s, g in known.items()}  # NaN: of two feet one has no CoP
    total = np.sum(list(force.values()), axis=0)
    beside = {"left": np.array([0.0, _APART]), "right": np.array([0.0, -_APART])}
    plates = recording.kind in ("plate", "platform")
    with np.errstate(invalid="ignore", divide="ignore"):
        parts = [
            force[s][:, None] * np.nan_to_num(g.cop + (0.0 if plates else beside[s]))
            for s, g in known.items()
            if g.cop is not None
        ]
        both = np.sum(parts, axis=0) / total[:, None]
    on = total > 0.3 * float(np.nanpercentile(total, 98.0))
    step = next(iter(known.values())).used
    window = (recording.time >= step[0].heel_strike_s) & (recording.time <= step[-1].toe_off_s) & on
    points = np.where(window[:, None], both, np.nan)[: max(1, round(20.0 * recording.rate_hz)) + int(np.argmax(window))]
    panel.plot(-1e3 * points[:, 1], 1e3 * points[:, 0], color=COLOURS["cop"], linewidth=0.6, alpha=0.7)
