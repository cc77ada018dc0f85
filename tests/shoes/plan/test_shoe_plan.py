"""Tests of the plan: what is inside what, the cable's way, and the mirrored side."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from plantar.shoes.fit.taxels import fit_taxels
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.shoe_plan import mirrored_plan, plan_shoe


@pytest.fixture(scope="module")
def fit(small_foot):
    return fit_taxels(small_foot.sole, taxels=9, overhang_max=10.0, border=2.0)


@pytest.fixture(scope="module")
def plan(small_foot, fit):
    return plan_shoe(small_foot, fit, ShoeParameters())


def test_everything_is_where_it_belongs(plan, small_foot):
    p = ShoeParameters()
    assert plan.cavity.exterior.distance(small_foot.sole) == pytest.approx(p.clearance, abs=0.01)
    assert plan.rim.exterior.distance(plan.cavity) == pytest.approx(p.rim_thickness, abs=0.03)
    assert plan.contact.buffer(2e-3).covers(plan.rim)
    for cell, pocket in zip(plan.cells, plan.pockets, strict=True):
        assert cell.exterior.distance(pocket) == pytest.approx(0.5 * p.rib)
        assert plan.contact.exterior.distance(cell) >= p.border - 0.01
    gaps = [a.distance(b) for i, a in enumerate(plan.pockets) for b in plan.pockets[:i]]
    assert min(gaps) == pytest.approx(p.rib)
    assert 0.0 < plan.overhang <= p.overhang_max


def test_the_layout_is_in_metres_in_the_sole_frame(plan, fit):
    layout = plan.layout
    assert (layout.side, layout.name, len(layout)) == ("left", "small", 9)
    assert fit.lattice_cells is not None
    centres = fit.lattice.centres(fit.lattice_cells)
    np.testing.assert_allclose(layout.positions[:, :2] * 1000, centres, atol=1e-6)
    np.testing.assert_allclose(layout.areas, 691e-6, rtol=1e-6)
    np.testing.assert_allclose(layout.outline * 1000, ring(plan.contact), atol=1e-3)
    assert all(layout.neighbours)


def test_cut_cells_share_their_corners_in_the_layout():
    from plantar.shoes.foot.foot import foot_from_dimensions

    foot = foot_from_dimensions("b", length=0.241, width=0.138, sole_center=(0.015, 0.0), corner_radius=0.0196)
    fit = fit_taxels(foot.sole, taxels=51, overhang_max=10.0, border=2.0)
    layout = plan_shoe(foot, fit, ShoeParameters(border=fit.border)).layout
    assert len(layout) == 51
    pairs = sum(len(n) for n in layout.neighbours) // 2
    assert pairs > 51 * 2.3  # of a patch of whole cells: 3 n less the rim
    assert layout.cell_area == pytest.approx(691e-6)
    assert layout.cell_shape == "hexagon"


def test_the_cable_reaches_every_taxel_once(plan):
    assert len(plan.connectors) == 1
    assert plan.connectors[0] == int(
        np.argmin(np.hypot(*(plan.layout.positions[:, :2] * 1000 - plan.heel.point(0.0, 0.0)).T))
    )
    assert len(plan.route) == len(plan.layout) - 1
    reached = {plan.connectors[0]}
    for i, j in plan.route:
        assert i in reached
        assert j not in reached
        assert j in plan.layout.neighbours[i]
        reached.add(j)
    assert reached == set(range(len(plan.layout)))


def test_patches_apart_get_a_connector_each(small_foot, fit):
    x = np.array([f.mean(axis=0)[0] for f in fit.cells])
    kept = np.flatnonzero((x < x.min() + 30.0) | (x > x.max() - 30.0))
    apart = replace(fit, cells=tuple(fit.cells[i] for i in kept), shares=fit.shares[kept], lattice_cells=None)
    plan = plan_shoe(small_foot, apart, ShoeParameters())
    assert len(plan.connectors) == 2
    assert len(plan.route) == len(plan.layout) - 2
    first, second = (plan.layout.positions[i, 0] for i in plan.connectors)
    assert first < second
    assert second == min(v for v in plan.layout.positions[:, 0] if v > first + 0.035)  # as near to the first as can be


def test_the_other_side_is_the_mirror_image(plan):
    right = mirrored_plan(plan)
    assert right.side == right.layout.side == "right"
    flip = np.array([1.0, -1.0])
    np.testing.assert_array_equal(right.layout.positions[:, :2], plan.layout.positions[:, :2] * flip)
    for name in ("foot", "contact", "cavity", "rim"):
        shape, mirror = getattr(plan, name), getattr(right, name)
        assert mirror.exterior.is_ccw
        assert mirror.equals(shapely.affinity.scale(shape, 1.0, -1.0, origin=(0, 0)))
    assert right.route == plan.route
    assert (right.heel.x, right.heel.y, right.heel.turn) == (plan.heel.x, -plan.heel.y, -plan.heel.turn)
    assert mirrored_plan(right).contact.equals(plan.contact)


def test_cells_too_small_for_the_ribs_are_refused(small_foot):
    fit = fit_taxels(small_foot.sole, cell_area=100.0)
    with pytest.raises(FootError, match="leave no pocket between ribs of 8 mm"):
        plan_shoe(small_foot, fit, replace(ShoeParameters(), rib=8.0))


def test_a_wide_instep_widens_the_cavity_but_not_the_sole(small_foot, fit):
    wide = replace(small_foot, outline_up_to=lambda height: small_foot.sole.buffer(6.0))
    plan = plan_shoe(wide, fit, ShoeParameters())
    assert plan.cavity.area == pytest.approx(small_foot.sole.buffer(6.5).area, rel=1e-2)
    assert math.isclose(plan.overhang, 3.5, abs_tol=0.05)
