"""Rules of step feasibility on made-up contacts, and the way around."""

import numpy as np
import pytest

from plantar import InputError, hex_layout
from plantar.gait.propose.feasibility import FeasibilityRules, FootholdProbe, room_ahead, seen_foothold, way_around
from plantar.geometry.polygon import area
from plantar.sensing.proximity import cells_polygon

OUTLINE = np.array([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
LAYOUT = hex_layout(OUTLINE)
RULES = FeasibilityRules()


def probe(mask: np.ndarray, rules: FeasibilityRules = RULES, moment: float = 0.0, noise: float = 1.5) -> FootholdProbe:
    rng = np.random.default_rng(0)
    made = FootholdProbe(LAYOUT, rules)
    load = np.where(mask, 130.0 / max(1, mask.sum()), 0.0)
    for _ in range(25):
        made.update_load(np.clip(load + rng.normal(0.0, noise, len(mask)), 0.0, None), np.array([0.0, moment]))
    return made


def test_a_slab_is_stepped_on_and_a_small_block_is_not():
    whole = probe(np.ones(len(LAYOUT), dtype=bool)).verdict()
    assert whole.feasible
    assert whole.area_ratio > 0.9
    block = probe(np.hypot(*LAYOUT.positions[:, :2].T) < 0.035).verdict()
    assert not block.feasible
    assert block.area_ratio == pytest.approx(area(block.polygon_in_sole) / LAYOUT.sole_area)
    assert 0.05 < block.area_ratio < 0.5


def test_what_is_seen_is_the_contour_of_the_nearest_ground():
    over = LAYOUT.positions[:, 0] > 0.0
    distance = np.where(over, 0.011, 0.041)
    half = seen_foothold(LAYOUT, distance, RULES)
    assert half is not None
    assert not half.feasible
    assert half.polygon_in_sole == pytest.approx(cells_polygon(LAYOUT, over))
    assert half.area_ratio == pytest.approx(area(half.polygon_in_sole) / LAYOUT.sole_area)
    level = seen_foothold(LAYOUT, 0.01 + 0.03 * LAYOUT.positions[:, 0], RULES)
    assert level is not None
    assert level.feasible


def test_nothing_is_refused_by_taxels_that_are_dead_or_see_nothing():
    distance = np.full(len(LAYOUT), 0.01)
    distance[::2] = np.nan
    seen = seen_foothold(LAYOUT, distance, RULES)
    assert seen is not None
    assert seen.feasible
    distance[:] = np.inf
    distance[:2] = 0.01
    assert seen_foothold(LAYOUT, distance, RULES) is None
    assert seen_foothold(LAYOUT, np.full(len(LAYOUT), np.nan), RULES) is None


def test_noise_alone_supports_nothing():
    assert probe(np.zeros(len(LAYOUT), dtype=bool)).verdict().area_ratio == 0.0


def test_dead_taxels_do_not_spoil_the_area():
    made = FootholdProbe(LAYOUT, RULES)
    force = np.full(len(LAYOUT), 4.0)
    force[[3, 9]] = np.nan
    for _ in range(10):
        made.update_load(force, None)
    assert made.verdict().feasible


def test_what_is_seen_right_below_counts_as_supported():
    made = probe(np.zeros(len(LAYOUT), dtype=bool))
    distance = np.full(len(LAYOUT), np.inf)
    made.update_view(distance)
    assert made.verdict().area_ratio == 0.0
    made.update_view(np.where(LAYOUT.positions[:, 0] > 0.0, 0.001, 0.03))
    assert 0.3 < made.verdict().area_ratio < 0.7


@pytest.mark.parametrize(("moment", "feasible"), [(3.0, True), (-3.0, True), (8.5, False), (-8.5, False)])
def test_the_force_torque_rule_goes_by_the_moment_alone(moment, feasible):
    rules = FeasibilityRules(rule="force_torque")
    small = np.hypot(*LAYOUT.positions[:, :2].T) < 0.035
    found = probe(small, rules, moment).verdict()
    assert found.feasible is feasible
    assert found.moment == pytest.approx(abs(moment))
    assert not FootholdProbe(LAYOUT, rules).verdict().feasible  # nothing was sensed


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("seed", range(10))
def test_the_way_around_clears_the_obstacle_by_the_clearance(side, seed):
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-0.06, 0.06, 2), rng.uniform(0.01, 0.04, 2)
    obstacle = np.array([middle - half, middle + half])
    move = way_around(obstacle, OUTLINE, side, RULES)
    if move is None:
        return
    assert np.count_nonzero(move) == 1
    moved = OUTLINE + move
    gaps = [
        obstacle[0, 0] - moved[:, 0].max(),
        moved[:, 0].min() - obstacle[1, 0],
        obstacle[0, 1] - moved[:, 1].max(),
        moved[:, 1].min() - obstacle[1, 1],
    ]
    assert max(gaps) == pytest.approx(RULES.clearance)


def test_a_foot_does_not_go_where_the_other_one_stands_and_gives_up_where_nothing_is_allowed():
    obstacle = np.array([[-0.09, 0.0], [0.09, 0.065]])
    rules = FeasibilityRules(sideways_cost=1.0, outward=0.2, forward=0.02, backward=0.02)
    left = way_around(obstacle, OUTLINE, "left", rules)
    assert left[1] > 0.1
    assert way_around(obstacle, OUTLINE, "right", rules) is not None  # its outward is to the right
    assert way_around(np.array([[-0.3, -0.3], [0.3, 0.3]]), OUTLINE, "left", rules) is None
    assert way_around(np.empty((0, 2)), OUTLINE, "left", rules) is None


@pytest.mark.parametrize("seed", range(20))
def test_the_next_step_of_a_foot_clears_what_it_did_not_step_on(seed):
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-0.06, 0.06, 2), rng.uniform(0.01, 0.04, 2)
    obstacle = np.array([middle - half, middle + half])
    ahead = np.array([rng.uniform(0.1, 0.4), rng.uniform(-0.02, 0.02)])
    more = room_ahead(obstacle, OUTLINE, ahead, RULES)
    heel = OUTLINE[:, 0].min() + ahead[0]
    missing = obstacle[1, 0] + RULES.clearance - heel
    assert more == pytest.approx(missing if 0.0 < missing <= RULES.forward else 0.0)


def test_a_foot_beside_an_obstacle_or_behind_it_goes_no_further_than_planned():
    obstacle = np.array([[-0.03, -0.03], [0.03, 0.03]])
    assert room_ahead(obstacle, OUTLINE, [0.1, 0.0], RULES) > 0.0
    assert room_ahead(obstacle, OUTLINE, [0.1, 0.2], RULES) == 0.0
    assert room_ahead(obstacle, OUTLINE, [0.1, -0.2], RULES) == 0.0
    assert room_ahead(obstacle, OUTLINE, [-0.3, 0.0], RULES) == 0.0


def test_an_unknown_rule_is_refused():
    with pytest.raises(InputError, match="skin, force_torque"):
        FeasibilityRules(rule="eyes")
