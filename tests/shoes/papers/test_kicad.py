"""Tests of the flexible board: brackets, ids as in the layout, and an outline that fits the print."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import shapely

from plantar.shoes import ShoeReport, foot_from_dimensions
from plantar.shoes.cells.cell_file import read_cell
from plantar.shoes.insole import build_insole
from plantar.shoes.papers.kicad import board_nets, board_outlines, net_list_text
from plantar.shoes.units import to_mm


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_board_has_the_ids_and_places_of_the_layout(exported: tuple[ShoeReport, Path], side: str) -> None:
    report, folder = exported
    (shoe,) = (s for s in report.build.shoes if s.side == side)
    board, nets = ((folder / f"board_{side}.{e}").read_text() for e in ("kicad_pcb", "net"))
    for text in (board, nets):
        assert text.count("(") == text.count(")")
    places = re.findall(r'taxel" \(layer "F.Cu"\) \(at (\S+) (\S+)\)\n\(fp_text reference "T(\d+)"', board)
    wanted = to_mm(shoe.layout.positions).round(3).tolist()
    assert [(float(x), -float(y), int(k)) for x, y, k in places] == [
        (x, y, k) for (x, y, _), k in zip(wanted, shoe.layout.ids.tolist(), strict=True)
    ]
    for k in shoe.layout.ids.tolist():
        assert f'(name "TAXEL_{k}") (node (ref "T{k}") (pin "1")) (node (ref "J1")' in nets
    openings = shapely.union_all([q.buffer(0.01) for q in shoe.plan.pockets])
    outline = shapely.union_all(board_outlines(shoe, report.build.parameters))
    assert outline.geom_type == "Polygon"  # one board
    assert openings.area > outline.intersection(openings).area > 0.9 * openings.area
    assert all(outline.covers(shapely.Point(x, y)) for x, y, _ in wanted)


def test_a_sheet_has_a_line_for_each_row_and_column() -> None:
    foot = foot_from_dimensions("a", length=0.26, width=0.095, corner_radius=0.03)
    shoe = build_insole(foot, 6.0, cell=read_cell("sheet"), layout_only=True).shoes[0]
    rows, columns = shoe.plan.sheet_lines
    nets = board_nets(shoe)
    assert len(nets) == rows + columns
    assert sum(len(parts) for parts in nets.values()) == 2 * len(shoe.layout)
    assert net_list_text(shoe).count("(net (code") == rows + columns
