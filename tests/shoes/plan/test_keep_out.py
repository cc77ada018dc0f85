"""Straps, lugs and clips keep out of the way of the robot's other links."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.shoes.build import build_shoe
from plantar.shoes.foot.foot import Foot
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.keep_out import keep_out
from plantar.shoes.solid.retention import choose_retention, strap_meets

from ..foot_family import FAMILY, prism, small_turns, turned

STRAPS = ShoeParameters(retention="straps")


def foot_with(links: np.ndarray | None) -> Foot:
    plate = prism(np.array([[-80, -45], [150, -45], [150, 45], [-80, 45]], dtype=float), 0.0, 25.0)
    block = prism(np.array([[-25, -25], [25, -25], [25, 25], [-25, 25]], dtype=float), 25.0, 60.0)
    return replace(
        foot_from_triangles("a", np.concatenate([plate, block]), where="a", up="z", forward="x"), links=links
    )


def column(low: float, high: float) -> np.ndarray:
    """Points of a link that fills a range of x over the foot."""
    grid = np.meshgrid(np.arange(low, high, 2.0), np.arange(-20, 20, 2.0), np.arange(28.0, 90.0, 2.0))
    return np.stack(grid, axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("links", [None, column(-40.0, 40.0), column(-80.0, 20.0), column(20.0, 150.0)])
def test_straps_are_where_links_leave_room(links):
    foot = foot_with(links)
    plan = build_shoe(foot, side="left", layout_only=True).shoes[0].plan
    held = choose_retention(foot, plan, STRAPS)
    others = keep_out(foot)
    for place in held.places:
        assert strap_meets(others, plan.foot, place.x, held.width, STRAPS) == 0
        near = others.links[np.abs(others.links[:, 0] - place.x) < 0.5 * held.width]
        assert not (near[:, 2] < 40.0).any()  # by hand: none of the shank over the strap's width


def test_a_strap_keeps_off_the_ankle_of_a_foot_without_a_model():
    """A flat plate, whose ankle lies where the rear strap would: its links would come down to the plate there."""
    plate = prism(np.array([[-80, -45], [150, -45], [150, 45], [-80, 45]], dtype=float), 0.0, 25.0)
    rear = 35.0 - 0.2 * 230.0
    foot = foot_from_triangles("a", plate - np.array([rear, 0.0, 0.0]), where="a", up="z", forward="x")
    plan = build_shoe(foot, side="left", layout_only=True).shoes[0].plan
    held = choose_retention(foot, plan, STRAPS)
    assert held.straps == 2
    for place in held.places:
        assert abs(place.x) > 0.5 * held.width + 0.1 * 230.0 - 4.0  # the grid of the shank's points


@pytest.mark.parametrize("turn", [7, 16, 36])
def test_the_upper_end_of_a_tilted_plate_is_no_shank(turn):
    plate = turned(FAMILY["plate"](), *small_turns("plate")[turn])
    links = keep_out(foot_from_triangles("plate", plate, where="plate")).links
    np.testing.assert_allclose(links[links[:, 2] < 20.0].mean(axis=0)[:2], 0.0, atol=2.0)  # above the ankle


def test_a_wall_is_lowered_where_a_link_passes():
    beside = np.stack(np.meshgrid(np.arange(-20, 20, 2.0), [47.0, 48.0], np.arange(8.0, 30.0, 2.0)), -1).reshape(-1, 3)
    build = build_shoe(foot_with(beside), side="left", layout_only=True)
    assert build.parameters.rim_height == 7.0
    assert any("rim_height lowered from 12 to 7 mm: other links" in note for note in build.notes)
    free = build_shoe(foot_with(beside + np.array([0.0, 20.0, 0.0])), side="left", layout_only=True)
    assert free.parameters.rim_height == 12.0
    everywhere = build_shoe(foot_with(beside - np.array([0.0, 0.0, 6.0])), side="left", layout_only=True)
    assert everywhere.parameters.rim_height == 12.0  # which the check of the mounting names


def test_screws_where_neither_straps_nor_clips_have_room():
    sides = np.stack(np.meshgrid(np.arange(-80, 150, 2.0), [-48.0, 48.0], np.arange(20, 40, 2.0)), -1).reshape(-1, 3)
    for links, kind in ((column(-80.0, 150.0), "clips"), (np.concatenate([column(-80.0, 150.0), sides]), "screws")):
        foot = foot_with(links)
        plan = build_shoe(foot, side="left", layout_only=True).shoes[0].plan
        assert choose_retention(foot, plan, ShoeParameters()).kind == kind


def test_a_strap_below_a_link_passes():
    foot = foot_with(column(-40.0, 40.0) + np.array([0.0, 0.0, 80.0]))
    plan = build_shoe(foot, side="left", layout_only=True).shoes[0].plan
    assert strap_meets(keep_out(foot), plan.foot, 0.0, 20.0, STRAPS) == 0
