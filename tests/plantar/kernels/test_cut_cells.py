"""The kernel that cuts a polygon at a line: both forms, against shapely."""

import numpy as np
import pytest
import shapely

from plantar.geometry.polygon import area, convex_hull, part_inside
from plantar.kernels import python_form
from plantar.kernels.geometry import cut_cells

INTERPRETED = python_form("cut_cells")


@pytest.mark.parametrize("seed", range(60))
def test_a_polygon_is_cut_as_shapely_cuts_it_and_both_forms_give_the_same_bits(seed):
    rng = np.random.default_rng(seed)
    polygon = convex_hull(rng.normal(scale=0.1, size=(rng.integers(3, 30), 2)))
    angle, h = rng.uniform(0.0, 2.0 * np.pi), rng.normal(scale=0.08)
    nx, ny = np.cos(angle), np.sin(angle)
    if seed % 4 == 0:  # through a corner
        h = float(polygon[0] @ [nx, ny])
    found = cut_cells.part_below(polygon, nx, ny, h)
    assert found.tobytes() == INTERPRETED.part_below(polygon, nx, ny, h).tobytes()
    n, along = np.array([nx, ny]), np.array([-ny, nx])
    side = shapely.Polygon([h * n + along, h * n - along, (h - 1.0) * n - along, (h - 1.0) * n + along])
    expected = shapely.intersection(shapely.Polygon(polygon), side).area
    left = part_inside(polygon, nx, ny, h)
    assert (area(left) if len(left) > 2 else 0.0) == pytest.approx(expected, abs=1e-12)
    assert part_inside(np.asfortranarray(polygon), nx, ny, h).tobytes() == left.tobytes()


def test_nothing_is_left_of_nothing_or_beyond_the_line():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    for form in (cut_cells, INTERPRETED):
        assert form.part_below(np.empty((0, 2)), 1.0, 0.0, 0.0).shape == (0, 2)
        assert form.part_below(square, 1.0, 0.0, -0.5).shape == (0, 2)
        assert form.part_below(square, 1.0, 0.0, 2.0).tolist() == square.tolist()
        with pytest.raises(ValueError, match="contiguous"):
            form.part_below(square[:, ::-1], 1.0, 0.0, 0.5)
