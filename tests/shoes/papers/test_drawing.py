"""Tests of the drawing: what stands in it, read from its SVG."""

from __future__ import annotations

from pathlib import Path

import pytest

from shoes import ShoeReport
from shoes.papers.drawing import draw_shoe


@pytest.mark.parametrize("index", [0, 1])
def test_the_drawing_states_its_dimensions(exported: tuple[ShoeReport, Path], tmp_path: Path, index: int) -> None:
    report, _ = exported
    shoe, p = report.build.shoes[index], report.build.parameters
    assert shoe.surface is not None
    (path,) = draw_shoe(shoe, report.build, shoe.surface, [tmp_path / "drawing.svg"])
    text = path.read_text()
    low_x, low_y, high_x, high_y = shoe.plan.contact.bounds
    for comment in (
        f"{high_x - low_x:.1f}",
        f"{high_y - low_y:.1f}",
        f"{p.thickness:g}",
        f"{p.rim_top:g}",
        f"small, {shoe.side} shoe",
        "From above; overhang of the contact face",
        "A-A, y =",
        "B-B, x =",
    ):
        assert f"<!-- {comment}" in text
    for taxel in shoe.layout.ids:
        assert f"<!-- {taxel} -->" in text
