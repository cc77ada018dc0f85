"""GEOS is the reference on a grid (grid_size): without one it loses overlays whose edges almost coincide."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, LayoutError, grid_layout, hex_layout
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.tiling import MOST_TAXELS

RECTANGLE = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]


def blob(seed: int) -> np.ndarray:
    """A star-shaped outline, often concave, about as large as a foot, in a random place."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, int(rng.integers(8, 30))))
    angle = angle[np.append(True, np.diff(angle) > 0.05)]
    radius = rng.uniform(0.04, 0.12, len(angle))
    return np.column_stack([radius * np.cos(angle), 0.5 * radius * np.sin(angle)]) + rng.normal(0.0, 0.2, 2)


outlines = st.integers(0, 2**32 - 1).map(blob).filter(lambda o: len(o) > 4 and shapely.Polygon(o).is_valid)
placements = st.fixed_dictionaries(
    {
        "cell_area": st.floats(100e-6, 691e-6),
        "origin": st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)),
        "angle": st.floats(-math.pi, math.pi),
        "minimum_fraction": st.floats(0.0, 1.0),
        "clip": st.booleans(),
    }
)


def laid_out(outline, placement, lattice=hex_layout):
    try:
        return lattice(outline, **placement)
    except LayoutError as error:
        if "no cell of" not in str(error):
            raise
        return None


@given(outlines, placements)
def test_cells_lie_in_the_outline_and_do_not_overlap(outline, placement):
    layout = laid_out(outline, placement)
    if layout is None:
        return
    sole = shapely.Polygon(outline)
    cells = [shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))]
    tolerance = 1e-3 * layout.cell_area
    for i, cell in enumerate(cells):
        assert shapely.LinearRing(layout.cell_polygon(i)).is_ccw
        assert shapely.difference(cell, sole, grid_size=1e-9).area < tolerance
        assert cell.area == pytest.approx(layout.areas[i], rel=1e-9)
        assert cell.area <= layout.cell_area * (1 + 1e-3)
        wanted = placement["minimum_fraction"] if placement["clip"] else 1.0
        assert cell.area >= (wanted - 1e-3) * layout.cell_area
        where = cell.centroid.coords[0]
        assert np.hypot(*(layout.positions[i, :2] - where)) < 1e-3 * math.sqrt(layout.cell_area)
    assert shapely.union_all(cells, grid_size=1e-9).area == pytest.approx(
        layout.areas.sum(), abs=len(cells) * tolerance
    )
    assert layout.sole_area == pytest.approx(sole.area)


@given(outlines, placements)
def test_neighbours_are_the_cells_with_a_common_edge(outline, placement):
    layout = laid_out(outline, placement)
    if layout is None:
        return
    cells = [shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))]
    for i in range(len(layout)):
        for j in range(i):
            common = cells[i].boundary.intersection(cells[j].boundary).length
            long = common > 1e-2 * math.sqrt(layout.cell_area)
            assert not long or j in layout.neighbours[i]
            assert (j in layout.neighbours[i]) == (i in layout.neighbours[j])
            assert j not in layout.neighbours[i] or common > 0.0


@given(outlines)
def test_keeping_every_part_covers_the_sole(outline):
    layout = hex_layout(outline, cell_area=200e-6, minimum_fraction=0.0)
    cells = shapely.union_all([shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))], grid_size=1e-9)
    gap = shapely.difference(shapely.Polygon(outline), cells, grid_size=1e-9)
    # Only slivers under a thousandth of a cell, and lesser parts of cells that the outline cuts in several, are left.
    lattice = HexLattice(200e-6)
    axial = lattice.cells_near(*np.array(shapely.Polygon(outline).bounds).reshape(2, 2))
    lesser = 0.0
    for corner in lattice.corners(axial):
        parts = sorted(
            p.area for p in shapely.get_parts(shapely.Polygon(outline).intersection(shapely.Polygon(corner)))
        )
        lesser += sum(parts[:-1]) + (parts[-1] if parts and parts[-1] < 1.001e-3 * 200e-6 else 0.0)
    assert gap.area == pytest.approx(lesser, abs=1e-3 * 200e-6 * len(layout))


def test_orientation_of_the_outline_does_not_matter():
    one, other = hex_layout(RECTANGLE), hex_layout(RECTANGLE[::-1])
    assert one.positions.tolist() == other.positions.tolist()
    assert one.sole_area == pytest.approx(other.sole_area)


def test_without_clip_every_cell_is_whole():
    layout = hex_layout(RECTANGLE, clip=False)
    assert layout.areas == pytest.approx(np.full(len(layout), 691e-6))
    assert all(len(c) == 6 for c in layout.corners)
    axial = {
        (round(x / HexLattice(691e-6).width * 2), round(y / HexLattice(691e-6).side / 1.5))
        for x, y, _ in layout.positions
    }
    assert len(axial) == len(layout)


def test_given_cells_are_kept_whole_across_the_outline():
    layout = hex_layout(RECTANGLE, cells=[[0, 0], [1, 0], [40, 0]])
    assert len(layout) == 3
    assert layout.neighbours == ((1,), (0,), ())
    assert layout.areas == pytest.approx(np.full(3, 691e-6))


def test_a_sole_cut_in_two_by_a_slit_keeps_the_larger_part_of_a_cell():
    slit = [
        [-0.1, -0.05],
        [0.1, -0.05],
        [0.1, 0.05],
        [0.003, 0.05],
        [0.003, -0.02],
        [0.002, -0.02],
        [0.002, 0.05],
        [-0.1, 0.05],
    ]
    layout = hex_layout(slit, minimum_fraction=0.4)
    middle = np.flatnonzero(np.hypot(*layout.positions[:, :2].T) < 0.01)
    assert len(middle) == 1
    assert layout.positions[middle[0], 0] < 0.002
    assert 0.5 < layout.areas[middle[0]] / layout.cell_area < 0.6


@pytest.mark.parametrize(
    ("outline", "text"),
    [
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "crosses itself"),
        ([[0, 0], [1, 1], [2, 2]], "crosses itself or has no area"),
        ([[0, 0], [1, 1]], "3 or more"),
        ([], "3 or more"),
        ([[0, 0], [1, 0], [math.nan, 1]], "finite"),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], r"\(x, y\)"),
        ([[0, 0], [1], [1, 1]], r"\(x, y\)"),
        ("foot", r"\(x, y\)"),
        ([[0, 0], [0.01, 0], [0.01, 0.01]], "no cell of 691 mm"),
        ([[0, 0], [250, 0], [250, 100], [0, 100]], f"more than {MOST_TAXELS} taxels; .* an outline in m"),
    ],
)
def test_a_bad_outline_is_named(outline, text):
    with pytest.raises(LayoutError, match=text):
        hex_layout(outline)


@pytest.mark.parametrize("fraction", [-0.1, 1.1, math.nan])
def test_a_bad_fraction_is_named(fraction):
    with pytest.raises(InputError, match="minimum fraction"):
        hex_layout(RECTANGLE, minimum_fraction=fraction)


def test_a_cell_given_twice_is_named():
    with pytest.raises(LayoutError, match="a cell twice"):
        hex_layout(RECTANGLE, cells=[[0, 0], [1, 0], [0, 0]])


grids = st.fixed_dictionaries(
    {
        "pitch": st.tuples(st.floats(8e-3, 0.03), st.floats(8e-3, 0.03)),
        "origin": st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)),
        "angle": st.floats(-math.pi, math.pi),
        "minimum_fraction": st.floats(0.0, 1.0),
        "clip": st.booleans(),
    }
)


@given(outlines, grids)
def test_a_grid_holds_the_cells_that_a_walk_over_all_its_squares_finds(outline, grid):
    dx, dy = grid["pitch"]
    area = dx * dy
    turn = np.array(
        [[math.cos(grid["angle"]), -math.sin(grid["angle"])], [math.sin(grid["angle"]), math.cos(grid["angle"])]]
    )
    sole, sure, doubtful = shapely.Polygon(outline), 0, 0
    middle = np.rint((outline.mean(axis=0) - grid["origin"]) @ turn / grid["pitch"])
    side = np.arange(-int(0.3 / min(dx, dy)), int(0.3 / min(dx, dy)))
    squares = middle + np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 1, 2)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    rings = ((squares + square) * grid["pitch"]) @ turn.T + grid["origin"]
    cells = shapely.polygons(rings)
    for cell in cells[shapely.intersects(sole, cells)]:
        parts = shapely.get_parts(shapely.intersection(sole, cell, grid_size=1e-9))
        share = max((p.area for p in parts), default=0.0) / area
        wanted = max(grid["minimum_fraction"], 1e-3) if grid["clip"] else 1.0
        sure += share > wanted + 1e-3 or share > 1.0 - 1e-9
        doubtful += abs(share - wanted) <= 1e-3
    layout = laid_out(outline, grid, grid_layout)
    if layout is None:
        assert sure == 0
        return
    assert sure - doubtful <= len(layout) <= sure + doubtful
    assert layout.cell_shape == "rectangle"
    for i in range(len(layout)):
        cell = shapely.Polygon(layout.cell_polygon(i))
        assert cell.exterior.is_ccw
        assert shapely.difference(cell, sole, grid_size=1e-9).area < 1e-3 * area
        assert cell.area == pytest.approx(layout.areas[i], rel=1e-9)


def test_whole_squares_of_a_grid_share_their_corners_to_the_bit():
    layout = grid_layout(RECTANGLE, pitch=(0.01, 0.02), angle=0.3, clip=False)
    assert layout.areas == pytest.approx(2e-4)
    shared = sum(len(c) for c in layout.corners) - len(layout.vertices)
    assert shared > len(layout)
    inner = [n for n in layout.neighbours if len(n) == 4]
    assert inner
    assert max(len(n) for n in layout.neighbours) == 4


@pytest.mark.parametrize("pitch", [(0.0, 0.01), (0.01, -1.0), (math.nan, 0.01), (math.inf, 0.01)])
def test_a_grid_needs_a_pitch(pitch):
    with pytest.raises(InputError, match="grid pitch"):
        grid_layout(RECTANGLE, pitch=pitch)


def test_a_grid_refuses_what_it_cannot_lay_out():
    with pytest.raises(InputError, match="not finite"):
        grid_layout(RECTANGLE, angle=math.nan)
    with pytest.raises(InputError, match="minimum fraction"):
        grid_layout(RECTANGLE, minimum_fraction=2.0)
    with pytest.raises(LayoutError, match=f"more than {MOST_TAXELS}"):
        grid_layout(RECTANGLE, pitch=(1e-4, 1e-4))
    with pytest.raises(LayoutError, match="too many cells"):
        grid_layout([[0, 0], [1e-3, 0], [40, 40], [0, 1e-3]], pitch=(1e-3, 1e-3))
    with pytest.raises(LayoutError, match="no cell of"):
        grid_layout(RECTANGLE, pitch=(1.0, 1.0))


def test_cut_cells_keep_the_lattice_where_the_outline_does_not_cut_them():
    lattice = HexLattice(691e-6, angle=0.1)
    layout = hex_layout([[-0.13, -0.06], [0.12, -0.05], [0.12, 0.05], [-0.12, 0.06]], angle=0.1)
    exact = lattice.corners(lattice.cells_near([-0.2, -0.2], [0.2, 0.2])).reshape(-1, 2)
    gap = np.hypot(*(layout.vertices[:, None, :2] - exact).transpose(2, 0, 1)).min(axis=1)
    assert ((gap == 0.0) | (gap > 1e-7)).all()
    assert (gap == 0.0).sum() > 2 * len(layout) / 3
