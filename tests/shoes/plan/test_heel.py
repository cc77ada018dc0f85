"""Tests of the place of the connection board behind the heel."""

import math

import numpy as np
import pytest
import shapely

from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.heel import Heel, find_heel, holder_depth

P = ShoeParameters()


def test_a_straight_heel_has_it_straight_behind():
    foot = shapely.box(-80, -40, 140, 50)
    heel, note = find_heel(foot.buffer(3.5, join_style="mitre"), foot, P)
    assert heel == Heel(-83.5, 5.0, 0.0, True)
    assert note is None
    assert holder_depth(P) == pytest.approx(2.2 + 1.6 + 2.0 * 0.3 + 1.5)


def test_a_slanted_heel_turns_it():
    foot = shapely.affinity.rotate(shapely.box(-80, -40, 140, 40), 30.0, origin=(0, 0))
    heel, note = find_heel(foot.buffer(3.5, join_style="mitre"), foot, P)
    assert math.degrees(heel.turn) == pytest.approx(30.0)
    assert note is None
    np.testing.assert_allclose(heel.point(0.0, 0.0), np.array([-83.5 * math.cos(heel.turn), -83.5 * 0.5]), atol=0.01)
    np.testing.assert_allclose(heel.placed(shapely.Point(3, 2)).coords[0], heel.point(3, 2), atol=1e-9)


def test_a_pointed_heel_may_have_no_room():
    foot = shapely.Polygon([(-120, 0), (140, -40), (140, 40)])
    heel, note = find_heel(foot.buffer(3.5, join_style="mitre", mitre_limit=1.1), foot, ShoeParameters(reach_max=11.0))
    assert not heel.board
    assert note is not None
    assert "no holder for the connection board" in note
    assert not find_heel(foot, foot, ShoeParameters(board_length=0.0))[0].board


def test_the_other_foot_has_it_mirrored():
    heel = Heel(-80.0, 5.0, 0.3, True)
    np.testing.assert_allclose(heel.mirrored().point(2.0, -3.0), heel.point(2.0, 3.0) * [1, -1])
