"""The kernel of a step in both forms: it is taken where all of its parts agree, and only there."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels import python_form

COMPILED = {n.rpartition(".")[2]: importlib.import_module(f"plantar.kernels.{n}") for n in kernels.KERNELS}


@pytest.mark.parametrize("form", [COMPILED.__getitem__, python_form])
def test_a_slide_and_a_hinge_go_to_their_target_in_one_step(form):
    """A slide along x and a hinge about z: a turn and the way of a point on the hinge's axis."""
    motions = np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
    q, velocity, step, error, jacobian, used = (
        np.zeros(2),
        np.zeros(2),
        np.zeros(2),
        *map(np.zeros, (6, (6, 2), (6, 2))),
    )
    target, wanted, actual, none = np.array([0.3, 0.0, 0.0]), np.eye(3), np.eye(3), np.zeros(3)
    chain, ones = np.array([0, 1]), np.ones(6)
    com = form("task_rows").ComRows(
        *(np.array([0]), np.array([1]), np.ones(1), 1.0, motions, np.zeros((1, 3)), np.array([0]), np.zeros((1, 3))),
        *(target, none, error[:3], jacobian[:3]),
    )
    turn = form("task_rows").TurnRows(chain, motions, wanted, actual, error[3:], jacobian[3:])
    newton = form("newton_step").NewtonStep(
        *(chain, ones, np.ones(2), chain, chain, np.zeros(2), np.ones(2), 0.0, 1e-3),
        *((jacobian, error, q), used, step, velocity),
    )
    empty = np.empty(0, dtype=np.intp)
    configuration = form("configuration").Configuration(chain, chain, empty, empty, q, velocity)
    kernel = form("task_step").TaskStep([com, turn], newton, configuration)
    sine, cosine = 0.6, 0.8
    wanted[:2, :2] = [[cosine, -sine], [sine, cosine]]
    assert kernel.step(1.0)
    assert kernel.near
    np.testing.assert_allclose(q, [0.3, 0.6], rtol=1e-12)
    assert not kernel.step(0.5)  # the hinge would go 0.6 once more
    assert kernel.near
    np.testing.assert_allclose(q, [0.3, 0.6], rtol=1e-12)
    kernel.move()  # as it stands
    np.testing.assert_allclose(q, [0.6, 1.2], rtol=1e-12)
    wanted[:2, :2] *= -1.0
    assert not kernel.step(9.0)
    assert not kernel.near
    np.testing.assert_allclose(q, [0.6, 1.2], rtol=1e-12)
