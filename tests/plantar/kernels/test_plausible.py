"""What the shell compares each tick: targets with the last ones, and forces on the soles."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.safety import plausible

FORMS = [plausible, kernels.python_form("plausible")]
LIMITS = (0.01, 0.02, 0.05, 30.0)
SHAPES = [(3,), (3, 3), (3,), (3, 3), (3,), (3,), (3, 3), (3,)]
WAYS = (0, 2, 5)  # positions, whose way counts
MOST = [LIMITS[k] for k in (0, 2, 1, 2, 3, 1, 2, 3)]


def targets(rng):
    return [rng.normal(size=shape) for shape in SHAPES]


def command(targets, com=(0.0, 0.0, 0.8), up=1.0):
    """A command with targets, of a state with a CoM over soles at heights of 0 and 0.1 m, and a trunk's cosine."""
    com_target, torso, *rest = targets
    feet = {
        side: SimpleNamespace(position=foot[0], rotation=foot[1], force=foot[2])
        for side, foot in (("left", rest[:3]), ("right", rest[3:]))
    }
    state = SimpleNamespace(
        com=np.array(com),
        rotation_base_to_world=np.diag([1.0, 1.0, up]),
        positions_sole={"left": np.array([0.0, 0.1, 0.1]), "right": np.zeros(3)},
    )
    return SimpleNamespace(com=com_target, rotation_torso=torso, feet=feet, state=state)


@pytest.mark.parametrize("form", FORMS)
def test_targets_within_their_limits(form):
    rng = np.random.default_rng(1)
    for _ in range(200):
        before = targets(rng)
        now = [v + most * rng.uniform(-1.02, 1.02, v.shape) for v, most in zip(before, MOST, strict=True)]
        for k in WAYS:  # most of them within
            now[k] = before[k] + MOST[k] * rng.uniform(-0.6, 0.6, 3)
        moves = form.TargetMoves(*LIMITS)
        moves.within(command(before))
        moved = [b - a for a, b in zip(before, now, strict=True)]
        sizes = [np.linalg.norm(way) if k in WAYS else np.abs(way).max() for k, way in enumerate(moved)]
        expected = all(size <= most for size, most in zip(sizes, MOST, strict=True))
        assert moves.within(command(now)) == expected
        assert moves.within(command(now))  # they are the last ones now


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("which", range(8))
def test_each_target_counts_and_nan_never_passes(form, which):
    before = targets(np.random.default_rng(which))
    for change in (1.01 * MOST[which], np.nan):
        moves = form.TargetMoves(*LIMITS)
        moves.within(command(before))
        now = [v.copy() for v in before]
        now[which].flat[-1] += change
        assert not moves.within(command(now))


@pytest.mark.parametrize("form", FORMS)
def test_soles_that_carry_need_no_other_look(form):
    check = form.SoleCheck(800.0, 240.0)
    assert check.look(np.array([100.0, 200.0]), 2, np.array([50.0]), 1) == 1
    assert check.look(np.array([100.0, 200.0]), 2, np.array([60.0]), 1) == 0  # the left one reports the same
    assert check.look(np.array([100.0, 90.0]), 2, np.array([40.0]), 1) == 0  # less than the robot weighs
    assert check.look(np.array([np.nan, 200.0]), 2, np.array([61.0]), 1) == -1
    assert check.look(np.array([200.0]), 2, np.array([61.0]), 1) == -1
    assert check.look(None, 2, np.array([61.0]), 1) == -1
    assert (check.left, check.right) == (190.0, 40.0)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("which", range(3))
def test_one_number_that_is_not_finite_is_seen(form, which):
    arrays = [np.arange(12.0), np.array([1e200, -1e200, 0.0]), np.full(3, 9.81)]
    assert form.are_finite(*arrays)
    for fault in (np.nan, np.inf, -np.inf):
        arrays[which][1] = fault
        assert not form.are_finite(*arrays)


@pytest.mark.parametrize("form", FORMS)
def test_a_taxel_that_repeats_itself_while_the_others_change(form):
    rng = np.random.default_rng(4)
    check = form.SoleCheck(800.0, 240.0, 16.0, 24)

    def found(ticks, change):
        seen = set()
        for k in range(ticks):
            left, right = (rng.normal(20.0, 1.0, 20) for _ in range(2))
            change(k, left, right)
            check.look(left, 20, right, 20)
            seen.add((check.left_stuck, check.right_stuck))
        return seen

    assert found(100, lambda k, left, right: None) == {(-1, -1)}
    assert found(24, lambda k, left, right: right.put(7, 60.0)) == {(-1, -1)}
    assert found(5, lambda k, left, right: right.put(7, 60.0)) == {(-1, 7)}
    assert found(60, lambda k, left, right: left.put(3, 0.0)) == {(-1, -1)}  # a taxel over a gap
    assert found(60, lambda k, left, right: left.put(range(5), 60.0)) == {(-1, -1)}  # all at the end of their range
    coarse = rng.normal(20.0, 1.0, 20)
    assert found(60, lambda k, left, right: left.put(range(12), coarse[:12])) == {(-1, -1)}  # in coarse steps
    last = [coarse, coarse]

    def slow(k, left, right):  # 50 Hz: between two readings all repeat themselves
        if k % 4 == 0:
            last[:] = left.copy(), right.copy()
        left[:], right[:] = last

    assert found(100, slow) == {(-1, -1)}


@pytest.mark.parametrize("form", FORMS)
def test_the_taxel_that_pulls_most(form):
    check = form.SoleCheck(800.0, 240.0, 16.0)

    def pulls(right):
        check.look(np.full(20, 20.0), 20, np.append(right, np.full(20 - len(right), 20.0)), 20)
        return check.left_pulls, check.right_pulls

    assert pulls([0.0, -15.9]) == (-1, -1)
    assert pulls([0.0, -17.0, np.nan, -18.0]) == (-1, 3)
    assert pulls([-40.0, -17.0, -18.0]) == (-1, -1)  # the sole's zero is off
    assert pulls([]) == (-1, -1)


@pytest.mark.parametrize("form", FORMS)
def test_the_height_of_a_command_s_state(form):
    moves = form.TargetMoves(*LIMITS, 0.5)
    assert moves.height == np.inf
    given = targets(np.random.default_rng(3))
    moves.within(command(given))
    assert moves.height == 0.8
    moves.within(command(given, com=(1.0, 0.0, 0.3)))
    assert moves.height == 0.3
    moves.within(command(given, up=0.49))
    assert moves.height == -np.inf
