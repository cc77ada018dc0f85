"""Hulls of a grid's cells by the ends of their rows: both forms, and shapely's hull of all corners."""

import numpy as np
import pytest
import shapely

from plantar.kernels import python_form
from plantar.kernels.geometry import row_hulls

FORMS = {"compiled": row_hulls, "python": python_form("row_hulls")}


def areas(module, force, row, column):
    out = np.full(len(force), np.nan)
    module.hull_areas(force, row, column, out)
    return out


def by_shapely(force, row, column):
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    places = np.stack([row, column], axis=1)[:, None] + corners
    return [shapely.MultiPoint(places[own > 0.0].reshape(-1, 2)).convex_hull.area for own in force]


@pytest.mark.parametrize("form", FORMS)
def test_areas_are_those_of_the_hull_of_all_corners(form):
    random = np.random.default_rng(6)
    for rows, columns, share in ((1, 1, 1.0), (1, 9, 0.4), (9, 1, 0.4), (12, 7, 0.05), (12, 7, 0.3), (30, 14, 0.8)):
        row, column = (each.ravel().astype(np.intp) for each in np.mgrid[:rows, :columns])
        order = random.permutation(len(row))  # cells come in any order
        force = np.where(random.random((20, len(row))) < share, random.random((20, len(row))), 0.0)
        found = areas(FORMS[form], force, row[order], column[order])
        assert found == pytest.approx(by_shapely(force, row[order], column[order]), rel=1e-12)


@pytest.mark.parametrize("form", FORMS)
def test_no_cell_has_no_area(form):
    place = np.zeros(1, dtype=np.intp)
    assert areas(FORMS[form], np.array([[0.0], [-1.0], [np.nan], [2.0]]), place, place).tolist() == [0.0, 0.0, 0.0, 1.0]


def test_both_forms_agree_to_the_last_bit():
    random = np.random.default_rng(7)
    row, column = (random.integers(0, 40, 60).astype(np.intp) for _ in range(2))
    force = random.normal(size=(50, 60))
    assert (areas(FORMS["compiled"], force, row, column) == areas(FORMS["python"], force, row, column)).all()
