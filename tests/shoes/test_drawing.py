"""Tests of the drawing: what stands in it, read from its SVG."""

from __future__ import annotations

from pathlib import Path

import pytest
import shapely

from shoes import ShoeReport
from shoes.drawing import draw_shoe, section_along_x


def test_the_section_along_x_cuts_plate_and_rim(exported: tuple[ShoeReport, Path]) -> None:
    report, _ = exported
    shoe, p = report.build.shoes[0], report.build.parameters
    assert shoe.surface is not None
    cut = section_along_x(shoe.surface, float(shoe.layout.positions[0, 1] * 1000) + 1e-3)
    low, _, high, _ = shoe.plan.contact.bounds
    assert cut.bounds == pytest.approx((low, 0.0, high, p.height), abs=0.6)
    inside = shapely.box(low + 10, p.plate_thickness + 1, high - 10, p.height + 1)
    assert not cut.intersects(inside)
    x = float(shoe.layout.positions[0, 0] * 1000)
    column = cut.intersection(shapely.LineString([(x, -1), (x, p.height)]))
    assert column.length == pytest.approx(p.floor)  # above a pocket's middle there is the floor alone


@pytest.mark.parametrize("index", [0, 1])
def test_the_drawing_states_its_dimensions(exported: tuple[ShoeReport, Path], tmp_path: Path, index: int) -> None:
    report, _ = exported
    shoe = report.build.shoes[index]
    assert shoe.surface is not None
    path = draw_shoe(shoe, report.build, shoe.surface, tmp_path / "drawing.svg")
    text = path.read_text()
    for comment in ("127.0", "77.0", "12", "24", f"small, {shoe.side} shoe, seen from above: 7 taxels of 691 mm²"):
        assert f"<!-- {comment}" in text
