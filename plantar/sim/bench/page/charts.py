"""Charts of a page, drawn by the page itself: bars in tables, and points on logarithmic axes."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence
from typing import NamedTuple

__all__ = ["Point", "bar", "scatter"]


class Point(NamedTuple):
    """A point of a chart.

    Attributes:
        x: Abscissa, above 0.
        y: Ordinate, above 0.
        group: What it belongs to, by which it is coloured and given in the legend.
        name: What it is.
        ours: Whether it is of this project, and so filled.
        shown: What stands next to it; empty for nothing.
    """

    x: float
    y: float
    group: str
    name: str
    ours: bool = False
    shown: str = ""


_WIDTH, _HEIGHT = 680.0, 400.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 70.0, 20.0, 14.0, 46.0
_COLOURS = 8


def bar(share: float, kind: str = "ours") -> str:
    """A bar in a cell.

    Args:
        share: Its length as a share of the longest, 0 to 1.
        kind: "ours" or "other".

    Returns:
        HTML, hidden from screen readers: the number stands next to it.
    """
    return f'<span class="bar {kind}" style="width:{100 * min(max(share, 0.005), 1.0):.1f}%" aria-hidden="true"></span>'


def scatter(label: str, axes: tuple[str, str], points: Sequence[Point], line: tuple[float, str] | None = None) -> str:
    """Points on two logarithmic axes.

    Args:
        label: What it shows, for screen readers.
        axes: Names of abscissa and ordinate, with units.
        points: The points; those that are not above 0 and finite are left out.
        line: Height of a dashed line across, and its name.

    Returns:
        HTML of a figure without caption, with its legend; nothing where there is no point.
    """
    kept = [p for p in points if all(math.isfinite(v) and v > 0.0 for v in p[:2])]
    if not kept:
        return ""
    x_ticks = _ticks([p.x for p in kept])
    y_ticks = _ticks([p.y for p in kept] + ([line[0]] if line else []))
    groups = list(dict.fromkeys(p.group for p in kept))

    def place(value: float, ticks: Sequence[float], low: float, high: float) -> float:
        a, b = math.log(ticks[0]), math.log(ticks[-1])
        return low + (math.log(value) - a) / (b - a) * (high - low)

    parts = []
    for tick in x_ticks:
        x = place(tick, x_ticks, _LEFT, _WIDTH - _RIGHT)
        parts.append(f'<path class="grid" d="M{x:.1f} {_TOP}V{_HEIGHT - _BOTTOM}"/>')
        parts.append(f'<text x="{x:.1f}" y="{_HEIGHT - _BOTTOM + 18}" text-anchor="middle">{_number(tick)}</text>')
    for tick in y_ticks:
        y = place(tick, y_ticks, _HEIGHT - _BOTTOM, _TOP)
        parts.append(f'<path class="grid" d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}"/>')
        parts.append(f'<text x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{_number(tick)}</text>')
    middle = 0.5 * (_TOP + _HEIGHT - _BOTTOM)
    parts.append(
        f'<text x="{0.5 * (_LEFT + _WIDTH):.0f}" y="{_HEIGHT - 8}" text-anchor="middle">{_text(axes[0])}</text>'
    )
    parts.append(
        f'<text transform="translate(16 {middle:.0f}) rotate(-90)" text-anchor="middle">{_text(axes[1])}</text>'
    )
    if line is not None:
        y = place(line[0], y_ticks, _HEIGHT - _BOTTOM, _TOP)
        parts.append(f'<path class="line" d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}"/>')
        parts.append(f'<text class="soft" x="{_LEFT + 5}" y="{y - 5:.1f}" text-anchor="start">{_text(line[1])}</text>')
    for p in sorted(kept, key=lambda p: p.ours):
        x, y = place(p.x, x_ticks, _LEFT, _WIDTH - _RIGHT), place(p.y, y_ticks, _HEIGHT - _BOTTOM, _TOP)
        style = f"c{groups.index(p.group) % _COLOURS}{' ours' if p.ours else ''}"
        told = f"{p.name}: {p.x:.3g}, {p.y:.3g}"
        parts.append(
            f'<circle class="{style}" cx="{x:.1f}" cy="{y:.1f}" r="{7 if p.ours else 5}">'
            f"<title>{_text(told)}</title></circle>"
        )
        if p.shown:
            end = x > _WIDTH - 120
            at = f'x="{x - 9 if end else x + 9:.1f}" y="{y + 4:.1f}" text-anchor="{"end" if end else "start"}"'
            parts.append(f'<text class="name" {at}>{_text(p.shown)}</text>')
    keys = "".join(
        f'<li><span class="key c{i % _COLOURS}{" ours" if any(p.ours for p in kept if p.group == g) else ""}" '
        f'aria-hidden="true"></span>{_text(g)}</li>'
        for i, g in enumerate(groups)
    )
    return (
        f'<div class="scroll chart" tabindex="0" role="region" aria-label="Chart: {_text(label)}">'
        f'<svg viewBox="0 0 {_WIDTH:.0f} {_HEIGHT:.0f}" role="img" aria-label="{_text(label)}">{"".join(parts)}</svg>'
        "</div>"
        f'<ul class="keys">{keys}</ul>'
    )


def _ticks(values: Sequence[float]) -> list[float]:
    """Ticks of a logarithmic axis that holds the values: 1, 2, 5 of each decade, or decades where they are many."""
    low, high = math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)
    high = max(high, low + 1)
    if high - low <= 2:
        fine = [m * 10.0**k for k in range(low, high) for m in (1.0, 2.0, 5.0)] + [10.0**high]
        first = max((i for i, t in enumerate(fine) if t <= min(values) * (1 + 1e-9)), default=0)
        last = min((i for i, t in enumerate(fine) if t >= max(values) * (1 - 1e-9)), default=len(fine) - 1)
        return fine[first : max(last, first + 1) + 1]
    step = math.ceil((high - low) / 8)
    return [10.0**k for k in range(low, high + step, step)]


def _number(value: float) -> str:
    if 1e-3 <= value < 1e4:
        return f"{value:g}"
    return f"1e{round(math.log10(value))}"


def _text(text: str) -> str:
    return html.escape(text)
