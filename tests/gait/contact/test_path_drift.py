"""Drift of the ground beside a walk: a filter against least squares over all noises, made drifts, and made ground."""

import math
from unittest import mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.gait.contact import path_drift
from plantar.gait.contact.path_drift import PathDrift
from tests.examples import examples

SPREAD, KEPT = 0.008, 40.0  # a taxel of 28 mm; s
STEP, WAY, STEPS = 1.9, 0.2, 100  # s and m a step: `uneven` of hrp2kai
SEEN, ROW, INNER = 0.076, 0.024, 0.075  # m: half a sole, its rows of taxels, and from its middle to the ground's end


def drifts(steps, random):
    """A heading's course (steps,) in rad, drawn from the model: its bias and its turns by chance."""
    kept = math.exp(-STEP / KEPT)
    bias = random.normal(0.0, path_drift._BIAS)
    heading = [0.0]
    for _ in range(steps - 1):
        heading.append(heading[-1] + STEP * bias + random.normal(0.0, path_drift._TURN * math.sqrt(STEP)))
        bias = kept * bias + random.normal(0.0, path_drift._BIAS * math.sqrt(1.0 - kept**2))
    return np.array(heading)


def walked(headings, random, follows=True, sign=1.0):
    """How far in m to the left of its ground each sole lands, where steps follow the edges that soles see.

    Left soles see their ground end at their right, right soles at their left, `sign` -1 in a mirror.
    """
    drift, offset, beside = PathDrift(SPREAD, KEPT), 0.0, []
    noise = np.zeros(len(headings)) if random is None else random.normal(0.0, 0.0025, len(headings))
    for k, heading in enumerate(headings):
        offset += WAY * heading
        beside.append(offset + noise[k])
        outward = sign if k % 2 == 0 else -sign  # of the left sole
        rows = max(0, math.ceil((SEEN - INNER - ROW / 2 - outward * beside[-1]) / ROW))
        edge = None if rows == 0 or rows > 3 else outward * rows * ROW
        drift.landed(STEP * k, WAY if k else 0.0, edge)
        move = drift.offset(WAY) if follows else 0.0
        if abs(move) > 0.004:
            offset += move
            drift.moved(move)
    return np.array(beside)


def test_it_is_the_least_squares_of_all_noises():
    """Of the bias at first, each change of it and each turn by chance, weighted by what they are likely to be."""
    random = np.random.default_rng(3)
    n, seen = 40, [20, 23, 24, 31, 39]
    kept = math.exp(-STEP / KEPT)
    bias, heading, y = np.zeros((3, 2 * n))
    bias[0] = path_drift._BIAS
    rows = []
    for k in range(n):
        if k:
            y = y + WAY * (heading + 0.5 * STEP * bias)
            heading = heading + STEP * bias
            heading[n + k] = path_drift._TURN * math.sqrt(STEP)
            bias = kept * bias
            bias[k] = path_drift._BIAS * math.sqrt(1.0 - kept**2)
        rows.append(y)
    edges = np.array(rows)[seen] @ random.standard_normal(2 * n) + SPREAD * random.standard_normal(len(seen))
    drift = PathDrift(SPREAD, KEPT)
    for k in range(n):
        drift.landed(STEP * k, WAY, dict(zip(seen, edges.tolist(), strict=True)).get(k))
    weighted = np.vstack([np.array(rows)[seen] / SPREAD, np.eye(2 * n)])
    likely = np.linalg.lstsq(weighted, np.concatenate([edges / SPREAD, np.zeros(2 * n)]))[0]
    assert drift.offset(0.0) == pytest.approx(float(y @ likely), abs=1e-9)
    assert drift.offset(0.3) == pytest.approx(float((y + 0.3 * heading) @ likely), abs=1e-9)


@pytest.mark.parametrize("share", [0.8, 1.0, 1.2])
@given(seed=st.integers(0, 2**31))
@examples(20)
def test_steps_that_follow_edges_stay_on_ground_that_drifts(share, seed):
    """Also where the bias is a fifth smaller or larger than is expected."""
    headings = drifts(STEPS, np.random.default_rng(seed))
    with mock.patch.object(path_drift, "_BIAS", share * path_drift._BIAS):
        beside = walked(headings, np.random.default_rng(seed))
    assert np.abs(beside).max() < 2 * ROW  # the other sole's ground begins there


def test_steps_that_do_not_leave_it():
    left = [
        np.abs(walked(drifts(STEPS, np.random.default_rng(s)), np.random.default_rng(s), follows=False)).max()
        for s in range(20)
    ]
    assert sum(far > 2 * ROW for far in left) > 15


@given(seed=st.integers(0, 2**31), bias=st.floats(-2.0, 2.0))
@examples(20)
def test_a_bias_of_twice_what_is_expected_that_never_changes_is_followed_to_either_side(seed, bias):
    headings = bias * path_drift._BIAS * STEP * np.arange(STEPS)
    assert np.abs(walked(headings, np.random.default_rng(seed))).max() < 2 * ROW


def test_a_mirrored_walk_moves_mirrored():
    headings = drifts(STEPS, np.random.default_rng(7))
    beside = walked(headings, None)
    assert np.abs(beside).max() > 0.01
    assert walked(-headings, None, sign=-1.0) == pytest.approx(-beside, abs=1e-12)


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=100))
def test_whole_soles_move_nothing(ways):
    drift = PathDrift(SPREAD, KEPT)
    for k, way in enumerate(ways):
        drift.landed(STEP * k, way, None)
    assert drift.offset(10.0) == 0.0


@given(st.lists(st.none() | st.floats(-0.08, 0.08), min_size=6, max_size=6))
def test_edges_of_the_first_six_steps_are_no_drift(edges):
    drift = PathDrift(SPREAD, KEPT)
    for k, edge in enumerate(edges):
        drift.landed(STEP * k, WAY, edge)
        assert abs(drift.offset(WAY)) < 0.004  # what steps are moved for at least


def test_ground_with_a_shape_of_its_own_moves_steps_by_less_than_edges_that_drift_explains():
    """After 40 whole soles: an edge on its own, and the same after one that no drift brings there."""
    moves = []
    for first in (None, 0.3):
        drift = PathDrift(SPREAD, KEPT)
        for k in range(40):
            drift.landed(STEP * k, WAY, None)
        drift.landed(STEP * 40, WAY, first)
        drift.moved(drift.offset(0.0))
        drift.landed(STEP * 42, WAY, 0.02)
        moves.append(drift.offset(0.0))
    assert 0.0 < moves[1] < 0.5 * moves[0]
