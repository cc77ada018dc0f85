"""Tests of the fit of stated cells: inside, apart by the ribs, and as many as a search over placements finds."""

import itertools
import math

import numpy as np
import pytest
import shapely

from plantar.errors import FootError, InputError
from plantar.shoes.cells.cell import Cell, read_cell
from plantar.shoes.fit.cell_fit import fit_cells
from plantar.shoes.fit.cell_pattern import pattern_of

RIB = 2.4
FSR = Cell(shape="round", size=18.28, active=12.7, thickness=0.46, tail_length=6.72, tail_width=8.0)
CELLS = {
    "square": Cell(shape="square", size=20.0),
    "bricks": Cell(shape="rectangle", length=22.0, width=11.0, lattice="hex"),
    "rectangle": Cell(shape="rectangle", length=25.0, width=12.0, active_length=20.0, active_width=8.0, thickness=1.0),
    "hex film": Cell(shape="hex", size=18.0, active=12.0, thickness=0.5),
    "hex": Cell(shape="hex", size=20.0),
    "round": Cell(shape="round", size=14.0, thickness=0.5),
    "round on squares": Cell(shape="round", size=14.0, thickness=0.5, lattice="square"),
    "tail": FSR,
    "wide": Cell(shape="square", size=12.0, pitch_x=20.0, pitch_y=17.0),
}


def outline(seed: int, notched: bool = False) -> shapely.Polygon:
    """A sole about 200 x 90 mm, rounded, skewed, perhaps with a waist."""
    chance = np.random.default_rng(seed)
    points = chance.uniform((-100, -45), (100, 45), (9, 2))
    shape = shapely.MultiPoint(points).convex_hull.buffer(12.0, quad_segs=3)
    if notched:
        bite = shapely.Point(shape.centroid.x, shape.bounds[3]).buffer(22.0, quad_segs=3)
        shape = max(getattr(shape - bite, "geoms", [shape - bite]), key=lambda g: g.area)
    return shapely.Polygon(shape.exterior)


def polygons(rings: object) -> list[shapely.Polygon]:
    return [shapely.Polygon(r) for r in rings]


def some(*quick: str) -> list[object]:
    """The cells by name, all but some of them marked as long."""
    return [name if name in quick else pytest.param(name, marks=pytest.mark.long) for name in CELLS]


@pytest.mark.parametrize("notched", [False, pytest.param(True, marks=pytest.mark.long)])
@pytest.mark.parametrize("name", some("square", "wide", "hex film"))
def test_cells_are_inside_and_ribs_are_left_between_their_pockets(name, notched):
    cell = CELLS[name]
    sole = outline(3, notched)
    fit = fit_cells(sole, cell, rib=RIB)
    pockets = polygons(fit.pockets)
    felt = polygons(fit.cells)
    assert 0 < len(felt) == len(pockets)
    assert all(sole.buffer(0.01).covers(shape) for shape in (*pockets, *felt))
    apart = [a.distance(b) for a, b in itertools.combinations(pockets, 2)]
    assert min(apart, default=RIB) > RIB - 0.02
    assert shapely.union_all(felt, grid_size=1e-6).area == pytest.approx(sum(c.area for c in felt), rel=1e-6)
    if cell.kind == "film":
        assert all(p.buffer(-cell.play + 0.01).covers(c) for p, c in zip(pockets, felt, strict=True))
        assert felt[0].area == pytest.approx(cell.active_area, rel=1e-9)
    else:
        assert felt[0].area == pytest.approx(pattern_of(cell, RIB).area, rel=1e-9)
        assert all(c.buffer(1e-6).covers(p) for p, c in zip(pockets, felt, strict=True))
    assert fit.covered == pytest.approx(sum(c.intersection(sole).area for c in felt))


def brute_force(sole: shapely.Polygon, cell: Cell, steps: int, angles: np.ndarray) -> int:
    """Most copies of a cell's room inside, by trying placements of a lattice that is written down here anew."""
    pattern = pattern_of(cell, RIB)
    shapely.prepare(sole)
    most = 0
    for angle in angles:
        room = shapely.affinity.rotate(pattern.room, angle, origin=(0, 0), use_radians=True)
        ring = np.array(room.exterior.coords)
        c = math.cos(angle)
        s = math.sin(angle)
        i, j = (v.ravel() for v in np.meshgrid(np.arange(-40, 41), np.arange(-40, 41)))
        u = i * pattern.width + j * pattern.shift
        v = j * pattern.rise
        grid = np.column_stack([c * u - s * v, s * u + c * v])
        for a, b in itertools.product(np.arange(steps) / steps, repeat=2):
            du = a * pattern.width
            dv = b * pattern.rise
            at = grid + np.array([c * du - s * dv, s * du + c * dv])
            at = at[shapely.contains_xy(sole, at[:, 0], at[:, 1])]
            most = max(most, int(shapely.covers(sole, shapely.polygons(at[:, None] + ring)).sum()))
    return most


@pytest.mark.parametrize("name", some("square"))
def test_no_placement_of_a_grid_of_them_holds_more(name):
    sole = outline(11)
    fit = fit_cells(sole, CELLS[name], rib=RIB)
    period = pattern_of(CELLS[name], RIB).period
    most = brute_force(sole, CELLS[name], 6, np.linspace(0.0, period, 6, endpoint=False))
    assert most <= len(fit.cells)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", CELLS)
def test_at_most_one_more_fits_at_any_placement_of_a_fine_grid(name, seed):
    sole = outline(seed, notched=seed % 2 == 1)
    cell = CELLS[name]
    fit = fit_cells(sole, cell, rib=RIB)
    period = pattern_of(cell, RIB).period
    known = brute_force(sole, cell, 16, np.array([0.0, fit.lattice.angle]))
    every = brute_force(sole, cell, 8, np.linspace(0.0, period, 24, endpoint=False))
    assert known <= len(fit.cells)  # at an angle that was looked at the best offset is found exactly
    assert every <= len(fit.cells) + 1


@pytest.mark.parametrize(("columns", "rows"), [(4, 3), (1, 1)])
@pytest.mark.parametrize("turn", [0.0, 21.0])
def test_a_box_made_for_squares_holds_just_those(columns, rows, turn):
    pitch = 20.0 + 0.4 + RIB
    box = shapely.affinity.rotate(shapely.box(0, 0, columns * pitch + 0.2, rows * pitch + 0.2), turn)
    fit = fit_cells(box, CELLS["square"], rib=RIB)
    assert len(fit.cells) == columns * rows


@pytest.mark.long
def test_a_number_of_cells_takes_the_least_overhang():
    sole = shapely.box(0, 0, 4 * 22.8 - 5.0, 3 * 22.8)
    fit = fit_cells(sole, CELLS["square"], rib=RIB, taxels=12, overhang_max=8.0)
    assert len(fit.cells) == 12
    assert 2.5 <= fit.overhang <= 3.0
    with pytest.raises(FootError, match=r"do not fit: \d+ do with cells up to"):
        fit_cells(sole, CELLS["square"], rib=RIB, taxels=40, overhang_max=8.0)


def test_a_pitch_that_leaves_no_rib_is_refused():
    near = Cell(shape="round", size=18.0, thickness=0.5, pitch_x=19.0)
    with pytest.raises(FootError, match=r"pitch_x is 19 mm; allowed: 20\.8 mm or more, which leaves a rib of 2\.4 mm"):
        fit_cells(outline(1), near, rib=RIB)


@pytest.mark.parametrize("seed", [0, 3])
def test_a_sheet_has_the_crossings_that_lie_inside_and_is_cut_there(seed):
    sole = outline(seed, notched=seed > 1)
    cell = Cell(shape="sheet", pitch_x=10.0, pitch_y=10.0, line_width=6.0, thickness=0.5, edge=2.0)
    fit = fit_cells(sole, cell, rib=RIB)
    felt = polygons(fit.cells)
    (recess,) = polygons(fit.pockets)
    assert sole.buffer(-0.5 * RIB + 0.01).covers(recess)
    assert all(recess.buffer(0.01).covers(c) for c in felt)
    assert shapely.union_all(felt, grid_size=1e-6).area == pytest.approx(sum(c.area for c in felt), rel=1e-4)
    crossings = {tuple(line) for line in fit.lines.tolist()}
    assert len(crossings) == len(felt)
    # A crossing is where its row and column say, and its electrodes are a margin within the sheet.
    rows, columns = fit.lines.T
    whole = fit.shares > 1.0 - 1e-9
    centres = np.array([c.centroid.coords[0] for c in felt])
    for k, line in ((1, rows), (0, columns)):
        start = centres[whole, k] - cell.pitch_x * line[whole]
        assert np.ptp(start) < 1e-3
    with pytest.raises(InputError, match="a sheet has as many crossings as the outline holds"):
        fit_cells(sole, cell, rib=RIB, taxels=20)


def test_a_sheet_with_too_many_lines_or_none_is_refused():
    fine = Cell(shape="sheet", pitch_x=2.0, pitch_y=2.0, line_width=1.0, thickness=0.5)
    with pytest.raises(FootError, match="allowed: 128 together"):
        fit_cells(outline(1).buffer(50), fine, rib=RIB)
    coarse = Cell(shape="sheet", pitch_x=40.0, pitch_y=40.0, line_width=30.0, thickness=0.5)
    with pytest.raises(FootError, match="no crossing of electrodes of 30 mm lies inside"):
        fit_cells(shapely.box(0, 0, 60, 33), coarse, rib=RIB)


def test_columns_of_a_hexagonal_sheet_zigzag_between_its_rows():
    cell = read_cell("velostat")
    fit = fit_cells(outline(3), cell, rib=RIB)
    at, (rows, columns) = fit.crossings, fit.lines.T
    assert len({tuple(line) for line in fit.lines.tolist()}) == len(at)
    for row in np.unique(rows):  # straight rows, a pitch apart
        assert np.ptp(at[rows == row, 1]) < 1e-3
        apart = np.diff(np.sort(at[rows == row, 0])) / cell.pitch_x
        np.testing.assert_allclose(apart, apart.round(), atol=1e-3)
    for column in np.unique(columns):  # a column's next taxel is half a pitch to the side
        x = at[columns == column, 0]
        assert np.ptp(x) < 0.5 * cell.pitch_x + 2e-3
    felt = polygons(fit.cells)
    assert shapely.union_all(felt, grid_size=1e-6).area == pytest.approx(sum(c.area for c in felt), rel=1e-4)
    whole = [c for c, share in zip(felt, fit.shares, strict=True) if share > 1.0 - 1e-6]
    assert {len(c.exterior.coords) for c in whole} == {7}
    assert whole[0].area == pytest.approx(cell.pitch_x * cell.pitch_y, rel=1e-3)
