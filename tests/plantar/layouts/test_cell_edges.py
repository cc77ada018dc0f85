import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.geometry.outline import Outline
from plantar.layouts.cell_edges import cells_overlap, edge_table

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_twins_point_at_each_other():
    table = edge_table([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]], [[0, 1, 2, 3], [1, 4, 5, 2]])
    twins = {h: t for h, t in enumerate(np.asarray(table.twin).tolist()) if t >= 0}
    assert twins == {1: 7, 7: 1}


def test_an_edge_is_cut_at_the_corner_of_another_cell():
    """One square above two: the long edge gets a vertex in its middle and two twins."""
    table = edge_table(
        [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [0, 3], [2, 3]], [[0, 1, 2, 3], [1, 4, 5, 2], [3, 5, 7, 6]]
    )
    assert np.diff(np.asarray(table.cell_start)).tolist() == [4, 4, 5]
    assert (np.asarray(table.twin) >= 0).sum() == 6


def test_no_cells_make_an_empty_table():
    found = edge_table(np.empty((0, 2)), []).rings(b"", Outline)
    assert (found.points.shape, found.starts, found.ring_areas) == ((0, 2), (0,), ())


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_overlap_of_two_squares(dx, dy):
    shift = np.round([dx, dy], 3)
    tail = np.vstack([SQUARE, SQUARE + shift])
    head = np.vstack([np.roll(SQUARE, -1, axis=0), np.roll(SQUARE, -1, axis=0) + shift])
    meet = (np.abs(shift) < 1.0).all()
    if not (np.abs(shift) == 1.0).any() and not (shift == 0.0).any():  # there edges lie on each other, not noded
        assert cells_overlap(tail, head, 1e-6) == meet


@pytest.mark.parametrize("cells", [[[0, 1, 2, 3], [0, 1, 2, 3]], [[0, 1, 2, 3], [3, 2, 1, 0]]])
def test_a_cell_given_twice_makes_no_table(cells):
    assert edge_table(SQUARE, cells) is None
