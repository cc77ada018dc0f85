"""Tests of the lattice fit: whole cells, as many as can be, where they should be."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar.errors import FootError
from plantar.layouts.hex_lattice import HexLattice
from plantar.shoes.fit.cell_pattern import hex_pattern
from plantar.shoes.fit.lattice_fit import fit_lattice, whole_cell_region
from plantar.shoes.geometry.outline import rounded_rectangle

from ...examples import examples

WIDTH = math.sqrt(2 / math.sqrt(3))  # flat to flat of a hexagon of area 1


def cells(fit: object) -> list[shapely.Polygon]:
    return [shapely.Polygon(c) for c in fit.lattice.corners(fit.cells)]


@pytest.mark.parametrize(("columns", "rows"), [(5, 4), (1, 1), (7, 2), (3, 3)])
@pytest.mark.parametrize("slack", [0.0, 0.12])
def test_a_box_made_for_a_patch_holds_just_that_patch(columns, rows, slack):
    width = WIDTH * math.sqrt(691)
    side = WIDTH * math.sqrt(691 / 3)
    length = columns * width + (0.5 * width if rows > 1 else 0.0)
    height = (1.5 * rows + 0.5) * side
    fit = fit_lattice(shapely.box(0, 0, length + slack, height + slack))
    assert len(fit.cells) == columns * rows
    assert fit.lattice.angle == 0.0
    assert shapely.union_all(cells(fit)).bounds == pytest.approx((0, 0, length, height), abs=0.1201)


@pytest.mark.parametrize(("columns", "rows"), [(3, 2), (5, 4), (8, 3)])
def test_a_box_that_is_turned_is_filled_along_its_edges(columns, rows):
    width = WIDTH * math.sqrt(691)
    side = WIDTH * math.sqrt(691 / 3)
    box = shapely.box(0, 0, width * (columns + 0.5) + 0.3, side * (1.5 * rows + 0.5) + 0.3)
    assert len(fit_lattice(shapely.affinity.rotate(box, 17.0)).cells) == columns * rows


def test_the_papers_feet_hold_as_many_as_was_proven_once():
    assert len(fit_lattice(rounded_rectangle(223.7, 146.5, (25.0, 10.0), 20.0)).cells) == 36
    assert len(fit_lattice(rounded_rectangle(241.0, 138.0, (15.0, 0.0), 19.6)).cells) == 39


def test_rows_along_y_are_found():
    width = WIDTH * math.sqrt(691)
    side = WIDTH * math.sqrt(691 / 3)
    fit = fit_lattice(shapely.box(0, 0, (1.5 * 4 + 0.5) * side + 0.12, 3.5 * width + 0.12))
    assert len(fit.cells) == 12
    assert math.degrees(fit.lattice.angle) == pytest.approx(30)


@examples(10)
@given(st.lists(st.tuples(st.floats(-120, 120), st.floats(-60, 60)), min_size=6, max_size=14), st.floats(400, 900))
def test_cells_are_whole_inside_and_apart(points, area):
    sole = shapely.MultiPoint(points).convex_hull.buffer(15)
    try:
        fit = fit_lattice(sole, cell_area=area)
    except FootError:
        assert sole.area < 20 * area
        return
    polygons = cells(fit)
    assert all(sole.buffer(0.01).covers(p) for p in polygons)
    assert shapely.union_all(polygons).area == pytest.approx(len(polygons) * area, rel=1e-9)
    # No lattice of a random sample does better.
    rng = np.random.default_rng(7)
    for _ in range(40):
        lattice = HexLattice(area, tuple(rng.uniform(0, 40, 2)), rng.choice([0.0, math.pi / 6]))
        near = lattice.cells_near(np.array(sole.bounds[:2]), np.array(sole.bounds[2:]))
        inside = sum(sole.covers(shapely.Polygon(c)) for c in lattice.corners(near))
        assert inside <= len(polygons)


def test_a_waist_and_a_split_keep_cells_inside():
    dumbbell = shapely.union_all(
        [shapely.box(-100, -40, -20, 40), shapely.box(20, -40, 100, 40), shapely.box(-30, -4, 30, 4)]
    )
    fit = fit_lattice(dumbbell)
    assert all(dumbbell.buffer(0.01).covers(p) for p in cells(fit))
    assert len(fit.cells) >= 8
    assert {p.centroid.x < 0 for p in cells(fit)} == {True, False}


def test_the_whole_cell_region_is_where_a_cell_fits():
    shape = shapely.Polygon([(0, 0), (90, 0), (90, 70), (50, 40), (0, 60)])
    side = 9.0
    angle = 0.3
    area = 1.5 * math.sqrt(3) * side**2
    region = whole_cell_region(shape, hex_pattern(area).parts, angle)
    rng = np.random.default_rng(3)
    for x, y in rng.uniform((0, 0), (90, 70), (300, 2)):
        hexagon = shapely.Polygon(HexLattice(area, (x, y), angle).corners(np.array([[0, 0]]))[0])
        if shapely.Point(x, y).distance(region.boundary) > 5e-3:
            assert region.contains(shapely.Point(x, y)) == shape.covers(hexagon)


def test_a_number_of_taxels_takes_the_least_overhang():
    sole = rounded_rectangle(223.7, 146.5, (25.0, 10.0), 20.0)
    fit = fit_lattice(sole, taxels=42, overhang_max=7.7)
    assert len(fit.cells) == 42
    assert fit.overhang == 4.5
    assert shapely.union_all(cells(fit)).bounds == pytest.approx(
        (25 - 105.95, 10 - 77.46, 25 + 105.95, 10 + 77.46), abs=0.5
    )
    assert (
        max(
            sole.exterior.distance(shapely.Point(c))
            for p in cells(fit)
            for c in p.exterior.coords
            if not sole.covers(shapely.Point(c))
        )
        <= 4.5
    )
    with pytest.raises(FootError, match=r"42 taxels .* do not fit: \d+ do with cells up to 4 mm beyond"):
        fit_lattice(sole, taxels=42, overhang_max=4.0)


def test_fewer_taxels_than_fit_leave_out_those_that_matter_least():
    sole = rounded_rectangle(223.7, 146.5, (25.0, 10.0), 20.0)
    most = len(fit_lattice(sole).cells)
    for wanted in (1, 5, most - 1, most):
        fit = fit_lattice(sole, taxels=wanted)
        assert len(fit.cells) == wanted
        assert fit.overhang == 0.0
        assert all(sole.buffer(0.01).covers(p) for p in cells(fit))


def test_the_same_sole_gives_the_same_fit_and_a_shifted_one_the_shifted():
    sole = shapely.Polygon([(-77, -42), (-74, 43), (105, 45), (120, 42), (150, -42), (137, -45)])
    first = fit_lattice(sole)
    again = fit_lattice(sole)
    assert first.lattice == again.lattice
    assert (first.cells == again.cells).all()
    moved = fit_lattice(shapely.affinity.translate(sole, 40.0, -25.0))
    assert len(moved.cells) == len(first.cells)


def test_a_sole_that_holds_no_cell_is_refused():
    with pytest.raises(FootError, match="no whole cell of 5000 mm"):
        fit_lattice(shapely.box(0, 0, 60, 60), cell_area=5000.0)
