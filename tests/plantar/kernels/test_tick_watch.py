"""The kernels of the judge's ticks: where feet stand, and what a walk was at most, against plain Python; both forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts import foot_contacts, ground_reaction
from plantar.kernels.judging import stand_watch, tick_watch

PYTHON = tuple(map(python_form, ("foot_contacts", "ground_reaction", "stand_watch", "tick_watch")))
FORMS = pytest.mark.parametrize(
    "forms", [(foot_contacts, ground_reaction, stand_watch, tick_watch), PYTHON], ids=["compiled", "python"]
)
REACH = 5e-4


@FORMS
def test_a_stand_is_where_it_carried_last_and_slips_from_where_it_did_first(forms):
    rng, watch = np.random.default_rng(1), forms[2].StandWatch(100.0)
    first, last, slip = [None, None], [None, None], [0.0, 0.0]
    for _ in range(3000):
        foot = int(rng.integers(2))
        if rng.random() < 0.01:
            watch.begin(foot)
            first[foot], last[foot], slip[foot] = None, None, 0.0
        force = float(rng.choice([99.9, 100.0, 400.0, np.nan]))
        x, y, yaw = rng.normal(size=3).tolist()
        watch.carry(foot, force, x, y, yaw)
        if force >= 100.0:
            first[foot] = first[foot] or (x, y)
            last[foot] = (x, y, yaw)
            slip[foot] = max(slip[foot], math.dist(first[foot], (x, y)))
        for k in range(2):
            assert bool(watch.stood[k]) == (last[k] is not None)
            assert watch.slip[k] == pytest.approx(slip[k], rel=1e-14)
            if last[k] is not None:
                assert tuple(np.asarray(watch.place)[k].tolist()) == last[k]


def foot_of(lists, rng):
    """A foot with up to 6 contacts somewhere."""
    k = int(rng.integers(0, 7))
    vectors = np.zeros((3 * k, 3))
    vectors[::3], vectors[1::3] = rng.normal(0.0, 0.1, (k, 3)), rng.uniform([-9, -9, 0], [9, 9, 99], (k, 3))
    foot = lists.FootContacts(np.zeros(1, dtype=np.uint8))
    foot.take(np.zeros((k, 2), dtype=np.int32), vectors, np.zeros(k), np.ones(k, dtype=np.uint8))
    return foot


def found(forms, seed):
    """What is found tick by tick in 400 ticks, and what plain Python finds."""
    lists, reactions, stands, ticks = forms
    rng = np.random.default_rng(seed)
    reaction, other = (reactions.GroundReaction(math.nan, 50.0, REACH) for _ in range(2))
    feet, upright, center = stands.StandWatch(100.0), np.eye(3).ravel(), np.zeros(3)
    places, turns, ground = np.zeros((2, 3)), np.zeros((2, 9)), np.zeros(2)
    watch = ticks.TickWatch(
        *(reaction, feet, upright, center, list(places), list(turns), ground, math.cos(math.radians(40.0)), 0.5)
    )
    up, margin, since, errors, off, areas = 1.0, math.inf, math.inf, np.zeros(3), [], [0.0, 0.0]
    told, plain = [], []
    for now in range(400):
        if rng.random() < 0.05:
            foot = int(rng.integers(2))
            watch.margin_since, watch.until[foot], watch.area[foot] = math.inf, now + 30.0, 0.0
            since, areas[foot] = math.inf, 0.0
        upright[8], center[:] = rng.uniform(0.75, 1.0), rng.normal([0.0, 0.0, 0.8], 0.1)
        places[:], turns[:], ground[:] = rng.normal(0.0, 0.1, (2, 3)), rng.normal(size=(2, 9)), rng.uniform(0, 200, 2)
        both = (foot_of(lists, rng), foot_of(lists, rng))
        com, zmp = center + rng.normal(0.0, 0.01, 3), rng.normal(size=2)
        zmp = None if rng.random() < 0.2 else zmp.tolist()
        may_have_fallen = watch.update(both, float(now), com.tolist(), zmp)
        other.update(both)
        _, true, _, depth, _ = other.told()
        if depth is not None:
            margin, since = min(margin, depth), min(since, depth)
            if zmp is not None:
                off.append(math.dist(zmp, true))
        areas = [max(a, other.area(k)) if now <= watch.until[k] else a for k, a in enumerate(areas)]
        up, errors = min(up, upright[8]), np.maximum(errors, np.abs(com - center))
        fallen = upright[8] < math.cos(math.radians(40.0)) or center[2] - places[:, 2].min() < 0.5
        squares, compared = sum(v * v for v in off), len(off)
        told.append([watch.up, watch.margin, watch.margin_since, *watch.errors, *watch.area, watch.squares])
        told[-1] += [watch.compared, may_have_fallen, *np.asarray(feet.place).ravel(), *feet.slip]
        plain.append([up, margin, since, *errors, *areas, pytest.approx(squares, rel=1e-12), compared, fallen])
        for k in range(2):
            if ground[k] >= 100.0:
                assert feet.place[k, 2] == math.atan2(turns[k, 3], turns[k, 0])
                assert np.asarray(feet.place)[k, :2].tolist() == places[k, :2].tolist()
    return told, plain


@FORMS
@pytest.mark.parametrize("seed", range(3))
def test_each_tick_is_what_plain_python_finds(forms, seed):
    told, plain = found(forms, seed)
    assert [row[: len(plain[0])] for row in told] == plain
    assert 0 < sum(row[10] for row in told) < 400


def test_the_two_forms_agree_to_the_last_bit():
    both = [found(forms, 7)[0] for forms in ((foot_contacts, ground_reaction, stand_watch, tick_watch), PYTHON)]
    assert both[0] == both[1]
