"""A flexible board for a sole in KiCad's formats: its outline with a pad for each taxel, and the net list.

The board lies in pockets, ports and channel with the gap of sliding parts. Each taxel, or of a sheet each row and
column, has its own line to the connector at the heel. Lengths in mm; KiCad's y points down.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from plantar.shoes.build import Shoe
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import channel_lines, pocket_outlines
from plantar.shoes.units import to_mm

__all__ = ["board_nets", "board_outlines", "board_text", "net_list_text"]

_PAD, _LINE = 1.0, 0.1  # mm
_LAYERS = '(0 "F.Cu" signal) (31 "B.Cu" signal) (37 "F.SilkS" user) (44 "Edge.Cuts" user)'


def board_nets(shoe: Shoe) -> dict[str, list[str]]:
    """Nets by name, each with the references of its taxels; taxel k of the layout is T<k>."""
    plan, ids = shoe.plan, shoe.layout.ids.tolist()
    if plan.lines is None:
        return {f"TAXEL_{k}": [f"T{k}"] for k in ids} | {"GND": [f"T{k}" for k in ids]}
    nets: dict[str, list[str]] = {}
    for k, (row, column) in zip(ids, plan.lines.tolist(), strict=True):
        nets.setdefault(f"ROW_{row}", []).append(f"T{k}")
        nets.setdefault(f"COLUMN_{column}", []).append(f"T{k}")
    return dict(sorted(nets.items()))


def board_outlines(shoe: Shoe, parameters: ShoeParameters) -> list[Any]:
    """Gives the board's outlines of a shoe and its parameters, shapely polygons in mm, one for each patch."""
    found = [q.buffer(-parameters.made_by.slide) for q in pocket_outlines(shoe.plan, parameters)]
    return [part for q in found for part in getattr(q, "geoms", [q]) if not part.is_empty]


def board_text(shoe: Shoe, parameters: ShoeParameters) -> str:
    """Gives a shoe's board by its parameters as .kicad_pcb, taxels and connector as footprints."""
    nets = board_nets(shoe)
    number = {name: i for i, name in enumerate(nets, start=1)}
    lines = [
        "(kicad_pcb (version 20221018) (generator plantar)",
        f'(general (thickness 0.2)) (paper "A3") (layers {_LAYERS})',
        '(net 0 "")',
        *(f'(net {i} "{name}")' for name, i in number.items()),
    ]
    for outline in board_outlines(shoe, parameters):
        for line in (ring(outline), *(np.asarray(h.coords)[:-1] for h in outline.interiors)):
            points = " ".join(f"(xy {x:.3f} {-y:.3f})" for x, y in line.tolist())
            edge = f"(stroke (width {_LINE}) (type solid)) (fill none)"
            lines.append(f'(gr_poly (pts {points}) {edge} (layer "Edge.Cuts"))')
    centres = to_mm(shoe.layout.positions[:, :2]).tolist()
    for k, (x, y) in zip(shoe.layout.ids.tolist(), centres, strict=True):
        own = [name for name, parts in nets.items() if f"T{k}" in parts]
        lines += _footprint(f"T{k}", "plantar:taxel", (x, y), own, number)
    lines += _footprint("J1", "plantar:connector", _connector(shoe, parameters), list(nets), number)
    return "\n".join([*lines, ")", ""])


def _connector(shoe: Shoe, p: ShoeParameters) -> tuple[float, float]:
    lines = channel_lines(shoe.plan, p)
    x, y = (lines[0][-1] if lines else np.array(shoe.plan.contact.centroid.coords[0])).tolist()
    return x, y


def _footprint(
    reference: str, kind: str, at: tuple[float, float], nets: list[str], number: dict[str, int]
) -> Iterator[str]:
    yield f'(footprint "{kind}" (layer "F.Cu") (at {at[0]:.3f} {-at[1]:.3f})'
    yield f'(fp_text reference "{reference}" (at 0 -2) (layer "F.SilkS"))'
    for i, name in enumerate(nets, start=1):
        place = f"(at {1.5 * _PAD * (i - 0.5 * (len(nets) + 1)):.3f} 0) (size {_PAD} {_PAD})"
        yield f'(pad "{i}" smd rect {place} (layers "F.Cu") (net {number[name]} "{name}"))'
    yield ")"


def net_list_text(shoe: Shoe) -> str:
    """The nets as KiCad's .net file: pins of taxels and of the connector J1."""
    nets = board_nets(shoe)
    on = {f"T{k}": [name for name, parts in nets.items() if f"T{k}" in parts] for k in shoe.layout.ids.tolist()}
    parts = [f'(comp (ref "{r}") (value "taxel") (footprint "plantar:taxel"))' for r in on]
    parts.append('(comp (ref "J1") (value "heel") (footprint "plantar:connector"))')
    lines = []
    for i, (name, taxels) in enumerate(nets.items(), start=1):
        nodes = [f'(node (ref "{r}") (pin "{on[r].index(name) + 1}"))' for r in taxels]
        lines.append(f'(net (code "{i}") (name "{name}") {" ".join(nodes)} (node (ref "J1") (pin "{i}")))')
    text = "\n".join(["(components", *parts, ")", "(nets", *lines, ")"])
    return f'(export (version "E")\n{text}\n)\n'
