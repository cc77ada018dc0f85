"""Tests of feet that are given by dimensions or an outline."""

import pytest
import shapely

from plantar.errors import FootError
from plantar.shoes.foot.foot import foot_from_dimensions, foot_from_outline


@pytest.mark.parametrize(
    "change",
    [
        {"length": 5.0},
        {"length": 0.01},
        {"width": float("nan")},
        {"corner_radius": 0.2},
        {"corner_radius": -0.01},
        {"sole_center": (0.0, float("inf"))},
    ],
)
def test_dimensions_out_of_range_are_refused(change):
    good = {"length": 0.2, "width": 0.1, "sole_center": (0.0, 0.0), "corner_radius": 0.01}
    with pytest.raises(FootError, match="foot of a"):
        foot_from_dimensions("a", **(good | change))


def test_an_outline_of_a_foots_size_is_a_foot():
    outline = shapely.Polygon([(-60, -40), (120, -30), (140, 10), (110, 50), (-60, 35)])
    foot = foot_from_outline("a", outline)
    assert foot.sole.equals(outline)
    assert foot.passing(30.0).equals(outline)
    for bad in (shapely.box(0, 0, 30, 20), shapely.box(0, 0, 5000, 200), shapely.box(0, 0, 90, 200)):
        with pytest.raises(FootError, match=r"a: the outline is .*; allowed: 60 to 450 mm long"):
            foot_from_outline("a", bad)


def test_what_passes_a_height_holds_the_sole_and_is_worked_out_once():
    calls = []
    sole = shapely.box(-60, -30, 90, 30)
    foot = foot_from_outline("a", sole)
    wide = type(foot)("a", sole, lambda h: calls.append(h) or shapely.box(-50, -20, 80, 20 + h), 50.0)
    assert wide.passing(20.0).bounds == (-60.0, -30.0, 90.0, 40.0)
    assert wide.passing(20.0) is wide.passing(20.0)
    assert calls == [20.0]
