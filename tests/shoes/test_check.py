"""Tests of the checks: each holds on a good shoe and fails on one that is broken in its way."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from shoes import ShoeReport
from shoes.check import check_shoe, floor_thickness, section, thinnest_wall
from shoes.tray import read_step

Shape = Callable[..., NDArray[np.float64]]
FLIP = np.array([1.0, -1.0, 1.0])


def failed(report: ShoeReport, folder: Path, **change: object) -> set[str]:
    """Names of the checks that do not hold when one input of the check is replaced."""
    shoe = report.build.shoes[0]
    given = {
        "shoe": shoe,
        "parameters": report.build.parameters,
        "surface": shoe.surface,
        "step": read_step(str(folder / "shoe_left.step")),
    } | change
    return {c.name for c in check_shoe(**given).checks if not c.holds}  # type: ignore[arg-type]


def test_a_good_shoe_passes(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    assert failed(report, folder) == set()
    for check in report.checks.values():
        assert check.holds
        assert check.watertight
        assert check.min_wall_mm == pytest.approx(2.0, abs=0.01)  # border and rib
        assert check.mass_g == pytest.approx(check.volume_cm3 * 1.01, abs=0.01)
        assert check.size_mm == pytest.approx((127.0, 77.0, 24.0), abs=0.01)


def test_an_open_surface_fails(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    surface = report.build.shoes[0].surface
    assert surface is not None
    assert "watertight" in failed(report, folder, surface=surface[5:])
    assert "watertight" in failed(report, folder, surface=surface[:, ::-1])  # inside out


def test_two_bodies_fail(exported: tuple[ShoeReport, Path], box: Shape) -> None:
    report, folder = exported
    surface = report.build.shoes[0].surface
    assert surface is not None
    two = np.concatenate([surface, box((200, 210), (0, 10), (0, 10))])
    assert "separate surfaces in the STL" in failed(report, folder, surface=two)


def test_another_volume_fails(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    surface = report.build.shoes[0].surface
    assert surface is not None
    assert "STL against STEP volume, %" in failed(report, folder, surface=surface * 1.01)
    assert "STL against STEP volume, %" not in failed(report, folder, surface=surface * 1.001)


def test_thin_walls_fail(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    demanding = replace(report.build.parameters, wall_min=2.0)
    assert failed(report, folder, parameters=demanding) == set()
    object.__setattr__(demanding, "wall_min", 2.1)  # past what the parameters themselves allow
    assert failed(report, folder, parameters=demanding) == {"thinnest wall, mm"}


def test_a_layout_that_is_not_the_solid_fails(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    shoe = report.build.shoes[0]
    layout = shoe.layout
    moved = replace(
        layout, positions=layout.positions + np.array([1e-4, 0, 0]), vertices=layout.vertices + np.array([1e-4, 0, 0])
    )
    wrong = replace(shoe, plan=replace(shoe.plan, layout=moved))
    assert failed(report, folder, shoe=wrong) == {"pocket corners against the layout, mm"}
    narrow = replace(layout, outline=layout.outline * 0.5)
    assert "taxels beyond the contact face" in failed(
        report, folder, shoe=replace(shoe, plan=replace(shoe.plan, layout=narrow))
    )


def test_a_foot_that_does_not_fit_fails(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    shoe = report.build.shoes[0]
    for grown in (0.2, 5.0):
        wide = replace(shoe, plan=replace(shoe.plan, foot=shoe.plan.foot.buffer(grown)))
        assert "gap between foot and rim, mm" in failed(report, folder, shoe=wide)
    small = replace(shoe, plan=replace(shoe.plan, foot=shoe.plan.foot.buffer(-12.0)))
    assert "overhang, mm" in failed(report, folder, shoe=small)


def test_sections_of_a_hollow_box(box: Shape) -> None:
    hollow = np.concatenate([box((0, 50), (0, 40), (0, 30)), box((5, 44), (3, 36), (10, 20))[:, ::-1]])
    assert section(hollow, 5.0).equals(shapely.box(0, 0, 50, 40))
    cut = section(hollow, 15.0)
    assert cut.area == pytest.approx(50 * 40 - 39 * 33)
    assert thinnest_wall(cut) == pytest.approx(3.0)
    assert section(hollow, 40.0).is_empty
    assert thinnest_wall(section(hollow, 5.0)) == math.inf
    assert floor_thickness(hollow, np.array([[20.0, 20.0], [2.0, 2.0]])) == pytest.approx(10.0)
    assert floor_thickness(hollow, np.array([[20.0, 20.0], [99.0, 2.0]])) == 0.0


def test_the_wall_between_two_holes_counts() -> None:
    plate = shapely.box(0, 0, 50, 50) - shapely.box(10, 10, 20, 40) - shapely.box(21.5, 10, 40, 40)
    assert thinnest_wall(plate) == pytest.approx(1.5)
