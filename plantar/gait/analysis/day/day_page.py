"""Page and tables of a day."""

import html
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.atomic import output_folder, write_text
from plantar.common.pages.page import Section, embedded, number, page, row, table, warning_list
from plantar.common.table_writer import csv_text
from plantar.common.version import VERSION
from plantar.gait.analysis.day.bouts import ACTIVITIES
from plantar.gait.analysis.day.measured_day import Day, hours_and_minutes
from plantar.gait.analysis.earlier_output import earlier_output, remove_earlier
from plantar.gait.analysis.masks import Masks
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.plotting import COLOURS, new_figure

_PAINT = {"walking": "#2a9d8f", "standing": "#e9b44c", "sitting": "#8aa1c1", "unloaded": "#d9d9d9", "gap": "#ffffff"}
_LISTED = 10  # longest walks on the page
_IN_WORDS = {
    "walking": "Walking",
    "standing": "Standing",
    "sitting": "Sitting",
    "unloaded": "Feet unloaded (lying, or shoes not worn)",
    "gap": "Not measured",
}


def write_day(day: Day, masks: Masks, folder: Path, title: str, figures: bool = True) -> list[str]:
    """Write day.json, bouts.csv, hours.csv and, with figures, day.html with its figure; returns the paths."""
    earlier = earlier_output(folder)
    with output_folder(folder) as target:
        summary = summary_of(day)
        write_text(target / "day.json", json.dumps(summary, indent=1, allow_nan=False) + "\n")
        bouts = [[b.activity, day.at(b.begin), b.begin, b.end, b.lasts, b.steps, b.cadence] for b in day.bouts]
        names = ["activity", "clock", "begin_s", "end_s", "duration_s", "steps", "cadence_steps_per_min"]
        write_text(target / "bouts.csv", csv_text(names, bouts))
        flat = [_flat(hour) for hour in summary["hours"]]
        columns = list(dict.fromkeys(name for hour in flat for name in hour))
        write_text(target / "hours.csv", csv_text(columns, [[hour.get(name) for name in columns] for hour in flat]))
        if figures:
            drawn = write_figures(
                [("day", figure_of(day), "Activities over the day, and load of each foot an hour")], target
            )
            write_text(target / "day.html", day_page(day, masks, drawn, title))
        names = sorted(path.name for path in target.iterdir())
    written = [str(folder / name) for name in names]
    remove_earlier(earlier, written)
    return written


def summary_of(day: Day) -> dict[str, Any]:
    """A day as plain values of day.json."""
    return {
        "clock": None if day.clock is None else day.clock.isoformat(),
        "duration_s": day.end - day.begin,
        "weight_N": day.weight_N,
        "steps": day.steps,
        "seconds": {name: day.seconds(name) for name in ACTIVITIES},
        "walks": len(day.walks),
        "longest_walk_s": max((bout.lasts for bout in day.walks), default=0.0),
        "best_cadence_1_min": day.cadence_1,
        "best_cadence_30_min": day.cadence_30,
        "hours": [
            {
                "clock": hour.clock,
                "begin_s": hour.begin,
                "steps": hour.steps,
                "seconds": dict(hour.seconds),
                "impulse_Ns": dict(hour.impulse_Ns),
                "pressure_Pas": {side: dict(own) for side, own in hour.pressure_Pas.items()},
            }
            for hour in day.hours
        ],
        "notes": list(day.notes),
        "version": VERSION,
    }


def _flat(hour: dict[str, Any]) -> dict[str, Any]:
    out = {key: hour[key] for key in ("clock", "begin_s", "steps")}
    out |= {f"{name}_s": value for name, value in hour["seconds"].items()}
    out |= {f"{side}_impulse_Ns": value for side, value in hour["impulse_Ns"].items()}
    for side, regions in hour["pressure_Pas"].items():
        out |= {f"{side}_{region}_pressure_Pas": value for region, value in regions.items()}
    return out


def day_page(day: Day, masks: Masks, figures: Sequence[tuple[Path, str]], title: str) -> str:
    """Returns HTML of a day's page; figures are PNG files with captions."""
    sections = [Section("summary", "The day in a minute", _words(day))]
    sections.append(Section("course", "Its course", embedded(figures)))
    sections.append(Section("hours", "By the hour", _hours(day)))
    if any(own for hour in day.hours for own in hour.pressure_Pas.values()):
        sections.append(Section("regions", "Pressure of regions", _regions(day, masks)))
    sections.append(Section("walks", "Longest walks", _walks(day)))
    sections.append(Section("notes", "Notes", warning_list(day.notes) + _how()))
    about = (
        f'<p class="about">{hours_and_minutes(day.end - day.begin)} from {day.at(day.begin)} to {day.at(day.end)}. '
        f"Plantar {html.escape(VERSION)}.</p>"
    )
    return page(title, about, sections)


def _words(day: Day) -> str:
    walks = day.walks
    measured = sum(day.seconds(name) for name in ACTIVITIES[:-1]) or 1.0
    shares = {name: 100.0 * day.seconds(name) / measured for name in ACTIVITIES[:-1]}
    parts = [f"<p><strong>{day.steps:,} steps</strong> in {len(walks)} walks".replace(",", "\u202f")]
    if walks:
        longest = max(walks, key=lambda bout: bout.lasts)
        parts.append(
            f"; the longest lasts {hours_and_minutes(longest.lasts)}, from {day.at(longest.begin)}. The best minute "
            f"has <strong>{day.cadence_1:.0f} steps</strong>"
        )
        if day.cadence_30 is not None:
            parts.append(f", the best 30 minutes {day.cadence_30:.0f} a minute")
    parts.append(".</p><ul>")
    for name in ACTIVITIES:
        seconds = day.seconds(name)
        if seconds > 0.0:
            share = f" ({shares[name]:.0f} %)" if name in shares else ""
            parts.append(f"<li>{_IN_WORDS[name]}: <strong>{hours_and_minutes(seconds)}</strong>{share}</li>")
    parts.append("</ul>")
    sums = {side: sum(hour.impulse_Ns[side] for hour in day.hours) for side in day.hours[0].impulse_Ns}
    if len(sums) == 2 and sum(sums.values()) > 0.0:
        left = 100.0 * sums["left"] / sum(sums.values())
        parts.append(
            f"<p>Of the day's load the left foot carries <strong>{left:.0f} %</strong> and the right one "
            f"<strong>{100.0 - left:.0f} %</strong>.</p>"
        )
    return "".join(parts)


def _hours(day: Day) -> str:
    sides = list(day.hours[0].impulse_Ns)
    head = ["Hour", "Steps", *(f"{name.capitalize()} (min)" for name in ACTIVITIES)]
    head += [f"{side.capitalize()} load (kN·s)" for side in sides]
    rows = []
    for hour in day.hours:
        minutes = [number(hour.seconds[name] / 60.0, 2) for name in ACTIVITIES]
        loads = [number(1e-3 * hour.impulse_Ns[side]) for side in sides]
        rows.append(row(html.escape(hour.clock), [str(hour.steps), *minutes, *loads]))
    return table("hours", "Steps, time in each activity, and each foot's force over time.", head, rows)


def _regions(day: Day, masks: Masks) -> str:
    sides = [side for side in day.hours[0].pressure_Pas if day.hours[0].pressure_Pas[side]]
    head = [
        "Region",
        *(f"{s.capitalize()}, {what}" for s in sides for what in ("day (MPa·s)", "most in an hour (MPa·s)")),
    ]
    rows = []
    for name, title in masks.names:
        cells = []
        for side in sides:
            own = [hour.pressure_Pas[side].get(name, 0.0) for hour in day.hours]
            cells += [number(1e-6 * sum(own)), number(1e-6 * max(own))]
        rows.append(row(html.escape(title), cells))
    caption = "Largest pressure of each region, over time; of the day, and of the hour with the most."
    return table("regions", caption, head, rows)


def _walks(day: Day) -> str:
    walks = sorted(day.walks, key=lambda b: -b.lasts)[:_LISTED]
    rows = [
        row(day.at(b.begin), [hours_and_minutes(b.lasts), str(b.steps), number(b.cadence)])
        for b in sorted(walks, key=lambda b: b.begin)
    ]
    return table("walks", f"The {len(rows)} longest.", ["From", "Lasts", "Steps", "Cadence (steps/min)"], rows)


def _how() -> str:
    return (
        "<p>A walk has two strides of each foot or more; a pause of 3 s ends it. In standing the feet carry 60 % of "
        "the weight or more, in sitting less, and below 3 % they are unloaded. Postures of less than 5 s count to what "
        "is before them.</p>"
    )


_TICKS = (120, 300, 600, 900, 1800, 3600)  # s from one to the next, ten at most


def figure_of(day: Day) -> Any:
    """Figure of activities over the day and load by the hour."""
    figure, axes = new_figure(9.5, 4.6, rows=2, grid=False, height_ratios=(1, 2.2))
    band, load = axes
    for name in ACTIVITIES[:-1]:
        spans = [((b.begin - day.begin) / 3600.0, b.lasts / 3600.0) for b in day.bouts if b.activity == name]
        if spans:
            band.broken_barh(spans, (0.0, 1.0), facecolors=_PAINT[name], label=name, linewidth=0)
    hours = (day.end - day.begin) / 3600.0
    whole = 3600 * max(1, round(hours / 10.0))
    fine = next((step for step in _TICKS if 3600.0 * hours <= 10 * step), whole)
    for panel, apart in ((band, fine), (load, whole)):  # a load is that of its hour
        ticks = range(0, int(3600.0 * hours) + 1, apart)
        panel.set_xlim(0.0, hours)
        panel.set_xticks([tick / 3600.0 for tick in ticks], [day.at(day.begin + tick)[:-3] for tick in ticks])
    band.set_yticks([])
    band.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=8, frameon=False)
    sides = list(day.hours[0].impulse_Ns)
    for k, side in enumerate(sides):
        begins = np.array([(hour.begin - day.begin) / 3600.0 for hour in day.hours])
        widths = np.diff([*begins, hours]) / len(sides)
        values = [1e-3 * hour.impulse_Ns[side] for hour in day.hours]
        load.bar(begins + k * widths, values, 0.92 * widths, align="edge", color=COLOURS[side], label=f"{side} foot")
    load.set_ylabel("load an hour (kN·s)")
    load.set_xlabel("clock" if day.clock is not None else "hours since the begin")
    load.legend(fontsize=8, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure
