"""Tests of the taxels of a sole: borders, cut cells, parts."""

import numpy as np
import pytest
import shapely

from plantar.shoes.fit.taxels import LEAST_BORDER, LEAST_SHARE, fit_taxels
from plantar.shoes.geometry.outline import rounded_rectangle

SOLE = rounded_rectangle(241.0, 138.0, (15.0, 0.0), 19.6)


def test_as_many_whole_cells_as_fit():
    fit = fit_taxels(SOLE, border=2.0, overhang_max=10.0)
    assert fit.whole == len(fit.cells) == 39
    assert fit.border == 2.0
    assert fit.notes == ()
    assert fit.covered == pytest.approx(39 * 691, rel=1e-4)
    assert fit.lattice_cells is not None


def test_a_number_narrows_the_border_before_it_cuts_cells():
    kept = fit_taxels(SOLE, taxels=42, border=2.0, overhang_max=10.0)
    assert (kept.border, kept.whole, kept.notes) == (2.0, 42, ())
    narrow = fit_taxels(SOLE, taxels=47, border=2.0, overhang_max=10.0)
    assert (narrow.border, narrow.whole) == (LEAST_BORDER, 47)
    assert "the border around the cells is 0.5 instead of 2 mm" in narrow.notes[0]


def test_cut_cells_stay_within_reach_and_do_not_overlap():
    fit = fit_taxels(SOLE, taxels=51, border=2.0, overhang_max=10.0)
    assert len(fit.cells) == 51
    assert fit.whole < 51
    polygons = [shapely.Polygon(c) for c in fit.cells]
    assert all(p.is_valid and p.exterior.is_ccw for p in polygons)
    assert all(SOLE.buffer(10.0).covers(p) for p in polygons)
    total = sum(p.area for p in polygons)
    assert shapely.union_all(polygons).area == pytest.approx(total, rel=1e-6)
    assert total == pytest.approx(691.0 * fit.shares.sum(), rel=2e-3)
    assert fit.shares.min() >= LEAST_SHARE
    edges = np.concatenate([np.hypot(*(c - np.roll(c, 1, axis=0)).T) for c in fit.cells])
    assert edges.min() > 0.9  # none too short to print
    again = fit_taxels(SOLE, taxels=51, border=2.0, overhang_max=10.0)
    assert all((a == b).all() for a, b in zip(fit.cells, again.cells, strict=True))


def test_taxels_lie_wherever_the_plate_meets_the_ground():
    face = shapely.box(-110, -50, 110, 50)
    wide = fit_taxels(face, overhang=1.5)
    assert all(face.buffer(1.51, join_style="mitre").covers(shapely.Polygon(c)) for c in wide.cells)
    assert wide.whole >= fit_taxels(face).whole
    assert wide.overhang == 1.5
