"""Tests of the share of the load that the taxels carry: springs worked out by hand, and feet of many shapes."""

from dataclasses import replace
from functools import cache

import pytest

from plantar.shoes.build import ShoeBuild, build_shoe
from plantar.shoes.foot.foot import Foot, foot_from_dimensions
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.load_share import apparent_modulus, check_load_share, shore_modulus
from plantar.shoes.plan.shoe_plan import pad_rim
from plantar.shoes.plan.strength import load_case

FOOT = foot_from_dimensions("a", length=0.2, width=0.1, corner_radius=0.02, mass=60.0)
BAD = ShoeParameters(pad_relief=0.0, strengthen="no")


@cache
def built(parameters: ShoeParameters, foot: Foot = FOOT) -> ShoeBuild:
    return build_shoe(foot, layout_only=True, parameters=parameters)


def test_the_modulus_is_that_of_a_free_block_and_grows_with_the_shape_factor():
    assert shore_modulus(40.0) == pytest.approx(1.7, abs=0.02)
    assert apparent_modulus(40.0, 100.0, 40.0, 1e6) == pytest.approx(shore_modulus(40.0))
    # a square of 10 x 10 x 1 mm: S = 2.5, 1 + 2 x 0.85 x 6.25
    assert apparent_modulus(40.0, 100.0, 40.0, 1.0) == pytest.approx(11.625 * shore_modulus(40.0))


def test_a_rim_up_to_the_print_takes_what_springs_side_by_side_give_it():
    build = built(BAD)
    plan, p = build.shoes[0].plan, build.parameters
    rim, cells = pad_rim(plan, p), sum(c.area for c in plan.cells)
    cell = plan.cells[0]
    height = p.taxel_protrusion + p.pocket_depth
    soft = height / apparent_modulus(p.taxel_hardness, cell.area, cell.length, height)
    soft += p.pad_thickness / apparent_modulus(p.pad_hardness, cell.area, cell.length, p.pad_thickness)
    beside = rim.area * apparent_modulus(p.pad_hardness, rim.area, rim.length, p.bottom) / p.bottom
    assert build.load_share.flat == pytest.approx((cells / soft) / (cells / soft + beside), abs=0.02)
    assert build.load_share.flat < 0.8  # which is why it is relieved


def test_a_relieved_pad_loads_the_taxels_alone_and_a_load_beyond_it_the_rim():
    build = built(ShoeParameters())
    share = build.load_share
    assert share.flat == pytest.approx(1.0)
    assert share.half > 0.9
    assert share.rim_stiffness == pytest.approx(0.0, abs=1e-9)
    assert build.parameters.pad_relief > share.compression
    plan, load = build.shoes[0].plan, load_case(FOOT, build.parameters)
    over = check_load_share(plan, replace(load, force=40.0 * load.force), build.parameters)
    assert over.flat < 0.95


def test_the_relief_grows_with_the_load():
    foam = ShoeParameters(pad_foam=92.0)
    light = built(foam, replace(FOOT, mass=10.0)).parameters.pad_relief
    heavy = built(foam, replace(FOOT, mass=400.0)).parameters.pad_relief
    assert light == ShoeParameters().pad_relief < heavy


@pytest.mark.parametrize("name", ["flat_box", "two_patch", "toe_out", "plate"])
def test_feet_of_many_shapes_load_their_taxels(generated_feet, name):
    foot = foot_from_triangles(name, generated_feet[name], where=name)
    share = build_shoe(foot, layout_only=True).load_share
    assert share.flat >= 0.95
    assert share.half >= 0.80
