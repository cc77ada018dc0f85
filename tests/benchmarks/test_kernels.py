"""The comparison of kernels with other routes: rivals, targets, table and figure."""

import csv

import kernel_rivals as rivals
import numpy as np
import pytest
from kernels import copy_share, targets, write_kernel_report

from plantar.bench.comparison import Result

TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def result(kernel: str, route: str, median: float, ratio: float, error: float | None = 0.0) -> Result:
    return Result(kernel, "20", route, route.startswith("plantar"), False, median, 0.0, ratio, error)


def test_rivals_are_right_where_they_should_be():
    assert rivals.hull_scipy(TRIANGLE) == pytest.approx(6.0)
    assert rivals.hull_shapely(TRIANGLE) == rivals.triangle(TRIANGLE) == pytest.approx(6.0)
    assert rivals.rectangle_slsqp(TRIANGLE) == pytest.approx(3.0, rel=1e-6)
    assert rivals.parallelogram_around(TRIANGLE) == pytest.approx(12.0)
    assert 0.97 * 3.0 < rivals.interior_rectangle([TRIANGLE], 0.02) <= 3.0
    holed = [10.0 * SQUARE, 10.0 * (0.25 + 0.5 * SQUARE[::-1])]
    assert rivals.interior_rectangle(holed, 0.05) == pytest.approx(25.0, rel=0.03)
    assert [rivals.triangle(p) for p in rivals.turned(TRIANGLE, 3)] == pytest.approx([6.0] * 3)


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
