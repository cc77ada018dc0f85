"""Cells that lines cut, against shapely's intersections."""

import math

import numpy as np
import pytest
import shapely

import plantar.geometry.cell_cutting
from plantar.geometry.cell_cutting import CellCutter
from plantar.kernels import python_form
from plantar.layouts.cell_layout import layout_of_cells


def comb(teeth: int) -> list[tuple[float, float]]:
    """A cell whose upper edge goes up and down: a line across its teeth cuts it into many parts."""
    top = [(0.01 * x, 0.02 if x % 2 else 0.08) for x in range(2 * teeth, -1, -1)]
    return [(0.0, 0.0), (0.02 * teeth, 0.0), *top]


@pytest.mark.parametrize("form", ["compiled", "interpreted"])
def test_cells_of_any_shape_keep_what_shapely_keeps(form, monkeypatch):
    if form == "interpreted":
        monkeypatch.setattr(plantar.geometry.cell_cutting, "cut_cells", python_form("cut_cells").cut_cells)
    cells = [comb(9), [(0.3, 0.0), (0.4, 0.0), (0.4, 0.1)]]
    cutter = CellCutter(layout_of_cells(cells))
    rng = np.random.default_rng(1)
    for count in [1, 2, 3, 7] * 6:
        angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, count))
        normals = np.column_stack([np.cos(angles), np.sin(angles)])
        distance = normals @ rng.uniform((0.0, 0.0), (0.3, 0.08)) + rng.uniform(0.0, 0.04, count)
        measure, chords = cutter.cut(np.column_stack([normals, distance]))
        for cell, (area, mx, my), lengths in zip(cells, measure, chords[:, :, 0], strict=True):
            left = shapely.Polygon(cell)
            for normal, h in zip(normals, distance, strict=True):
                along = np.array([-normal[1], normal[0]])
                corners = [h * normal + s * along - d * normal for s, d in ((-2, 0), (2, 0), (2, 4), (-2, 4))]
                left = left.intersection(shapely.Polygon(corners))
            assert area == pytest.approx(left.area, abs=1e-15)
            if left.area > 0.0:
                assert (mx / area, my / area) == pytest.approx((left.centroid.x, left.centroid.y), rel=1e-9)
            assert np.isfinite(lengths).all()
