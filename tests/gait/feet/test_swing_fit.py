"""The fitted swing against a ridge regression that is written out, with its ends as equations of a KKT system."""

import math

import numpy as np
import pytest
from msgspec.structs import astuple

from plantar.gait.feet.swing_fit import SwingFit, SwingFitRules

PERIOD, HEIGHT = 0.005, 0.05


def basis(s: float, order: int, derivative: int = 0) -> np.ndarray:
    """phi and its derivatives."""
    return np.array([math.perm(k, derivative) * s ** max(k - derivative, 0) for k in range(order + 1)])


class Written:
    """All conditions of one axis with their weights, in shares of the swing."""

    def __init__(self, rules, lasts, start, end, rise=None):
        n, tick = rules.order, PERIOD / lasts
        self.rows, self.values, self.weights = [], [], []
        self.n, self.damping, self.start, self.end = n, rules.damping, start, end
        for s in (0.0, 1.0):
            self.add(basis(s, n, 1), 0.0, rules.position * tick)
            self.add(basis(s, n, 2), 0.0, rules.position * tick**2)
        for s in () if rise is None else (rules.height_share, 1.0 - rules.height_share):
            self.add(basis(s, n), rise, rules.position)

    def add(self, row, value, weight):
        self.rows.append(row)
        self.values.append(value)
        self.weights.append(weight)

    def cost(self, a):
        off = np.array(self.rows) @ a - self.values
        return float(off @ (self.weights * off) + self.damping * a[1:] @ a[1:])

    def best(self):
        """The least cost through both ends, by its KKT system."""
        rows, weights = np.array(self.rows), np.array(self.weights)
        damped = self.damping * np.eye(self.n + 1)
        damped[0, 0] = 0.0  # a_0 is the start, wherever that is
        kept = np.array([basis(0.0, self.n), basis(1.0, self.n)])
        h = (rows.T * weights) @ rows + damped
        kkt = np.block([[h, kept.T], [kept, np.zeros((2, 2))]])
        return np.linalg.solve(kkt, np.r_[(rows.T * weights) @ self.values, self.start, self.end])[: self.n + 1]

    def printed(self):
        """K 14, and then K 16: both ends put in afterwards."""
        rows, weights = np.array(self.rows), np.array(self.weights)
        both = np.vstack([rows, basis(0.0, self.n), basis(1.0, self.n)])
        values, heavy = np.r_[self.values, self.start, self.end], np.r_[weights, 1.0, 1.0]
        a = np.linalg.solve((both.T * heavy) @ both + self.damping * np.eye(self.n + 1), (both.T * heavy) @ values)
        a[0] = self.start
        a[-1] = self.end - self.start - a[1:-1].sum()
        return a


@pytest.mark.parametrize("rules", [SwingFitRules(), SwingFitRules(damping=0.01, order=7)])
def test_each_tick_is_the_best_polynomial_through_both_ends(rules):
    rng, start = np.random.default_rng(0), np.array([0.1, -0.2, 0.05])
    fit, before = SwingFit(rules, start, PERIOD, HEIGHT), (start, np.zeros(3), np.zeros(3))
    for k in range(1, 40):
        lasts, end = 0.3 + 0.05 * math.sin(k), np.array([0.4, -0.3, 0.08]) + 0.02 * rng.normal(size=3)
        found = fit.aim(end, PERIOD * k, lasts)
        n, tick, s = rules.order, PERIOD / lasts, PERIOD * (k - 1) / lasts
        for axis in range(3):
            top = max(start[2], end[2]) + HEIGHT
            problem = Written(rules, lasts, start[axis], end[axis], top if axis == 2 else None)
            for d in range(3):
                problem.add(basis(s, n, d), before[d][axis] * lasts**d, rules.position * tick**d)
            best = problem.best()
            assert problem.cost(best) < problem.cost(problem.printed()) - 1e-12
            now = PERIOD * k / lasts
            wanted = [basis(now, n, d) @ best / lasts**d for d in range(3)]
            if found.position[axis] == pytest.approx(wanted[0], abs=1e-12):  # else kept from turning round
                assert found.velocity[axis] == pytest.approx(wanted[1], abs=1e-8)
                assert found.acceleration[axis] == pytest.approx(wanted[2], abs=1e-6)
            else:
                previous = before[0][axis]
                low, high = sorted((previous, end[axis]))
                kept = previous if axis == 2 else np.clip(wanted[0], low, high)
                assert found.position[axis] == pytest.approx(kept, abs=1e-12)
        before = astuple(found)


def test_as_printed_the_ends_are_put_in_afterwards():
    rules, rng, start = SwingFitRules(damping=0.01, ends="printed"), np.random.default_rng(1), np.zeros(3)
    fit, before = SwingFit(rules, start, PERIOD, HEIGHT), (start, np.zeros(3), np.zeros(3))
    compared = 0
    for k in range(1, 60):
        lasts, end = 0.8 + 0.05 * math.sin(k), np.array([0.2, -0.1, 0.02]) + 0.01 * rng.normal(size=3)
        found = fit.aim(end, PERIOD * k, lasts)
        n, tick, s = rules.order, PERIOD / lasts, PERIOD * (k - 1) / lasts
        for axis in range(3):
            problem = Written(rules, lasts, 0.0, end[axis], max(0.0, end[2]) + HEIGHT if axis == 2 else None)
            for d in range(3):
                problem.add(basis(s, n, d), before[d][axis] * lasts**d, rules.position * tick**d)
            printed = problem.printed()
            wanted = [basis(PERIOD * k / lasts, n, d) @ printed / lasts**d for d in range(3)]
            if found.position[axis] == pytest.approx(wanted[0], abs=1e-12):  # else kept from turning round
                assert found.velocity[axis] == pytest.approx(wanted[1], abs=1e-8)
                assert found.acceleration[axis] == pytest.approx(wanted[2], abs=1e-6)
                compared += 1
        before = astuple(found)
    assert compared > 80


def test_as_printed_the_damping_flattens_the_swing():
    goal = [0.2, 0.0, 0.0]
    printed, kept = (
        path(lambda _: goal, lambda _: 0.8, SwingFitRules(damping=damping, ends=ends))
        for damping, ends in ((0.01, "printed"), (1e-6, "kept"))
    )
    assert printed[:, 2].max() < 0.8 * HEIGHT < kept[:, 2].max()
    assert printed[-1] == pytest.approx(goal)


def path(goal_at, duration_at, rules=None) -> np.ndarray:
    """Positions (n, 3) of a swing whose goal and duration follow the time."""
    fit, found = SwingFit(rules or SwingFitRules(), [0.0, 0.0, 0.0], PERIOD, HEIGHT), []
    for k in range(1, 1000):
        time = PERIOD * k
        found.append(fit.aim(goal_at(time), time, duration_at(time)).position.copy())
        if time >= duration_at(time):
            break
    return np.array(found)


def test_an_undisturbed_swing_is_smooth_and_rests_at_its_ends():
    found = path(lambda _: [0.2, -0.05, 0.0], lambda _: 0.8)
    speed = np.diff(found, axis=0) / PERIOD
    assert found[-1] == pytest.approx([0.2, -0.05, 0.0])
    assert np.abs(speed[[0, -1], :2]).max() < 0.02
    assert np.abs(np.diff(speed, axis=0)).max() / PERIOD < 8.0  # m/s^2; minimum jerk over 0.2 m in 0.8 s has 1.8
    assert 0.05 <= found[:, 2].max() < 0.07


def test_a_goal_that_moves_is_reached_without_a_jump():
    found = path(lambda t: [0.2, 0.1 if t > 0.3 else 0.0, 0.0], lambda t: 0.8 if t < 0.35 else 0.9)
    assert found[-1] == pytest.approx([0.2, 0.1, 0.0])
    assert np.abs(np.diff(found, axis=0)).max() < 0.005  # 5 mm a tick for 100 mm
    papers = path(lambda t: [0.2, 0.1 if t > 0.3 else 0.0, 0.0], lambda _: 0.8, SwingFitRules(damping=0.01))
    assert np.abs(np.diff(papers, axis=0)).max() > 0.005  # which is why the damping is another one


def test_height_rises_and_then_falls_and_nothing_turns_round():
    found = path(lambda t: [0.2 + 0.02 * math.sin(30.0 * t), 0.1, 0.01], lambda t: 0.7 + 0.1 * math.sin(9.0 * t))
    rising = np.diff(found[:, 2])
    turn = int(np.argmax(found[:, 2]))
    assert (rising[:turn] >= 0.0).all()
    assert (rising[turn:] <= 0.0).all()
    assert (np.diff(found[:, 1]) >= 0.0).all()
    assert found[:, 1].max() <= 0.1 + 1e-12


@pytest.mark.parametrize("lasts", [0.02, 0.5, 100.0])
def test_any_duration_is_well_conditioned(lasts):
    fit = SwingFit(SwingFitRules(), [0.0, 0.0, 0.0], PERIOD, HEIGHT)
    for share in (PERIOD / lasts, 0.5, 1.0 - 1e-9):
        found = fit.aim([0.3, 0.1, 0.0], share * lasts, lasts)
        assert np.isfinite(np.concatenate(astuple(found))).all()
        assert -1e-9 <= found.position[0] <= 0.3
    assert fit.aim([0.3, 0.1, 0.0], lasts, lasts).position.tolist() == [0.3, 0.1, 0.0]
    assert fit.aim([0.3, 0.1, 0.0], lasts, 0.0).velocity.tolist() == [0.0, 0.0, 0.0]
