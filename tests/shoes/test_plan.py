"""Tests of the plan: what is inside what, and the mirrored side."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from shoes.fit import LatticeFit, fit_lattice
from shoes.foot import Foot
from shoes.outline import ring
from shoes.parameters import ShoeParameters
from shoes.plan import ShoePlan, mirrored_plan, plan_shoe


@pytest.fixture(scope="module")
def fit(small_foot: Foot) -> LatticeFit:
    return fit_lattice(small_foot.sole, taxels=9, overhang_max=7.7)


@pytest.fixture(scope="module")
def plan(small_foot: Foot, fit: LatticeFit) -> ShoePlan:
    return plan_shoe(small_foot, fit, ShoeParameters())


def test_everything_is_where_it_belongs(plan: ShoePlan, small_foot: Foot, fit: LatticeFit) -> None:
    p = ShoeParameters()
    assert plan.cavity.exterior.distance(small_foot.sole) == pytest.approx(p.clearance, abs=0.01)
    assert plan.rim.exterior.distance(plan.cavity) == pytest.approx(p.rim_thickness, abs=0.03)
    assert plan.contact.buffer(2e-3).covers(plan.rim)
    assert plan.contact.exterior.distance(plan.recesses[0]) >= p.border - 0.01
    cells = shapely.polygons(fit.lattice.corners(fit.cells))
    for cell, pocket in zip(cells, plan.pockets, strict=True):
        assert cell.exterior.distance(pocket) == pytest.approx(0.5 * p.rib)
        assert plan.recesses[0].covers(cell)
    gaps = [a.distance(b) for i, a in enumerate(plan.pockets) for b in plan.pockets[:i]]
    assert min(gaps) == pytest.approx(p.rib)
    assert 0.0 < plan.overhang <= p.overhang_max


def test_the_layout_is_in_metres_in_the_sole_frame(plan: ShoePlan, fit: LatticeFit) -> None:
    layout = plan.layout
    assert (layout.side, layout.name, len(layout)) == ("left", "small", 9)
    np.testing.assert_allclose(layout.positions[:, :2] * 1000, fit.lattice.centres(fit.cells), atol=1e-6)
    np.testing.assert_allclose(layout.areas, 691e-6, rtol=1e-6)
    np.testing.assert_allclose(layout.outline * 1000, ring(plan.contact), atol=1e-3)
    assert all(layout.neighbours)


def test_the_other_side_is_the_mirror_image(plan: ShoePlan) -> None:
    right = mirrored_plan(plan)
    assert right.side == right.layout.side == "right"
    flip = np.array([1.0, -1.0])
    np.testing.assert_array_equal(right.layout.positions[:, :2], plan.layout.positions[:, :2] * flip)
    for name in ("foot", "contact", "cavity", "rim"):
        shape, mirror = getattr(plan, name), getattr(right, name)
        assert mirror.exterior.is_ccw
        assert mirror.equals(shapely.affinity.scale(shape, 1.0, -1.0, origin=(0, 0)))
    back = mirrored_plan(right)
    assert back.contact.equals(plan.contact)


def test_cells_apart_get_recesses_of_their_own(small_foot: Foot) -> None:
    lattice = fit_lattice(small_foot.sole).lattice
    apart = LatticeFit(lattice, np.array([[-1, 0], [2, 0]]), 0.0, 0.0, 0.0)
    plan = plan_shoe(small_foot, apart, ShoeParameters())
    assert len(plan.recesses) == 2
    assert plan.recesses[0].distance(plan.recesses[1]) > 10


def test_cells_too_small_for_the_ribs_are_refused(small_foot: Foot) -> None:
    fit = fit_lattice(small_foot.sole, cell_area=100.0)
    with pytest.raises(FootError, match="leave no pocket between ribs of 8 mm"):
        plan_shoe(small_foot, fit, replace(ShoeParameters(), rib=8.0))


def test_a_wide_instep_widens_the_cavity_but_not_the_sole(small_foot: Foot, fit: LatticeFit) -> None:
    wide = replace(small_foot, outline_up_to=lambda height: small_foot.sole.buffer(6.0))
    plan = plan_shoe(wide, fit, ShoeParameters())
    assert plan.cavity.area == pytest.approx(small_foot.sole.buffer(6.5).area, rel=1e-2)
    assert math.isclose(plan.overhang, 3.5, abs_tol=0.05)
