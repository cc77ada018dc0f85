"""Tests of the checks: each holds on a good shoe and fails on one that is broken in its way."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from plantar.shoes.checks.check import check_shoe, corner_errors
from plantar.shoes.solid.step_model import read_step


@pytest.fixture(scope="module")
def failed(exported):
    """Gives the names of the checks that do not hold when one input of the check is replaced."""
    report, folder = exported
    step = read_step(folder / "shoe_left.step")

    def call(**change: Any) -> set[str]:
        shoe = report.build.shoes[0]
        given = {"shoe": shoe, "build": report.build, "surface": shoe.surface, "step": step} | change
        return {c.name for c in check_shoe(**given).checks if not c.holds}

    return call


def test_a_good_shoe_passes(exported, failed):
    report, _ = exported
    assert failed() == set()
    p = report.build.parameters
    for check in report.checks.values():
        assert check.holds
        assert check.watertight
        assert check.min_wall_mm == pytest.approx(1.5, abs=0.01)  # the rail behind the connection board
        assert check.mass_g == pytest.approx(check.volume_cm3 * 1.01, abs=0.01)
        assert check.size_mm[2] == pytest.approx(p.thickness + report.build.retention.top(p) - p.bottom, abs=0.01)
        assert check.printing[0].direction == "sole down"
        assert check.printing[0].overhang == 0.0
        assert check.mounting.gap == pytest.approx(p.clearance, abs=0.01)
        assert check.mounting.support_share == pytest.approx(1.0)


def test_a_part_of_the_assembly_that_is_no_solid_fails(exported, failed):
    names = {c.name for c in exported[0].checks["left"].checks}
    assert {"pad of the assembly valid", "connection board of the assembly valid"} <= names
    assert failed(parts={"pad": False, "taxel": True}) == {"pad of the assembly valid"}


def test_an_open_surface_fails(exported, failed):
    surface = exported[0].build.shoes[0].surface
    assert "watertight" in failed(surface=surface[5:])
    assert "watertight" in failed(surface=surface[:, ::-1])  # inside out


def test_two_bodies_fail(exported, failed, box):
    surface = exported[0].build.shoes[0].surface
    assert surface is not None
    two = np.concatenate([surface, box((200, 210), (0, 10), (0, 10))])
    names = failed(surface=two)
    assert {"separate surfaces in the STL", "reach of lugs, clips and holder, mm"} <= names


def test_another_volume_fails(exported, failed):
    surface = exported[0].build.shoes[0].surface
    assert "STL against STEP volume, %" in failed(surface=surface * 1.01)
    assert "STL against STEP volume, %" not in failed(surface=surface * 1.001)


def test_thin_walls_fail(exported, failed):
    build = exported[0].build
    assert failed(build=replace(build, parameters=replace(build.parameters, wall_min=1.5))) == set()
    demanding = replace(build.parameters, wall_min=1.6)
    assert failed(build=replace(build, parameters=demanding)) == {"thinnest wall, mm"}


def test_a_layout_that_is_not_the_solid_fails(exported, failed):
    shoe = exported[0].build.shoes[0]
    layout = shoe.layout
    by = np.array([1e-4, 0, 0])
    moved = replace(layout, positions=layout.positions + by, vertices=layout.vertices + by)
    wrong = replace(shoe, plan=replace(shoe.plan, layout=moved))
    assert failed(shoe=wrong) == {"cell corners against the solid, mm"}
    pockets = tuple(shapely.affinity.translate(q, 0.1) for q in shoe.plan.pockets)
    wrong = replace(shoe, plan=replace(shoe.plan, pockets=pockets))
    assert failed(shoe=wrong) == {"pocket corners against the layout, mm"}
    narrow = replace(layout, outline=layout.outline * 0.5)
    assert "taxels beyond the contact face" in failed(shoe=replace(shoe, plan=replace(shoe.plan, layout=narrow)))


def test_the_layouts_corners_are_corners_of_the_solid(exported):
    report, folder = exported
    for shoe in report.build.shoes:
        step = read_step(folder / f"shoe_{shoe.side}.step")
        cells, pockets = corner_errors(shoe, report.build.parameters, step)
        assert max(cells, pockets) < 1e-3
        # Told without the plan: a corner of the solid lies over every corner of the layout, but for the cable's way.
        corners = step.corners[:, :2]
        gaps = [np.hypot(*(corners - v[:2] * 1000).T).min() for v in shoe.layout.vertices]
        assert np.mean(np.array(gaps) < 0.05) > 0.9


def test_a_foot_that_does_not_fit_fails(exported, failed):
    build = exported[0].build
    for grown in (0.2, 5.0):
        sole = build.foot.sole.buffer(grown, join_style="mitre")
        wide = replace(build.foot, sole=sole, outline_up_to=lambda height, sole=sole: sole)
        names = failed(build=replace(build, foot=wide))
        assert {"gap between foot and wall, mm", "gap while the shoe is pushed on, mm"} <= names
    shoe = build.shoes[0]
    small = replace(shoe, plan=replace(shoe.plan, foot=shoe.plan.foot.buffer(-12.0)))
    assert "overhang, mm" in failed(shoe=small)


def test_a_heavier_robot_and_a_small_bed_fail(exported, failed):
    build = exported[0].build
    heavy = replace(build, parameters=replace(build.parameters, robot_mass=400.0))
    assert "stress of the wall, MPa" in failed(build=heavy)
    light = replace(build.parameters, bed_length=100.0, bed_width=100.0, bed_height=100.0)
    assert failed(build=replace(build, parameters=light)) == {"longest side on the printer, mm"}


def test_ceilings_too_wide_to_bridge_fail_but_in_a_powder_bed(exported, failed):
    build = exported[0].build
    narrow = replace(build.parameters, bridge_max=10.0)
    assert failed(build=replace(build, parameters=narrow)) == set()
    lines = replace(narrow, material="PETG")
    assert failed(build=replace(build, parameters=lines)) == {"overhang beyond 45 degrees, heel down, mm2"}
