import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError
from plantar.layouts.hex_lattice import HexLattice, hexagon_side

cell_areas = st.floats(1e-6, 1e-2)
angles = st.floats(-math.pi, math.pi)
origins = st.tuples(st.floats(-1, 1), st.floats(-1, 1))
lattices = st.builds(HexLattice, cell_areas, origins, angles)
axial_cells = st.tuples(st.integers(-50, 50), st.integers(-50, 50))


@given(cell_areas)
def test_side_gives_the_area_back(area):
    s = hexagon_side(area)
    assert 6 * (math.sqrt(3) / 4 * s * s) == pytest.approx(area)  # six equilateral triangles


@pytest.mark.parametrize("area", [0.0, -1.0, math.nan, math.inf])
def test_a_bad_area_is_named(area):
    with pytest.raises(InputError, match="cell area is"):
        hexagon_side(area)
    with pytest.raises(InputError, match="cell area is"):
        HexLattice(area)


@pytest.mark.parametrize(("origin", "angle"), [((math.nan, 0), 0.0), ((0, math.inf), 0.0), ((0, 0), math.nan)])
def test_a_place_that_is_not_finite_is_named(origin, angle):
    with pytest.raises(InputError, match="not finite"):
        HexLattice(691e-6, origin, angle)


@given(lattices, axial_cells)
def test_cell_is_a_regular_hexagon_of_its_area_about_its_centre(lattice, cell):
    axial = np.array([cell])
    corners, centre = lattice.corners(axial)[0], lattice.centres(axial)[0]
    ring = shapely.LinearRing(corners)
    assert ring.is_ccw
    assert shapely.Polygon(corners).area == pytest.approx(lattice.area, rel=1e-9)
    assert np.hypot(*(corners - centre).T) == pytest.approx(np.full(6, lattice.side), rel=1e-9)
    assert corners.mean(axis=0) == pytest.approx(centre, abs=1e-9)


@given(lattices, axial_cells)
def test_neighbours_are_one_width_away_and_share_two_corners_bit_for_bit(lattice, cell):
    centre = lattice.centres(np.array([cell]))[0]
    corners = {tuple(c) for c in lattice.corners(np.array([cell]))[0].tolist()}
    shared: list[set[tuple[float, float]]] = []
    directions = []
    for q, r in ((1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)):  # counter-clockwise from +x
        near = np.array([[cell[0] + q, cell[1] + r]])
        offset = lattice.centres(near)[0] - centre
        assert np.hypot(*offset) == pytest.approx(lattice.width, rel=1e-6)
        directions.append(math.atan2(offset[1], offset[0]) - lattice.angle)
        shared.append(corners & {tuple(c) for c in lattice.corners(near)[0].tolist()})
    assert [len(s) for s in shared] == [2] * 6
    assert set().union(*shared) == corners
    turn = np.unwrap([*directions, directions[0]])
    assert np.diff(turn)[:-1] == pytest.approx(np.full(5, math.pi / 3), abs=1e-6)  # counter-clockwise from the row
    assert math.sin(directions[0]) == pytest.approx(0.0, abs=1e-6)


def test_cells_tile_the_plane_without_gap_or_overlap():
    lattice = HexLattice(691e-6, (0.01, -0.02), 0.3)
    axial = np.array([(q, r) for q in range(-3, 4) for r in range(-3, 4)])
    cells = [shapely.Polygon(c) for c in lattice.corners(axial)]
    union = shapely.union_all(cells)
    assert union.geom_type == "Polygon"
    assert not union.interiors
    assert union.area == pytest.approx(len(axial) * lattice.area, rel=1e-9)


@given(lattices, origins, st.tuples(st.floats(0.0, 0.1), st.floats(0.0, 0.1)))
def test_cells_near_a_box_are_those_that_can_touch_it(lattice, lower, size):
    lattice = HexLattice(max(lattice.area, 1e-4), lattice.origin, lattice.angle)
    lower = np.array(lower)
    upper = lower + size
    got = lattice.cells_near(lower, upper)
    assert len(np.unique(got, axis=0)) == len(got)
    assert got.tolist() == sorted(got.tolist(), key=lambda c: (c[1], c[0]))
    # All cells in a much larger patch about the box, by brute force.
    half = int(0.2 / lattice.width) + 6
    c, s = math.cos(lattice.angle), math.sin(lattice.angle)
    local = (lower - lattice.origin) @ np.array([[c, -s], [s, c]])
    r0 = round(local[1] / (1.5 * lattice.side))
    q0 = round(local[0] / lattice.width - r0 / 2)
    patch = np.array([(q0 + q, r0 + r) for q in range(-2 * half, 2 * half + 1) for r in range(-half, half + 1)])
    centres = lattice.centres(patch)
    beyond = np.maximum(np.maximum(lower - centres, centres - upper), 0.0)
    touching = patch[np.hypot(*beyond.T) <= lattice.side]  # only these can meet the box
    assert {tuple(c) for c in touching.tolist()} <= {tuple(c) for c in got.tolist()}


def test_values_of_a_turned_lattice():
    """Cell (0, 1) lies half a width and one and a half sides from (0, 0); turned by 90 degrees, x becomes y."""
    lattice = HexLattice(691e-6, (1.0, 2.0), math.pi / 2)
    got = lattice.centres(np.array([[0, 1]]))[0] - [1.0, 2.0]
    assert got == pytest.approx([-1.5 * lattice.side, 0.5 * lattice.width])
