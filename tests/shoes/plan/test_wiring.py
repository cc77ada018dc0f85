"""Openings of the plate for pockets and cable: no steps so small that they would be walls of no width."""

import numpy as np
import pytest
import shapely

from plantar.shoes import build_shoe
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.plan.wiring import pocket_outlines


@pytest.mark.parametrize("cell", ["fsr_402", "square"])
@pytest.mark.parametrize(("length", "width"), [(0.215, 0.0756), (0.205, 0.0756), (0.235, 0.1), (0.25, 0.08)])
def test_outlines_have_no_edge_of_some_thousandths(length, width, cell):
    foot = foot_from_dimensions("a", length=length, width=width, sole_center=(0.02, 0.0), corner_radius=0.45 * width)
    build = build_shoe(foot, side="left", cell=read_cell(cell), layout_only=True)
    for outline in pocket_outlines(build.shoes[0].plan, build.parameters):
        for ring in (outline.exterior, *outline.interiors):
            assert np.hypot(*np.diff(shapely.get_coordinates(ring), axis=0).T).min() > 0.005
