"""Single taxels that report what none can are left out and named; those of sound soles never are."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar import hex_layout
from plantar.common.sides import SIDES
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.safety.taxel_check import AIR, TaxelCheck
from plantar.kernels.safety.plausible import SoleCheck
from plantar.sensing.reading import Reading

PERIOD = 0.005
WEIGHT = 800.0
LAYOUT = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
N = len(LAYOUT)
SWING = Phase(PhaseKind.SINGLE_SUPPORT, 1, 0.0, 1.0, "left")
BOTH = Phase(PhaseKind.DOUBLE_SUPPORT, 1, 0.0, 1.0)
EVEN = np.full(N, 0.5 * WEIGHT / N)


def after(ticks, forces, phase=BOTH, begin=0.0, check=None, pull=9.81):
    """The check and what it makes of the last of some ticks' forces on the left and right sole."""
    check = TaxelCheck(dict.fromkeys(SIDES, LAYOUT), WEIGHT, PERIOD) if check is None else check
    loads = (0.5 * WEIGHT, 0.5 * WEIGHT) if phase is BOTH else (0.0, WEIGHT)
    soles = SimpleNamespace(left=loads[0], right=loads[1], left_pulls=-1, right_pulls=-1)
    words = []
    for i in range(ticks):
        given = {s: Reading(0.0, f.copy()) for s, f in zip(SIDES, forces, strict=True)}
        seen = check.checked(given, soles, np.array([0.0, 0.0, pull]), phase, begin + i * PERIOD)
        soles = SoleCheck(WEIGHT, 0.0, AIR * WEIGHT)
        soles.update(seen["left"].force, N, seen["right"].force, N)
        words.append(check.found)
        check.found = ""
    return check, given, seen, [word for word in words if word]


def with_taxel(index, force, others=EVEN):
    forces = others.copy()
    forces[index] = force
    return forces


@pytest.mark.parametrize("index", [0, 7, N - 1])
def test_a_taxel_that_reads_600_N_while_both_soles_report_too_much_is_left_out(index):
    _, given, seen, words = after(9, (with_taxel(index, 600.0), EVEN))
    assert seen is not given
    assert np.flatnonzero(np.isnan(seen["left"].force)).tolist() == [index]
    assert np.array_equal(seen["right"].force, EVEN)
    assert words == [f"taxel {LAYOUT.ids[index]} of the left sole left out: it reads 600 N"]


@pytest.mark.parametrize(
    "forces",
    [
        (EVEN, EVEN),
        (1.3 * EVEN, 1.3 * EVEN),  # gains, or a heavier robot
        (with_taxel(7, 300.0, 0.3 * EVEN), 0.5 * EVEN),  # a stone under one taxel: no more than the robot weighs
        (2.0 * EVEN * (LAYOUT.positions[:, 0] > 0.07) * 6, EVEN),  # a row along an edge, at an impact
    ],
)
def test_sound_soles_stay_as_they_are(forces):
    _, given, seen, words = after(40, forces)
    assert seen is given
    assert not words


def test_a_corner_that_carries_the_robot_stays():
    forces = (with_taxel(0, 0.76 * WEIGHT, 0.1 * EVEN), 1.3 * EVEN)  # as measured on a partial foothold: 1.5 weights
    _, given, seen, _ = after(40, forces)
    assert seen is given
    forces = (with_taxel(0, 0.76 * WEIGHT, 0.1 * EVEN), 2.0 * EVEN)  # and as it lands, in 1.5 g
    _, given, seen, _ = after(40, forces, pull=15.0)
    assert seen is given


def test_an_impact_on_one_taxel_is_shorter_than_what_is_confirmed():
    _, given, seen, _ = after(7, (with_taxel(7, 600.0), EVEN))
    assert seen is given


def test_what_reads_a_load_in_the_air_is_left_out_until_a_swing_in_which_it_does_not():
    empty = np.zeros(N)
    check, _, seen, words = after(15, (with_taxel(3, 40.0, empty), 2.0 * EVEN), SWING, 0.3)
    assert np.flatnonzero(np.isnan(seen["left"].force)).tolist() == [3]
    assert len(words) == 1
    seen = after(10, (with_taxel(3, 60.0), EVEN), check=check)[2]
    assert np.isnan(seen["left"].force[3])  # on the ground it stays out
    _, given, seen, _ = after(10, (empty, 2.0 * EVEN), SWING, 0.3, check)
    assert seen is not given
    _, given, seen, _ = after(2, (EVEN, EVEN), check=check)
    assert seen is given


@pytest.mark.parametrize(("begin", "count"), [(0.05, 1), (0.6, 1), (0.3, 12)])
def test_a_foot_that_lifts_off_lands_or_touches_something_keeps_its_taxels(begin, count):
    forces = np.zeros(N)
    forces[:count] = 40.0
    _, given, seen, _ = after(20, (forces, 2.0 * EVEN), SWING, begin)
    assert seen is given


def test_a_short_touch_in_the_air_counts_only_where_it_returns_in_each_swing():
    empty = np.zeros(N)
    touched = (with_taxel(3, 150.0, empty), 2.0 * EVEN)
    check = None
    for _ in range(3):
        check, given, seen, _ = after(5, touched, SWING, 0.3, check)
        after(2, (EVEN, EVEN), check=check)
    assert seen is not given
    check = None
    for _ in range(4):
        check, given, seen, _ = after(5, touched, SWING, 0.3, check)
        after(2, (EVEN, EVEN), check=check)
        after(5, (empty, 2.0 * EVEN), SWING, 0.3, check)
        after(2, (EVEN, EVEN), check=check)
        assert seen is given


def test_a_foot_that_catches_a_fall_keeps_its_taxels():
    forces = np.zeros(N)
    forces[3] = 0.5 * WEIGHT
    _, given, seen, _ = after(20, (forces, 0.4 * EVEN), SWING, 0.3)
    assert seen is given


def test_a_taxel_that_pulls_is_left_out_at_any_time_and_until_a_step_in_which_it_does_not():
    check, _, seen, words = after(9, (with_taxel(3, -40.0), EVEN))
    assert np.flatnonzero(np.isnan(seen["left"].force)).tolist() == [3]
    assert words == [f"taxel {LAYOUT.ids[3]} of the left sole left out: it reads -40 N"]
    for out in (True, False):  # a swing ends the step in which it pulled, the next one a step in which it did not
        after(4, (np.zeros(N), 2.0 * EVEN), SWING, 0.3, check)
        seen = after(2, (EVEN, EVEN), check=check)[2]
        assert np.isnan(seen["left"].force[3]) == out


def test_taxels_that_pull_little_at_times_or_together_stay():
    assert after(40, (with_taxel(3, -0.9 * 0.02 * WEIGHT), EVEN))[3] == []
    assert after(8, (with_taxel(3, -40.0), EVEN))[3] == []
    forces = EVEN.copy()
    forces[: N // 4] = -40.0  # a sole whose zero is off
    assert after(40, (forces, EVEN))[3] == []
