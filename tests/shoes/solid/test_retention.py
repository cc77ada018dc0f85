"""Tests of what holds the shoe: chosen by what the foot offers."""

from dataclasses import replace

import pytest

from plantar.errors import FootError
from plantar.shoes import build_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.solid.retention import choose_retention, retention_steps


@pytest.fixture(scope="module")
def plate(generated_feet):
    foot = foot_from_triangles("plate", generated_feet["plate"], where="plate")
    return foot, build_shoe(foot, layout_only=True).shoes[0].plan


def test_clips_reach_over_a_free_edge(plate):
    foot, plan = plate
    found = choose_retention(foot, plan, ShoeParameters())
    assert found.kind == "clips"
    assert len(found.places) == 4
    assert {p.side for p in found.places} == {1, -1}
    assert [p.edge for p in found.places] == pytest.approx([18.0] * 4, abs=0.01)
    p = ShoeParameters()
    assert found.strain == pytest.approx(1.5 * p.clip_thickness * p.clip_hook / (18.0 + 2.5) ** 2, rel=0.02)
    steps = retention_steps(foot, plan, found, p)[1]
    tops = [b.z_high for s in steps if s.name == "clips" for b in s.blocks]
    assert max(tops) == pytest.approx(p.thickness + found.top(p), abs=0.5)
    hooks = [b for s in steps if s.name == "clips" for b in s.blocks if b.z_high > p.thickness + 18.0]
    assert any(b.low.intersection(plan.foot).area > p.clip_hook for b in hooks)


def test_straps_take_over_where_clips_cannot_hold(plate):
    foot, plan = plate
    for change, reason in (
        ({"clip_height_max": 12.0}, "18 mm high, above clip_height_max"),
        ({"clip_thickness": 5.0, "clip_hook": 4.0, "material": "PLA"}, "PLA takes 1.5 %"),
    ):
        found = choose_retention(foot, plan, ShoeParameters(**change))
        assert found.kind == "straps"
        assert found.straps == 2
        assert reason in found.note
    with pytest.raises(FootError, match=r"no clips: .*; use straps"):
        choose_retention(foot, plan, ShoeParameters(retention="clips", clip_height_max=12.0))
    flat = replace(foot, triangles=None)
    assert "upper side is not known" in choose_retention(flat, plan, ShoeParameters()).note


def test_a_short_foot_takes_one_narrow_strap(small_foot):
    plan = build_shoe(small_foot, layout_only=True).shoes[0].plan
    found = choose_retention(small_foot, plan, ShoeParameters())
    assert (found.kind, found.straps, found.width) == ("straps", 1, 20.0)
    narrow = choose_retention(small_foot, plan, ShoeParameters(strap_width=40.0))
    assert narrow.width == pytest.approx(120.0 / 6.0)


def test_screws_are_refused_that_would_pass_over_the_foot(plate):
    foot, plan = plate
    assert len(choose_retention(foot, plan, ShoeParameters(retention="screws")).places) == 4
    for low in (3.0, 6.0):
        flat = replace(foot, triangles=foot.triangles * [1.0, 1.0, low / 18.0])
        with pytest.raises(FootError, match=r"M4 screws 6 mm above the sole .* would pass over the foot"):
            choose_retention(flat, plan, ShoeParameters(retention="screws"))
    assert choose_retention(flat, plan, ShoeParameters(retention="screws", rim_height=6.0)).kind == "screws"


def test_what_is_asked_for_is_given(plate):
    foot, plan = plate
    for kind, places in (("none", 0), ("screws", 4), ("straps", 4), ("clips", 4)):
        found = choose_retention(foot, plan, ShoeParameters(retention=kind))
        assert (found.kind, len(found.places)) == (kind, places)


@pytest.mark.parametrize(
    ("height", "size", "change", "reason"),
    [
        (39.0, 200.0, {"robot_mass": 10.0}, "5 g on the shoe in swing are"),
        (39.0, 80.0, {"robot_mass": 150.0}, "in a scuff at the toe, which takes"),
        (16.0, 200.0, {"robot_mass": 60.0, "clip_width": 40.0, "clip_thickness": 4.0}, "200 N"),
    ],
)
def test_clips_that_would_not_hold_or_not_snap_on_give_way_to_straps(box, height, size, change, reason):
    foot = foot_from_triangles("f", box((-0.4 * size, 0.6 * size), (-0.22 * size, 0.22 * size), (0, height)), where="f")
    build = build_shoe(foot, cell_area=300.0, layout_only=True, parameters=ShoeParameters(**change))
    found = choose_retention(foot, build.shoes[0].plan, build.parameters)
    assert found.kind == "straps"
    assert reason in found.note
    mass = change["robot_mass"]
    held = found.pull_off(foot, 0.6, mass, build.parameters)
    assert held.force > held.swing
    assert held.moment > held.scuff
