"""Loads spread over the taxels: conservation, one-sidedness, patches of every kind."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import LayoutError, SoleLayout, hex_layout, layout_of_cells
from plantar.geometry.polygon import convex_hull, inner_offset, signed_margin
from plantar.sensing.cell_patch import _pseudo_inverse as pseudo_inverse
from plantar.sensing.force import center_of_pressure
from plantar.sim.sensing.contact_patch import patch_polygon
from plantar.sim.sensing.sole_pressure import SolePressure

from ...examples import examples

HALF = np.array([0.125, 0.0775])
OUTLINE = HALF * [[-1, -1], [1, -1], [1, 1], [-1, 1]]
LAYOUT = hex_layout(OUTLINE)
WHOLE = [(float(x), float(y)) for x, y in OUTLINE]


def test_line_on_the_bare_rim_keeps_its_place_along_the_rim():
    """Whole cells only leave a bare rim: a line load there goes to the cells along it, in proportion."""
    layout = hex_layout(OUTLINE, clip=False)
    edge = [(0.125, -0.0775), (0.125, 0.0775)]
    force = SolePressure(layout).spread(edge, 100.0, (0.125, 0.02))
    cop = center_of_pressure(layout, force, 0.0)
    assert cop[1] == pytest.approx(0.02, abs=0.008)  # a quarter of a cell
    assert layout.positions[force > 0, 0].min() > 0.06
    assert np.count_nonzero(force) >= 4
    assert force.max() < 50.0


@pytest.mark.parametrize("y", [0.0, -0.0775])
@pytest.mark.parametrize("x", [-0.09, -0.04, 0.0, 0.06, 0.1])
def test_a_line_along_a_row_of_cells_carries_its_load_where_it_acts(x, y):
    """Cells in a row span no area; a load near the end of the line must not move to its middle."""
    line = [(-0.125, y), (0.125, y)]
    force = SolePressure(LAYOUT).spread(line, 100.0, (x, y))
    cop = center_of_pressure(LAYOUT, force, 0.0)
    assert cop[0] == pytest.approx(x, abs=0.008)  # a quarter of a cell
    assert len(np.unique(LAYOUT.positions[force > 0, 1].round(3))) == 1


def test_pressure_is_zero_where_the_sole_lifts_off():
    """Beyond a sixth of the length a foundation that cannot pull lifts off at the far end."""
    pressure = SolePressure(LAYOUT)
    force = pressure.spread(WHOLE, 100.0, (0.08, 0.0))
    rear = LAYOUT.positions[:, 0] < -0.02
    assert force[rear].max() == 0.0
    assert center_of_pressure(LAYOUT, force, 0.0) == pytest.approx([0.08, 0.0], abs=1e-9)
    assert force[~rear].sum() == pytest.approx(100.0)


def test_load_beyond_the_reach_of_the_taxels_goes_to_the_nearest():
    force = SolePressure(LAYOUT).spread(WHOLE, 100.0, (0.2, 0.0))
    assert force.sum() == pytest.approx(100.0)
    hull = convex_hull(LAYOUT.positions[:, :2])
    cop = center_of_pressure(LAYOUT, force, 0.0)
    assert signed_margin(hull, cop) == pytest.approx(0.0, abs=1e-3)
    assert cop[0] > 0.1


def test_patch_beside_all_cells_loads_the_nearest_one():
    force = SolePressure(LAYOUT).spread([(0.3, 0.0)], 10.0, (0.3, 0.0))
    assert force.sum() == pytest.approx(10.0)
    assert np.count_nonzero(force) == 1
    assert LAYOUT.positions[np.argmax(force), 0] > 0.1


@pytest.mark.parametrize("force", [0.0, -5.0, float("nan"), float("inf")])
def test_no_push_no_taxel_force(force):
    assert not SolePressure(LAYOUT).spread(WHOLE, force, (0.0, 0.0)).any()
    assert not SolePressure(LAYOUT).spread([], 10.0, (0.0, 0.0)).any()


coordinate = st.tuples(st.floats(-0.14, 0.14), st.floats(-0.09, 0.09))


@given(st.lists(coordinate, min_size=1, max_size=9), coordinate, st.floats(1e-3, 5e3))
def test_any_patch_and_load_gives_finite_forces_that_add_up(patch, load, force):
    taxels = SHARED_PRESSURE.spread(patch, force, load)
    assert np.isfinite(taxels).all()
    assert (taxels >= 0.0).all()
    assert taxels.sum() == pytest.approx(force, rel=1e-9)
    assert (SolePressure(LAYOUT).spread(patch, force, load) == taxels).all()  # no memory of earlier calls


SHARED_PRESSURE = SolePressure(LAYOUT)


def test_result_does_not_depend_on_the_loads_before():
    """The search starts from the last load's cells; its result must be the same to the last bit all the same."""
    rng = np.random.default_rng(5)
    used = SolePressure(LAYOUT)
    beam = [(-0.02, -0.0775), (0.05, -0.0775), (0.05, 0.0775), (-0.02, 0.0775)]
    for patch, scale in ((WHOLE, HALF), (beam, HALF * [0.2, 1.0])):
        for _ in range(200):
            x, y = (float(v) for v in rng.uniform(-1.0, 1.0, 2) * scale)
            fresh = SolePressure(LAYOUT).spread(patch, 300.0, (x, y))
            assert (used.spread(patch, 300.0, (x, y)) == fresh).all()


@examples(30)
@given(st.floats(-0.7, 0.7), st.floats(-0.7, 0.7), st.floats(10.0, 2e3))
def test_full_sole_has_the_exact_centre_of_pressure(fx, fy, force):
    cop = HALF * [fx, fy]
    taxels = SHARED_PRESSURE.spread(WHOLE, force, (float(cop[0]), float(cop[1])))
    assert center_of_pressure(LAYOUT, taxels, 0.0) == pytest.approx(cop, abs=1e-7)


@examples(30)
@given(st.lists(coordinate, min_size=3, max_size=8), st.lists(st.floats(0.05, 1.0), min_size=8, max_size=8))
def test_loaded_cells_touch_the_patch(patch, weights):
    """No taxel away from the patch is loaded, and what is inside by a cell keeps its moment to a cell's size."""
    shares = np.array(weights[: len(patch)])
    load = shares @ np.array(patch) / shares.sum()
    hull = convex_hull(patch)
    if len(hull) < 3 or len(inner_offset(hull, 0.01)) < 3:
        return
    if np.abs(hull / HALF).max() > 1.0:
        return
    taxels = SHARED_PRESSURE.spread(patch, 100.0, (float(load[0]), float(load[1])))
    for i in np.flatnonzero(taxels):
        assert min(-signed_margin(hull, p) for p in [*LAYOUT.cell_polygon(i), LAYOUT.positions[i, :2]]) < 0.03
    cop = center_of_pressure(LAYOUT, taxels, 0.0)
    assert np.hypot(*(cop - load)) < 0.033  # one cell corner to corner


@pytest.mark.parametrize("seed", range(20))
def test_load_inside_the_reach_of_a_patch_is_met_exactly(seed):
    """Covered areas and centroids, the pistons of the model, carry the load's moment wherever they can."""
    import shapely

    rng = np.random.default_rng(seed)
    patch = HALF * rng.uniform(-1.0, 1.0, (int(rng.integers(3, 7)), 2))
    hull = convex_hull(patch)
    covered = [shapely.Polygon(LAYOUT.cell_polygon(i)).intersection(shapely.Polygon(hull)) for i in range(len(LAYOUT))]
    whole = [i for i, part in enumerate(covered) if part.area > 0.01 * LAYOUT.areas[i]]
    pistons = np.array([covered[i].centroid.coords[0] for i in whole])
    if len(convex_hull(pistons)) < 3:
        return
    reach = inner_offset(convex_hull(pistons), 0.002)
    load = rng.dirichlet(np.ones(len(reach)) * 0.3) @ reach
    force = SHARED_PRESSURE.spread([tuple(p) for p in patch.tolist()], 80.0, (float(load[0]), float(load[1])))
    assert force[whole] @ pistons / 80.0 == pytest.approx(load, abs=1e-4)  # patches are kept on a 0.1 mm grid


def tilted_layout(angle: float) -> SoleLayout:
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return SoleLayout(
        **{
            name: getattr(LAYOUT, name)
            for name in ("name", "side", "positions", "vertices", "corners", "neighbours", "areas", "outline", "ids")
        },
        rotations=np.broadcast_to(turn, (len(LAYOUT), 3, 3)),
    )


def test_tilted_taxels_add_up_in_the_vertical():
    layout = tilted_layout(0.3)
    force = SolePressure(layout).spread(WHOLE, 50.0, (0.0, 0.0))
    assert float(force @ layout.rotations[:, 2, 2]) == pytest.approx(50.0)
    with pytest.raises(LayoutError, match="does not face the ground"):
        SolePressure(tilted_layout(1.6))


def test_pseudo_inverse_is_numpy_s():
    """Of cells anywhere, in a row and alone, which leave directions without stiffness."""
    rng = np.random.default_rng(5)
    for k in range(300):
        u = np.column_stack([np.ones(k % 9 + 1), rng.uniform(-1.0, 1.0, (k % 9 + 1, 2))])
        if k % 3 == 0:
            u[:, 2] = 0.5 * u[:, 1]
        stiffness = (rng.dirichlet(np.ones(len(u))) * u.T) @ u
        theirs = np.linalg.pinv(stiffness, rcond=1e-9, hermitian=True)
        assert pseudo_inverse(stiffness, 1e-9) == pytest.approx(theirs, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("pitch", [0.02, 0.03, 0.045])
def test_cells_with_gaps_between_them_keep_the_load_where_it_acts(pitch):
    turn = np.arange(24) * math.pi / 12.0
    circle = 6.4e-3 * np.column_stack([np.cos(turn), np.sin(turn)])
    places = [(x, y) for x in np.arange(-0.09, 0.0901, pitch) for y in np.arange(-0.04, 0.0401, pitch)]
    box = [(-0.11, -0.06), (0.11, -0.06), (0.11, 0.06), (-0.11, 0.06)]
    films = layout_of_cells([circle + p for p in places], outline=np.array(box))
    middle = np.mean(places, axis=0)
    for cop in middle + np.array([[0.0, 0.0], [0.02, 0.006], [-0.015, -0.007]]):
        force = SolePressure(films).spread(box, 300.0, tuple(cop))
        assert force.sum() == pytest.approx(300.0)
        np.testing.assert_allclose(force @ films.positions[:, :2] / 300.0, cop, atol=1e-6)


def test_a_point_presses_like_the_disc_of_a_compliant_sole_on_a_pebble():
    """The square of a point has the second moments of the disc that 400 N make at 1 GPa/m on a radius of 30 mm."""
    disc = (4.0 * 0.03 * 400.0 / (math.pi * 1e9)) ** 0.25
    polygon, _ = patch_polygon(np.array([[0.02, -0.01]]), 3e-3)
    assert np.abs(polygon - [0.02, -0.01]) == pytest.approx(disc / math.sqrt(2.0), rel=0.02)
    line, _ = patch_polygon(np.array([[0.0, 0.0], [0.1, 0.0]]), 3e-3)
    assert np.ptp(line, axis=0) == pytest.approx([0.106, 0.006])
