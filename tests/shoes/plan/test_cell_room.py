"""Room for a cell's connector, and for its cable up the heel."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.shoes import ShoeParameters
from plantar.shoes.cells.cell import Cell
from plantar.shoes.plan.cell_room import bend_at_heel, cell_parameters

FILM = Cell(
    shape="round", size=18.0, active=12.0, thickness=0.5, tail_length=10.0, tail_width=6.0,
    connector_length=5.0, connector_height=3.2, bend_radius=7.0, lead_diameter=0.8,
)  # fmt: skip


def _clears(inner: float, thick: float, low: float, wide: float) -> bool:
    """Whether a cable's quarter ring about (r, r) lies in an L of two ways along x and y, by its points."""
    outer = inner + thick
    angle, radius = np.meshgrid(np.linspace(np.pi, 1.5 * np.pi, 721), np.linspace(inner, outer, 9))
    x, y = outer + radius * np.cos(angle), outer + radius * np.sin(angle)
    return bool(((y <= low + 1e-3) | (x <= wide + 1e-3)).all() and min(x.min(), y.min()) > -1e-9)


@pytest.mark.parametrize("depth", [1.5, 2.5, 4.0])
@pytest.mark.parametrize("gap", [1.4, 2.2, 6.0])
def test_the_widest_bend_touches_the_corner(depth, gap):
    radius = bend_at_heel(FILM, ShoeParameters(pocket_depth=depth, board_gap=gap))
    assert _clears(radius, 0.8, depth, gap - 0.2)
    assert not _clears(radius + 0.1, 0.8, depth, gap - 0.2)


@pytest.mark.parametrize("radius", [0.5, 6.0, 9.0, 12.0])
def test_pockets_hold_the_connector_and_the_board_stands_off_as_far_as_the_cable_bends(radius):
    cell = replace(FILM, bend_radius=radius)
    p, notes = cell_parameters(cell, ShoeParameters())
    assert p.pocket_depth == 3.2
    assert "the cell's connector is 3.2 mm thick" in notes[0]
    assert bend_at_heel(cell, p) >= radius
    assert p.board_gap == 2.2 or bend_at_heel(cell, replace(p, board_gap=p.board_gap - 0.1)) < radius
    assert (len(notes) == 2) == (p.board_gap > 2.2)
