"""Report: one HTML page without other files."""

import html
import json
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from plantar.common.gravity import GRAVITY
from plantar.common.pages.page import Section, embedded, figures_of, number, page, warning_list
from plantar.common.version import VERSION
from plantar.gait.analysis.measures import MEASURES
from plantar.gait.analysis.pages.player import BELOW
from plantar.gait.analysis.pages.tables import comparison_table, measures_table, regions_tables, steps_table

_GAIT = (
    ("cadence_steps_per_min", "Cadence", "steps/min", 1.0),
    ("steady_cadence_steps_per_min", "Cadence, steps in the means", "steps/min", 1.0),
    ("stride_time_s", "Stride time", "s", 1.0),
    ("double_support_percent", "Double support", "% of stride", 1.0),
    ("single_support_percent", "Single support", "% of stride", 1.0),
    ("step_length_m", "Step length", "mm", 1e3),
    ("step_width_m", "Step width", "mm", 1e3),
    ("walking_speed_m_s", "Walking speed", "m/s", 1.0),
)


def report_page(
    metrics: Mapping[str, Any], figures: Sequence[tuple[Path, str]], title: str, player: Mapping[str, Any] | None = None
) -> str:
    """Returns HTML of one recording: metrics, figures (PNG files, captions), title, and a player's data if any."""
    sections = [Section("summary", "Summary", f"<p>{html.escape(summary_text(metrics))}</p>{_tiles(metrics)}")]
    if metrics["warnings"]:
        sections.append(Section("assumed", "What was assumed", warning_list(metrics["warnings"])))
    sections += _with_figures("pressure", "Pressure", "", figures, ("pressure",))
    if player is not None:
        sections.append(Section("frames", "Frames", _player(player)))
    sections += _with_figures("load", "Force", "", figures, ("steps", "force"))
    sections.append(Section("measures", "Measures of the steps", measures_table(metrics) + _not_given(metrics)))
    sections += _with_figures("regions", "Regions of the foot", regions_tables(metrics), figures, ("regions",))
    sections += _with_figures("sides", "Left and right", "", figures, ("symmetry",))
    sections += _with_figures("wrench", "Wrench", "", figures, ("wrench",))
    sections += _with_figures("steps", "Each step", steps_table(metrics), (), ())
    script, style = ("", "") if player is None else (f"<script>{asset('report.js')}</script>", asset("report.css"))
    return page(f"Gait analysis: {title}", facts_of(metrics, title), sections, script, style)


def asset(name: str) -> str:
    """Text of a page's part: script, style or template."""
    return files("plantar.gait.analysis.pages").joinpath(name).read_text(encoding="utf-8")


def _with_figures(
    key: str, name: str, content: str, figures: Sequence[tuple[Path, str]], names: Sequence[str]
) -> list[Section]:
    content += embedded(figures, names)
    return [Section(key, name, content)] if content else []


def summary_text(metrics: Mapping[str, Any]) -> str:
    """Recording in two sentences: activity and load of the feet."""
    activity = metrics.get("activity", {"name": "unknown"})["name"]
    counts = [f"{len(foot['steps_used'])} of {foot['steps']} {side}" for side, foot in metrics["feet"].items()]
    cadence = metrics["gait"].get("steady_cadence_steps_per_min")
    pace = "" if cadence is None else f" at {number(cadence)} steps/min"
    direction = metrics["gait"].get("direction")
    way = "" if direction in (None, "forwards") else f" {direction}"
    what = "A recording" if activity == "unknown" else f"This is {activity}{way}"
    first = (
        f"{what}: {' and '.join(counts)} steps are in the means{pace}."
        if activity != "standing"
        else (
            f"This is standing for {number(metrics['duration_s'])} s: "
            + ", ".join(
                f"{number(foot['sway']['load_percent'])} % on the {side} foot"
                + (f" (95 % of its CoP in {number(1e4 * area)} cm²)" if area is not None else "")
                for side, foot in metrics["feet"].items()
                for area in (foot["sway"].get("sway_ellipse_m2"),)
            )
            + "."
        )
    )
    peaks = {side: foot["measures"].get("peak_force_N") for side, foot in metrics["feet"].items()}
    weight = metrics["gait"].get("body_weight_N")
    stated = metrics["subject"]["mass_kg"] is not None
    shown = [
        f"{number(100.0 * peak['mean'] / weight)} % ({number(peak['mean'])} N) on the {side}"
        for side, peak in peaks.items()
        if weight and peak and peak["mean"] is not None
    ]
    if not shown:
        return first
    of = f"{number(weight / GRAVITY)} kg, {'as stated' if stated else 'which the forces imply'}"
    return f"{first} Peak force relative to body weight ({of}) is {' and '.join(shown)} foot."


def _not_given(metrics: Mapping[str, Any]) -> str:
    reasons: dict[str, list[str]] = {}
    for key, reason in metrics.get("not_given", {}).items():
        reasons.setdefault(reason, []).append(MEASURES[key].title.lower())
    lines = (f"Not given: {', '.join(names)}, since {reason}." for reason, names in reasons.items())
    return "".join(f'<p class="about">{html.escape(line)}</p>' for line in lines)


def comparison_page(
    comparison: Mapping[str, Any], figures: Sequence[tuple[Path, str]], names: tuple[str, str], links: tuple[str, str]
) -> str:
    """Returns HTML page of a comparison of two recordings by names, with figures (PNG files, captions).

    Relative links lead to their own reports.
    """
    parts = "".join(
        f"<div><h3>{key.upper()}: {html.escape(name)}</h3>{_tiles(comparison[key])}"
        f"{warning_list(comparison[key]['warnings'])}"
        f'<p><a href="{html.escape(link)}">Full report of {key.upper()}</a></p></div>'
        for key, name, link in zip(("a", "b"), names, links, strict=True)
    )
    unlike = warning_list(comparison["warnings"])
    sections = [
        Section("summary", "Summary", f'{unlike}<div class="columns">{parts}</div>'),
        Section("measures", "Measures side by side", comparison_table(comparison)),
        figures_of(figures),
    ]
    about = f'<p class="about">A is {html.escape(names[0])}, B is {html.escape(names[1])}.</p>'
    return page(f"Comparison: {names[0]} and {names[1]}", about, sections)


def _tiles(metrics: Mapping[str, Any]) -> str:
    gait = metrics["gait"]
    tiles = [(f"Complete steps, {side}", str(foot["steps"])) for side, foot in metrics["feet"].items()]
    for key, name, unit, factor in _GAIT:
        same = key == "steady_cadence_steps_per_min" and gait.get(key) == gait.get("cadence_steps_per_min")
        if gait.get(key) is not None and not same:
            tiles.append((name, f"{number(gait[key] * factor)} {unit}"))
    return '<dl class="tiles">' + "".join(f"<div><dt>{n}</dt><dd>{v}</dd></div>" for n, v in tiles) + "</dl>"


def _player(data: Mapping[str, Any]) -> str:
    text = json.dumps(data, separators=(",", ":")).replace("</", "<\\/")
    highest = f"{number(data['feet'][0]['highest'])} {data['unit']}"
    scales = f"0 to {highest}; {BELOW:g} % of the loaded readings are below"
    part = "" if data["whole"] else f" The first {data['times'][-1] - data['times'][0]:.0f} s of walking are shown."
    return Template(asset("player.html")).substitute(data=text, scales=scales, part=part)


def facts_of(metrics: Mapping[str, Any], file: str) -> str:
    """Returns a report's HTML heading, from metrics and the name of its file."""
    robot = metrics["kind"] == "robot"
    length = metrics["subject"]["foot_length_m"]
    facts = [
        ("Robot" if robot else "Participant", _participant(metrics)),
        ("Body mass", _mass(metrics)),
        ("Foot length", "" if length is None else f"{1e3 * length:.0f} mm"),
        ("Device", ", ".join(str(part) for part in map(metrics["device"].get, ("name", "sensor")) if part)),
        ("Size", _size(metrics["device"]["feet"])),
        ("Recorded", f"{metrics['duration_s']:.4g} s, {metrics['frames']} frames at {metrics['rate_hz']:.6g} Hz"),
        ("Values", "raw counts of unknown unit" if metrics.get("raw") else ""),
        ("File", file),
        ("Analysed by", f"Plantar {VERSION}"),
    ]
    return _listed(facts)


def facts_of_image(metrics: Mapping[str, Any], file: str) -> str:
    """Returns an image report's HTML heading, from metrics and the name of its file."""
    width, height = metrics["size_px"]
    scale = "" if metrics["mm_per_pixel"] is None else f", {metrics['mm_per_pixel']:.4g} mm a pixel"
    facts = [
        ("Participant", _participant(metrics)),
        ("Image", f"{width} x {height} pixels{scale}"),
        ("File", file),
        ("Analysed by", f"Plantar {VERSION}"),
    ]
    return _listed(facts)


def _listed(facts: Iterable[tuple[str, str]]) -> str:
    rows = "".join(f"<div><dt>{name}</dt><dd>{html.escape(text)}</dd></div>" for name, text in facts if text)
    return f'<dl class="facts">{rows}</dl>'


def _participant(metrics: Mapping[str, Any]) -> str:
    return str(metrics["subject"]["name"]) or "not stated"


def _mass(metrics: Mapping[str, Any]) -> str:
    stated = metrics["subject"]["mass_kg"]
    implied = metrics["gait"].get("implied_weight_N")
    parts = [] if stated is None else [f"{number(stated)} kg"]
    if implied is not None:
        parts.append(f"the forces imply {number(implied / GRAVITY)} kg")
    return "; ".join(parts) if stated is not None or not parts else f"not stated; {parts[0]}"


def _size(feet: Mapping[str, Mapping[str, Any]]) -> str:
    sizes = {
        side: f"{1e3 * foot['length_m']:.0f} x {1e3 * foot['width_m']:.0f} mm, {foot['cells']} cells ({foot['layout']})"
        for side, foot in feet.items()
    }
    if len(set(sizes.values())) <= 1:
        return next(iter(sizes.values()), "")
    return "; ".join(f"{side}: {text}" for side, text in sizes.items())


def analysis_text(metrics: Mapping[str, Any], name: str = "") -> str:
    """Returns main figures of an analysis as lines, from its metrics; with a name for one of two."""
    rate = "" if metrics["rate_hz"] is None else f" at {metrics['rate_hz']:.6g} Hz"
    lines = [f"{name + ': ' if name else ''}{metrics['format']}: {metrics['frames']} frame(s){rate}"]
    for side, foot in metrics["feet"].items():
        if "footprint" in foot:
            print_ = foot["footprint"]
            arch = foot["footprint"]["arch_index"]
            length = "" if print_["length_m"] is None else f"{1e3 * print_['length_m']:.0f} mm long, "
            lines.append(f"  {side} footprint: {length}arch index {'-' if arch is None else f'{arch:.3f}'}")
            continue
        contact = foot["measures"]["contact_time_s"]["mean"]
        lines.append(f"  {side}: {foot['steps']} complete steps" + (f", contact {contact:.3f} s" if contact else ""))
    activity = metrics.get("activity", {})
    if activity.get("name") == "standing":
        lines.append(f"  this is standing, in which no steps are counted: {activity['why']}")
    cadence = metrics["gait"].get("cadence_steps_per_min")
    if cadence is not None:
        lines.append(f"  cadence {cadence:.1f} steps/min")
    return "\n".join(lines)
