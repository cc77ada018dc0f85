"""Tests of the strength check against beams worked out by hand."""

import math
from dataclasses import replace

import pytest
import shapely

from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.strength import check_strength, estimated_mass, load_case, strengthened

FOOT = foot_from_dimensions("a", length=0.2, width=0.1, mass=60.0)


def test_the_load_is_one_and_a_half_weights_on_a_third():
    load = load_case(FOOT, ShoeParameters())
    assert load.force == pytest.approx(1.5 * 60 * 9.81, abs=0.1)
    assert load.pressure == pytest.approx(1.5 * 60 * 9.81 / (20_000 / 3))
    assert load_case(FOOT, ShoeParameters(robot_mass=80.0)).mass == 80.0
    unknown = replace(FOOT, mass=None)
    assert load_case(unknown, ShoeParameters()).mass == estimated_mass(200.0)
    assert "12.1 to 79.7 kg" in load_case(unknown, ShoeParameters()).source
    assert "estimated" in load_case(unknown, ShoeParameters()).source
    assert estimated_mass(450.0) == 150.0


def test_beams_are_those_of_the_textbook():
    p = ShoeParameters()
    contact = shapely.box(-108, -50, 108, 50)  # 8 mm beyond the foot at both ends
    foot = replace(FOOT, support=shapely.union_all([shapely.box(-100, -50, -20, 50), shapely.box(20, -50, 100, 50)]))
    load, (overhang, gap, wall) = check_strength(foot, contact, p)
    assert overhang.stress == pytest.approx(3 * load.pressure * 8.0**2 / 5.0**2, rel=1e-3)
    assert gap.length == pytest.approx(40.0, abs=0.3)
    assert gap.stress == pytest.approx(0.5 * load.pressure * gap.length**2 / 5.0**2, rel=1e-3)
    push = 0.6 * load.force / 100.0
    assert wall.stress == pytest.approx(6 * push * 4.0 / 3.0**2, rel=1e-3)
    assert wall.allowed == pytest.approx(48 / 2 * 0.85)
    for member in (overhang, gap, wall):  # at the thickness needed the stress is what is allowed
        assert member.stress * (member.thickness / member.needed) ** 2 == pytest.approx(member.allowed, rel=1e-2)
    modulus, inertia = 1700.0, 5.0**3 / 12.0
    assert overhang.deflection == pytest.approx(load.pressure * 8.0**4 / (8 * modulus * inertia), abs=1e-3)
    # The wall as a cantilever with a force at a third of its height, its top carried along.
    bent = push * 4.0**2 * (3 * 12.0 - 4.0) / (6 * modulus * 3.0**3 / 12.0)
    assert wall.deflection == pytest.approx(bent, abs=1e-3)


def test_floor_and_wall_are_raised_until_they_hold():
    contact = shapely.box(-110, -60, 110, 60)
    wide = replace(FOOT, support=shapely.union_all([shapely.box(-100, -50, -70, 50), shapely.box(70, -50, 100, 50)]))
    weak = ShoeParameters(material="PLA", robot_mass=120.0)
    strong, notes = strengthened(wide, contact, weak)
    assert strong.floor > weak.floor
    assert strong.rim_thickness > weak.rim_thickness
    assert len(notes) == 2
    assert all("raised from" in n for n in notes)
    _, members = check_strength(wide, contact, strong)
    assert all(m.holds for m in members)
    less = replace(strong, floor=strong.floor - 0.2)
    assert not all(m.holds for m in check_strength(wide, contact, less)[1])
    kept, none = strengthened(wide, contact, replace(weak, strengthen="no"))
    assert (kept.floor, none) == (weak.floor, ())
    assert strengthened(FOOT, contact, ShoeParameters(robot_mass=1.0))[1] == ()
    assert math.isclose(strengthened(FOOT, contact, ShoeParameters(robot_mass=1.0))[0].floor, 5.0)


@pytest.mark.parametrize("mass", [40.0 + 2.5 * k for k in range(41)])
def test_what_is_raised_by_the_load_case_passes_its_check(mass):
    foot = foot_from_dimensions("a", length=0.24, width=0.1)
    for reach in (8.0, 9.37, 11.003):
        contact = foot.sole.buffer(reach, join_style="mitre")
        raised, _ = strengthened(foot, contact, ShoeParameters(robot_mass=mass))
        assert all(member.holds for member in check_strength(foot, contact, raised)[1])
    members = check_strength(foot, contact, raised)[1]
    # As thick as is needed, to the 0.001 mm that it is told in, holds as well.
    floor = max(member.needed for member in members if member.name.startswith("plate"))
    assert all(m.holds for m in check_strength(foot, contact, replace(raised, floor=floor))[1])
