"""What a bill asks for: a standard or a maker's product, and where."""

import pytest

from plantar.errors import FootError, InputError
from plantar.shoes import ShoeParameters, build_shoe
from plantar.shoes.checks.printability import Weights
from plantar.shoes.materials import MATERIALS, PROCESSES
from plantar.shoes.papers.bill import bill_of_parts
from plantar.shoes.papers.orders import (
    foam_order,
    nut_order,
    print_order,
    screw_length,
    screw_order,
    silicone_order,
    strap_order,
)
from plantar.shoes.plan.touching import _FOAMS

NOTHING = Weights(0.0, 0.0, 0.0, 0.0)


def test_a_laboratorys_cells_are_said_to_be_unavailable(small_foot):
    build = build_shoe(small_foot, side="left", layout_only=True)
    lines = {line.part: line for line in bill_of_parts(build.shoes[0], build, NOTHING)}
    assert "no shop sells" in lines["taxel"].order
    assert "laboratory" in lines["cable"].order
    others = [line for name, line in lines.items() if name not in ("taxel", "cable")]
    assert all(line.address for line in others)


@pytest.mark.parametrize("material", MATERIALS)
def test_each_print_names_its_material_and_process(material):
    for process in ("auto", *PROCESSES):
        text, address = print_order("a.stl", ShoeParameters(material=material, process=process))
        assert text.startswith("print of a.stl in ")
        assert address.startswith("https://")
    assert material.upper()[:3] in print_order("a.stl", ShoeParameters(material=material)).text.upper().replace(" ", "")


@pytest.mark.parametrize(("kpa", "grade"), [(120, 4), (92, 3), (63, 2), (35, 1), (24, 1), (14, 0), (7, 0)])
def test_each_foam_has_a_grade_of_the_standard(kpa, grade):
    text = foam_order(ShoeParameters(pad_foam=kpa)).text
    assert f"D1056 grade 2A{grade}, {kpa} kPa or less" in text


def test_all_foams_that_a_shoe_may_choose_have_a_grade():
    assert all("D1056" in foam_order(ShoeParameters(pad_foam=foam)).text for foam in _FOAMS)


def test_a_pad_without_a_rim_needs_one_sheet():
    assert "sheets of 2 mm" in foam_order(ShoeParameters(pad_foam=35, taxel_protrusion=0.0, pad_relief=0.0)).text


def test_a_silicone_is_named_where_its_hardness_is_near():
    assert "Smooth-Sil 940" in silicone_order("left", ShoeParameters(pad_hardness=40)).text
    assert "Smooth-On" not in silicone_order("left", ShoeParameters(pad_hardness=80)).text


def test_screws_have_lengths_and_threads_that_are_made(small_foot):
    assert [screw_length(v) for v in (2, 7.5, 11, 11.0001, 60)] == [2, 8, 12, 12, 60]
    with pytest.raises(InputError, match="not made; allowed: up to 60 mm"):
        screw_length(61.0)
    assert "ISO 4026, M4 x 12" in screw_order(4.0, 12).text
    assert "ISO 4032, M4" in nut_order(4.0).text


def test_a_thread_that_no_screw_has_is_refused(small_foot):
    with pytest.raises(FootError, match=r"screw_diameter is 4.5 mm.*allowed: 2.5, 3, 4, 5, 6"):
        build_shoe(small_foot, side="left", parameters=ShoeParameters(retention="screws", screw_diameter=4.5))


def test_a_strap_is_cut_from_the_next_wider_roll():
    assert strap_order(25.0).text.endswith("25 mm")
    assert strap_order(22.0).text.endswith("25 mm, cut to 22 mm")
