"""Tests of the proven bound: never below what is known to fit, and reached where the best is known."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.layouts.hex_lattice import HexLattice
from plantar.shoes.fit.cell_pattern import hex_pattern
from plantar.shoes.fit.fit_bound import bound_whole_cells
from plantar.shoes.fit.lattice_fit import fit_lattice
from plantar.shoes.geometry.outline import rounded_rectangle


def whole_cells(region: shapely.Polygon, lattice: HexLattice) -> int:
    near = lattice.cells_near(np.array(region.bounds[:2]), np.array(region.bounds[2:]))
    return int(shapely.covers(region, shapely.polygons(lattice.corners(near))).sum())


@settings(max_examples=25)
@given(
    st.lists(st.tuples(st.floats(-120, 120), st.floats(-60, 60)), min_size=6, max_size=12),
    st.booleans(),
    st.integers(0, 10_000),
)
def test_no_placement_beats_the_bound(points, notched, seed):
    region = shapely.MultiPoint(points).convex_hull.buffer(15)
    if notched:
        notch = shapely.Point(region.centroid.x, region.bounds[3]).buffer(25.0, quad_segs=4)
        rest = region - notch
        region = max(getattr(rest, "geoms", [rest]), key=lambda g: g.area)
        region = shapely.Polygon(region.exterior)
    proven = bound_whole_cells(region, hex_pattern(500.0))
    assert proven.best <= proven.bound <= region.area / 500.0 + 1e-6
    rng = np.random.default_rng(seed)
    most = max(
        whole_cells(region, HexLattice(500.0, tuple(rng.uniform(0, 40, 2)), rng.uniform(0, math.pi / 3)))
        for _ in range(60)
    )
    assert most <= proven.bound
    if proven.best:
        # Simplifying drops a detail, widening adds as much and the slack, twice at the sharpest mitred corner.
        detail = 0.01 if len(region.exterior.coords) <= 40 else 0.1
        reached = whole_cells(
            region.buffer(detail + 2.0 * (detail + 1e-3)), HexLattice(500.0, proven.origin, proven.angle)
        )
        assert reached >= proven.best


@pytest.mark.parametrize(("columns", "rows"), [(3, 2), (5, 4), (8, 3)])
@pytest.mark.parametrize("turn", [0.0, 17.0])
def test_a_box_made_for_a_patch_is_proven_to_hold_just_that(columns, rows, turn):
    side = math.sqrt(2 * 691 / (3 * math.sqrt(3)))
    length, height = math.sqrt(3) * side * (columns + 0.5), side * (1.5 * rows + 0.5)
    box = shapely.affinity.rotate(shapely.box(0, 0, length + 0.3, height + 0.3), turn)
    assert bound_whole_cells(box, hex_pattern(691.0)).bound == columns * rows
    fit = fit_lattice(box)  # also at an angle that the scan does not look at
    assert len(fit.cells) == fit.bound == columns * rows


def test_the_best_is_proven_on_the_papers_feet():
    for sole, most in (
        (rounded_rectangle(223.7, 146.5, (25.0, 10.0), 20.0), 36),
        (rounded_rectangle(241.0, 138.0, (15.0, 0.0), 19.6), 39),
    ):
        fit = fit_lattice(sole)
        assert len(fit.cells) == fit.bound == most
    wider = rounded_rectangle(241.0, 138.0, (15.0, 0.0), 19.6).buffer(9.9)
    assert bound_whole_cells(wider, hex_pattern(691.0)).bound < 51


def test_the_search_ends_early_where_less_is_asked_for():
    sole = rounded_rectangle(241.0, 138.0, (15.0, 0.0), 19.6)
    rough = bound_whole_cells(sole, hex_pattern(691.0), known=39, share=0.9)
    exact = bound_whole_cells(sole, hex_pattern(691.0), known=39)
    assert rough.boxes < exact.boxes
    assert exact.bound == 39 <= rough.bound <= 39 / 0.9
    assert exact.best == 0  # none better than known was met
