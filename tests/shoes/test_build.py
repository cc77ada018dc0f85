"""Tests of the one call from foot to shoes."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from plantar import read_layout
from plantar.errors import FootError, InputError
from shoes import Foot, ShoeParameters, build_shoe, export_shoe, foot_from_dimensions, foot_from_mesh


def test_sides_are_what_was_asked_and_mirror_each_other(small_foot: Foot) -> None:
    both = build_shoe(small_foot, layout_only=True)
    assert [s.side for s in both.shoes] == ["left", "right"]
    for side in ("left", "right"):
        one = build_shoe(small_foot, side=side, layout_only=True)  # type: ignore[arg-type]
        assert [s.side for s in one.shoes] == [side]
    left, right = (s.layout for s in both.shoes)
    np.testing.assert_array_equal(left.positions * [1, -1, 1], right.positions)


def test_arguments_out_of_range_are_refused(small_foot: Foot) -> None:
    with pytest.raises(InputError, match="side is 'middle'; allowed: left, right, both"):
        build_shoe(small_foot, side="middle")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"overhang of the taxels is 9 mm; allowed: 0 to 7\.2\d+ mm"):
        build_shoe(small_foot, overhang=9.0)
    with pytest.raises(InputError, match="cell area is"):
        build_shoe(small_foot, cell_area=691e-6)
    with pytest.raises(FootError, match="do not fit"):
        build_shoe(small_foot, taxels=60)


def test_progress_rises_to_one(small_foot: Foot) -> None:
    seen: list[tuple[float, str]] = []
    build_shoe(small_foot, layout_only=True, progress=lambda fraction, text: seen.append((fraction, text)))
    fractions = [f for f, _ in seen]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert all(text for _, text in seen)


def test_a_layout_needs_no_cad_kernel() -> None:
    code = (
        "import sys; from shoes import build_shoe, foot_from_dimensions;"
        "foot = foot_from_dimensions('a', length=.2, width=.1, sole_center=(0, 0), corner_radius=.01);"
        "build_shoe(foot, layout_only=True);"
        "print([m for m in ('cadquery', 'OCP', 'trimesh', 'mujoco', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("length", "width", "centre", "radius", "area"),
    [
        (0.08, 0.05, (0.01, 0.0), 0.005, 300.0),
        (0.35, 0.16, (0.05, -0.01), 0.04, 691.0),
        (0.15, 0.15, (0.0, 0.0), 0.075, 500.0),
    ],
)
def test_feet_of_every_size_pass_their_checks(
    tmp_path: Path, length: float, width: float, centre: tuple[float, float], radius: float, area: float
) -> None:
    foot = foot_from_dimensions("foot", length=length, width=width, sole_center=centre, corner_radius=radius)
    report = export_shoe(build_shoe(foot, side="right", cell_area=area), tmp_path)
    assert report.holds, report.checks


@pytest.mark.parametrize("name", ["jvrc1", "talos", "robotis_op3"])
def test_real_feet_give_shoes_that_hold(real_data: Path, tmp_path: Path, name: str) -> None:
    truth = json.loads((real_data / "feet" / f"{name}.json").read_text())
    foot = foot_from_mesh(real_data / "feet" / f"{name}.stl")
    report = export_shoe(build_shoe(foot, side="left"), tmp_path)
    assert report.holds, report.checks
    taxels = len(report.build.shoes[0].layout)
    assert 0.5 * truth["taxels_691mm2_upper_bound_hull"] < taxels <= truth["taxels_691mm2_upper_bound_hull"]
    size = report.checks["left"].size_mm
    assert truth["lowest_5mm"]["length_mm"] < size[0] < truth["silhouette_mm"][0] + 8
    assert truth["lowest_5mm"]["width_mm"] < size[1] < truth["silhouette_mm"][1] + 8
    layout = read_layout(tmp_path / "layout_left.json")
    x, y = truth["lowest_5mm"]["x_mm"], truth["lowest_5mm"]["y_mm"]
    corners = layout.vertices * 1000
    assert (corners.min(axis=0)[:2] > [x[0] - 0.1, y[0] - 0.1]).all()
    assert (corners.max(axis=0)[:2] < [x[1] + 0.1, y[1] + 0.1]).all()


def test_the_papers_shoe(repository: Path) -> None:
    """H1: 42 taxels of 691 mm^2, at most 250 mm long, overhang below 10 mm; the repository holds this layout."""
    import tomllib

    folder = repository / "sim" / "robots" / "h1"
    facts = tomllib.loads((folder / "robot.toml").read_text())["foot"]
    foot = foot_from_dimensions(
        "h1",
        length=facts["foot_length"],
        width=facts["foot_width"],
        sole_center=tuple(facts["sole_center"]),
        corner_radius=facts["corner_radius"],
    )
    build = build_shoe(foot, taxels=facts["taxels"], layout_only=True)
    for shoe in build.shoes:
        assert len(shoe.layout) == 42
        assert np.ptp(shoe.layout.outline, axis=0)[0] <= 0.250
        assert 0.0 < shoe.plan.overhang <= 10.0
        stored = read_layout(folder / f"layout_{shoe.side}.json")
        np.testing.assert_allclose(shoe.layout.vertices, stored.vertices, atol=1e-6)
        np.testing.assert_allclose(shoe.layout.outline, stored.outline, atol=2e-6)
        assert shoe.layout.corners == stored.corners
        assert shoe.layout.neighbours == stored.neighbours
    assert ShoeParameters().overhang_max == 10.0
