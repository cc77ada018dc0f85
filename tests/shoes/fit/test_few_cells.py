"""A few cells: as far apart as the sole allows, inside, and by ways that stay in it."""

import numpy as np
import pytest
import shapely

from plantar.errors import FootError, InputError
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.fit.cell_fit import fit_cells

CELL = read_cell("fx29_100")


@pytest.mark.parametrize("turn", [0.0, 7.0])
def test_four_cells_lie_in_the_corners(turn):
    sole = shapely.affinity.rotate(shapely.box(-80, -45, 140, 45).buffer(8.0), turn)
    fit = fit_cells(sole, CELL, rib=2.4)
    pockets = [shapely.Polygon(p) for p in fit.pockets]
    assert all(sole.covers(p) for p in pockets)
    assert shapely.union_all(pockets).geom_type == "MultiPolygon"
    centres = np.array([shapely.Polygon(c).centroid.coords[0] for c in fit.cells])
    hull = shapely.MultiPoint(centres).convex_hull
    # No four places within the room have a larger hull than its own, which the corners nearly fill.
    room = sole.buffer(-0.5 * CELL.size - CELL.play - 1.2)
    assert hull.area > 0.9 * room.area


def test_ways_between_cells_stay_in_the_sole():
    legs = shapely.union_all(
        [shapely.box(-80, -60, 140, -20), shapely.box(-80, 20, 140, 60), shapely.box(-80, -60, -40, 60)]
    )
    fit = fit_cells(legs, CELL, rib=2.4)
    centres = np.array([shapely.Polygon(c).centroid.coords[0] for c in fit.cells])
    ways = shapely.linestrings(centres[np.array(fit.links)])
    assert len(ways) == 3  # not from toe to toe, and not across
    assert all(legs.covers(way) for way in ways)


def test_soles_too_small_and_other_numbers_are_refused():
    with pytest.raises(FootError, match=r"cells fx29_100 lie .* mm apart on this sole; allowed: "):
        fit_cells(shapely.box(0, 0, 50, 40), CELL, rib=2.4)
    with pytest.raises(FootError, match="fits into the sole"):
        fit_cells(shapely.box(0, 0, 50, 20), CELL, rib=2.4)
    with pytest.raises(InputError, match="states how many a foot has"):
        fit_cells(shapely.box(0, 0, 200, 90), CELL, rib=2.4, taxels=6)
