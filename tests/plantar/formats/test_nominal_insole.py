"""The nominal 99-cell insole."""

import itertools

import numpy as np
import pytest

from plantar.formats.nominal_insole import CELL_AREAS, ROWS, WIDE_ROWS, nominal_insole
from plantar.geometry.polygon import area, signed_margin


@pytest.mark.parametrize("size", sorted(CELL_AREAS))
def test_areas_tile_the_outline(size):
    layout = nominal_insole(size, "left")
    assert len(layout) == sum(ROWS) == 99
    assert layout.areas.sum() == pytest.approx(layout.sole_area)
    assert layout.areas == pytest.approx(CELL_AREAS[size])
    drawn = [area(layout.cell_polygon(i)) for i in range(99)]
    assert drawn == pytest.approx(layout.areas.tolist(), rel=0.12)  # cells in a row are trapezoids beside each other
    if len(size) == 1:
        assert layout.areas.std() / layout.areas.mean() < 0.02


def test_rows_of_a_wide_insole_end_in_two_of_five():
    assert sum(WIDE_ROWS) == 99
    layout = nominal_insole("xw", "left")
    assert len({round(float(x), 6) for x in layout.positions[-5:, 0]}) <= 5
    assert layout.positions[-5:, 0].min() > layout.positions[-10:-5, 0].max()


def test_numbering_runs_heel_to_toe_and_medial_to_lateral():
    for side, medial in (("left", -1.0), ("right", 1.0)):
        layout = nominal_insole("x", side)
        starts = np.concatenate([[0], np.cumsum(ROWS)])
        rows = [layout.positions[a:b] for a, b in itertools.pairwise(starts)]
        assert all(b[:, 0].min() > a[:, 0].max() for a, b in itertools.pairwise(rows))
        assert all((np.diff(row[:, 1]) * medial < 0).all() for row in rows)
        hallux = layout.positions[95, :2]
        assert hallux[1] * medial > 0.0


def test_positions_lie_in_their_cells_and_neighbours_are_mutual():
    layout = nominal_insole("y", "right")
    for i in range(len(layout)):
        assert signed_margin(layout.cell_polygon(i), layout.positions[i, :2]) > 0.003
        assert all(i in layout.neighbours[j] for j in layout.neighbours[i])
        assert 2 <= len(layout.neighbours[i]) <= 6
