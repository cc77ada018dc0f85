"""The nominal 99-cell insole."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from plantar.formats.nominal_insole import CELL_AREA, ROWS, nominal_insole
from plantar.geometry.polygon import signed_margin


@pytest.mark.parametrize("size", sorted(CELL_AREA))
def test_areas_tile_the_outline(size: str) -> None:
    layout = nominal_insole(size, "left")
    assert len(layout) == sum(ROWS) == 99
    assert layout.areas.sum() == pytest.approx(layout.sole_area)
    assert layout.areas.mean() == pytest.approx(CELL_AREA[size])
    assert layout.areas.std() / layout.areas.mean() < 0.02


def test_numbering_runs_heel_to_toe_and_medial_to_lateral() -> None:
    for side, medial in (("left", -1.0), ("right", 1.0)):
        layout = nominal_insole("x", side)  # type: ignore[arg-type]
        starts = np.concatenate([[0], np.cumsum(ROWS)])
        rows = [layout.positions[a:b] for a, b in itertools.pairwise(starts)]
        assert all(b[:, 0].min() > a[:, 0].max() for a, b in itertools.pairwise(rows))
        assert all((np.diff(row[:, 1]) * medial < 0).all() for row in rows)
        hallux = layout.positions[95, :2]
        assert hallux[1] * medial > 0.0


def test_positions_lie_in_their_cells_and_neighbours_are_mutual() -> None:
    layout = nominal_insole("y", "right")
    for i in range(len(layout)):
        assert signed_margin(layout.cell_polygon(i), layout.positions[i, :2]) > 0.003
        assert all(i in layout.neighbours[j] for j in layout.neighbours[i])
        assert 2 <= len(layout.neighbours[i]) <= 6
