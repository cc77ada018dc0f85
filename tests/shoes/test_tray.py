"""Tests of the solid: measured on what cadquery built, against the plan and the parameters."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from shoes import Foot, ShoeParameters, ShoeReport, build_shoe
from shoes.check import section
from shoes.tray import build_tray, read_step, surface_of, write_step


def test_the_solid_is_one_and_its_sections_are_the_plan(exported: tuple[ShoeReport, Path]) -> None:
    report, _ = exported
    p = report.build.parameters
    for shoe in report.build.shoes:
        solid, plan, surface = shoe.solid, shoe.plan, shoe.surface
        assert solid is not None
        assert surface is not None
        assert solid.isValid()
        recess, pockets = shapely.union_all(list(plan.recesses)), shapely.union_all(list(plan.pockets))
        for z, wanted in (
            (0.5 * p.patch_depth, plan.contact - recess),
            (p.patch_depth + 0.5 * p.pocket_depth, plan.contact - pockets),
            (p.plate_thickness - 0.5 * p.floor, plan.contact),
            (p.plate_thickness + 0.5 * p.rim_height, plan.rim - plan.cavity),
        ):
            assert section(surface, z).symmetric_difference(wanted).area < 0.5
        box = solid.BoundingBox()
        assert (box.zmin, box.zmax) == pytest.approx((0.0, p.height), abs=1e-6)
        volume = (
            plan.contact.area * p.plate_thickness
            - recess.area * p.patch_depth
            - pockets.area * p.pocket_depth
            + (plan.rim.area - plan.cavity.area) * p.rim_height
        )
        assert solid.Volume() == pytest.approx(volume, rel=1e-5)


def test_the_surface_is_closed_and_points_outwards(exported: tuple[ShoeReport, Path]) -> None:
    shoe = exported[0].build.shoes[0]
    assert shoe.surface is not None
    a, b, c = np.moveaxis(shoe.surface, 1, 0)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(shoe.solid.Volume(), rel=1e-6)  # type: ignore[union-attr]
    np.testing.assert_allclose(np.cross(b - a, c - a).sum(axis=0), 0.0, atol=1e-5)


def test_step_reads_back_and_has_no_date(exported: tuple[ShoeReport, Path], tmp_path: Path) -> None:
    solid = exported[0].build.shoes[0].solid
    write_step(solid, str(tmp_path / "a.step"))
    write_step(solid, str(tmp_path / "b.step"))
    text = (tmp_path / "a.step").read_text()
    assert "2000-01-01T00:00:00" in text[:1000]
    assert text == (tmp_path / "b.step").read_text()
    assert read_step(str(tmp_path / "a.step")).Volume() == pytest.approx(solid.Volume(), rel=1e-9)  # type: ignore[union-attr]


def test_a_plan_that_falls_apart_is_refused(small_foot: Foot) -> None:
    shoe = build_shoe(small_foot, side="left", layout_only=True).shoes[0]
    apart = replace(shoe.plan, rim=shapely.affinity.translate(shoe.plan.rim, 500.0))
    with pytest.raises(FootError, match="falls into 2 solids"):
        build_tray(apart, ShoeParameters())


def test_other_dimensions_give_another_solid(small_foot: Foot) -> None:
    p = ShoeParameters(plate_thickness=9.0, patch_depth=3.0, rim_height=5.0, rim_thickness=1.5, pocket_clearance=0.0)
    shoe = build_shoe(small_foot, side="left", parameters=p).shoes[0]
    assert shoe.surface is not None
    assert np.ptp(shoe.surface[..., 2]) == pytest.approx(14.0)
    assert len(surface_of(shoe.solid)) == len(shoe.surface)
