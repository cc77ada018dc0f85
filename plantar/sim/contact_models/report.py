"""The comparison as files: tables, a figure of error against run time, and one page with the choice."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from plantar.atomic import write_text
from plantar.csv_table import csv_text, mapping_rows
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import read_layout
from plantar.layouts.tiling import hex_layout
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.contact_models.comparison import ContactRow, compare_contact_models
from plantar.sim.contact_models.page import COP_LIMIT_MM, EDGE_LIMIT_MM, contact_page, holds
from plantar.sim.contact_models.parameters import ParameterRow, study_contact_parameters

__all__ = ["measure_contact", "write_contact_report"]

_SOLE = ((-0.125, -0.0775), (0.125, -0.0775), (0.125, 0.0775), (-0.125, 0.0775))
"""The sole that is measured where none is given: 250 x 155 mm, in m."""

_LEAST, _MOST = 1e-2, 150.0
"""Errors in mm that are drawn: smaller and larger ones are drawn there."""


def measure_contact(folder: Path, layout: Path | None, progress: Callable[[float, str], None]) -> dict[str, Any]:
    """Compare the contact models on a sole, study the contact parameters, and write the report.

    Args:
        folder: Where to write; must exist.
        layout: Layout file of the sole; None for one of 250 x 155 mm with taxels of 691 mm^2.
        progress: Called with the fraction done and a text.

    Returns:
        Name of the chosen model, whether it holds what is required, rows of models and parameters, names of the files.

    Raises:
        LayoutError: If the layout file cannot be used.
    """
    sole = hex_layout(_SOLE) if layout is None else read_layout(layout)
    rows = compare_contact_models(sole, progress=lambda share, text: progress(0.9 * share, text))
    parameters = study_contact_parameters(sole, progress=lambda share, text: progress(0.9 + 0.1 * share, text))
    return {
        "chosen": rows[0].name,
        "holds": holds(rows[0]),
        "models": [r.as_dict() for r in rows],
        "parameters": [p.as_dict() for p in parameters],
        "files": write_contact_report(folder, sole, rows, parameters),
    }


def write_contact_report(
    folder: Path, layout: SoleLayout, rows: Sequence[ContactRow], parameters: Sequence[ParameterRow]
) -> list[str]:
    """Write contact.csv, contact_parameters.csv, contact_models.md and contact_models.png.

    Args:
        folder: Where to write; must exist.
        layout: The sole that was measured.
        rows: Contact models, the chosen one first.
        parameters: Contact parameters.

    Returns:
        Names of the files.
    """
    write_text(folder / "contact.csv", _csv([r.as_dict() for r in rows]))
    write_text(folder / "contact_parameters.csv", _csv([r.as_dict() for r in parameters]))
    write_text(folder / "contact_models.md", contact_page(layout, rows, parameters))
    _draw(folder / "contact_models.png", rows)
    return ["contact.csv", "contact_parameters.csv", "contact_models.md", "contact_models.png"]


def _csv(rows: Sequence[dict[str, Any]]) -> str:
    names = list(rows[0]) if rows else []
    cells = ({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
    return csv_text(names, mapping_rows(names, cells))


def _draw(path: Path, rows: Sequence[ContactRow]) -> None:
    """Error against run time: CoP on the left, tip-over edge on the right; dashed: what is required."""
    figure, axes = new_figure(11.0, 4.6, 1, 2)
    cop = [r.cop_max_mm for r in rows]
    edge = [max(abs(r.edge_x_mm), abs(r.edge_y_mm)) for r in rows]
    _draw_errors(axes[0], rows, cop, COP_LIMIT_MM, "largest CoP error in full-sole stance, mm")
    _draw_errors(axes[1], rows, edge, EDGE_LIMIT_MM, "tip-over edge off the true edge, mm")
    lines = [f"{i + 1}  {r.name}" for i, r in enumerate(rows)]
    legend = "\n".join(lines) + f"\n\nless than {_LEAST:g} mm: drawn there"
    axes[1].text(1.03, 0.98, legend, transform=axes[1].transAxes, va="top", fontsize=8.5)
    save_figure(figure, path)


def _draw_errors(ax: Any, rows: Sequence[ContactRow], errors: Sequence[float], limit: float, title: str) -> None:
    """One kind of error in mm of each model against the time that a simulated ms takes with it."""
    for i, (row, error) in enumerate(zip(rows, errors, strict=True)):
        shown = min(max(error, _LEAST), _MOST)
        colour = COLOURS["polygon"] if i == 0 else COLOURS["left"]
        ax.plot(row.millisecond_us, shown, "o", ms=9 if i == 0 else 6, color=colour, zorder=3)
        offset, side = ((-6, 5), "right") if i % 2 else ((6, 3), "left")
        at = (row.millisecond_us, shown)
        ax.annotate(str(i + 1), at, fontsize=9, xytext=offset, ha=side, textcoords="offset points")
    ax.axhline(limit, ls="--", color=COLOURS["reference"], lw=1)
    ax.set(xscale="log", yscale="log", ylim=(0.6 * _LEAST, 200.0), title=title)
    ticks = [t for t in (5, 10, 20, 50, 100, 200, 500, 1000) if ax.get_xlim()[0] <= t <= ax.get_xlim()[1]]
    ax.set_xticks(ticks, [str(t) for t in ticks])
    ax.set_xticks([], minor=True)
    ax.set_yticks([0.01, 0.1, 1, 10, 100], ["0.01", "0.1", "1", "10", "100"])
    ax.set_xlabel("us a simulated ms: step + 1/4 reading")
    ax.grid(alpha=0.3, which="major")
