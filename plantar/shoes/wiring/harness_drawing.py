"""Drawing of a shoe's wiring, seen from the ground: cells, leads or lines of the sheet, and each part's pins. In mm."""

import io
from collections import defaultdict
from typing import Any

import numpy as np

from plantar.plotting import COLOURS, drawn_name, new_figure
from plantar.shoes.build import Shoe
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import channel_lines, wire_lines
from plantar.shoes.wiring.flex_board import FlexBoard
from plantar.shoes.wiring.nets import Wiring

_ROW = "#1f6fb4"
_COLUMN = "#c2410c"
_PINS_A_LINE = 4
_LINES_A_COLUMN = 46
_LETTERS_A_LINE = 3 + 14 * _PINS_A_LINE
_LETTER = 0.602  # width of a letter of matplotlib's monospaced font as a share of the font's size


def draw_harness(shoe: Shoe, parameters: ShoeParameters, wiring: Wiring, board: FlexBoard | None) -> bytes:
    """Gives PNG of the wiring of a shoe, by parameters, with the flexible board of a sheet."""
    figure, (axes, table) = new_figure(16.0, 9.0, columns=2, width_ratios=(1.15, 1.0))
    _plan(axes, shoe, parameters, wiring, board)
    _pins(table, wiring)
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=110, bbox_inches=_drawn(figure, axes, table), metadata={"Software": None})
    return out.getvalue()


def _drawn(figure: Any, axes: Any, table: Any) -> Any:
    """Box in inches of what is drawn on a figure: of the plan, and of the lines of the table, which has free space."""
    figure.draw_without_rendering()
    boxes = [axes.get_tightbbox(), *(line.get_window_extent() for line in table.texts)]
    return boxes[0].union(boxes).transformed(figure.dpi_scale_trans.inverted()).padded(0.1)


def _plan(axes: Any, shoe: Shoe, p: ShoeParameters, wiring: Wiring, board: FlexBoard | None) -> None:
    plan = shoe.plan
    axes.plot(*_closed(plan.contact), color=COLOURS["reference"], lw=1.0)
    if board is not None:
        axes.plot(*_closed(board.outline), color="#111111", lw=1.0)
        for comb in board.combs:
            axes.fill(*ring(comb.shape).T, color="#d7dce2", lw=0.0)
        for piece in board.pieces:
            axes.plot(
                *piece.ends.T,
                color=_ROW if piece.net[0] == "R" else _COLUMN,
                lw=0.8,
                ls="-" if piece.layer == 0 else ":",
            )
        size = 4.0 if len(shoe.layout) > 80 else 6.0
        for comb in board.combs[::2]:
            x, y = comb.shape.envelope.centroid.coords[0]
            axes.text(x, y - 2.0, f"T{comb.taxel}", ha="center", va="center", fontsize=size)
        title = f"T id; rows {_span('R', wiring)} blue, columns {_span('C', wiring)} orange, dotted on the back"
    else:
        colour = {lead.cell: lead.colour for lead in wiring.leads if lead.net != "3V3"}
        for q in plan.pockets:
            axes.fill(*ring(q).T, color="#e9ecef", lw=0.0)
        for line in (*wire_lines(plan).values(), *channel_lines(plan, p)):
            axes.plot(*line.T, color=COLOURS["reference"], lw=2.5, alpha=0.45, solid_capstyle="round")
        for cell, k in zip(plan.cells, shoe.layout.ids.tolist(), strict=True):
            x, y = cell.centroid.coords[0]
            own = colour[k] if wiring.circuit == "divider" else "#111111"
            axes.fill(*ring(cell).T, facecolor="#cfd5dc", edgecolor=own, lw=2.5)
            axes.text(x, y, f"T{k}", ha="center", va="center", fontsize=7)
        title = "T id, its edge in the colour of its lead; grey: the way of the leads to the heel"
    axes.set_aspect("equal", anchor="N")
    axes.invert_yaxis()  # seen from the ground, toes to the right, the left side is below
    axes.set_xlabel("mm, toes to the right; seen from the ground")
    axes.set_title(f"{drawn_name(shoe.layout.name)}, {shoe.side}: {title}", fontsize=9, loc="left")


def _span(letter: str, wiring: Wiring) -> str:
    count = sum(1 for net in wiring.nets if net[0] == letter and net[1:].isdigit())
    return f"{letter}0 to {letter}{count - 1}"


def _closed(shape: Any) -> Any:
    corners = ring(shape)
    return np.concatenate([corners, corners[:1]]).T


def _pins(axes: Any, wiring: Wiring) -> None:
    """Each part's pins and what they are joined to, in columns of text."""
    pins: dict[str, list[str]] = defaultdict(list)
    for net, joined in wiring.nets.items():
        for pin in joined:
            if pin.part[0] in "UJ":
                pins[pin.part].append(f"{pin.name} {net}")
    for found in pins.values():
        found.sort(key=_natural)
    what = {part: bought.what for bought in wiring.bought for part in pins if _is_of(part, bought.references)}
    lines: list[tuple[str, bool]] = []
    for part in sorted(pins, key=lambda name: (name[0] != "U", int(name[1:]))):
        lines.append((f"{part}  {what.get(part, '')}", True))
        entries = pins[part]
        rows = [entries[k : k + _PINS_A_LINE] for k in range(0, len(entries), _PINS_A_LINE)]
        lines += [("   " + "   ".join(f"{entry:<11}" for entry in row), False) for row in rows]
    columns = -(-len(lines) // _LINES_A_COLUMN)
    axes.set_axis_off()
    width = 72.0 * axes.figure.get_figwidth() * axes.get_position().width  # in points, as fonts
    size = min(9.0, width / (columns * _LETTERS_A_LINE * _LETTER))
    for k, (text, bold) in enumerate(lines):
        place = (k // _LINES_A_COLUMN / columns, 1.0 - (k % _LINES_A_COLUMN) / _LINES_A_COLUMN)
        weight = "bold" if bold else "normal"
        axes.text(*place, text, transform=axes.transAxes, fontsize=size, family="monospace", weight=weight, va="top")
    axes.set_title("pin and net of each part", fontsize=9, loc="left")


def _natural(entry: str) -> tuple[str, int]:
    """A pin's letters and number: C2 before C10."""
    name = entry.split()[0]
    letters = name.rstrip("0123456789")
    return letters, int(name[len(letters) :] or 0)


def _is_of(part: str, references: str) -> bool:
    ends = references.split(" to ")
    if len(ends) == 2 and part[0] == ends[0][0]:
        return int(ends[0][1:]) <= int(part[1:]) <= int(ends[1][1:])
    return part in references.split(", ")
