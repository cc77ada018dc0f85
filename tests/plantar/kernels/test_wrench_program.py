"""The kernel of the wrench distribution's program in both forms against the same in numpy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.mechanics import wrench_program

from ...examples import examples

FORMS = (wrench_program, python_form("wrench_program"))
WEIGHT, LENGTH, NET, PRESSURE, HORIZONTAL = 600.0, 0.1, 1e4, 0.3, 50.0
UNIT = WEIGHT * np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])


class Filled:
    """A kernel of one form with the arrays that it fills."""

    def __init__(self, module, count, fixed):
        self.jacobian, self.hessian = np.zeros((6, 6 * count)), np.zeros((6 * count, 6 * count))
        self.wanted, self.gradient = np.zeros(6), np.ones(6 * count)
        scales = (WEIGHT, LENGTH, NET, PRESSURE, HORIZONTAL)
        filled = (self.jacobian, fixed, self.hessian, self.wanted, self.gradient)
        self.kernel = module.WrenchProgram(scales, np.tile(UNIT, count), *filled)


def net_wrench(contacts, wrenches, point):
    """Net wrench (6,) in the world about a point."""
    total = np.zeros(6)
    for (position, rotation), wrench in zip(contacts, wrenches, strict=True):
        force, moment = rotation @ wrench[:3], rotation @ wrench[3:]
        total += [*force, *(moment + np.cross(position - point, force))]
    return total


def contacts_of(rng, count):
    return [(rng.normal(size=3), Rotation.from_rotvec(rng.normal(size=3)).as_matrix()) for _ in range(count)]


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 4))
def test_it_fills_the_program_that_numpy_would(seed, count):
    rng = np.random.default_rng(seed)
    fixed, shares = rng.normal(size=(6 * count, 6 * count)), rng.uniform(0.0, 1.0, count)
    contacts, point = contacts_of(rng, count), rng.normal(size=3)
    wrench, unknowns = UNIT * rng.normal(size=6), rng.normal(size=6 * count)
    forms, solved = [Filled(module, count, fixed) for module in FORMS], []
    for form in forms:
        assert form.kernel.ask(tuple(wrench.tolist()), tuple(point.tolist()), tuple(shares.tolist()))
        assert all(form.kernel.place(i, *contact) for i, contact in enumerate(contacts))
        assert not any(form.kernel.place(i, *contact) for i, contact in enumerate(contacts))
        assert form.kernel.turn()
        assert form.kernel.weigh(True)
        assert not form.kernel.weigh(False)
        form.kernel.aim()
        form.kernel.finish_gradient()
        largest, error, wrenches = form.kernel.finish(unknowns, "abcd"[:count])
        assert list(wrenches) == list("abcd"[:count])
        solved.append((largest, np.array(list(wrenches.values())), error))
    form, (largest, wrenches, error) = forms[0], solved[0]
    middle = np.mean([position for position, _ in contacts], axis=0)
    wanted = np.concatenate([wrench[:3], wrench[3:] + np.cross(point - middle, wrench[:3])])
    np.testing.assert_allclose(form.wanted, wanted / UNIT, rtol=1e-12, atol=1e-13)
    net = net_wrench(contacts, wrenches, middle)
    np.testing.assert_allclose(form.jacobian @ unknowns, net / UNIT, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(error, net - wanted, rtol=1e-10, atol=1e-9)
    assert largest == pytest.approx(np.abs(error / UNIT).max())
    np.testing.assert_array_equal(wrenches, unknowns.reshape(-1, 6) * UNIT)
    np.testing.assert_array_equal(form.gradient, np.full(6 * count, -NET))
    # Half of v' H v adds the sum over pairs of the squared deviations from the wanted proportion.
    normal = unknowns[2::6]
    off = np.outer(shares, normal) - np.outer(normal, shares)
    added = unknowns @ (form.hessian - fixed) @ unknowns
    level = [(rotation @ unknowns[6 * i : 6 * i + 3])[:2] for i, (_, rotation) in enumerate(contacts)]
    beside = [shares[j] * level[i] - shares[i] * level[j] for i in range(count) for j in range(i)]
    expected = PRESSURE * 0.5 * float((off**2).sum()) + HORIZONTAL * sum(float(f @ f) for f in beside)
    assert added == pytest.approx(expected, rel=1e-9, abs=1e-11)
    for name in ("jacobian", "hessian", "wanted", "gradient"):
        np.testing.assert_array_equal(*(getattr(form, name) for form in forms), err_msg=name)
    for one, other in zip(*solved, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("module", FORMS)
def test_numbers_that_are_not_finite_are_told(module):
    rng = np.random.default_rng(1)
    form = Filled(module, 2, np.eye(12))
    request, (one, other) = [0.0, 0.0, WEIGHT, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0], contacts_of(rng, 2)
    assert form.kernel.ask(request[:6], request[6:], (0.5, 0.5))
    for i in range(9):
        broken = [*request[:i], np.nan, *request[i + 1 :]]
        assert not form.kernel.ask(broken[:6], broken[6:], (0.5, 0.5))
    for shares in ((np.nan, 1.0), (0.5, np.inf), (0.0, 0.0), (-1.0, 0.5)):
        assert not form.kernel.ask(request[:6], request[6:], shares)
    form.kernel.place(0, *one)
    for position in (np.array([0.0, np.nan, 0.0]), np.array([0.0, 0.0, np.inf])):
        assert form.kernel.place(1, position, other[1])
        assert not form.kernel.turn()
    form.kernel.place(1, other[0], np.full((3, 3), np.nan))
    assert not form.kernel.turn()
    for place in range(6):
        unknowns = rng.normal(size=12)
        unknowns[place] = np.nan
        assert np.isnan(form.kernel.finish(unknowns, "ab")[0])


@examples(30)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 3))
def test_the_least_cost_is_numpy_s_where_it_meets_the_constraints(seed, count):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(6 * count, 6 * count))
    fixed = root @ root.T + np.eye(6 * count)
    rows = rng.normal(size=(5, 6 * count))
    for module in FORMS:
        form = Filled(module, count, fixed)
        shares = (1.0 / count,) * count
        assert form.kernel.ask((0.0,) * 6, (0.0,) * 3, shares)
        for i, contact in enumerate(contacts_of(rng, count)):
            form.kernel.place(i, *contact)
        assert form.kernel.turn()
        assert form.kernel.weigh(True)
        form.gradient[:] = rng.normal(size=6 * count)
        least = np.linalg.solve(form.hessian, -form.gradient)
        met = rows @ least
        np.testing.assert_allclose(form.kernel.least_cost(rows, met + 1e-3), least, rtol=1e-7, atol=1e-9)
        met[int(rng.integers(5))] -= 1e-3
        assert form.kernel.least_cost(rows, met) is None
        fixed[0, 0] = -1e6  # no cost has a least value then
        assert form.kernel.weigh(True)
        assert form.kernel.least_cost(rows, met + 1.0) is None
        fixed[0, 0] = (root @ root.T + np.eye(6 * count))[0, 0]
