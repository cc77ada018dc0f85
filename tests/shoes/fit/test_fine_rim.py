"""A fine rim: cells that fill the edge of the face, and a blind rim of 12 mm at most."""

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from plantar.errors import FootError, InputError
from plantar.shoes import build_shoe, foot_from_dimensions
from plantar.shoes.fit.fine_rim import BLIND_MOST, fit_fine_rim, strip_cells
from plantar.shoes.geometry.outline import grown, rounded_rectangle

from ..foot_family import oval

SOLES = {
    "round corners": rounded_rectangle(180.0, 90.0, (20.0, 0.0), 22.0),
    "sharp corners": rounded_rectangle(170.0, 80.0, (20.0, 0.0), 0.0),
    "waist": shapely.Polygon(
        [(-70, -35), (0, -25), (60, -40), (110, -28), (118, 5), (105, 38), (60, 42), (0, 28), (-72, 30)]
    ).buffer(4.0, quad_segs=4),
}


@pytest.mark.parametrize("name", SOLES)
def test_the_cells_fill_the_edge_and_leave_a_narrow_blind_rim(name):
    foot = SOLES[name]
    fit = fit_fine_rim(foot, cell_area=691.0, overhang=1.5, border=2.0)
    cells = [shapely.Polygon(c) for c in fit.cells]
    region, face = grown(foot, 1.5), grown(foot, 3.5)
    assert sum(c.area for c in cells) == pytest.approx(shapely.union_all(cells).area, rel=1e-6)  # none over another
    assert all(region.buffer(0.5).covers(c) for c in cells)  # less what of its detail is dropped
    assert region.difference(region.buffer(-6.0)).difference(shapely.union_all(cells)).area < 0.06 * region.area
    hull = shapely.MultiPoint([c.centroid for c in cells]).convex_hull
    assert max(hull.distance(shapely.Point(p)) for p in face.exterior.coords) <= BLIND_MOST
    assert min(c.area for c in cells) >= 60.0
    assert max(fit.shares) <= 1.0 + 1e-6
    assert fit.whole == sum(abs(c.area - 691.0) < 1e-3 for c in cells) > 0


@pytest.mark.parametrize("seed", [3, 4, 7, 9])
def test_corners_of_neighbouring_cells_coincide_or_lie_apart(seed):
    chance = np.random.default_rng(seed)
    size = chance.uniform(200, 260), chance.uniform(80, 110)
    sole = shapely.Polygon(oval(*size, 20, int(chance.integers(20, 90)), chance.uniform(2, 4)))
    fit = fit_fine_rim(shapely.affinity.rotate(sole, chance.uniform(-4, 4)), cell_area=691.0, overhang=1.0, border=2.0)
    corners = np.unique(np.concatenate(fit.cells).round(4), axis=0)
    gaps, _ = cKDTree(corners).query(corners, k=2)
    assert gaps[:, 1].min() > 0.2  # mm: an edge of a groove is made


def test_a_strip_has_one_cell_at_each_sharp_corner():
    region = shapely.box(0.0, 0.0, 160.0, 80.0)
    cells, inside = strip_cells(region, shapely.box(-2.0, -2.0, 162.0, 82.0), 691.0)
    corners = [(0, 0), (160, 0), (160, 80), (0, 80)]
    owners = [[i for i, c in enumerate(cells) if shapely.Polygon(c).touches(shapely.Point(p))] for p in corners]
    assert [len(o) for o in owners] == [1, 1, 1, 1]
    depth = 0.5 * (80.0 - (inside.bounds[3] - inside.bounds[1]))
    for (owner,) in owners:
        np.testing.assert_allclose(np.ptp(cells[owner], axis=0), depth)


def test_a_spike_has_no_fine_rim():
    with pytest.raises(FootError, match="blind rim of more than 12 mm"):
        fit_fine_rim(
            shapely.Polygon([(-60, -40), (40, -6), (140, 0), (40, 6), (-60, 40)]),
            cell_area=691.0,
            overhang=0.0,
            border=2.0,
        )


def test_a_shoe_offers_a_fine_rim_and_makes_it():
    foot = foot_from_dimensions("a", length=0.2, width=0.1, sole_center=(0.02, 0.0), corner_radius=0.02)
    plain = build_shoe(foot, layout_only=True, side="left")
    assert plain.shoes[0].plan.blind_rim > BLIND_MOST
    assert any("--rim fine" in note for note in plain.notes)
    fine = build_shoe(foot, layout_only=True, side="left", rim="fine")
    assert fine.shoes[0].plan.blind_rim <= BLIND_MOST
    assert not any("--rim fine" in note for note in fine.notes)
    assert fine.shoes[0].layout.cell_shape == "mixed"
    assert len(fine.shoes[0].plan.route) == len(fine.shoes[0].layout) - len(fine.shoes[0].plan.connectors)
    assert fine.load_share.flat > 0.95


def test_what_cannot_be_asked_of_a_rim_is_named():
    foot = foot_from_dimensions("a", length=0.2, width=0.1)
    with pytest.raises(InputError, match="rim is 'fancy'; allowed: whole, fine"):
        build_shoe(foot, rim="fancy", layout_only=True)
    with pytest.raises(InputError, match="a fine rim takes as many taxels as it needs"):
        build_shoe(foot, rim="fine", taxels=30, layout_only=True)
