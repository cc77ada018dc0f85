"""The plate below a few cells: as thick as its load asks for, and what it carries."""

from dataclasses import replace

import pytest
import shapely

from plantar.shoes import ShoeParameters, build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.plan.ground_plate import ground_plate, has_ground_plate, plate_carries
from plantar.shoes.plan.strength import load_case

FOOT = foot_from_dimensions("a", length=0.22, width=0.11, corner_radius=0.02, sole_center=(0.02, 0.0), mass=40.0)
BUILD = build_shoe(FOOT, side="left", cell=read_cell("fx29_200"), layout_only=True)
PLAN = BUILD.shoes[0].plan


def test_four_load_cells_have_a_plate_that_bears_the_load_case():
    p = BUILD.parameters
    assert has_ground_plate(PLAN)
    assert p.pad_kind == "plate"
    assert "PA12, printed" in p.pad_material
    plate = ground_plate(PLAN, load_case(FOOT, p), p)
    assert plate.holds
    thinner = replace(p, pad_thickness=p.pad_thickness - 0.5)
    assert not ground_plate(PLAN, load_case(FOOT, p), thinner).holds
    # by hand: F L / 4 over the width, twice the strength
    force = 1.5 * 40.0 * 9.81
    moment = 0.25 * force * plate.length / (PLAN.contact.bounds[3] - PLAN.contact.bounds[1])
    assert plate.stress == pytest.approx(6.0 * moment / p.pad_thickness**2, rel=1e-3)


def test_a_load_on_half_the_sole_acts_on_the_cells_and_one_on_its_edge_does_not():
    x0, y0, x1, y1 = PLAN.contact.bounds
    assert plate_carries(PLAN, shapely.box(x0, y0, 0.5 * (x0 + x1), y1)) == 1.0
    assert plate_carries(PLAN, shapely.box(x0, y0, x0 + 5.0, y1)) == 0.0
    assert (BUILD.load_share.flat, BUILD.load_share.half) == (1.0, 1.0)


def test_many_cells_have_a_soft_pad():
    build = build_shoe(FOOT, side="left", layout_only=True, parameters=ShoeParameters())
    assert not has_ground_plate(build.shoes[0].plan)
    assert build.parameters.pad_kind == "soft"
