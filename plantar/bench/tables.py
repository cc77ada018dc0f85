"""Tables and figures of every benchmark."""

import math
import platform
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

from plantar.common.atomic import write_text
from plantar.common.table_writer import csv_text, mapping_rows
from plantar.plotting import COLOURS

_PAINT = ("#4c78a8", "#f2a541", "#59a14f", "#b279a2", "#9d755d", "#2f4b7c", "#76b7b2", "#e377c2", "#8c8c8c")


def cell(value: Any) -> str:
    """A table cell: three digits, a dash if not measured.

    Example:
        >>> cell(12.345), cell(1234.5), cell(None), cell(float("inf")), cell(-0.0001), cell("a"), cell(3)
        ('12.3', '1234', '-', '-', '-0.0001', 'a', '3')
    """
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "-"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1000.0 else f"{value:.0f}"
    return str(value)


def markdown_table(head: Sequence[str], lines: Iterable[Sequence[Any]]) -> str:
    """Returns a Markdown table with columns `head` and values `lines`.

    Example:
        >>> print(markdown_table(("a", "b"), [("1", 2.0)]))
        | a | b |
        | --- | --- |
        | 1 | 2 |
    """
    rows = [head, ["---"] * len(head), *lines]
    return "\n".join("| " + " | ".join(map(cell, cells)) + " |" for cells in rows)


def made_on() -> str:
    """When and on what a table is made."""
    return f"{time.strftime('%Y-%m-%d')}, {platform.machine()}, Python {platform.python_version()}"


def plain_row(row: Any) -> dict[str, Any]:
    """Fields of a dataclass by name; None for a number that is not finite."""
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in asdict(row).items()}


def write_rows(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write `rows` as a CSV at `path`, with six digits."""
    names = list(rows[0]) if rows else []
    cells = ({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
    write_text(path, csv_text(names, mapping_rows(names, cells)))


class Mark(NamedTuple):
    """A point of a figure of run time against error. `error`: 0 is drawn at the figure's least."""

    cost: float
    error: float
    group: str
    ours: bool = False
    hollow: bool = False
    marker: str = "o"
    text: str = ""


def draw_errors(axis: Any, marks: Sequence[Mark], labels: tuple[str, str, str], least: float) -> None:
    """Draw `marks` on logarithmic Matplotlib `axis`, with `labels` of title, run time and error, from `least` on."""
    others = list(dict.fromkeys(m.group for m in marks if not m.ours))
    for group in dict.fromkeys(m.group for m in marks):
        axis.plot([], [], "o", color=_colour(group, others), label=group)
    for m in marks:
        colour = _colour(m.group, others)
        face = "none" if m.hollow else colour
        at = (m.cost, max(m.error, least))
        axis.plot(*at, marker=m.marker, color=colour, markerfacecolor=face, linestyle="none", markersize=7)
        if m.text:
            axis.annotate(m.text, at, xytext=(4, 3), textcoords="offset points", fontsize=6.5)
    axis.set(xscale="log", yscale="log", title=labels[0], xlabel=labels[1], ylabel=labels[2])
    axis.xaxis.set_minor_formatter("")
    axis.grid(True, which="major", color="#e5e5e5", linewidth=0.6)


def _colour(group: str, others: Sequence[str]) -> str:
    return _PAINT[others.index(group) % len(_PAINT)] if group in others else COLOURS["cop"]
