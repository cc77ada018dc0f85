"""The report: one HTML page that needs nothing else, for screen, print and dark mode."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

__all__ = ["UNITS", "report_page"]

UNITS: Mapping[str, tuple[str, str, float]] = {
    "contact_time_s": ("Contact time", "s", 1.0),
    "stride_time_s": ("Stride time", "s", 1.0),
    "step_time_s": ("Step time", "s", 1.0),
    "swing_time_s": ("Swing time", "s", 1.0),
    "stance_percent": ("Stance", "% of stride", 1.0),
    "swing_percent": ("Swing", "% of stride", 1.0),
    "double_support_percent": ("Double support", "% of stride", 1.0),
    "peak_force_N": ("Peak vertical force", "N", 1.0),
    "impulse_Ns": ("Impulse (force-time integral)", "N·s", 1.0),
    "landing_impact_N": ("Landing impact (50 ms)", "N", 1.0),
    "peak_pressure_Pa": ("Peak pressure", "kPa", 1e-3),
    "pressure_time_integral_Pas": ("Pressure-time integral", "kPa·s", 1e-3),
    "contact_area_m2": ("Contact area", "cm²", 1e4),
    "cop_path_m": ("CoP path length", "mm", 1e3),
    "cop_excursion_ap_m": ("CoP excursion, back to front", "mm", 1e3),
    "cop_excursion_ml_m": ("CoP excursion, side to side", "mm", 1e3),
    "cop_velocity_m_s": ("CoP velocity", "mm/s", 1e3),
    "cop_margin_m": ("CoP margin to the sole's edge", "mm", 1e3),
}
"""Title, unit for readers, and factor from SI of each measure of a step."""

_STYLE = """
:root{color-scheme:light dark;--ink:#1b1f24;--soft:#57606a;--paper:#fff;--line:#d0d7de;--warn:#fff4ce;--warnink:#5c4400}
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--soft:#9da7b1;--paper:#0d1117;--line:#30363d;--warn:#3a2f0b;
--warnink:#f2d98b}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:60rem;margin:2rem auto;
padding:0 1rem}
h1{font-size:1.6rem;margin-bottom:.2rem}h2{font-size:1.2rem;margin-top:2rem}p.about{color:var(--soft);margin-top:0}
.scroll{overflow-x:auto}table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--soft);padding:.3rem 0}
th,td{padding:.25rem .6rem;border-bottom:1px solid var(--line);text-align:right}
th:first-child,td:first-child{text-align:left}th[scope=row]{font-weight:400}
dl{display:grid;grid-template-columns:repeat(auto-fit,minmax(9rem,1fr));gap:.5rem 1rem}
dl div{border:1px solid var(--line);border-radius:.4rem;padding:.4rem .7rem}
dt{color:var(--soft);font-size:.85rem}dd{margin:0;font-size:1.25rem}
ul.warnings{background:var(--warn);color:var(--warnink);border-radius:.4rem;padding:.7rem 1rem .7rem 2rem}
figure{margin:1rem 0;background:#fff;border:1px solid var(--line);border-radius:.4rem;padding:.5rem}
figure img{display:block;max-width:100%;height:auto;margin:auto}figcaption{color:#57606a;font-size:.9rem}
@media print{:root{--ink:#000;--soft:#444;--paper:#fff;--line:#999;--warn:#fff;--warnink:#000}
body{margin:0;max-width:none;font-size:11pt}figure,tr,dl{break-inside:avoid}}
"""


def report_page(metrics: Mapping[str, Any], figures: Sequence[tuple[Path, str]], title: str) -> str:
    """The page as text.

    Args:
        metrics: What `analyse_recording` returns.
        figures: PNG files to embed, each with a caption that also serves as its alternative text.
        title: Title of the page, for example the file's name.

    Returns:
        HTML that refers to no other file and no network.
    """
    feet: Mapping[str, Any] = metrics["feet"]
    parts = [
        f"<h1>Gait analysis: {html.escape(title)}</h1>",
        f'<p class="about">Format {html.escape(str(metrics["format"]))}, {metrics["frames"]} frames at '
        f"{metrics['rate_hz']:.6g} Hz ({metrics['duration_s']:.4g} s).</p>",
        _tiles(metrics),
    ]
    if metrics["warnings"]:
        rows = "".join(f"<li>{html.escape(w)}</li>" for w in metrics["warnings"])
        parts.append(f'<h2>What was assumed</h2><ul class="warnings">{rows}</ul>')
    parts += ["<h2>Measures of the complete steps</h2>", _table(feet, metrics["gait"]["symmetry_percent"])]
    parts.append("<h2>Figures</h2>")
    for path, caption in figures:
        data = base64.b64encode(path.read_bytes()).decode()
        text = html.escape(caption)
        parts.append(
            f'<figure><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>'
        )
    body = "\n".join(parts)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>Gait analysis: {html.escape(title)}</title><style>{_STYLE}</style></head>\n"
        f"<body><main>\n{body}\n</main></body></html>\n"
    )


def _number(value: float | None, digits: int = 3) -> str:
    """A value with about as many digits as its size deserves; an en dash where it is not known."""
    if value is None:
        return "–"
    decimals = max(0, digits - len(str(int(abs(value))))) if abs(value) >= 1.0 else digits
    return f"{value:.{decimals}f}".replace("-", "−")


def _tiles(metrics: Mapping[str, Any]) -> str:
    gait = metrics["gait"]
    tiles = [(f"Complete steps, {side}", str(foot["steps"])) for side, foot in metrics["feet"].items()]
    for key, name, unit in (
        ("cadence_steps_per_min", "Cadence", "steps/min"),
        ("stride_time_s", "Stride time", "s"),
        ("double_support_percent", "Double support", "%"),
    ):
        if gait[key] is not None:
            tiles.append((name, f"{_number(gait[key])} {unit}"))
    return "<dl>" + "".join(f"<div><dt>{n}</dt><dd>{v}</dd></div>" for n, v in tiles) + "</dl>"


def _table(feet: Mapping[str, Any], symmetry: Mapping[str, float | None]) -> str:
    head = "".join(f'<th scope="col">{side}: mean ± SD</th><th scope="col">CV (%)</th>' for side in feet)
    rows = []
    for key, (name, unit, factor) in UNITS.items():
        cells = []
        for foot in feet.values():
            spread = foot["measures"][key]
            mean, sd, cv = spread["mean"], spread["sd"], spread["cv_percent"]
            text = _number(None if mean is None else mean * factor)
            text += "" if sd is None else f" ± {_number(sd * factor)}"
            cells.append(f"<td>{text}</td><td>{_number(cv, 2)}</td>")
        if len(feet) == 2:
            cells.append(f"<td>{_number(symmetry[key], 2)}</td>")
        if any("–" not in c.split("</td>")[0] for c in cells):
            rows.append(f'<tr><th scope="row">{name} ({unit})</th>{"".join(cells)}</tr>')
    if not rows:
        return "<p>The recording holds no complete step.</p>"
    last = '<th scope="col">Symmetry index (%)</th>' if len(feet) == 2 else ""
    return (
        '<div class="scroll" tabindex="0" role="region" aria-label="Measures"><table><caption>Over the complete steps; '
        "symmetry index 100 (L − R) / ((L + R) / 2), 0 is symmetric.</caption>"
        f'<thead><tr><th scope="col">Measure</th>{head}{last}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
    )
