"""Tests of the foot in the shoe: gaps measured on a surface whose gaps are known."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.shoes.checks.mounting import check_mounting
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.solid.retention import Retention

Shape = Callable[..., NDArray[np.float64]]
P = ShoeParameters(lead_in=0.0)
NONE = Retention("none", (), 0.0, 0.0, "")


def tray(box: Shape, gap: float, floor: float = P.thickness) -> NDArray[np.float64]:
    """A tray around a foot of 200 x 80 mm."""
    inside = box((-60 - gap, 140 + gap), (-40 - gap, 40 + gap), (floor, 100.0))
    outside = box((-70, 150), (-50, 50), (P.bottom, P.rim_top))
    # The inside is open above: its upper face lies beyond every section that is looked at.
    return np.concatenate([outside, inside[:, ::-1]])


@pytest.fixture(scope="module")
def foot(box):
    body = np.concatenate([box((-60, 140), (-40, 40), (0, 30)), box((-20, 20), (-20, 20), (30, 80))])
    return foot_from_triangles("a", body, where="a")


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("gap", [0.5, 2.0])
def test_gaps_are_those_of_the_tray(box, foot, side, gap):
    found = check_mounting(foot, side, tray(box, gap), NONE, P)
    assert found.gap == pytest.approx(gap, abs=1e-3)
    assert found.gap_on_the_way == pytest.approx(gap, abs=1e-3)
    assert found.play == pytest.approx(gap * np.sqrt(2.0), abs=1e-3)  # at the corners
    assert found.floor_gap == 0.0
    assert found.support_share == pytest.approx(1.0)


def test_a_foot_that_is_wider_above_is_caught_on_its_way(box, foot):
    wide = np.concatenate([box((-60, 140), (-40, 40), (0, 6)), box((-60, 140), (-41, 41), (6, 30))])
    higher = foot_from_triangles("a", wide, where="a")
    found = check_mounting(higher, "left", tray(box, 0.5), NONE, P)
    assert found.gap == 0.0  # it does not fit in place either
    narrow = np.concatenate([box((-60, 140), (-40, 40), (0, 6)), box((-50, 130), (-30, 30), (6, 30))])
    assert check_mounting(foot_from_triangles("a", narrow, where="a"), "left", tray(box, 0.5), NONE, P).gap == (
        pytest.approx(0.5, abs=1e-3)
    )
    # A wall that leans in above a foot that is narrow there stands in the way of its wide lower part.
    leaning = np.concatenate(
        [tray(box, 0.5)[:16], box((-60.5, 140.5), (-40.5, 40.5), (P.thickness, P.thickness + 8.0))[:, ::-1]]
    )
    shut = check_mounting(foot_from_triangles("a", narrow, where="a"), "left", leaning, NONE, P)
    assert shut.gap_on_the_way == 0.0


def test_a_hole_in_the_floor_and_a_foot_above_it_are_told(box, foot):
    holed = np.concatenate([tray(box, 0.5), box((0, 100), (-40, 40), (P.bottom + 0.1, P.thickness - 0.01))[:, ::-1]])
    found = check_mounting(foot, "left", holed, NONE, P)
    assert found.support_share == pytest.approx(0.5, abs=1e-3)
    lifted = replace(foot, triangles=foot.triangles + np.array([0.0, 0.0, 0.4]))
    assert check_mounting(lifted, "left", tray(box, 0.5), NONE, P).floor_gap == pytest.approx(0.4)
