"""The kernel of static loads against numpy's cross products over each velocity's bodies, in both forms."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.joints import static_load, task_step


@pytest.mark.parametrize("seed", range(6))
def test_a_velocity_holds_the_weight_of_all_that_it_moves(seed):
    rng = np.random.default_rng(seed)
    parents = np.array([0, 0, 1, 2, 1, 0, 5])  # two trees; the world is body 0
    bodies = np.array([1, 1, 2, 3, 4, 4, 6])
    places = np.array([5, 2, 0])
    inertias, motions = rng.normal(size=(7, 10)), rng.normal(size=(7, 6))
    gravity = rng.normal(size=3)
    force = rng.normal(size=3)
    torques = np.zeros(3)
    found = []
    for module in (static_load, python_form("static_load")):
        kernel = module.StaticLoad(parents, bodies, inertias, motions, gravity, places, torques)
        for _ in range(2):
            kernel.weigh()
        weights = np.array(kernel.load)
        center = np.array([0.1, -0.2, 0.3])
        jacobian = np.zeros((3, 7))
        tasks = task_step if module is static_load else python_form("task_step")
        kernel.less(tasks.PointRows(np.array([2, 1, 0]), motions, center, jacobian), force, 0.5, 0.4, 0.2)
        kernel.take()
        moved_by = motions[:3, 3:] + np.cross(motions[:3, :3], [0.5, 0.4, 0.2] - center)
        share = np.concatenate([moved_by @ force, np.zeros(4)])
        np.testing.assert_allclose(torques, (weights - share)[places], rtol=1e-12)
        found.append(weights)
    assert np.array_equal(*found)
    moved = {1: (1, 2, 3, 4), 2: (2, 3), 3: (3,), 4: (4,), 6: (6,)}
    for v, body in enumerate(bodies.tolist()):
        force = -gravity * inertias[list(moved[body]), 9].sum()
        moment = np.cross(inertias[list(moved[body]), 6:9].sum(axis=0), -gravity)
        assert found[0][v] == pytest.approx(motions[v] @ [*moment, *force], abs=1e-12)


@pytest.mark.parametrize("form", [static_load, python_form("static_load")])
def test_soles_that_press_carry_their_load_and_others_none(form):
    rng = np.random.default_rng(4)
    tasks = task_step if form is static_load else python_form("task_step")
    inertias, motions, torques = rng.normal(size=(7, 10)), rng.normal(size=(7, 6)), np.zeros(7)
    tree = np.array([0, 0, 1, 2, 1, 0, 5]), np.array([1, 1, 2, 3, 4, 4, 6])
    kernel = form.StaticLoad(*tree, inertias, motions, rng.normal(size=3), np.arange(7), torques)
    levers = tuple(
        tasks.PointRows(np.array(chain), motions, rng.normal(size=3), np.zeros((3, 7))) for chain in ([2, 1], [4, 0])
    )
    points, places = rng.normal(size=(2, 2)), rng.normal(size=(2, 3))
    for left, right in ((300.0, 100.0), (-5.0, 80.0), (-1.0, -2.0)):
        forces = [np.array([3.0, -2.0, left]), np.array([1.0, 4.0, right])]
        share = kernel.stand(levers, forces[0], points[0], places[0], forces[1], points[1], places[1])
        pressing = max(left, 0.0), max(right, 0.0)
        assert share == (pressing[0] / sum(pressing) if sum(pressing) else 0.5)
        whole = torques.copy()
        kernel.weigh()
        for lever, force, point, place in zip(levers, forces, points, places, strict=True):
            if force[2] > 0.0:
                kernel.less(lever, force, *point.tolist(), float(place[2]))
        kernel.take()
        assert np.array_equal(torques, whole)
