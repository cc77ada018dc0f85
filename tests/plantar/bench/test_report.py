"""The comparison of kernels: references that agree with what is known, targets, tables and figure."""

import csv
import math
import subprocess
import sys

import numpy as np
import pytest

from plantar.bench import references as exact
from plantar.bench import rivals
from plantar.bench.comparison import Reference, Result, Route, compare
from plantar.bench.report import copy_share, targets, write_kernel_report
from plantar.bench.soles import random_outline

TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def result(kernel: str, route: str, median: float, ratio: float, error: float | None = 0.0) -> Result:
    return Result(kernel, "20", route, route.startswith("plantar"), False, median, 0.0, ratio, error)


def test_references_give_what_is_known_of_a_triangle():
    assert exact.hull_area_exact(TRIANGLE) == 6.0
    assert exact.triangle_area_exact(TRIANGLE) == 6.0
    assert exact.circle_radius(TRIANGLE) == pytest.approx(1.0, rel=1e-14)
    assert exact.rectangle_area(TRIANGLE) == pytest.approx(3.0, rel=1e-12)
    assert exact.rectangle_area_any_angle(TRIANGLE, samples=30) == pytest.approx(3.0, rel=1e-9)
    assert exact.parallelogram_area(TRIANGLE, samples=30) == pytest.approx(3.0, rel=1e-12)
    assert exact.least_parallelogram_area(TRIANGLE) == 12.0
    assert exact.least_box_area(TRIANGLE) == 12.0
    assert exact.centroid_exact(TRIANGLE).tolist() == [4.0 / 3.0, 1.0]
    assert exact.closest_point_exact(TRIANGLE, [4.0, 3.0]).tolist() == pytest.approx([2.56, 1.08])


def test_the_reference_of_the_inner_offset_is_right_where_edges_vanish():
    assert exact.inner_offset_area(SQUARE, 0.25) == pytest.approx(0.25, rel=1e-15)
    assert exact.inner_offset_area(SQUARE, 0.6) == 0.0


def test_the_reference_in_an_outline_sees_holes_and_upright_edges():
    corner = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
    assert exact.outline_rectangle_area([corner]) == pytest.approx(4.0, rel=1e-12)
    hole = 0.25 + 0.5 * SQUARE[::-1]
    assert exact.outline_rectangle_area([SQUARE, hole]) == pytest.approx(0.25, rel=1e-12)
    assert exact.outline_rectangle_area([SQUARE, SQUARE + np.array([1.5, 0.0])]) == pytest.approx(1.0, rel=1e-12)


def test_random_outlines_have_the_cells_that_were_asked_for():
    for active, share in ((250, 0.3), (1000, 0.9)):
        outline = random_outline(active, share, 1)
        assert outline.area == pytest.approx(active * 1e-5, rel=0.2)
        assert np.array_equal(outline.points, random_outline(active, share, 1).points)
        assert not np.array_equal(outline.points, random_outline(active, share, 2).points)


def test_rivals_are_right_where_they_should_be():
    assert rivals.hull_scipy(TRIANGLE) == pytest.approx(6.0)
    assert rivals.hull_shapely(TRIANGLE) == rivals.triangle(TRIANGLE) == pytest.approx(6.0)
    assert rivals.rectangle_slsqp(TRIANGLE) == pytest.approx(3.0, rel=1e-6)
    assert rivals.parallelogram_around(TRIANGLE) == pytest.approx(12.0)
    assert 0.97 * 3.0 < rivals.interior_rectangle([TRIANGLE], 0.02) <= 3.0
    holed = [10.0 * SQUARE, 10.0 * (0.25 + 0.5 * SQUARE[::-1])]
    assert rivals.interior_rectangle(holed, 0.05) == pytest.approx(25.0, rel=0.03)
    assert [rivals.triangle(p) for p in rivals.turned(TRIANGLE, 3)] == pytest.approx([6.0] * 3)


def test_a_route_that_raises_or_gives_nan_is_wrong_altogether():
    routes = [
        Route("fine", float, [2.0], ours=True),
        Route("raises", math.sqrt, [-1.0]),
        Route("nan", lambda v: math.nan, [2.0]),
    ]
    found = compare("k", "1", routes, Reference([2.0]), rounds=2, most=0.01)
    assert [r.error for r in found] == [0.0, 1.0, 1.0]
    assert found[0].ratio == 1.0


def test_targets_take_the_worst_size_and_say_whether_they_are_met():
    found = [
        result("closest point", "plantar", 1.0, 1.0, 1e-16),
        result("closest point", "shapely nearest_points, with construction", 9.0, 9.0),
        result("inner offset", "plantar", 1.0, 1.0),
        result("inner offset", "shapely buffer, mitred", 12.0, 12.0),
        result("walking tick", "plantar", 39.0, 1.0, 2e-12),
        result("rectangle inside, any angle", "plantar", 39.0, 1.0, 1e-8),
    ]
    met = {t.what.partition(" against ")[0]: t.met for t in targets(found)}
    assert met == {
        "closest point": False,
        "inner offset": True,
        "walking tick, both feet": True,
        "relative error of the exact kernels": False,
        "relative error at any angle": True,
    }


def test_the_share_of_the_copy_bandwidth_counts_what_is_read_and_written():
    found = [
        result("wrench of a recording", "plantar", 10.0, 1.0),
        result("wrench of a recording", "plantar, with area and CoP", 30.0, 3.0),
        result("wrench of a recording", "copy of the forces", 8.0, 0.8, None),
    ]
    assert copy_share(found) == pytest.approx((102 + 6) / (2 * 102) * 0.8)
    assert copy_share(found[:1]) is None
    assert [(t.figure, t.met) for t in targets(found) if "CoP" in t.what] == [(3.0, False)]


def test_the_report_holds_every_result(tmp_path):
    found = [
        result("hull + area", "plantar, from active taxels", 1.0, 1.0),
        result("hull + area", "scipy ConvexHull, from active taxels", 50.0, 50.0, 1e-16),
    ]
    assert write_kernel_report(tmp_path, found) == ["kernels.md", "kernels.csv", "kernels.png"]
    with (tmp_path / "kernels.csv").open() as file:
        assert [row["route"] for row in csv.DictReader(file)] == [r.route for r in found]
    text = (tmp_path / "kernels.md").read_text()
    assert "| hull + area against scipy ConvexHull, from active taxels | >= 50 times | 50 times | 20 | yes |" in text
    assert (tmp_path / "kernels.png").stat().st_size > 10_000


def test_neither_plantar_nor_the_help_loads_the_measuring():
    code = (
        "import sys, plantar; [getattr(plantar, n) for n in plantar.__all__]; sys.argv = ['plantar', '--help']\n"
        "from plantar import cli\ntry:\n    cli.main()\nexcept SystemExit:\n    pass\n"
        "assert not [m for m in sys.modules if m.startswith('plantar.bench')]"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_headlines_are_against_the_fastest_library_that_gives_the_same_answer():
    def timed(route: str, median: float, size: str, approximate: bool = False) -> Result:
        return Result("walking tick", size, route, route.startswith("plantar"), approximate, median, 0.0, median, 0.0)

    found = targets(
        [
            timed("plantar", 1.0, "20"),
            timed("plantar, percepts", 4.0, "20"),
            timed("slow library", 50.0, "20"),
            timed("quick library", 12.0, "20"),
            timed("quicker, polygons ready", 3.0, "20"),
            timed("quickest (float32)", 2.0, "20"),
            timed("a guess", 0.1, "20", approximate=True),
            timed("plantar", 1.0, "51"),
            timed("quick library", 40.0, "51"),
        ]
    )
    told = {t.what: (t.figure, t.where) for t in found if t.unit == "times"}
    assert told == {
        "walking tick against quick library": (12.0, "20"),
        "walking tick (plantar, percepts) against quick library": (3.0, "20"),
    }
