"""The report: one HTML page that needs nothing else, for screen, keyboard, print and dark mode."""

from __future__ import annotations

import base64
import html
import json
import math
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from gait.analysis.measures import MEASURES, REGION_MEASURES, Measure, raw_name
from gait.analysis.regions import REGIONS

__all__ = ["comparison_page", "footprint_page", "number", "report_page"]

_GAIT = (
    ("cadence_steps_per_min", "Cadence", "steps/min", 1.0),
    ("stride_time_s", "Stride time", "s", 1.0),
    ("double_support_percent", "Double support", "% of stride", 1.0),
    ("single_support_percent", "Single support", "% of stride", 1.0),
    ("step_length_m", "Step length", "mm", 1e3),
    ("step_width_m", "Step width", "mm", 1e3),
    ("walking_speed_m_s", "Walking speed", "m/s", 1.0),
)


def report_page(
    metrics: Mapping[str, Any],
    figures: Sequence[tuple[Path, str]],
    title: str,
    player: Mapping[str, Any] | None = None,
) -> str:
    """The page of one recording as text.

    Args:
        metrics: What `analyse_recording` returns.
        figures: PNG files to embed, each with a caption that also serves as its alternative text.
        title: Title of the page, for example the file's name.
        player: What `player_data` gives; no player where None.

    Returns:
        HTML that refers to no other file and no network.
    """
    sections = [("summary", "Summary", _tiles(metrics))]
    if metrics["warnings"]:
        rows = "".join(f"<li>{html.escape(w)}</li>" for w in metrics["warnings"])
        sections.append(("assumed", "What was assumed", f'<ul class="warnings">{rows}</ul>'))
    if player is not None:
        sections.append(("frames", "Frames", _player(player)))
    sections.append(("measures", "Measures of the complete steps", _table(metrics)))
    regions = _regions(metrics)
    if regions:
        sections.append(("regions", "Regions of the foot", regions))
    sections.append(("figures", "Figures", "".join(_figure(path, caption) for path, caption in figures)))
    about = (
        f"Format {html.escape(str(metrics['format']))}, {metrics['frames']} frames at {metrics['rate_hz']:.6g} Hz "
        f"({metrics['duration_s']:.4g} s)." + (" Readings are raw counts." if metrics.get("raw") else "")
    )
    script = "" if player is None else f"<script>{_asset('report.js')}</script>"
    return _page(f"Gait analysis: {title}", about, sections, script)


def comparison_page(
    comparison: Mapping[str, Any], figures: Sequence[tuple[Path, str]], names: tuple[str, str], links: tuple[str, str]
) -> str:
    """The page that puts two recordings side by side.

    Args:
        comparison: What `compare_recordings` returns.
        figures: PNG files to embed, with their captions.
        names: Names of the recordings.
        links: Files of their own reports, relative to this page.

    Returns:
        HTML that embeds all it shows; it links to the two reports beside it.
    """
    parts = []
    for key, name, link in zip(("a", "b"), names, links, strict=True):
        metrics = comparison[key]
        rows = "".join(f"<li>{html.escape(w)}</li>" for w in metrics["warnings"])
        notes = f'<ul class="warnings">{rows}</ul>' if rows else ""
        parts.append(
            f"<div><h3>{key.upper()}: {html.escape(name)}</h3>{_tiles(metrics)}{notes}"
            f'<p><a href="{html.escape(link)}">Full report of {key.upper()}</a></p></div>'
        )
    sections = [
        ("summary", "Summary", f'<div class="columns">{"".join(parts)}</div>'),
        ("measures", "Measures side by side", _comparison_table(comparison)),
        ("figures", "Figures", "".join(_figure(path, caption) for path, caption in figures)),
    ]
    about = f"A is {html.escape(names[0])}, B is {html.escape(names[1])}."
    return _page(f"Comparison: {names[0]} and {names[1]}", about, sections, "")


_FOOTPRINT = (
    ("length_m", "Length", "mm", 1e3),
    ("width_m", "Width", "mm", 1e3),
    ("toeless_length_m", "Length without toes", "mm", 1e3),
    ("heel_width_m", "Width of the heel", "mm", 1e3),
    ("forefoot_width_m", "Width of the forefoot", "mm", 1e3),
    ("area_m2", "Area", "cm²", 1e4),
    ("toeless_area_m2", "Area without toes", "cm²", 1e4),
    ("arch_index", "Arch index", "", 1.0),
    ("axis_angle_deg", "Angle of the axis to the vertical, to the left", "°", 1.0),
)


def footprint_page(metrics: Mapping[str, Any], figures: Sequence[tuple[Path, str]], title: str) -> str:
    """The page of a footprint image as text.

    Args:
        metrics: What `analyse_image` returns.
        figures: PNG files to embed, with their captions.
        title: Title of the page, for example the file's name.

    Returns:
        HTML that refers to no other file and no network.
    """
    feet = {side: foot["footprint"] for side, foot in metrics["feet"].items()}
    head = "".join(f'<th scope="col">{side} foot</th>' for side in feet)
    rows = []
    for key, name, unit, factor in _FOOTPRINT:
        if any(foot[key] is not None for foot in feet.values()):
            cells = "".join(f"<td>{number(None if f[key] is None else f[key] * factor)}</td>" for f in feet.values())
            rows.append(f'<tr><th scope="row">{name}{f" ({unit})" if unit else ""}</th>{cells}</tr>')
    for region, name in REGIONS.items():
        shares = [foot["region_area_percent"].get(region) for foot in feet.values()]
        if any(s is not None for s in shares):
            cells = "".join(f"<td>{number(s)}</td>" for s in shares)
            rows.append(f'<tr><th scope="row">{name} (% of area)</th>{cells}</tr>')
    table = _scrolled(
        "Measures of the footprints",
        "<caption>Measures of the footprints.</caption>"
        f'<thead><tr><th scope="col">Measure</th>{head}</tr></thead><tbody>{"".join(rows)}</tbody>',
    )
    sections = [("measures", "Measures", table)]
    if metrics["warnings"]:
        notes = "".join(f"<li>{html.escape(w)}</li>" for w in metrics["warnings"])
        sections.append(("assumed", "What was assumed", f'<ul class="warnings">{notes}</ul>'))
    sections.append(("figures", "Figures", "".join(_figure(path, caption) for path, caption in figures)))
    width, height = metrics["size_px"]
    scale = "" if metrics["mm_per_pixel"] is None else f", {metrics['mm_per_pixel']:.4g} mm a pixel"
    return _page(f"Footprint: {title}", f"Image of {width} x {height} pixels{scale}.", sections, "")


def _page(title: str, about: str, sections: Sequence[tuple[str, str, str]], script: str) -> str:
    menu = "".join(f'<li><a href="#{key}">{name}</a></li>' for key, name, _ in sections)
    body = "\n".join(
        f'<section aria-labelledby="{key}"><h2 id="{key}" tabindex="-1">{name}</h2>\n{content}</section>'
        for key, name, content in sections
    )
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<link rel="icon" href="data:,"><title>{html.escape(title)}</title>'
        f"<style>{_asset('report.css')}</style></head>\n"
        '<body><a class="skip" href="#content">Skip to content</a>\n'
        f'<header><h1>{html.escape(title)}</h1><p class="about">{about}</p>'
        f'<nav aria-label="Sections"><ul>{menu}</ul></nav></header>\n'
        f'<main id="content" tabindex="-1">\n{body}\n</main>\n{script}</body></html>\n'
    )


def _asset(name: str) -> str:
    return files("gait.analysis").joinpath(name).read_text(encoding="utf-8")


def number(value: float | None, digits: int = 3) -> str:
    """A value with about as many digits as its size deserves; an en dash where it is not known.

    Args:
        value: The value, or None.
        digits: Digits that count.

    Returns:
        The text.

    Example:
        >>> number(1234.5), number(-0.01234), number(None), number(0.0), number(2.0)
        ('1234', '−0.0123', '–', '0', '2.00')
    """
    if value is None:
        return "–"
    if value == 0.0:
        return "0"
    decimals = min(6, max(0, digits - 1 - math.floor(math.log10(abs(value)))))
    return f"{value:.{decimals}f}".replace("-", "−")


def _figure(path: Path, caption: str) -> str:
    data = base64.b64encode(path.read_bytes()).decode()
    text = html.escape(caption)
    return f'<figure><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>\n'


def _tiles(metrics: Mapping[str, Any]) -> str:
    gait = metrics["gait"]
    tiles = [(f"Complete steps, {side}", str(foot["steps"])) for side, foot in metrics["feet"].items()]
    for key, name, unit, factor in _GAIT:
        if gait.get(key) is not None:
            tiles.append((name, f"{number(gait[key] * factor)} {unit}"))
    return '<dl class="tiles">' + "".join(f"<div><dt>{n}</dt><dd>{v}</dd></div>" for n, v in tiles) + "</dl>"


def _named(key: str, measure: Measure, raw: bool) -> tuple[str, str, str, float]:
    """Key, title and unit of a measure, and the factor to that unit."""
    if raw and raw_name(key) != key:
        unit = {"_Ns": "counts·s", "_Pas": "counts·s", "_N_s": "counts/s", "_Nm": "counts·m"}
        return raw_name(key), measure.title, next((u for e, u in unit.items() if key.endswith(e)), "counts"), 1.0
    return key, measure.title, measure.unit, measure.factor


def _spread_cells(spread: Mapping[str, Any] | None, factor: float) -> str:
    if spread is None or spread["mean"] is None:
        return "<td>–</td><td>–</td>"
    text = number(spread["mean"] * factor)
    text += "" if spread["sd"] is None else f" ± {number(spread['sd'] * factor, 2)}"
    return f"<td>{text}</td><td>{number(spread['cv_percent'], 2)}</td>"


def _table(metrics: Mapping[str, Any]) -> str:
    feet: Mapping[str, Any] = metrics["feet"]
    raw = bool(metrics.get("raw"))
    both = len(feet) == 2
    columns = 2 * len(feet) + 1 + both
    rows: list[str] = []
    group = ""
    for plain, measure in MEASURES.items():
        key, title, unit, factor = _named(plain, measure, raw)
        spreads = [foot["measures"].get(key) for foot in feet.values()]
        if all(s is None or s["mean"] is None for s in spreads):
            continue
        if measure.group != group:
            group = measure.group
            rows.append(f'<tr class="group"><th scope="rowgroup" colspan="{columns}">{group}</th></tr>')
        cells = "".join(_spread_cells(s, factor) for s in spreads)
        if both:
            cells += f"<td>{number(metrics['gait']['symmetry_percent'].get(key), 2)}</td>"
        rows.append(f'<tr><th scope="row">{title}{f" ({unit})" if unit else ""}</th>{cells}</tr>')
    if not rows:
        return "<p>The recording holds no complete step.</p>"
    head = "".join(f'<th scope="col">{side}: mean ± SD</th><th scope="col">CV (%)</th>' for side in feet)
    last = '<th scope="col">Symmetry index (%)</th>' if both else ""
    note = "; symmetry index 100 (L − R) / ((L + R) / 2), 0 is symmetric" if both else ""
    return _scrolled(
        "Measures",
        f"<caption>Over the complete steps: mean, standard deviation, coefficient of variation{note}.</caption>"
        f'<thead><tr><th scope="col">Measure</th>{head}{last}</tr></thead><tbody>{"".join(rows)}</tbody>',
    )


def _regions(metrics: Mapping[str, Any]) -> str:
    raw = bool(metrics.get("raw"))
    out: list[str] = []
    for side, foot in metrics["feet"].items():
        if not foot["regions"]:
            continue
        shown = [_named(key, measure, raw) for key, measure in REGION_MEASURES.items()]
        head = "".join(f'<th scope="col">{title}{f" ({unit})" if unit else ""}</th>' for _, title, unit, _ in shown)
        rows = []
        for region, title in REGIONS.items():
            if region in foot["regions"]:
                values = foot["regions"][region]
                cells = "".join(
                    f"<td>{number(m['mean'] * f if (m := values.get(key)) and m['mean'] is not None else None)}</td>"
                    for key, _, _, f in shown
                )
                rows.append(f'<tr><th scope="row">{title}</th>{cells}</tr>')
        out.append(
            _scrolled(
                f"Regions of the {side} foot",
                f"<caption>The {side} foot, means over its complete steps.</caption>"
                f'<thead><tr><th scope="col">Region</th>{head}</tr></thead><tbody>{"".join(rows)}</tbody>',
            )
        )
    return "".join(out)


def _comparison_table(comparison: Mapping[str, Any]) -> str:
    rows: list[str] = []
    raw = bool(comparison["a"].get("raw") or comparison["b"].get("raw"))
    for side, measures in comparison["difference"].items():
        rows.append(f'<tr class="group"><th scope="rowgroup" colspan="6">{side.capitalize()} foot</th></tr>')
        for plain, measure in MEASURES.items():
            key, title, unit, factor = _named(plain, measure, raw)
            row = measures.get(key)
            if row is None:
                continue
            cells = ""
            for one in ("a", "b"):
                sd = "" if row[one]["sd"] is None else f" ± {number(row[one]['sd'] * factor, 2)}"
                cells += f"<td>{number(row[one]['mean'] * factor)}{sd}</td>"
            cells += f"<td>{number(row['difference'] * factor)}</td><td>{number(row['percent'], 2)}</td>"
            cells += f"<td>{number(row['effect_size'], 2)}</td>"
            rows.append(f'<tr><th scope="row">{title}{f" ({unit})" if unit else ""}</th>{cells}</tr>')
    head = "".join(
        f'<th scope="col">{name}</th>'
        for name in ("A: mean ± SD", "B: mean ± SD", "B − A", "B − A (% of A)", "Effect size (Cohen's d)")
    )
    if not rows:
        return "<p>The recordings have no foot with complete steps in common.</p>"
    return _scrolled(
        "Measures side by side",
        "<caption>Over the complete steps. Effect size: B − A over the pooled standard deviation.</caption>"
        f'<thead><tr><th scope="col">Measure</th>{head}</tr></thead><tbody>{"".join(rows)}</tbody>',
    )


def _scrolled(label: str, table: str) -> str:
    return f'<div class="scroll" tabindex="0" role="region" aria-label="{label}"><table>{table}</table></div>\n'


def _player(data: Mapping[str, Any]) -> str:
    text = json.dumps(data, separators=(",", ":")).replace("</", "<\\/")
    scales = "; ".join(f"{foot['side']} 0 to {number(foot['highest'])} {data['unit']}" for foot in data["feet"])
    part = "" if data["whole"] else f" The first {data['times'][-1] - data['times'][0]:.0f} s of walking are shown."
    options = "".join(
        f'<option value="{value}"{" selected" if value == 1 else ""}>{name}</option>'
        for value, name in ((0.1, "1/10"), (0.25, "1/4"), (0.5, "1/2"), (1, "1"), (2, "2"))
    )
    return (
        '<div id="player" role="group" aria-label="Player of frames">\n'
        '<canvas id="player-canvas" role="img" tabindex="0" aria-label="Soles from above: pressure of each cell, '
        'loaded cells outlined, CoP, polygon. The line of text below gives the figures."></canvas>\n'
        f'<p class="legend"><span><span class="scale" aria-hidden="true"></span> pressure: {scales}</span>'
        '<span><span class="dot" aria-hidden="true"></span> centre of pressure</span>'
        '<span><span class="dash" aria-hidden="true"></span> support polygon</span></p>\n'
        '<label for="player-frame">Frame</label> '
        '<input type="range" id="player-frame" min="0" max="0" value="0" disabled>\n'
        '<div class="controls"><button type="button" id="player-play" aria-pressed="false" disabled>Play</button>'
        '<button type="button" id="player-back" disabled>Frame back</button>'
        '<button type="button" id="player-forward" disabled>Frame forward</button>'
        '<button type="button" id="player-before" disabled>Event before</button>'
        '<button type="button" id="player-next" disabled>Next event</button>'
        f'<label for="player-speed">Speed</label> <select id="player-speed" disabled>{options}</select></div>\n'
        f'<p id="player-readout"></p><p class="hidden" id="player-live" aria-live="polite"></p>'
        f"<noscript><p>The player needs JavaScript; everything else on this page does not.</p></noscript>"
        f'<p class="about">Seen from above, toes up.{part} '
        "Keys: arrows and space on the picture, arrows on the slider.</p>\n"
        f'</div>\n<script type="application/json" id="player-data">{text}</script>\n'
    )
