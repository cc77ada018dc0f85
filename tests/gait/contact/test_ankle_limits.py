import numpy as np
import pytest

from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.geometry.polygon import area, centroid, inner_offset

SOLE = np.array([[-0.1, -0.07], [0.14, -0.07], [0.14, 0.07], [-0.1, 0.07]])
TOES = np.array([[0.07, -0.07], [0.14, -0.07], [0.14, 0.07], [0.07, 0.07]])
PITCH = [-1.0, 0.0, 0.0, 0.1, 0.12]  # normal along -x: an ankle 0.12 m high that bears the weight 0.1 m away
ROLL = [0.0, 1.0, 0.02, 0.05, 0.1]  # and one whose joint lies 20 mm to the left


def reach(*strips: list[float], margin: float = 0.015) -> AnkleLimits:
    return AnkleLimits(np.array(strips).reshape(-1, 5), margin)


def test_a_strong_ankle_leaves_all_as_it_is():
    for strong in (reach(), reach([-1.0, 0.0, 0.0, 1.0, 0.1])):
        assert strong.within(TOES).tolist() == TOES.tolist()
        assert strong.center(TOES, np.array([0.105, 0.0])).tolist() == [0.105, 0.0]


def test_a_foot_is_used_as_far_as_its_ankle_limitses():
    region = inner_offset(reach(PITCH, ROLL).within(SOLE), 0.015)
    low, high = region.min(axis=0), region.max(axis=0)
    # 95 % of what it reaches, or 15 mm inside the sole's own edges.
    assert [*low, *high] == pytest.approx([-0.085, 0.02 - 0.0475, 0.095, 0.055])


def test_a_foothold_under_the_toes_is_loaded_where_the_ankle_limitses_and_the_edge_is_far():
    found = reach(PITCH).center(TOES, centroid(TOES))
    assert found == pytest.approx([0.5 * (0.085 + 0.095), 0.0])


def test_one_too_narrow_for_the_margin_is_loaded_in_what_is_reached():
    narrow = TOES * [1.0, 0.2]
    assert area(inner_offset(narrow, 0.015)) == 0.0
    assert reach(PITCH).center(narrow, centroid(narrow)) == pytest.approx([0.5 * (0.07 + 0.095), 0.0])


def test_what_the_ankle_does_not_reach_at_all_is_loaded_where_least_is_missing():
    beyond = TOES + np.array([0.1, 0.0])
    assert reach(PITCH, margin=0.0).within(beyond).tolist() == beyond.tolist()
    # In its middle, 35 mm farther out, a hrp2kai's knee gave way.
    assert reach(PITCH).center(beyond, np.array([0.2, 0.0])) == pytest.approx([0.185, 0.0])


def test_on_a_slope_the_limits_lie_where_the_ankle_is():
    up = np.array([-np.sin(0.17), 0.0])  # the toes rise: the ankle is behind where it stands on the level
    level, sloping = (inner_offset(reach(PITCH).within(SOLE, lean), 0.015) for lean in (np.zeros(2), up))
    assert level.max(axis=0)[0] - sloping.max(axis=0)[0] == pytest.approx(0.12 * np.sin(0.17))
    assert reach(PITCH).center(SOLE, np.zeros(2), up)[0] < reach(PITCH).center(SOLE, np.zeros(2))[0] - 0.009
