"""Wired shoes of three kinds of cells, without solids, made once."""

import pytest

from plantar.shoes import build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell


@pytest.fixture(scope="session")
def wired_builds():
    """Builds of one foot's left and right shoe, layouts alone, by cell."""
    foot = foot_from_dimensions(
        "small", length=0.12, width=0.07, sole_center=(0.015, 0.005), corner_radius=0.01, mass=4.0
    )
    return {
        name: build_shoe(foot, cell=read_cell(name), layout_only=True)
        for name in ("velostat", "fsr_402_short", "fx29_25")
    }
